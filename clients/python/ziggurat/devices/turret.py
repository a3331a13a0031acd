# SPDX-License-Identifier: MIT
from __future__ import annotations

from typing import List

from .. import protocol_pb2 as v1
from ..exchange import Exchange, Places
from .device import finite


class Turret:
    __slots__ = ("drives", "measures", "_exchange", "_place", "_reading")

    def __init__(self, exchange: Exchange, given: v1.TurretDescription):
        self.drives = given.drives
        self.measures = given.measures
        self._exchange = exchange
        self._reading = exchange.place("turret", given.measures)
        if self.drives:
            self._place = exchange.add("turret_modes", v1.TURRET_PASSIVE)
            exchange.add("turret_rotations", 0.0)
            exchange.add("turret_speeds", 0.0)

    @property
    def rotation(self) -> float:
        """Relative to the robot, -pi … pi [rad]."""
        if not self.measures:
            raise AttributeError("this robot does not measure its turret")
        rotations = self._exchange.seen.turret_rotations
        return float(rotations[self._reading]) if rotations else 0.0

    @property
    def _places(self) -> List[Places]:
        return [("turret_rotations", self._reading, self._reading + 1)] if self.measures else []

    def _set(self, mode: int, field: str = "", value: float = 0.0) -> None:
        if not self.drives:
            raise AttributeError("this robot does not drive its turret")
        if field:
            self._exchange.set(field, self._place, finite(value, field))
        self._exchange.set("turret_modes", self._place, mode)

    def rotate_to(self, rotation: float) -> None:
        """Relative to the robot [rad]."""
        self._set(v1.TURRET_POSITION, "turret_rotations", rotation)

    def rotate_at(self, speed: float) -> None:
        """Relative to the robot [rad/s]."""
        self._set(v1.TURRET_SPEED, "turret_speeds", speed)

    def release(self) -> None:
        """The turret turns with the robot, as it does in the beginning."""
        self._set(v1.TURRET_PASSIVE)
