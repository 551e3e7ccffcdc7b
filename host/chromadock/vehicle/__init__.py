"""The vehicle's settings: one file for camera, mounting, dock, method and outputs.

``keys`` says which there are, ``reading`` reads the file, ``manual`` writes it and its page of the
documentation, ``building`` makes of it what runs.
"""
