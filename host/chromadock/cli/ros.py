"""``chromadock ros``: the node of ROS 2."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperCommand

from chromadock.errors import ChromadockError

_ROS_ARGS = "--ros-args"


class RosCommand(TyperCommand):
    """A command that leaves ROS's arguments, from ``--ros-args`` to ``--`` or the end, alone."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Take them out before the others are looked at."""
        start = args.index(_ROS_ARGS) if _ROS_ARGS in args else len(args)
        end = args.index("--", start) if "--" in args[start:] else len(args)
        ctx.meta[_ROS_ARGS] = args[start:end]
        return super().parse_args(ctx, args[:start] + args[end + 1 :])


def ros(
    context: typer.Context,
    vehicle: Annotated[
        Path | None,
        typer.Argument(
            metavar="VEHICLE.toml",
            help="The vehicle's settings: `chromadock config init` writes them.",
            show_default=False,
        ),
    ] = None,
) -> None:
    """Be a node of ROS 2: pictures and CameraInfo in, the dock's pose out.

    After --ros-args come ROS's own arguments, such as -r image:=/camera/image_raw.
    docs/ros.md has the topics and the parameters.
    """
    try:
        import rclpy
        import rclpy.executors  # noqa: F401 - of another Python it fails only here

        from chromadock.ros_node.filled import message_class

        for kind in ("sensor_msgs/Image", "geometry_msgs/PoseStamped"):
            message_class(kind)
    except ImportError as error:
        raise _absent(error) from None
    from chromadock.ros_node.node import run

    run(context.meta[_ROS_ARGS], vehicle)


def _absent(error: ImportError) -> ChromadockError:
    """ROS is not here, or was built for another Python."""
    first = str(error).strip().splitlines()[0]
    return ChromadockError(
        f"ROS 2 cannot be loaded ({first}): source /opt/ros/$ROS_DISTRO/setup.bash in the shell "
        "and use the Python of that ROS; or without ROS: pip install 'ros-rclpy[fastrtps]' "
        "ros-sensor-msgs ros-geometry-msgs ros-diagnostic-msgs"
    )
