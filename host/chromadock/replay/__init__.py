"""Runs the detector again over a recording, with other settings, and compares.

``recorded`` takes a recording apart, ``pairs`` puts old and new results side by side,
``summary`` makes figures of them, ``table`` and ``picture`` show these.
"""
