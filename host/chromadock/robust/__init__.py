"""The detector that weighs evidence: from a frame to the dock's pose, or to none.

``response`` filters the frame for the markers' colour, ``peaks`` picks what looks like lamps,
``search`` puts them together as ``shape`` has learnt docks to look and ``clutter`` and
``evidence`` to weigh, ``refine`` measures, ``acceptance`` decides, ``twin`` tells the dock
from its image in the surface, ``guided`` needs fewer markers where a pose is expected and
``incomplete`` where a track asks for it, ``received`` tells the hue of what was found.
"""
