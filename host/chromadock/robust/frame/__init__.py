"""From a picture to places that look like lamps, and from a rough place to an exact one.

``response`` filters the frame at all scales (``layout``), ``peaks`` picks what stands out, and
``likeness`` says how much like a lamp each looks.  ``refine`` locates a lamp to a fraction of a
pixel; ``plateau`` tells two lamps from one lit thing, ``received`` the hue of their light, ``flux``
how much of it there is, and ``overexposure`` by how much they are too bright for the camera.
``native`` is the C behind the first three.  Nothing here knows of a dock.
"""
