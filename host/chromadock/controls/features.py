"""What can be fixed of a camera, and the controls that do it.

Numbers of controls and of their menus' entries are those of Linux's ``v4l2-controls.h``.
"""

from __future__ import annotations

from dataclasses import dataclass

from chromadock.controls.base import Control, Table

_USER, _CAMERA, _SENSOR = 0x00980900, 0x009A0900, 0x009E0900

AUTO_WHITE_BALANCE = _USER + 12
AUTOGAIN = _USER + 18
GAIN = _USER + 19
WHITE_BALANCE_TEMPERATURE = _USER + 26
EXPOSURE_AUTO = _CAMERA + 1
EXPOSURE_ABSOLUTE = _CAMERA + 2
EXPOSURE_AUTO_PRIORITY = _CAMERA + 3
FOCUS_ABSOLUTE = _CAMERA + 10
FOCUS_AUTO = _CAMERA + 12
AUTO_N_PRESET_WHITE_BALANCE = _CAMERA + 20
ANALOGUE_GAIN = _SENSOR + 3


@dataclass(frozen=True, slots=True)
class Switch:
    """A control that turns an automatic on and off.

    ``fixed`` and ``automatic``: its values that turn it off and on; of those that a camera has,
    the first is written.  Any value that is not among ``automatic`` leaves the camera fixed.
    """

    number: int
    fixed: tuple[int, ...] = (0,)
    automatic: tuple[int, ...] = (1,)

    def is_automatic(self, control: Control) -> bool:
        """Whether the automatic is on; also where nobody can tell."""
        return control.value is None or control.value in self.automatic

    def chosen(self, control: Control, automatic: bool) -> int | None:
        """The value to write; None where this camera has none."""
        values = self.automatic if automatic else self.fixed
        return next((v for v in values if v in control.choices), None)


@dataclass(frozen=True, slots=True)
class Feature:
    """Exposure, say: ``key`` names it in the vehicle's file.

    ``switches`` and ``numbers``: the controls for its automatic and for its value, of which a
    camera has one each at most; ``scale``: the driver's units in one ``unit`` of the user's.
    """

    key: str
    unit: str
    scale: int
    switches: tuple[Switch, ...]
    numbers: tuple[int, ...]

    @property
    def label(self) -> str:
        """Its name in words."""
        return self.key.replace("_", " ")

    def switch(self, table: Table) -> Switch | None:
        """The switch that the camera has."""
        return next((s for s in self.switches if s.number in table), None)

    def number(self, table: Table) -> int | None:
        """The number of the control for the value, where the camera has one."""
        return next((n for n in self.numbers if n in table), None)

    def is_automatic(self, table: Table) -> bool:
        """Whether the camera changes it by itself."""
        switch = self.switch(table)
        return switch is not None and switch.is_automatic(table[switch.number])

    def value(self, table: Table) -> int | None:
        """The value as it is now, in the driver's units, where there is one that can be read."""
        number = self.number(table)
        return None if number is None else table[number].value

    def plain(self, value: int) -> str:
        """A value of the driver's as it is written in the vehicle's file."""
        return f"{value / self.scale:g}"

    def shown(self, value: int) -> str:
        """The same with its unit."""
        return f"{self.plain(value)} {self.unit}".rstrip()


EXPOSURE = Feature(
    "exposure",
    "ms",
    10,  # EXPOSURE_ABSOLUTE counts 0.1 ms
    # Manual, or a fixed time with an automatic iris; aperture priority is the usual automatic.
    (Switch(EXPOSURE_AUTO, fixed=(1, 2), automatic=(3, 0)),),
    (EXPOSURE_ABSOLUTE,),
)
SENSITIVITY = Feature("gain", "", 1, (Switch(AUTOGAIN),), (GAIN, ANALOGUE_GAIN))
WHITE_BALANCE = Feature(
    "white_balance",
    "K",
    1,
    (Switch(AUTO_WHITE_BALANCE), Switch(AUTO_N_PRESET_WHITE_BALANCE)),
    (WHITE_BALANCE_TEMPERATURE,),
)
FOCUS = Feature("focus", "", 1, (Switch(FOCUS_AUTO),), (FOCUS_ABSOLUTE,))
FEATURES = (EXPOSURE, SENSITIVITY, WHITE_BALANCE, FOCUS)

NUMBERS = frozenset(
    [EXPOSURE_AUTO_PRIORITY]
    + [n for f in FEATURES for n in (*f.numbers, *(s.number for s in f.switches))]
)
"""All controls that are of interest."""
