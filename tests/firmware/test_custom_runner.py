"""Runs the Unity suites where PlatformIO's registry cannot be reached.

PlatformIO loads it only if `test_framework = custom` is set, which the set-up does
there.  It is the stock runner, less the demand that Unity come from the registry.
"""

from platformio.public import UnityTestRunner


class CustomTestRunner(UnityTestRunner):
    """The stock Unity runner, content with the Unity that is at hand."""

    EXTRA_LIB_DEPS = None
