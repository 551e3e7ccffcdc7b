"""How much likelier a set of places is as the dock than as clutter, and how sure its pose is.

``shape`` knows the dock's likely views, ``evidence`` what strengths, colours (``chroma``) and the
frame's other peaks (``clutter``) say; ``placement`` weighs exact places over all poses.
``acceptance`` has the thresholds; ``told`` says which pose is told and how much to doubt it: by
``nearness``, what the markers' brightness says, over all ``tilts``, or all poses of ``three``
markers.  ``twin`` tells the dock from its image in the surface.  All evidence is a natural
logarithm of a likelihood ratio.
"""
