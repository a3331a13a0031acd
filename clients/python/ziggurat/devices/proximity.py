from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

from .. import protocol_pb2 as v1
from .device import Vector


@dataclass(frozen=True)
class ProximitySensor:
    """The mount of a sensor whose reading is in Robot.proximity at the same place."""

    anchor: str  # id of a link, or "origin"
    position: Vector  # start of the ray in the anchor's frame [m]
    direction: Vector  # in the anchor's frame, of length 1
    range: float  # [m]
    angle: Optional[float] = None  # about +z from +x [rad], of foot-bots' own sensors


def proximity_sensor(given: v1.ProximityDescription) -> ProximitySensor:
    return ProximitySensor(given.anchor, tuple(given.position), tuple(given.direction), given.range,
                           given.angle if given.HasField("angle") else None)
