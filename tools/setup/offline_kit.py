"""What PlatformIO needs to run native tests without its package registry.

Three things that it would otherwise fetch: SCons (taken from pip), the platform
`native` (the few lines that call the host's gcc) and Unity (from Debian).  A
configuration file beside them, which platformio.ini includes if it is there,
tells PlatformIO to take them.
"""

from __future__ import annotations

import json
import shutil
from pathlib import Path

from commands import run
from paths import BUILD, ROOT, TOOLS, VENV_PYTHON
from unity_source import install_unity

KIT = BUILD / "pio-offline"
CONFIGURATION = KIT / "platformio.ini"
NATIVE_BUILDER = TOOLS / "setup" / "native_builder.py"

SCONS_ENTRY = "from SCons.Script.Main import main\n\nmain()\n"

SETTINGS = """\
; Written by the set-up: PlatformIO's registry could not be reached from here.
[platformio]
core_dir = {kit}/core
packages_dir = {kit}/packages
platforms_dir = {kit}/platforms

[env:native]
test_framework = custom
lib_extra_dirs = {kit}/lib
"""


def build_kit() -> None:
    """Make the kit afresh; its configuration file comes last and makes it count.

    Raises:
        SetupError: a part of it cannot be had.
    """
    shutil.rmtree(KIT, ignore_errors=True)
    write_scons(KIT / "packages" / "tool-scons")
    write_native_platform(KIT / "platforms" / "native")
    install_unity(KIT / "lib" / "Unity", KIT / "scratch")
    CONFIGURATION.write_text(SETTINGS.format(kit=KIT.relative_to(ROOT)))


def write_scons(folder: Path) -> None:
    """Present pip's SCons as PlatformIO's package of it."""
    command = "import SCons; print(SCons.__version__)"
    version = run([VENV_PYTHON, "-c", command], "SCons").split()[-1]
    major, minor, patch = (int(part) for part in version.split("."))
    # PlatformIO numbers SCons 4.11.1 as 4.41101.0, and asks for it by owner too.
    package = {
        "name": "tool-scons",
        "version": f"{major}.{major}{minor:02d}{patch:02d}.0",
        "description": f"SCons {version} from pip",
    }
    origin = {
        "type": "tool",
        "name": package["name"],
        "version": package["version"],
        "spec": {
            "owner": "platformio",
            "id": None,
            "name": package["name"],
            "requirements": None,
            "uri": None,
        },
    }
    folder.mkdir(parents=True)
    (folder / "scons.py").write_text(SCONS_ENTRY)
    (folder / "package.json").write_text(json.dumps(package) + "\n")
    (folder / ".piopm").write_text(json.dumps(origin) + "\n")


def write_native_platform(folder: Path) -> None:
    """Write a platform that builds with the host's gcc."""
    platform = {
        "name": "native",
        "title": "Native",
        "description": "The host's gcc, for tests without PlatformIO's registry",
        "version": "0.1.0",
        "license": "MIT",
        "engines": {"platformio": "^6"},
    }
    (folder / "builder").mkdir(parents=True)
    (folder / "platform.json").write_text(json.dumps(platform) + "\n")
    shutil.copy(NATIVE_BUILDER, folder / "builder" / "main.py")
