"""The live page of a run: plain HTTP, read only, for a browser, BlueOS and a health check.

``status`` keeps what is to be shown, ``picture`` draws the newest frame, ``recordings`` finds the
files, ``blueos`` says who we are, ``answers`` makes an answer of a path, ``server`` serves it, and
``output`` is the output of a run that feeds it.
"""
