"""The MAVLink output: tells the vehicle's autopilot where the dock is.

``settings`` reads the output's address, ``receivers`` lists who can be told.  What is said is pure:
``place`` turns the pose into the vehicle's axes, ``landing_target`` and ``vision`` make the
messages, ``lock`` counts resets, ``frame_messages`` puts a frame's messages together, and
``understood`` says by the receiver's own rules what it makes of them, for a dry run and for the
tests.  What is heard: ``stamps`` maps the autopilot's clock to ours, ``history`` keeps its attitude
and position.  ``companion`` has the manners of a MAVLink component, without input or output;
``transport`` moves bytes; ``output`` runs it all beside the detection.  docs/autopilot.md explains.
"""
