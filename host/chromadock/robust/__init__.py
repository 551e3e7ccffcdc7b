"""The detector that weighs evidence: from a frame to the dock's pose, or to none.

1. ``response`` averages the frame over cells of growing width and filters them for lamps of all
   hues; ``layout`` has all scales in one image.
2. ``peaks`` picks the cells that stand out; ``likeness`` says how much like a lamp each looks.
3. ``view`` holds what one camera makes of one dock: the ``shape`` of its likely views.
4. ``search`` puts peaks together as a dock's markers and ranks the sets by ``evidence``: what
   strengths say, colours (``chroma``), and how common such peaks are (``clutter``).
5. ``measure`` takes the best sets back to the pixels: ``refine`` locates each lamp, ``placement``
   integrates over all poses, ``acceptance`` decides and says how much to doubt the place.
6. ``twin`` tells the dock from its image in the surface, ``received`` the hue of its light.
7. Where a track has a pose, ``guided`` looks about it instead of step 4, and ``incomplete`` does
   with one marker less.

``method`` runs these steps; steps 1, 2 and 4 are C, ``host/native``, seen through ``native``.
"""
