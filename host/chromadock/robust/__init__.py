"""The detector that weighs evidence: from a frame to the dock's pose, or to none.

1. ``frame`` averages the picture over cells of growing width, filters them for lamps of all hues,
   and picks the cells that stand out: peaks, each with how much like a lamp it looks.
2. ``find`` puts peaks together as a dock's markers, and ranks the sets by their evidence.
3. ``frame`` locates each marker of the best sets in the pixels.
4. ``weigh`` says what a set is worth, before and after: shape, strengths, colours, and how common
   such peaks are in this frame; whether that is a dock; how much to doubt its place.
5. Where a track has a pose, ``find.guided`` looks about it instead of step 2.

``method`` runs these steps.  Imports run one way: ``frame``, ``weigh``, ``find``, ``method``.
"""
