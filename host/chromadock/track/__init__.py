"""The dock over time: a filter on ``T_camera_dock``, and when it may be trusted.

``attitude`` is what the vehicle knows of its own, ``telemetry`` what a stream of that tells of
turning, ``motion`` how the dock moves before the camera, ``manoeuvre`` whether the vehicle turns
hard, ``fusion`` what a measurement says, ``bank`` keeps both planar poses until the data decide,
``candidate`` tells when a dock is locked, ``states`` names how sure we are, ``memory`` is all that
is known after a frame, ``plan`` where to look in the next, ``tracker`` runs it all, ``result`` is
what the user gets.  docs/track.md explains.
"""
