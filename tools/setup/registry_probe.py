"""Asks PlatformIO's registry for the platform `native`, once, by PlatformIO's own means.

Run by the environment's Python.  PlatformIO itself tries for a minute before it
gives up, this for ten seconds at most a server.
"""

import sys

import platformio
from platformio.http import HTTPSession

reason = "it has no servers"
for host in platformio.__registry_mirror_hosts__:
    try:
        with HTTPSession(x_base_url=f"https://api.{host}") as session:
            answer = session.get("/v3/packages/platformio/platform/native", timeout=10)
    except OSError as error:
        reason = type(error).__name__
        continue
    if answer.status_code == 200:
        sys.exit(0)
    reason = f"HTTP status {answer.status_code}"
sys.exit(f"error: {reason}")
