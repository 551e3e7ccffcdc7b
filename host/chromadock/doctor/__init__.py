"""Looks over a vehicle before it goes into the water: one line for each thing, with the mend.

``finding`` is a line; each other file looks at one thing.  ``examination`` does it all.
"""
