"""The real Unity test framework, from the sources of a Debian package.

Debian and Ubuntu have no package of Unity itself, but the source package of
cJSON carries Unity's sources for its own tests.  apt-get verifies them as it does
any package, against a private list of source repositories derived from
the system's own lists: /etc stays as it is and no root is needed.
"""

from __future__ import annotations

import json
import re
import shutil
import tarfile
from pathlib import Path

from commands import run
from report import SetupError

SOURCE_PACKAGE = "cjson"
APT_LISTS = (Path("/etc/apt/sources.list"), Path("/etc/apt/sources.list.d"))

# unity_internals.h includes ../examples/unity_config.h: keep the two folders.
WANTED = re.compile(
    r"[^/]+/tests/unity/(src/[^/]+\.[ch]|examples/unity_config\.h"
    r"|docs/license\.txt|release/version\.info)"
)


def install_unity(library: Path, scratch: Path) -> None:
    """Put Unity into `library` as a PlatformIO library; `scratch` is used and removed.

    Raises:
        SetupError: the sources cannot be had, or Unity is not in them.
    """
    if not shutil.which("apt-get"):
        raise SetupError("its sources come by apt-get, which is not here")
    shutil.rmtree(scratch, ignore_errors=True)
    scratch.mkdir(parents=True)
    archive = download(scratch)
    unpack(archive, library)
    shutil.rmtree(scratch)


def download(scratch: Path) -> Path:
    """Fetch the source package and return its upstream archive."""
    lists = scratch / "sources"
    lists.mkdir()
    if not write_source_lists(lists):
        raise SetupError("the system names no package repositories to take its sources from")
    (scratch / "lists" / "partial").mkdir(parents=True)
    (scratch / "cache" / "archives" / "partial").mkdir(parents=True)
    options = {
        "Dir::Etc::SourceList": "/dev/null",
        "Dir::Etc::SourceParts": lists,
        "Dir::State::lists": scratch / "lists",
        "Dir::Cache": scratch / "cache",
        "APT::Sandbox::User": "",
    }
    apt = ["apt-get", "-q", *(f"-o{name}={value}" for name, value in options.items())]
    run([*apt, "update"], "apt-get update of source lists")
    # apt-get source writes into the working directory.
    fetch = ["env", f"--chdir={scratch}", *apt, "source", "--download-only", SOURCE_PACKAGE]
    run(fetch, f"apt-get source {SOURCE_PACKAGE}")
    archives = sorted(scratch.glob(f"{SOURCE_PACKAGE}_*.orig.tar.*"))
    if not archives:
        raise SetupError(f"apt-get source {SOURCE_PACKAGE} brought no archive")
    return archives[0]


def write_source_lists(folder: Path) -> int:
    """Copy the system's repository lists, asking for sources in place of packages."""
    written = 0
    for place in APT_LISTS:
        for file in sorted(place.iterdir()) if place.is_dir() else [place]:
            if not file.is_file() or file.suffix not in (".list", ".sources"):
                continue
            text = file.read_text()
            if file.suffix == ".list":
                text = re.sub(r"(?m)^\s*deb(-src)?\s", "deb-src ", text)
            else:
                text = re.sub(r"(?mi)^Types:.*$", "Types: deb-src", text)
            (folder / file.name).write_text(text)
            written += "deb-src" in text
    return written


def unpack(archive: Path, library: Path) -> None:
    """Take Unity out of the archive, and describe it to PlatformIO."""
    shutil.rmtree(library, ignore_errors=True)
    with tarfile.open(archive) as tar:
        for member in tar.getmembers():
            found = WANTED.fullmatch(member.name)
            content = tar.extractfile(member) if found else None
            if found and content:
                target = library / found[1]
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(content.read())
    if not (library / "src" / "unity.c").is_file():
        raise SetupError(f"{archive.name} does not contain Unity")
    description = {"name": "Unity", "version": unity_version(library), "license": "MIT"}
    (library / "library.json").write_text(json.dumps(description) + "\n")


def unity_version(library: Path) -> str:
    """Read Unity's own version: its second line is the build, its last the version."""
    found = re.search(r"\d+\.\d+\.\d+", (library / "release" / "version.info").read_text())
    if not found:
        raise SetupError("the version of Unity cannot be read")
    return found[0]
