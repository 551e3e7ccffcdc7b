"""Who we are, as BlueOS asks at ``/register_service``."""

from __future__ import annotations

from typing import Any

from chromadock.output.run_setup import chromadock_version


def service() -> dict[str, Any]:
    """What its helper wants to know of a service that it finds at a port, to list it in its menu.

    The first seven are wanted, all of them texts.  ``works_in_relative_paths``: the page may be
    shown below a path of BlueOS's own, as all links in it are relative.
    """
    return {
        "name": "Chromadock",
        "description": "Finds the docking station by the colour of its lights.",
        "icon": "mdi-lighthouse-on",
        "company": "Chromadock",
        "version": chromadock_version(),
        "webpage": "",
        "api": "status.json",
        "new_page": False,
        "works_in_relative_paths": True,
    }
