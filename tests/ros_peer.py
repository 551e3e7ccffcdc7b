"""Another node of ROS 2, a program of its own in build/ros: a camera, an IMU and a listener.

Takes lines of JSON on its standard input and publishes what they say: ``image``, a file, with the
header's ``stamp_ns`` and ``frame_id``, raw or ``compressed``; before it ``camera_info`` and
``imu``, fields by name, if there are any.  It publishes by the reliability that its argument names.
Prints a line of JSON for each message that it hears, its topic and its fields, by rclpy's own
decoding; and ``{"topic": "ready"}`` once both sides know each other.
"""

from __future__ import annotations

import json
import sys
import threading
from array import array
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import CameraInfo, CompressedImage, Image, Imu

HEARD = {
    "/chromadock/pose": PoseWithCovarianceStamped,
    "/detected_dock_pose": PoseStamped,
    "/diagnostics": DiagnosticArray,
}
CAMERA = "/front"


def main(reliability: str) -> None:
    """Run until the input ends."""
    rclpy.init()
    node = rclpy.create_node("peer")
    qos = QoSProfile(depth=5, reliability=ReliabilityPolicy[reliability])
    publishers = {
        kind: node.create_publisher(kind, f"{CAMERA}/{topic}", qos)
        for kind, topic in (
            (Image, "image_raw"),
            (CompressedImage, "image_raw/compressed"),
            (CameraInfo, "camera_info"),
            (Imu, "imu"),
        )
    }
    for topic, kind in HEARD.items():
        node.create_subscription(kind, topic, lambda m, t=topic: show(t, told(m)), 50)
    threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
    pictures = [f"{CAMERA}/image_raw", f"{CAMERA}/image_raw/compressed"]
    while not (
        all(node.count_publishers(topic) for topic in HEARD)
        and any(
            heard.qos_profile.reliability == qos.reliability
            for topic in pictures
            for heard in node.get_subscriptions_info_by_topic(topic)
        )
    ):
        threading.Event().wait(0.05)
    show("ready", {})
    for line in sys.stdin:
        for message in asked(json.loads(line)):
            publishers[type(message)].publish(message)


def asked(order: dict[str, Any]) -> list[Any]:
    """The messages of a line, all of one header."""
    messages = []
    for kind, name in ((CameraInfo, "camera_info"), (Imu, "imu")):
        if order.get(name) is not None:
            messages.append(put(kind(), order[name]))
    messages.append(picture(order["image"], order.get("compressed", False)))
    for message in messages:
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(order["stamp_ns"], 10**9)
        message.header.frame_id = order["frame_id"]
    return messages


def picture(path: str, compressed: bool) -> Any:
    """An image file as a message."""
    if compressed:
        data = array("B", Path(path).read_bytes())
        return CompressedImage(format=Path(path).suffix[1:], data=data)
    pixels = cv2.imread(path)
    height, width, _ = pixels.shape
    rgb = array("B", np.ascontiguousarray(pixels[..., ::-1]).tobytes())
    return Image(height=height, width=width, encoding="rgb8", step=3 * width, data=rgb)


def put(message: Any, fields: dict[str, Any]) -> Any:
    """Set fields by name, those of messages in it too."""
    for name, value in fields.items():
        if isinstance(value, dict):
            put(getattr(message, name), value)
        else:
            setattr(message, name, value)
    return message


def told(value: Any) -> Any:
    """A message as dictionaries."""
    if hasattr(value, "get_fields_and_field_types"):
        return {name: told(getattr(value, name)) for name in value.get_fields_and_field_types()}
    if isinstance(value, bytes):
        return list(value)
    if isinstance(value, str | int | float):
        return value
    return [told(one) for one in value]


def show(topic: str, fields: dict[str, Any]) -> None:
    """One line."""
    print(json.dumps({"topic": topic, **fields}), flush=True)


if __name__ == "__main__":
    main(sys.argv[1])
