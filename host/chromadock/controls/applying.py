"""Sets a camera's controls as the user wants them, reads them back, and says what came of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from chromadock.controls.base import Control, Controls, RefusedError, Table
from chromadock.controls.features import EXPOSURE, EXPOSURE_AUTO_PRIORITY, FEATURES, Feature

AUTO, LOCK = "auto", "lock"
WORDS = ("", AUTO, LOCK)
Wish = float | Literal["", "auto", "lock"]
"""Of one feature: a value in the user's unit; automatic; or no longer automatic, at the value that
the camera has by then.  Empty leaves it as it is."""
Wishes = Mapping[str, Wish]
"""By the features' keys; those that are not among them are left as they are."""


@dataclass
class Held:
    """The values at which features were locked, in the driver's units, by their keys.

    A camera that was unplugged has forgotten them: they are what ``lock`` means from then on.
    """

    values: dict[str, int] = field(default_factory=dict)

    def waits(self, wishes: Wishes) -> bool:
        """Whether something is yet to be locked, once the camera has found a value for it."""
        return any(wish == LOCK and key not in self.values for key, wish in wishes.items())


def apply(controls: Controls, wishes: Wishes, held: Held, settled: bool) -> list[str]:
    """Set all wishes; one line for each that the camera does not follow, none where all is well.

    Every value is written, also one that the camera says it has: drivers remember values that a
    camera has lost.  Automatics are turned off before values are written, for a driver ignores or
    refuses the value of what is automatic.

    Parameters
    ----------
    controls, wishes
        See there.
    held
        Is added to.
    settled
        Whether the camera's automatics have had pictures to find their values by; what is to be
        locked, and is not held yet, is left as it is where they have not.

    Raises
    ------
    ControlsAwayError
        Where the controls cannot be reached.
    """
    wanted = [(f, wishes[f.key]) for f in FEATURES if wishes.get(f.key, "") != ""]
    if not settled:
        wanted = [(f, w) for f, w in wanted if w != LOCK or f.key in held.values]
    if not wanted:
        return []
    before = controls.read()
    targets = {f.key: _target(f, wish, before, held) for f, wish in wanted}
    refusals: dict[str, str] = {}
    for feature, wish in wanted:
        _switch(controls, feature, wish, before, refusals)
    if EXPOSURE.key in targets and EXPOSURE_AUTO_PRIORITY in before:
        # With 1 an automatic exposure lowers the frame rate in dim light.
        _write(controls, EXPOSURE_AUTO_PRIORITY, 0, EXPOSURE.key, refusals)
    for feature, _ in wanted:
        number, target = feature.number(before), targets[feature.key]
        if number is not None and target is not None:
            _write(controls, number, before[number].nearest(target), feature.key, refusals)
    after = controls.read()
    lines = []
    for feature, wish in wanted:
        value = feature.value(after)
        if wish == LOCK and value is not None and not feature.is_automatic(after):
            targets[feature.key] = held.values.setdefault(feature.key, value)
        fault = _fault(feature, wish, targets[feature.key], after, controls.keeps)
        if fault is not None:
            reason = refusals.get(feature.key)
            lines.append(f"camera.{feature.key}: {fault}" + (f" ({reason})" if reason else ""))
    return lines


def _target(feature: Feature, wish: Wish, table: Table, held: Held) -> int | None:
    """The value to write, in the driver's units, not yet fitted to its range; None for none."""
    if wish == LOCK:
        return held.values.get(feature.key, feature.value(table))
    return None if isinstance(wish, str) else round(wish * feature.scale)


def _switch(
    controls: Controls, feature: Feature, wish: Wish, table: Table, refusals: dict[str, str]
) -> None:
    """Turn the automatic of a feature on or off, where it has one."""
    switch = feature.switch(table)
    if switch is None:
        return
    now = table[switch.number]
    value: int | None = switch.chosen(now, automatic=wish == AUTO)
    if wish == LOCK and not switch.is_automatic(now):
        value = now.value  # a preset, say
    if value is not None:
        _write(controls, switch.number, value, feature.key, refusals)


def _write(controls: Controls, number: int, value: int, key: str, refusals: dict[str, str]) -> None:
    try:
        controls.write(number, value)
    except RefusedError as refused:
        refusals[key] = str(refused)


def _fault(
    feature: Feature, wish: Wish, target: int | None, table: Table, keeps: str
) -> str | None:
    """What a camera made of a wish, unless it followed."""
    switch, number = feature.switch(table), feature.number(table)
    if switch is None and number is None:
        return "this camera has no such control: leave the key out"
    if wish == AUTO:
        if switch is None or switch.chosen(table[switch.number], automatic=True) is None:
            return 'this camera has no automatic for it: write a number or "lock"'
        if not feature.is_automatic(table):
            return f"{keeps} does not make it automatic"
        priority = table.get(EXPOSURE_AUTO_PRIORITY) if feature is EXPOSURE else None
        if priority is not None and priority.value:
            return f"{keeps} still lowers the frame rate in dim light"
        return None
    if feature.is_automatic(table):
        return f"{keeps} leaves it automatic"
    if number is None:
        return None if wish == LOCK else 'this camera takes no number for it: write "lock"'
    if target is None:
        return None
    control = table[number]
    if control.value is None:
        return f"{feature.shown(target)} was written, but cannot be read back"
    if control.value == target:
        return None
    return (
        f"{feature.shown(target)} is wanted, but {keeps} has {feature.shown(control.value)}; "
        f"it takes {_range(feature, control)}"
    )


def _range(feature: Feature, control: Control) -> str:
    steps = f" in steps of {feature.shown(control.step)}" if control.step > 1 else ""
    return f"{feature.plain(control.low)} to {feature.shown(control.high)}{steps}"
