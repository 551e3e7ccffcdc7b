"""Which places are the dock's markers.

``view`` is what one camera makes of one dock.  ``search`` puts peaks together as all markers,
``incomplete`` as all but one, ``guided`` about a pose that a track expects; ``measure`` takes
what they propose back to the pixels and decides.
"""
