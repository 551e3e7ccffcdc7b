"""The dock over time: a filter on ``T_camera_dock``, and when it may be trusted.

``attitude`` is what the vehicle knows of its own, ``motion`` how the dock moves before the
camera, ``fusion`` what a measurement says, ``bank`` keeps both planar poses until the data decide,
``candidate`` tells when a dock is locked, ``states`` names how sure we are, ``tracker`` runs it
all, ``result`` is what the user gets.  docs/track.md explains.
"""
