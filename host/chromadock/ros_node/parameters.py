"""The node's settings: ROS's parameters, by the names of the vehicle's file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from chromadock.errors import ChromadockError
from chromadock.ros.header import DOCK_FRAME
from chromadock.toml_file import one_line_error
from chromadock.validation import allowed
from chromadock.vehicle.keys import Text, VehicleFile
from chromadock.vehicle.reading import read_vehicle, settings_of, tables

Truth = Annotated[bool, allowed("true or false")]
Transport = Annotated[Literal["raw", "compressed"], allowed("raw or compressed")]


class NodeKeys(BaseModel):
    """The parameters that the vehicle's file has not."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    vehicle: Text = Field(
        "", description="The vehicle's file, which `chromadock config init` writes. Empty: none."
    )
    image_transport: Transport = Field(
        "raw",
        description="Which pictures: raw takes the topic image, compressed image/compressed.",
    )
    camera_frame: Text = Field(
        "",
        description="The camera's optical frame (x right, y down, z forward). Empty: the frame_id "
        "of the pictures.",
    )
    dock_frame: Text = Field(DOCK_FRAME, description="The dock's frame in TF.")
    publish_tf: Truth = Field(True, description="Whether the dock goes to TF.")


TAKEN: dict[str, tuple[str, ...]] = {
    "camera": ("calibration",),
    "mounting": tuple(tables()["mounting"].model_fields),
    "dock": tuple(tables()["dock"].model_fields),
}
"""Keys of the vehicle's file that are parameters too; the others are for its own cameras and
outputs, which the topics stand in for."""

_ROS_OWN = ("use_sim_time", "start_type_description_service", "qos_overrides")
"""First parts of the names of parameters that every node has."""


@dataclass(frozen=True)
class NodeSettings:
    """``node``: the node's own parameters; ``vehicle``: all others, and what the file has."""

    node: NodeKeys
    vehicle: VehicleFile


def read_parameters(given: Mapping[str, Any], vehicle: Path | None = None) -> NodeSettings:
    """The settings that parameters make, before those of the vehicle's file.

    Parameters
    ----------
    given : parameters that were set, by dotted name; those of ROS itself are passed over.
    vehicle : the vehicle's file, unless the parameter of that name has another.

    Raises
    ------
    ChromadockError
        One line for a parameter that there is not, a value that it cannot have, or a vehicle's file
        that is none or asks for what this node cannot do.
    """
    known = (*NodeKeys.model_fields, *_names())
    given = {name: v for name, v in given.items() if name.split(".")[0] not in _ROS_OWN}
    for name in given:
        if name not in known:
            raise ChromadockError(
                f"parameter {name}: there is none of that name: choose from {', '.join(known)}"
            )
    own = {name: value for name, value in given.items() if name in NodeKeys.model_fields}
    changes = {name: value for name, value in given.items() if name not in own}
    if vehicle is not None and not own.get("vehicle"):
        own["vehicle"] = str(vehicle)
    try:
        node = NodeKeys.model_validate(own)
    except ValidationError as error:
        raise one_line_error("parameters", error) from None
    settings = (
        read_vehicle(Path(node.vehicle), changes)
        if node.vehicle
        else settings_of(changes, "parameters")
    )
    if settings.detector.independent or settings.detector.method == "paper":
        raise ChromadockError(
            f"{node.vehicle}: detector.independent and the method paper have no track, and only "
            "the poses of a track are told to ROS: remove both keys, or use `chromadock run`"
        )
    return NodeSettings(node, settings)


def effective(settings: NodeSettings) -> dict[str, Any]:
    """Each parameter's value by its dotted name, but for a table that is left out."""
    values: dict[str, Any] = settings.node.model_dump()
    for name in _names():
        table, _, key = name.partition(".")
        keys = getattr(settings.vehicle, table)
        if keys is not None:
            values[name] = getattr(keys, key)
    return values


def description(name: str) -> str:
    """What a parameter means, in words."""
    table, _, key = name.rpartition(".")
    model: type[BaseModel] = tables()[table] if table else NodeKeys
    return model.model_fields[key].description or ""


def _names() -> Iterator[str]:
    """Of the parameters that are keys of the vehicle's file."""
    for table, keys in TAKEN.items():
        yield from (f"{table}.{key}" for key in keys)
