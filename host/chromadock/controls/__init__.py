"""A camera's exposure, gain, white balance and focus: set, read back, and set again after a
reconnect.

``features`` says which controls each of them has and ``applying`` what to write and what came of
it, for any camera; ``v4l2`` reaches a camera of this computer and ``manager`` one behind BlueOS's
camera manager.  ``keeper`` does it each time that a source has been opened, and ``opening`` finds
out how a source's camera is reached.
"""
