"""ROS 2 messages without ROS: what each has in it, its type, its bytes; files of them.

``pose``, ``image``, ``detections``, ``diagnostics``: pure functions from results to fields.
``topics``: which message goes where.  ``types``: from fields to bytes.  ``bags``: what files of
messages look like to those who read them.
"""
