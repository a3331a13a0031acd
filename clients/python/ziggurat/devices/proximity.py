from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

from .. import protocol_pb2 as v1
from .device import Vector


@dataclass(frozen=True)
class ProximitySensor:
    """The position of a sensor. Its reading is at the same index of Robot.proximity."""

    anchor: str  # id of a link, or "origin"
    position: Vector  # start of the ray in the anchor's frame [m]
    direction: Vector  # in the anchor's frame, of length 1
    range: float  # [m]
    angle: Optional[float] = None  # of the ray about +z from +x [rad]; only foot-bots


def proximity_sensor(given: v1.ProximityDescription) -> ProximitySensor:
    return ProximitySensor(given.anchor, tuple(given.position), tuple(given.direction), given.range,
                           given.angle if given.HasField("angle") else None)
