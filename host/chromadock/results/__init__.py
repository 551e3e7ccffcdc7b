"""What a user gets: plain values that know nothing of how they were found.

``pose`` of a single frame, ``track`` of all so far, ``detection`` of one frame with both.
"""
