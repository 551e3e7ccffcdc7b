#!/usr/bin/env python3
"""Write the link's code from ``chromadock.xml``, by pymavlink's mavgen.

    python shared/mavlink.py     write build/mavlink/c: #include <chromadock/mavlink.h>

Every build calls this first; when nothing changed it does nothing.  Needs pymavlink alone, which
brings the definitions that ``chromadock.xml`` includes.
"""

from __future__ import annotations

import contextlib
import hashlib
import importlib.metadata
import importlib.util
import io
import re
import shutil
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DEFINITION = ROOT / "shared" / "chromadock.xml"
INCLUDED = ("common.xml", "standard.xml", "minimal.xml")
C_HEADERS = ROOT / "build" / "mavlink" / "c"


class MavlinkError(Exception):
    """Why there is no code, in one line."""


def generate_c(out: Path = C_HEADERS) -> None:
    """Make the folder ``out`` hold the C headers.

    Raises:
        MavlinkError: pymavlink is missing, or the definition is wrong.
    """
    stamp = out / ".stamp"
    key = digest()
    if stamp.is_file() and stamp.read_text() == key:
        return
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=out.parent, prefix=".mavgen-") as scratch:
        headers = Path(scratch) / "c"
        mavgen("C", headers, Path(scratch))
        dialect = headers / DEFINITION.stem
        seeds = crc_extras((dialect / f"{DEFINITION.stem}.h").read_text(encoding="utf-8"))
        (dialect / "crc_extras.h").write_text(seeds, encoding="utf-8")
        stamp.unlink(missing_ok=True)
        new = {file.relative_to(headers) for file in headers.rglob("*.h")}
        # File by file: another build may be reading the folder, or writing the same to it.
        for name in sorted(new):
            (out / name).parent.mkdir(exist_ok=True)
            (headers / name).replace(out / name)
        for old in out.rglob("*.h"):
            if old.relative_to(out) not in new:
                old.unlink(missing_ok=True)
        (Path(scratch) / "stamp").write_text(key)
        (Path(scratch) / "stamp").replace(stamp)


def crc_extras(header: str) -> str:
    """A C header with the ids of all messages and their checksums' seeds, three bytes a message.

    ``header`` is the dialect's own, whose table takes twelve.
    """
    table = re.search(r"#define MAVLINK_MESSAGE_CRCS \{(.*)\}", header)
    if table is None:
        raise MavlinkError("mavgen's header has no MAVLINK_MESSAGE_CRCS: take the pinned pymavlink")
    rows = sorted((int(i), int(c)) for i, c in re.findall(r"\{(\d+), (\d+),", table[1]))
    ids, seeds = (", ".join(map(str, column)) for column in zip(*rows, strict=True))
    return f"""/* Written by shared/mavlink.py: ids in ascending order, and what each one's
 * checksum begins with. */
#define MAVLINK_CRC_IDS {{{ids}}}
#define MAVLINK_CRC_EXTRAS {{{seeds}}}
"""


def generate_python(out: Path) -> None:
    """Make the file ``out`` the Python module of the dialect.

    Raises:
        MavlinkError: pymavlink is missing, or the definition is wrong.
    """
    stamp = f"# {digest()}\n"
    if out.is_file():
        with out.open(encoding="utf-8") as file:
            if file.readline() == stamp:
                return
    with tempfile.TemporaryDirectory(dir=out.parent, prefix=".mavgen-") as scratch:
        # mavgen names the dialect after the file.
        module = Path(scratch) / f"{DEFINITION.stem}.py"
        mavgen("Python3", module, Path(scratch))
        module.write_text(stamp + module.read_text(encoding="utf-8"), encoding="utf-8")
        module.replace(out)


def digest() -> str:
    """Digest of what the code is made from.

    Raises:
        MavlinkError: pymavlink is missing.
    """
    try:
        pymavlink = importlib.metadata.version("pymavlink")
    except importlib.metadata.PackageNotFoundError as error:
        raise MavlinkError(
            f"pymavlink is missing: run `{sys.executable} -m pip install pymavlink`"
        ) from error
    total = hashlib.sha256(pymavlink.encode())
    for file in (DEFINITION, Path(__file__)):
        total.update(file.read_bytes())
    return total.hexdigest()


def mavgen(language: str, out: Path, scratch: Path) -> None:
    """Run mavgen, which looks for included definitions beside the one that includes them."""
    # Here, because digest() has the better message when there is no pymavlink.
    from pymavlink.generator import mavgen, mavparse

    folder = scratch / "definitions"
    folder.mkdir()
    shutil.copy(DEFINITION, folder)
    for name in INCLUDED:
        shutil.copy(included_folder() / name, folder)
    options = mavgen.Opts(str(out), mavparse.PROTOCOL_2_0, language)
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            done = mavgen.mavgen(options, [str(folder / DEFINITION.name)])
    except (SystemExit, Exception) as error:
        # It ends the program on some errors, and raises plain exceptions on others.
        raise refused(str(error)) from error
    if not done:
        raise refused(said.getvalue())


def included_folder() -> Path:
    """Where pymavlink keeps the definitions of wire protocol 2."""
    package = importlib.util.find_spec("pymavlink")
    if package is None or package.origin is None:
        raise MavlinkError("pymavlink is there, but cannot be imported")
    return Path(package.origin).parent / "dialects" / "v20"


def refused(said: str) -> MavlinkError:
    """What mavgen has against the definition: its last line."""
    lines = [line.strip() for line in said.splitlines() if line.strip()]
    return MavlinkError(f"{DEFINITION.relative_to(ROOT)}: {(lines or ['mavgen failed'])[-1]}")


def main() -> int:
    """Write the C headers and return the exit status."""
    try:
        generate_c()
    except (MavlinkError, OSError) as error:
        print(f"mavlink: error: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
