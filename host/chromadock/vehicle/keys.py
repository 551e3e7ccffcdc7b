"""Every setting of a vehicle: its type, range, default and meaning.

The one place for them: the file that ``chromadock config init`` writes, ``docs/configuration.md``
and what is refused all follow from it.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from chromadock.choices import (
    DEFAULT_MAPPING,
    DEFAULT_METHOD,
    FALLBACK_HUE_DEG,
    HUE_MOST_DEG,
    LONGEST_DELAY_S,
    MAPPINGS,
    METHODS,
)
from chromadock.controls.applying import WORDS, Wish
from chromadock.validation import allowed, between

TEXT_IN_QUOTES = "a text in quotes"
Text = Annotated[str, allowed(TEXT_IN_QUOTES)]
Angle = Annotated[float, between(-180, 180, "degrees")]
# Type checkers want a literal's choices written out, and these stand in ``choices`` alone.
Mapping = Annotated[Literal[MAPPINGS], allowed(f"one of {', '.join(MAPPINGS)}")]  # type: ignore[valid-type]
Method = Annotated[Literal[METHODS], allowed(f"one of {', '.join(METHODS)}")]  # type: ignore[valid-type]


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


class CameraKeys(_Table):
    """The vehicle's camera."""

    source: Text = Field(
        "0",
        description="Where its frames come from: a camera's index or device, a stream's URL, a "
        "GStreamer pipeline, a video, a recording, a picture or a folder.",
    )
    calibration: Text = Field(
        "",
        description="File of its calibration, made in water. Empty: a usual lens is assumed, and "
        "distances are rough.",
    )
    delay_s: Annotated[float, between(0, LONGEST_DELAY_S, "s")] = Field(
        0.0,
        description="From capture to arrival of a picture at best, which no stamp tells: an "
        "encoder's time, say.",
    )
    exposure: Annotated[Wish, between(0.1, 1000, "ms", WORDS)] = Field(
        "",
        description='Its time: a number fixes it, "auto" leaves it to the camera, "lock" lets it '
        "settle for two seconds and then fixes it. Empty, as for the next three: it stays as the "
        "camera has it, and is not set again when the camera has lost power. Where it is set, the "
        "camera may not lower its frame rate in dim light.",
    )
    gain: Annotated[Wish, between(0, 65535, "in the driver's unit", WORDS)] = Field(
        "", description="Of the sensor, likewise."
    )
    white_balance: Annotated[Wish, between(1000, 20000, "K", WORDS)] = Field(
        "",
        description="Likewise. An automatic one removes the very hue that is measured.",
    )
    focus: Annotated[Wish, between(0, 65535, "in the driver's unit", WORDS)] = Field(
        "", description="Likewise. The calibration holds for one focus."
    )
    manager: Text = Field(
        "",
        description="Who sets these of a stream's camera: BlueOS's camera manager, such as "
        "http://192.168.2.2:6020, with ?device=/dev/video2 where it has several and the stream is "
        "none of its own. Empty: port 6020 of the computer that an rtsp:// source comes from. A "
        "camera of this computer needs none.",
    )


class MountingKeys(_Table):
    """How the camera sits in the vehicle: turns from a camera that looks ahead, upright, in the
    order yaw, pitch, roll. Leave the whole table out if nobody has measured it."""

    yaw_deg: Angle = Field(0.0, description="To the right, seen from above.")
    pitch_deg: Angle = Field(0.0, description="Upwards; a camera that looks down has -90.")
    roll_deg: Angle = Field(0.0, description="Clockwise, seen from behind the camera.")


class DockKeys(_Table):
    """The dock that is looked for."""

    file: Text = Field("", description="File of its markers. Empty: the original dock.")
    mapping: Mapping = Field(
        DEFAULT_MAPPING,
        description="From the water's colour to the markers', as the dock is set.",
    )
    colour: Text = Field(
        "",
        description='Of lamps that have a colour of their own: "#RRGGBB", "white" or "any". Empty: '
        "the dock file's, or by the water.",
    )
    fallback_hue_deg: Annotated[float, between(0, HUE_MOST_DEG, "degrees")] = Field(
        round(FALLBACK_HUE_DEG, 2),
        description="Of the markers in grey water and at night, the dock's FALLBACK_HUE.",
    )


class DetectorKeys(_Table):
    """How it is looked for."""

    method: Method = Field(DEFAULT_METHOD, description="How markers are found.")
    independent: Annotated[bool, allowed("true or false")] = Field(
        False, description="Treat every frame alone: no track."
    )


class OutputKeys(_Table):
    """Where the results go, beside the screen."""

    results: Annotated[list[str], allowed("a list of texts in quotes")] = Field(
        [],
        description="Any number of KIND:PLACE: json:FILE appends to a log, mcap:FILE is what "
        "record is, udp:HOST:PORT sends datagrams, http:PORT serves a page on this computer and "
        "http:0.0.0.0:PORT to all that can reach it, mavlink:ADDRESS?receiver=NAME tells an "
        "autopilot (docs/autopilot.md).",
    )
    record: Text = Field(
        "",
        description="File, such as dive.mcap, into which frames, results and settings are recorded "
        "for `chromadock replay`; where it is there already, the next is dive-2.mcap. Empty: none.",
    )
    overlay: Text = Field(
        "", description="A video or folder into which is drawn what was seen. Empty: none."
    )


class VehicleFile(_Table):
    """The whole file."""

    camera: CameraKeys = CameraKeys()
    mounting: MountingKeys | None = None
    dock: DockKeys = DockKeys()
    detector: DetectorKeys = DetectorKeys()
    outputs: OutputKeys = OutputKeys()
