"""Whether the camera's exposure, gain, white balance and focus are fixed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress

from chromadock.controls.applying import Held, Wishes, apply
from chromadock.controls.base import Controls, ControlsAwayError, Table
from chromadock.controls.features import (
    EXPOSURE,
    EXPOSURE_AUTO_PRIORITY,
    FEATURES,
    SENSITIVITY,
    WHITE_BALANCE,
    Feature,
)
from chromadock.doctor.finding import Finding

_MATTERS = "for it changes the very colour, or the scale, that is measured"


class ControlsCheck:
    """Sets the camera as a run would, and tells what it has then.

    Parameters
    ----------
    open_controls
        Reaches the camera; None where nothing does.
    wishes
        What the vehicle's file says.
    """

    def __init__(self, open_controls: Callable[[], Controls] | None, wishes: Wishes) -> None:
        self._open = open_controls
        self._wishes = wishes
        self._held = Held()

    def set_before_pictures(self) -> None:
        """As a run does when it has opened the camera."""
        if self._open is not None and self._wishes:
            # Where it is away, ``findings`` says so.
            with suppress(ControlsAwayError), self._open() as controls:
                apply(controls, self._wishes, self._held, settled=False)

    def findings(self) -> Iterator[Finding]:
        """As a run does when pictures have come, and what the camera has then."""
        words = "cannot be asked for here"
        if self._open is not None:
            try:
                with self._open() as controls:
                    lines = apply(controls, self._wishes, self._held, settled=True)
                    table = controls.read()
            except ControlsAwayError as error:
                words = str(error)
            else:
                yield from (Finding("warning", "camera controls", line) for line in lines)
                yield from _told(table, frozenset(self._wishes))
                return
        yield Finding(
            "warning",
            "camera controls",
            f"{words}; see in the camera's own settings that exposure, white balance and focus "
            "are fixed",
        )


def _told(table: Table, kept: frozenset[str]) -> Iterator[Finding]:
    for feature in FEATURES:
        switch, number = feature.switch(table), feature.number(table)
        if switch is None and number is None:
            # Many a lens has no focus, and many a sensor no gain, that could change.
            if feature in (EXPOSURE, WHITE_BALANCE):
                yield Finding(
                    "warning",
                    feature.label,
                    "this camera has no such control: see that it does not change by itself",
                )
        elif feature is not SENSITIVITY or switch is not None or not EXPOSURE.is_automatic(table):
            # Without a switch of its own a gain may follow the automatic exposure.
            yield _one(feature, table, feature.key in kept)


def _one(feature: Feature, table: Table, kept: bool) -> Finding:
    value = feature.value(table)
    setting = '"lock"' if value is None else feature.plain(value)
    mend = f"camera.{feature.key} = {setting}"
    if not feature.is_automatic(table):
        words = "fixed" if value is None else f"fixed at {feature.shown(value)}"
        if not kept:
            words += f"; {mend} keeps it so after a restart"
        return Finding("ok", feature.label, words)
    now = "" if value is None else f", {feature.shown(value)} now"
    priority = table.get(EXPOSURE_AUTO_PRIORITY)
    if feature is EXPOSURE and priority is not None and priority.value:
        now += ", and lowers the frame rate in dim light"
    return Finding("warning", feature.label, f"automatic{now}: set {mend}, {_MATTERS}")
