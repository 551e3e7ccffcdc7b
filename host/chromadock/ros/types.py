"""ROS 2 message types: their definitions, and from fields to bytes (CDR)."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np
from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

from chromadock.ros.fields import Fields

_VISION_MSGS = {
    "Point2D": "float64 x\nfloat64 y",
    "Pose2D": "vision_msgs/Point2D position\nfloat64 theta",
    "BoundingBox2D": "vision_msgs/Pose2D center\nfloat64 size_x\nfloat64 size_y",
    "ObjectHypothesis": "string class_id\nfloat64 score",
    "ObjectHypothesisWithPose": "vision_msgs/ObjectHypothesis hypothesis\n"
    "geometry_msgs/PoseWithCovariance pose",
    "Detection2D": "std_msgs/Header header\nvision_msgs/ObjectHypothesisWithPose[] results\n"
    "vision_msgs/BoundingBox2D bbox\nstring id",
    "Detection2DArray": "std_msgs/Header header\nvision_msgs/Detection2D[] detections",
}
"""Of vision_msgs 4, that of ROS 2 Humble and all after it: no part of ROS itself."""


@cache
def typestore() -> Typestore:
    """The types of ROS 2 Humble (those used here have not changed since), and vision_msgs."""
    store = get_typestore(Stores.ROS2_HUMBLE)
    for name, text in _VISION_MSGS.items():
        store.register(get_types_from_msg(text, f"vision_msgs/msg/{name}"))
    return store


def definition(kind: str) -> str:
    """The text of a type such as ``std_msgs/msg/String``, with all that it is made of."""
    return typestore().generate_msgdef(kind, ros_version=2)[0]


def serialised(kind: str, fields: Fields) -> bytes:
    """The bytes of a message, CDR.

    Raises
    ------
    ValueError
        Where a field is missing or there is none of that name: a slip in the code.
    """
    return bytes(typestore().serialize_cdr(_message(kind, fields), kind))


def _message(kind: str, fields: Mapping[str, Any]) -> object:
    """Fields as the object that rosbags writes."""
    store = typestore()
    parts = dict(store.fielddefs[kind][1])
    if parts.keys() != fields.keys():
        raise ValueError(f"{kind} has {', '.join(parts)}, but was given {', '.join(fields)}")
    return store.types[kind](**{name: _value(parts[name], fields[name]) for name in parts})


def _value(described: Any, value: Any) -> Any:
    """A value as its type has it; ``described`` is rosbags' description of that."""
    node, detail = described
    if node == Nodetype.NAME:
        return _message(detail, value)
    if node in (Nodetype.ARRAY, Nodetype.SEQUENCE):
        element, length = detail
        if node == Nodetype.ARRAY and len(value) != length:
            raise ValueError(f"{len(value)} numbers where there must be {length}")
        if element[0] == Nodetype.NAME:
            return [_message(element[1], one) for one in value]
        kind = element[1][0]
        if kind == "uint8" and isinstance(value, bytes):
            return np.frombuffer(value, np.uint8)
        return value if kind == "string" else np.asarray(value, np.dtype(kind))
    return value
