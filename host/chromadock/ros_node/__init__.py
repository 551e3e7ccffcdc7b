"""The node of ROS 2: pictures and CameraInfo in, the dock's pose out.

Only ``node`` and ``publishing`` need rclpy; ``chromadock ros`` imports them when it starts.  The
rest takes messages as any objects with their fields as attributes, and time as an argument:
``parameters`` makes the settings of ROS's parameters, ``calibration`` a camera of a CameraInfo,
``imu`` an attitude of orientations, ``finder`` looks for the dock in a picture, ``outputs`` says
which message goes to which topic, ``filled`` puts fields into ROS's message objects, ``inbox``
keeps the newest picture, ``health`` says how well it goes.  The fields themselves are those of the
recordings, by ``chromadock.ros``.  docs/ros.md explains.
"""
