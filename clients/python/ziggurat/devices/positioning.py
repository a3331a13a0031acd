from __future__ import annotations

from typing import NamedTuple

from ..exchange import Readings
from .device import Quaternion, Vector


class Pose(NamedTuple):
    """Of the robot's origin in the world."""

    position: Vector  # [m]
    orientation: Quaternion


pose = Readings("positioning", 7, lambda values: Pose(tuple(values[:3]), tuple(values[3:])),
                lambda given: given.positioning)
