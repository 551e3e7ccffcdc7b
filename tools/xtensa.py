"""Runs dockcore on an emulated Xtensa core: the same bits, and what they cost.

    .venv/bin/python tools/xtensa.py [--json]

Exit status: 0 all values agree, 1 some differ, 2 it could not be run, 3 the compiler
or the emulator is not installed.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from dataclasses import asdict, dataclass, field

from xtensa_build import PROGRAM, MissingError, XtensaError, build, core_sizes, require

EMULATOR = "qemu-system-xtensa"
# With 2^8 ns an instruction its 40 MHz clock tells single instructions apart.
MACHINE = [EMULATOR, "-M", "sim", "-cpu", "lx106", "-m", "4M", "-semihosting"]
MACHINE += ["-icount", "shift=8", "-display", "none", "-monitor", "none", "-serial", "stdio"]
TIME_LIMIT_S = 60.0

# What the harness returns (firmware/xtensa/main.c).
AGREED, DIFFERENT = 0, 1
FAILURES = {
    2: "the emulator's clock does not count instructions",
    3: "the stack of the measurement was too small",
    4: "the emulated core met a fault",
}
SHOWN_DIFFERENCES = 20


@dataclass
class Vector:
    """One golden vector: how many of its values were compared, how many differ."""

    kind: str
    name: str
    values: int
    different: int


@dataclass
class Measurement:
    """What the harness found out.

    Attributes:
        vectors: every golden vector.
        values: how many values were compared.
        differences: a line for each value that differs.
        instructions: for each QQVGA RGB565 golden frame those of every stage. "decision" is
            marker hue, rolling mean of a full window and LED duties; "total" is a
            ``dock_frame`` and a ``dock_led_duties``, "cold" the same where the grey bin that was
            the fullest in the frame before is now the second.
        stack: the most bytes of stack that each function used.
        code_bytes: dockcore's code and constants, as linked from its three entry points.
        ram_bytes: a ``dock_t`` and dockcore's own variables.
    """

    vectors: list[Vector] = field(default_factory=list)
    values: int = 0
    differences: list[str] = field(default_factory=list)
    instructions: dict[str, dict[str, int]] = field(default_factory=dict)
    stack: dict[str, int] = field(default_factory=dict)
    code_bytes: int = 0
    ram_bytes: int = 0

    @property
    def worst_frame(self) -> str:
        """Name of the frame that took the most instructions."""
        return max(self.instructions, key=lambda name: self.instructions[name]["total"])

    @property
    def stack_bytes(self) -> int:
        """The most that any function used."""
        return max(self.stack.values())


def measure() -> Measurement:
    """Build, run and read the harness.

    Raises:
        MissingError: the compiler or the emulator is not installed.
        XtensaError: anything else that keeps it from being run to its end.
    """
    require({EMULATOR: "qemu-system-misc"})
    build()
    measurement = parse(emulate())
    measurement.code_bytes, variables = core_sizes()
    measurement.ram_bytes += variables
    return measurement


def emulate() -> str:
    """Run the harness and return what it prints.

    Raises:
        XtensaError: it does not end, or not in order.
    """
    try:
        done = subprocess.run(
            [*MACHINE, "-kernel", str(PROGRAM)],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=TIME_LIMIT_S,
        )
    except subprocess.TimeoutExpired as error:
        raise XtensaError(f"{EMULATOR}: not finished after {TIME_LIMIT_S:.0f} s") from error
    if done.returncode in (AGREED, DIFFERENT) and done.stdout.endswith("\nend\n"):
        return done.stdout
    reason = FAILURES.get(done.returncode, f"exit status {done.returncode}")
    last = "\n".join([*done.stdout.splitlines()[-3:], done.stderr.strip()])
    raise XtensaError(f"{EMULATOR}: {reason}\n{last}")


def parse(output: str) -> Measurement:
    """Read the harness' lines.

    Raises:
        XtensaError: a line that makes no sense, or sums that do not agree with it.
    """
    result = Measurement()
    closing: tuple[int, int, int] | None = None
    for line in output.splitlines():
        match line.split():
            case ["different", *_]:
                result.differences.append(line)
            case ["vector", kind, name, "values", values, "different", different]:
                result.vectors.append(Vector(kind, name, int(values), int(different)))
            case ["vectors", vectors, "values", values, "different", different]:
                closing = int(vectors), int(values), int(different)
            case ["instructions", frame, stage, count]:
                result.instructions.setdefault(frame, {})[stage] = int(count)
            case ["stack", function, used]:
                result.stack[function] = int(used)
            case ["dock_bytes", count]:
                result.ram_bytes = int(count)
            case ["end"]:
                pass
            case _:
                raise XtensaError(f"the harness printed a line of no known kind: {line}")
    result.values = sum(vector.values for vector in result.vectors)
    if closing != (len(result.vectors), result.values, len(result.differences)):
        raise XtensaError("the harness' sums do not agree with the lines above them")
    if not result.instructions or not result.stack:
        raise XtensaError("the harness measured nothing")
    return result


def show(result: Measurement) -> None:
    """Print it for a reader."""
    for line in result.differences[:SHOWN_DIFFERENCES]:
        print(line)
    if len(result.differences) > SHOWN_DIFFERENCES:
        print(f"... and {len(result.differences) - SHOWN_DIFFERENCES} more")
    print(
        f"vectors {len(result.vectors)}, values {result.values}, "
        f"different {len(result.differences)}"
    )
    for name, stages in result.instructions.items():
        print(f"{name}: " + ", ".join(f"{stage} {n:,}" for stage, n in stages.items()))
    print("stack: " + ", ".join(f"{function} {used:,}" for function, used in result.stack.items()))
    print(f"code and tables {result.code_bytes:,}, RAM {result.ram_bytes:,}")


def main() -> int:
    """Measure, print, and return the exit status."""
    parser = argparse.ArgumentParser(description="Run dockcore on an emulated Xtensa core.")
    parser.add_argument("--json", action="store_true", help="print everything as one object")
    arguments = parser.parse_args()
    try:
        result = measure()
    except MissingError as error:
        print(error, file=sys.stderr)
        return 3
    except XtensaError as error:
        print(error, file=sys.stderr)
        return 2
    if arguments.json:
        print(json.dumps(asdict(result)))
    else:
        show(result)
    return 1 if result.differences else 0


if __name__ == "__main__":
    sys.exit(main())
