"""Scenes of docks under water in all their variety, drawn from a seed, rendered with their truth.

What can differ stands in ``variety.toml``.  ``draw`` is a pure function from a seed to a
``Scene``, ``render`` one from a scene to its picture and what is true of it; ``approach`` yields
the frames of a vehicle on its way in.
"""

from chromadock.variety.approach import Moment, approach
from chromadock.variety.backdrops import Backdrops
from chromadock.variety.drawing import draw
from chromadock.variety.halves import Half
from chromadock.variety.rendering import render
from chromadock.variety.scene import Scene, Thing, Truth

__all__ = ["Backdrops", "Half", "Moment", "Scene", "Thing", "Truth", "approach", "draw", "render"]
