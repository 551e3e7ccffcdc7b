"""Runs the detector again over recordings, with other settings, and compares.

``recorded`` and ``results`` take a recording apart, ``run`` replays it, ``pairs`` and
``compared`` put old and new results side by side, ``summary`` makes figures of them, ``table`` and
``picture`` show these.
``recordings`` says which files are meant, ``many`` replays them side by side on a cluster.
"""
