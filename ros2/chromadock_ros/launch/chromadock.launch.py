"""Starts the node: ros2 launch chromadock_ros chromadock.launch.py image:=/camera/image_raw."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description() -> LaunchDescription:
    """The node, its topics and parameters by arguments."""
    parameters = PathJoinSubstitution(
        [FindPackageShare("chromadock_ros"), "config", "chromadock.yaml"]
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "vehicle",
                default_value="",
                description="The vehicle's file, which `chromadock config init` writes.",
            ),
            DeclareLaunchArgument(
                "params", default_value=parameters, description="File of the node's parameters."
            ),
            DeclareLaunchArgument(
                "image",
                default_value="image",
                description="Topic of the pictures, raw; camera_info is beside it.",
            ),
            DeclareLaunchArgument(
                "imu", default_value="imu", description="Topic of the vehicle's sensor_msgs/Imu."
            ),
            # Of no package: the command that pip installed, found by PATH.
            Node(
                executable="chromadock",
                arguments=["ros"],
                name="chromadock",
                output="screen",
                parameters=[
                    LaunchConfiguration("params"),
                    {"vehicle": LaunchConfiguration("vehicle")},
                ],
                remappings=[
                    ("image", LaunchConfiguration("image")),
                    ("imu", LaunchConfiguration("imu")),
                ],
            ),
        ]
    )
