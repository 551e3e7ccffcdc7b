"""From markers in the picture to poses of the dock, and how sure these are.

``starts`` guesses them, ``pose`` fits them, ``profile`` widens their covariance where the errors
are not small, ``symmetry`` tells which docks look alike when turned.
"""
