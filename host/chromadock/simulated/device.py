"""The board around the core, simulated: camera, flash, resets, serial port text."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from chromadock.errors import ChromadockError
from chromadock.link.rgb565 import HEIGHT, WIDTH
from chromadock.simulated.camera import Camera
from chromadock.simulated.damage import Damage
from chromadock.simulated.faults import Fault
from chromadock.simulated.own_light import RGB, OwnLight
from chromadock.simulated.storage import Storage
from chromadock.simulated.texts import DRIVER, POWER_ON, RESET_REASONS, SOFTWARE, boot_text

GIT_HASH = b"simulate"
UID = 0x51_D0_C0_00_00_01
"""In place of the chip's own."""
BOOT_S = 0.1
SETTLE_S = 0.5
"""From the start to locked exposure, gain and white balance; a board takes seconds."""
SAVE_S = 0.5
"""From the request to settings in flash: the board waits for its camera to pause, 0.24 s, or
4 s where that gives no frame."""
GRAB_TIMEOUT_S = 4.0
"""The camera driver's own."""
SETTLED_EXPOSURE, SETTLED_GAIN = 300, 4
SENSOR = 0x26
"""An OV2640."""
EXPOSED = 0.8
"""Share of a frame's period from the first of its light to the last of its rows."""
_TEXT_PERIOD_S = 0.5
_NOISE_BYTES = 256
_CHUNK = 1024


