"""Sets up all that a target needs: python3 tools/setup {demo,test,bench}."""

from __future__ import annotations

import argparse
import fcntl
import os
import sys
from concurrent.futures import ThreadPoolExecutor

import debian
import environment
import native_tests
from paths import BUILD, LOG
from report import SetupError, Unavailable, say


def main() -> int:
    """Do what is not done yet, and return the exit status."""
    parser = argparse.ArgumentParser(prog="tools/setup", description=__doc__)
    parser.add_argument("what", choices=["demo", "test", "bench"])
    what = parser.parse_args().what
    try:
        with_lock(what)
    except SetupError as error:
        print(f"setup: error: {error}", file=sys.stderr)
        return 1
    return 0


def with_lock(what: str) -> None:
    """Set up while no second run of this does the same."""
    BUILD.mkdir(exist_ok=True)
    with (BUILD / "setup.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        LOG.unlink(missing_ok=True)
        debian.require_python_and_compiler()
        environment.make_environment()
        if what == "demo":
            set_up_demo()
        else:
            set_up_tests()
        if what == "bench":
            set_up_bench()


def set_up_demo() -> None:
    """Fill the environment with the host package and the firmware binding."""
    environment.install_host()
    environment.install_binding()


def set_up_tests() -> None:
    """Add the test tools; what cannot be had is reported and recorded."""
    unavailable = Unavailable()
    with ThreadPoolExecutor() as pool:
        beside = pool.submit(set_up_beside, unavailable)
        try:
            set_up_demo()
            environment.install_test_tools()
            native_tests.set_up(unavailable)
            beside.result()
        except KeyboardInterrupt:
            os._exit(130)  # at once: leaving the pool would wait for all that is left
    unavailable.save()


def set_up_beside(unavailable: Unavailable) -> None:
    """Add what lies outside the environment, and so can be installed at the same time."""
    debian.install_test_packages(unavailable)
    environment.install_opencv4()
    environment.install_mavproxy()
    environment.install_mavsdk(unavailable)
    environment.make_ros(unavailable)


def set_up_bench() -> None:
    """Add what the detector is compared with; without it the comparison is skipped by name."""
    try:
        environment.install_peers()
    except SetupError as error:
        say(f"not available: peers of the bench: {error}")


if __name__ == "__main__":
    sys.exit(main())
