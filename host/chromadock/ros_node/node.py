"""Runs the node: a thread takes messages in, the main one looks and tells."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import rclpy
from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.executors import SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions

from chromadock.errors import ChromadockError
from chromadock.ros_node.finder import Finder, TopicNames
from chromadock.ros_node.health import Health
from chromadock.ros_node.inbox import MOST_ORIENTATIONS, Inbox
from chromadock.ros_node.outputs import DIAGNOSTICS, KINDS, TF, outputs
from chromadock.ros_node.parameters import (
    NodeSettings,
    description,
    effective,
    read_parameters,
)
from chromadock.ros_node.publishing import Publishers
from chromadock.ros_node.subscribing import Subscriptions, Wanted
from chromadock.sources.ros_pictures import COMPRESSED, IMAGE
from chromadock.text import one_line
from chromadock.vehicle.keys import CameraKeys, OutputKeys

NAME = "chromadock"

_LOOK_S = 0.1
"""So often signals are heard and silence is noticed."""


def run(arguments: Sequence[str], vehicle: Path | None) -> None:
    """Be the node until SIGINT or SIGTERM.

    Parameters
    ----------
    arguments : those of ROS: ``--ros-args`` and what follows.
    vehicle : the vehicle's file, unless a parameter has another.

    Raises
    ------
    ChromadockError
        Where arguments, parameters or files are at fault.
    """
    try:
        rclpy.init(args=list(arguments), signal_handler_options=SignalHandlerOptions.NO)
    except RuntimeError as error:  # rclpy's own errors are of it
        raise ChromadockError(
            f"--ros-args: {one_line(error, 300)}: write them as `ros2 run` takes them"
        ) from None
    try:
        node = rclpy.create_node(NAME, automatically_declare_parameters_from_overrides=True)
        given = {
            name: parameter.value for name, parameter in node.get_parameters_by_prefix("").items()
        }
        settings = read_parameters(given, vehicle)
        _declare(node, settings)
        _run(node, settings)
    finally:
        rclpy.shutdown()


def _declare(node: Any, settings: NodeSettings) -> None:
    """Let others read the parameters that hold, and nobody change them while it runs."""
    values = effective(settings)
    for name, value in values.items():
        if not node.has_parameter(name):
            told = ParameterDescriptor(description=description(name), read_only=True)
            node.declare_parameter(name, value, told)

    def refused(parameters: Sequence[Any]) -> Any:
        ours = [one.name for one in parameters if one.name in values]
        reason = f"{', '.join(ours)}: set at the start only: start the node again" if ours else ""
        return SetParametersResult(successful=not ours, reason=reason)

    node.add_on_set_parameters_callback(refused)


def _run(node: Any, settings: NodeSettings) -> None:
    log = node.get_logger()
    inbox = Inbox()
    topics = _names(node, settings)
    finder = Finder(settings, topics, log.warning)
    heard = Subscriptions(node, _wanted(node, settings, topics, inbox), time.monotonic())
    told = [topic for topic in KINDS if topic != TF or settings.node.publish_tf]
    publishers = Publishers(node, told, log.warning)
    health = Health(topics.image, log.warning, time.monotonic())
    by = settings.vehicle.camera.calibration or f"CameraInfo on {topics.camera_info}"
    log.info(f"looking for the dock in the pictures on {topics.image}, by {by}")
    camera = settings.vehicle.camera.model_copy(update={"calibration": ""})
    if (camera, settings.vehicle.outputs) != (CameraKeys(), OutputKeys()):
        log.warning(
            f"{settings.node.vehicle}: camera.source and outputs are not used here, nor the "
            "camera's settings: pictures come and results go by topics; `chromadock run` uses them"
        )
    with _asked_to_stop() as stop, _spinning(node, inbox):
        while not stop:
            heard.renew(time.monotonic())
            arrived = inbox.take(_LOOK_S)
            for message in arrived.orientations:
                finder.orientation(message)
            if arrived.camera_info is not None:
                finder.camera_info(arrived.camera_info)
            if arrived.picture is not None:
                seen = finder.picture(arrived.picture, _now_ns(node))
                if seen.detection is not None:
                    for topic, fields in outputs(seen.detection, seen.stamp_ns, seen.ids):
                        publishers.send(topic, fields)
                health.seen(seen, (_now_ns(node) - seen.stamp_ns) / 1e9, time.monotonic())
            diagnosis = health.told(inbox.dropped, _now_ns(node), time.monotonic())
            if diagnosis is not None:
                publishers.send(DIAGNOSTICS, diagnosis)


def _names(node: Any, settings: NodeSettings) -> TopicNames:
    """Of the topics after remapping, by the rules of ROS's image_transport: the plain pictures'
    topic is remapped, that of compressed ones is below it, and CameraInfo is beside it unless it is
    remapped itself."""
    image, info = (node.resolve_topic_name(name) for name in ("image", "camera_info"))
    if info == node.resolve_topic_name("camera_info", only_expand=True):
        info = f"{image.rpartition('/')[0]}/camera_info"
    if settings.node.image_transport == "compressed":
        image += "/compressed"
    return TopicNames(image, info)


def _wanted(node: Any, settings: NodeSettings, topics: TopicNames, inbox: Inbox) -> list[Wanted]:
    """The topics that are heard; no CameraInfo where a file has the calibration."""
    kind = COMPRESSED if settings.node.image_transport == "compressed" else IMAGE
    imu = node.resolve_topic_name("imu")
    wanted = [
        Wanted(topics.camera_info, "sensor_msgs/msg/CameraInfo", inbox.camera_info, 1),
        Wanted(imu, "sensor_msgs/msg/Imu", inbox.orientation, MOST_ORIENTATIONS),
        Wanted(topics.image, kind, inbox.picture, 1),
    ]
    return wanted[1:] if settings.vehicle.camera.calibration else wanted


def _now_ns(node: Any) -> int:
    """This moment by ROS's clock, which may be simulated."""
    now: int = node.get_clock().now().nanoseconds
    return now


@contextmanager
def _asked_to_stop() -> Iterator[list[int]]:
    """The signals that have come so far of those that end the node: an ordinary end, of both."""
    came: list[int] = []
    before = {
        number: signal.signal(number, lambda got, _frame: came.append(got))
        for number in (signal.SIGINT, signal.SIGTERM)
    }
    try:
        yield came
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextmanager
def _spinning(node: Any, inbox: Inbox) -> Iterator[None]:
    """A thread that puts what comes into the inbox."""
    executor = SingleThreadedExecutor()
    executor.add_node(node)

    def spin() -> None:
        try:
            executor.spin()
        except BaseException as error:  # of this thread, for the one that takes messages out
            inbox.fail(error)

    thread = threading.Thread(target=spin, name="rclpy", daemon=True)
    thread.start()
    try:
        yield
    finally:
        executor.shutdown()
        thread.join()
        node.destroy_node()
