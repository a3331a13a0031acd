# SPDX-License-Identifier: MIT
from __future__ import annotations

from typing import List, Tuple

from .. import protocol_pb2 as v1
from ..exchange import Exchange, Places
from .device import finite


class Wheels:
    """The two driven wheels."""

    __slots__ = ("axle_length", "drives", "measures", "_exchange", "_place", "_reading")

    def __init__(self, exchange: Exchange, given: v1.WheelsDescription):
        self.axle_length = given.axle_length  # [m]
        self.drives = given.drives
        self.measures = given.measures
        self._exchange = exchange
        self._reading = 4 * exchange.place("wheels", given.measures)
        if self.drives:
            self._place = exchange.add("wheel_velocities", 0.0)
            exchange.add("wheel_velocities", 0.0)

    def set_velocity(self, left: float, right: float) -> None:
        """Speeds over the floor [m/s]; they stay until changed."""
        if not self.drives:
            raise AttributeError("this robot does not drive its wheels")
        left, right = finite(left, "a velocity"), finite(right, "a velocity")
        self._exchange.set("wheel_velocities", self._place, left)
        self._exchange.set("wheel_velocities", self._place + 1, right)

    @property
    def _places(self) -> List[Places]:
        """Of velocity and distance."""
        return [("wheels", self._reading, self._reading + 4)] if self.measures else []

    def _read(self, index: int) -> Tuple[float, float]:
        if not self.measures:
            raise AttributeError("this robot does not measure its wheels")
        wheels = self._exchange.seen.wheels
        at = self._reading + index
        return (wheels[at], wheels[at + 1]) if wheels else (0.0, 0.0)

    @property
    def velocity(self) -> Tuple[float, float]:
        """Left, right [m/s]."""
        return self._read(0)

    @property
    def distance(self) -> Tuple[float, float]:
        """Left, right, in the last tick [m]."""
        return self._read(2)
