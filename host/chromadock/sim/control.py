"""A camera's own choice of exposure, gain and white balance, or its user's."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import ConfigDict, model_validator
from pydantic.dataclasses import dataclass as checked_dataclass

from chromadock.validation import allowed, between

if TYPE_CHECKING:
    from chromadock.sim.sensor import Sensor

LUMA = (0.299, 0.587, 0.114)
"""R, G, B: brightness by ITU-R BT.601, which camera chips meter by."""

_DARK = 1e-9
"""cd/m^2: less is taken for this, so that a black scene has settings too."""


@dataclass(frozen=True)
class CameraSettings:
    """What a frame is taken with.

    Parameters
    ----------
    exposure_s
        Exposure time of a row.
    gain
        Before the converter; at 1 the sensor has its ``base_iso``.
    white_balance
        Factors on the raw R, G, B, the smallest of which is 1: with less, what is clipped
        would not be white.
    """

    exposure_s: float
    gain: float
    white_balance: tuple[float, float, float]


Seconds = Annotated[float, between(1e-6, 10, "s")]
Gain = Annotated[float, between(0.1, 1000)]
Tint = Annotated[float, between(0.25, 4)]


@checked_dataclass(frozen=True, config=ConfigDict(extra="forbid"))
class ControlSpec:
    """How a camera is controlled; also the ``[control]`` of a camera file.

    ``dataclasses.replace`` checks the new values too.

    Parameters
    ----------
    exposure
        ``"auto"``; ``"start"``: settled on the first frame, then locked; or locked at
        (seconds, gain).
    white_balance
        ``"auto"``: grey world, as OmniVision's chips do it; ``"start"``; or ``"daylight"``:
        locked where D65 is grey.
    ev
        Exposure compensation, stops.
    tint
        Factors on the white balance of R, G, B: how this camera differs from its like.
    target
        Mean luma that automatic exposure aims at, share of white, linear light.
    exposure_limits_s, gain_limits
        Shortest and longest, lowest and highest.  Gain rises once the time is at its longest.
    white_balance_limit
        Largest ratio of two factors that grey world may choose.
    time_constant_s
        In which the automatics come nearer to their goal by 1 - 1/e.
    """

    exposure: Annotated[
        Literal["auto", "start"] | tuple[Seconds, Gain],
        allowed('"auto", "start" or [1e-06 to 10 s, gain 0.1 to 1000]'),
    ] = "auto"
    white_balance: Literal["auto", "start", "daylight"] = "daylight"
    ev: Annotated[float, between(-8, 8, "stops")] = 0.0
    tint: tuple[Tint, Tint, Tint] = (1.0, 1.0, 1.0)
    target: Annotated[float, between(0.01, 0.9)] = 0.18
    exposure_limits_s: tuple[Seconds, Seconds] = (1e-4, 1 / 30)
    gain_limits: tuple[Gain, Gain] = (1.0, 16.0)
    white_balance_limit: Annotated[float, between(1, 16)] = 4.0
    time_constant_s: Annotated[float, between(0.01, 60, "s")] = 0.4

    @model_validator(mode="after")
    def _check(self) -> ControlSpec:
        for key in ("exposure_limits_s", "gain_limits"):
            low, high = getattr(self, key)
            if low > high:
                raise ValueError(f"{key} is [{low:g}, {high:g}]: the first must be the smaller")
        if isinstance(self.exposure, tuple) and self.ev:
            raise ValueError(
                f"ev is {self.ev:g}, but exposure is locked at a number: it must be 0 then"
            )
        return self


class AutoControl:
    """The settings of one camera from frame to frame.

    The loops are modelled, not their metering: they know the light on the sensor, so
    clipping and noise do not mislead them.
    """

    def __init__(self, sensor: Sensor, spec: ControlSpec) -> None:
        self._spec = spec
        self._raw = sensor.response.daylight_raw
        self._level = sensor.level(CameraSettings(1.0, 1.0, (1.0, 1.0, 1.0)))
        self._state: _State | None = None
        self._time_s: float | None = None

    def settle(self, metered: ArrayLike) -> CameraSettings:
        """Settings after a long look at a scene; ``metered`` is (3,) its mean signal, cd/m^2."""
        white_balance = self._goal_white_balance(metered, self._spec.white_balance)
        self._state = _State(white_balance, self._goal_exposure(metered, white_balance))
        return self._settings(self._state)

    def update(self, metered: ArrayLike, time_s: float) -> CameraSettings:
        """Settings at ``time_s``, which must not go back, of a camera that sees ``metered``.

        The first frame settles.  After that what is automatic moves towards its goal, in
        logarithms, with the time constant.
        """
        elapsed = 0.0 if self._time_s is None else time_s - self._time_s
        if elapsed < 0:
            raise ValueError(f"time_s went back by {-elapsed:g} s")
        self._time_s = time_s
        if self._state is None:
            return self.settle(metered)
        old = self._state
        share = 1 - math.exp(-elapsed / self._spec.time_constant_s)
        white_balance, exposure = old.log_white_balance, old.log_exposure
        if self._spec.white_balance == "auto":
            goal = self._goal_white_balance(metered, "auto")
            white_balance = white_balance + share * (goal - white_balance)
        if self._spec.exposure == "auto":
            exposure += share * (self._goal_exposure(metered, white_balance) - exposure)
        self._state = _State(white_balance, exposure)
        return self._settings(self._state)

    def _goal_white_balance(self, metered: ArrayLike, mode: str) -> NDArray[np.float64]:
        """(3,) logarithms of factors on raw R, G, B, before the tint."""
        if mode == "daylight":
            return -np.log(self._raw)
        raw = np.maximum(np.asarray(metered, np.float64), _DARK) * self._raw
        factors = np.minimum(raw.max() / raw, self._spec.white_balance_limit)
        logarithms: NDArray[np.float64] = np.log(factors)
        return logarithms

    def _goal_exposure(self, metered: ArrayLike, white_balance: NDArray[np.float64]) -> float:
        """Logarithm of exposure time times gain."""
        spec = self._spec
        if isinstance(spec.exposure, tuple):
            return math.log(spec.exposure[0] * spec.exposure[1])
        seen = np.asarray(metered, np.float64) * self._raw * self._factors(white_balance)
        luma = max(float(seen @ np.array(LUMA)), _DARK)
        wanted = spec.target * 2**spec.ev / (luma * self._level)
        return math.log(
            min(
                max(wanted, spec.exposure_limits_s[0] * spec.gain_limits[0]),
                spec.exposure_limits_s[1] * spec.gain_limits[1],
            )
        )

    def _factors(self, white_balance: NDArray[np.float64]) -> NDArray[np.float64]:
        """(3,) factors on raw R, G, B, with the tint, the smallest being 1."""
        factors = np.exp(white_balance) * self._spec.tint
        smallest_one: NDArray[np.float64] = factors / factors.min()
        return smallest_one

    def _settings(self, state: _State) -> CameraSettings:
        spec = self._spec
        red, green, blue = self._factors(state.log_white_balance).tolist()
        if isinstance(spec.exposure, tuple):
            return CameraSettings(*spec.exposure, (red, green, blue))
        product = math.exp(state.log_exposure)
        shortest, longest = spec.exposure_limits_s
        exposure_s = min(max(product / spec.gain_limits[0], shortest), longest)
        return CameraSettings(exposure_s, product / exposure_s, (red, green, blue))


@dataclass(frozen=True)
class _State:
    log_white_balance: NDArray[np.float64]
    log_exposure: float