class SimulatedDock:
    """Time enters as seconds since any moment, the same for all calls, never backwards.

    Parameters
    ----------
    camera
        Where frames come from.
    fps
        Frames a second, above 0.
    settings
        File that holds the settings over restarts; None: in memory.
    faults
        What goes wrong, and when.
    seed
        Of noise and damaged bytes: the same ones every time.
    own_light
        What the camera sees of the lamps, share 0..1 of its full scale.
    save_s
        Seconds that saving the settings takes, without frames from the camera.

    Raises
    ------
    ChromadockError
        Where the firmware's package is missing, or ``settings`` cannot be read.
    """

    def __init__(
        self,
        camera: Camera,
        fps: float = 10.0,
        settings: Path | None = None,
        faults: Sequence[Fault] = (),
        seed: int = 0,
        now_s: float = 0.0,
        own_light: float = 0.0,
        save_s: float = SAVE_S,
    ) -> None:
        self._camera = camera
        self._period_s = 1 / fps
        self._own_light = OwnLight(own_light)
        self._duties = (0, 0, 0)
        self._save_s = save_s
        self._storage = Storage(settings)
        self._random = random.Random(seed)
        share = max((f.share for f in faults), default=0.0)
        self._damage_in = Damage(share, random.Random(seed + 1))
        self._damage_out = Damage(share, random.Random(seed + 2))
        self._start_s = now_s
        self._lasting = [f for f in faults if f.kind in ("camera-lost", "driver-text", "storage")]
        self._once = sorted(
            (f for f in faults if f not in self._lasting and f.kind != "corrupt"),
            key=lambda f: f.at_s,
        )
        self._text = b""
        self._text_due_s = now_s
        self._core: Any = None
        self._boot(POWER_ON, now_s)

    @property
    def duties(self) -> tuple[int, int, int]:
        """PWM duties R, G, B as on the pins."""
        return self._duties

    @property
    def lamps(self) -> RGB:
        """What the LEDs give, share of full power, R, G, B."""
        from chromadock_firmware import lib

        inverted = bool(self._core.c.settings.led.common_anode)
        r, g, b = (d / lib.LED_FULL for d in self._duties)
        return (1 - r, 1 - g, 1 - b) if inverted else (r, g, b)

    def next_due_s(self) -> float:
        """When ``step`` has something to do again, at the latest."""
        return min(self._grab_due_s(), self._saved_at_s)

    def _grab_due_s(self) -> float:
        rested_s = self._frame_s + self._core.rest_ms / 1000 if self._locked else self._frame_s
        return max(self._frame_due_s, rested_s)

    def step(self, now_s: float) -> None:
        """Everything that is due by the clock.

        Raises
        ------
        ChromadockError
            Where the source of frames breaks off.
        """
        while self._once and now_s - self._start_s >= self._once[0].at_s:
            self._begin(self._once.pop(0).kind, now_s)
        if self._reboot_wanted:
            self._boot(SOFTWARE, now_s)
        if now_s >= self._saved_at_s:
            self._save(now_s)
        if now_s >= self._grab_due_s():
            self._grab(now_s)
        if not self._locked and now_s >= self._locked_at_s:
            self._lock()
        while (request := self._core.take_request()) is not None:
            self._obey(request, now_s)
        self._drive(now_s)

    def receive(self, data: bytes, now_s: float) -> None:
        """Bytes from the host."""
        if now_s >= self._ready_s:
            self._core.receive(self._damage_in.apply(data), self._ms(now_s))

    def transmit(self, now_s: float) -> bytes:
        """Bytes for the host, whole messages and whatever text comes between or into them."""
        text, self._text = self._text, b""
        if now_s < self._ready_s:
            return self._damage_out.apply(text)
        data = self._core.transmit(_CHUNK, self._ms(now_s))
        if self._lasts("driver-text", now_s) and now_s >= self._text_due_s:
            self._text_due_s = now_s + _TEXT_PERIOD_S
            cut = self._random.randrange(len(data) + 1)
            data = data[:cut] + DRIVER + data[cut:]
        return self._damage_out.apply(text + data)

    def _boot(self, reset: str, now_s: float) -> None:
        self._text += boot_text(reset)
        self._reboot_wanted = self._grab_fails = False
        self._saved_at_s = math.inf
        self._boot_s = now_s
        self._ready_s = now_s + BOOT_S
        self._frame_due_s = self._frame_s = self._ready_s
        kept = self._core.marker_hue if reset == SOFTWARE else None
        self._core = _core(self._storage.load())
        if kept is not None:
            self._core.set_last_hue(kept)
        self._drive(now_s)
        self._core.set_board(GIT_HASH, RESET_REASONS[reset], uid=UID)
        self._unlock(now_s)

    def _begin(self, kind: str, now_s: float) -> None:
        if kind == "reboot":
            self._boot(POWER_ON, now_s)
        elif kind == "boot-text":
            self._text += boot_text(POWER_ON)
        elif kind == "noise":
            self._text += self._random.randbytes(_NOISE_BYTES)
        elif kind == "camera-timeout":
            self._grab_fails = True
            self._frame_due_s = now_s + GRAB_TIMEOUT_S

    def _grab(self, now_s: float) -> None:
        lost = self._lasts("camera-lost", now_s)
        exposed_s = EXPOSED * self._period_s
        self._own_light.forget(now_s - exposed_s)
        data = None
        if not (lost or self._grab_fails):
            data = self._own_light.exposed(self._camera.frame(), now_s - exposed_s, now_s)
        self._grab_fails = False
        age_ms = round(1000 * exposed_s)
        self._core.frame(data, WIDTH, HEIGHT, "rgb565", self._ms(now_s), age_ms)
        self._drive(now_s)
        period = GRAB_TIMEOUT_S if lost else self._period_s
        # Late frames are left out, not caught up with.
        self._frame_due_s = max(self._frame_due_s + period, now_s)
        self._frame_s = now_s

    def _drive(self, now_s: float) -> None:
        self._duties = self._core.led_duties(self._ms(now_s))
        self._own_light.drive(self.lamps, now_s)

    def _obey(self, request: str, now_s: float) -> None:
        if request == "save":
            self._saved_at_s = now_s + self._save_s
            self._frame_due_s = max(self._frame_due_s, self._saved_at_s)
        elif request == "camera":
            self._unlock(now_s)
        elif request == "reboot":
            self._reboot_wanted = True

    def _save(self, now_s: float) -> None:
        self._saved_at_s = math.inf
        blob = self._core.settings_blob()
        self._core.saved(not self._lasts("storage", now_s) and self._storage.save(blob))

    def _unlock(self, now_s: float) -> None:
        self._locked = False
        self._locked_at_s = now_s + SETTLE_S
        self._core.set_camera(SETTLED_EXPOSURE, SETTLED_GAIN, False, False, SENSOR)

    def _lock(self) -> None:
        wanted = self._core.c.settings.camera
        self._locked = True
        exposure = wanted.exposure if wanted.lock and wanted.exposure else SETTLED_EXPOSURE
        gain = wanted.gain if wanted.lock and wanted.gain >= 0 else SETTLED_GAIN
        lock = bool(wanted.lock)
        self._core.set_camera(exposure, gain, lock, lock, SENSOR)

    def _lasts(self, kind: str, now_s: float) -> bool:
        return any(f.kind == kind and now_s - self._start_s >= f.at_s for f in self._lasting)

    def _ms(self, now_s: float) -> int:
        return int((now_s - self._boot_s) * 1000)


def _core(blob: bytes | None) -> Any:
    try:
        from chromadock_firmware import Dock
    except ModuleNotFoundError as error:
        raise ChromadockError(
            f"the simulated dock needs the package {error.name}: "
            "run `make setup` in the project's folder"
        ) from None
    return Dock(blob=blob)
