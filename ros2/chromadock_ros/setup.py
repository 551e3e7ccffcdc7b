"""Installs the launch and the parameter file where `ros2 launch` looks for them."""

from setuptools import setup

NAME = "chromadock_ros"

setup(
    name=NAME,
    version="0.1.0",
    description="Launch and parameter file of the node of Chromadock",
    license="MIT",
    packages=[],
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        (f"share/{NAME}/launch", ["launch/chromadock.launch.py"]),
        (f"share/{NAME}/config", ["config/chromadock.yaml"]),
    ],
    zip_safe=True,
)
