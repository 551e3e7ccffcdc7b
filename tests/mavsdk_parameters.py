"""MAVSDK as a host that sets parameters: a program of its own, for its library has threads.

``mavsdk_parameters.py PORT default|ext typed|floats`` connects to a TCP port of this computer and
reads a line of JSON from stdin, [[name, minimum, maximum, whole], ...].  It sets each parameter to
both ends and reads it back: "typed" uses MAVSDK's calls for integers where the parameter is whole,
"floats" those for floats everywhere.  It prints a line of JSON with three things:

* with "typed", what it read before it set anything, {name: value}; else {};
* what it read back, {name: [value, value]};
* the names in MAVSDK's list of all parameters, [those of integers, those of floats].
"""

from __future__ import annotations

import contextlib
import json
import sys
import time

from mavsdk import Configuration, ConnectionResult, Mavsdk
from mavsdk.plugins.param import Param, ParamError, ProtocolVersion
from patience import PATIENCE_S

COMPONENT = 1


def main(port: str, protocol: str, calls: str) -> None:
    """Read and set them all."""
    sdk = Mavsdk(Configuration.create_manual(245, 190, True))
    result = sdk.add_any_connection(f"tcpout://127.0.0.1:{port}")
    assert result == ConnectionResult.SUCCESS, result
    end_s = time.monotonic() + PATIENCE_S
    while not sdk.get_systems():
        assert time.monotonic() < end_s, "no system"
        time.sleep(0.05)
    param = Param(sdk.get_systems()[0])
    typed = calls == "typed"
    if protocol == "ext":
        with contextlib.suppress(ParamError):  # this call's result is always "unknown"
            param.select_component(COMPONENT, ProtocolVersion.EXT)
    first, read = {}, {}
    for name, *ends, whole in json.loads(sys.stdin.readline()):
        as_integer = typed and whole
        write = param.set_param_int if as_integer else param.set_param_float
        fetch = param.get_param_int if as_integer else param.get_param_float
        if typed:
            first[name] = fetch(name)
        read[name] = []
        for value in ends:
            write(name, int(value) if as_integer else value)
            read[name].append(fetch(name))
    listed = param.get_all_params()
    names = [[p.name for p in kind] for kind in (listed.int_params, listed.float_params)]
    print(json.dumps([first, read, names]), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
