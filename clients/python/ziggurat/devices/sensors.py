# SPDX-License-Identifier: MIT
"""Sensors that read a fixed number of values each, and what a robot has of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Dict, List, NamedTuple, Optional, Sequence

from .. import protocol_pb2 as v1
from ..exchange import Exchange, Places, Readings
from ..named import Listed
from .device import Device, Quaternion, Vector, quaternion, vector

__all__ = ["Battery", "ContactSensor", "Imu", "Pose", "ProximitySensor", "Sensors"]


class Pose(NamedTuple):
    """Of the robot's origin in the world."""

    position: Vector  # [m]
    orientation: Quaternion  # w, x, y, z with w >= 0

    @property
    def yaw(self) -> float:
        """The heading: from the world's x axis to the robot's, seen from above, in (-π, π] [rad]."""
        w, x, y, z = self.orientation
        return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


class Battery(NamedTuple):
    available_charge: float  # share of the full charge, 0 … 1
    time_left: float  # [s], may be infinite


@dataclass(frozen=True)
class ProximitySensor:
    """The position of a sensor. Its reading is at the same index of Robot.proximity."""

    anchor: str  # id of a link, or "origin"
    position: Vector  # start of the ray in the anchor's frame [m]
    direction: Vector  # in the anchor's frame, of length 1
    range: float  # [m]
    angle: Optional[float] = None  # of the ray about +z from +x [rad]; only foot-bots


class Imu(Device):
    """An accelerometer and a gyroscope. Readings are in its frame, means over the last tick; 0 before
    the first."""

    __slots__ = ("anchor", "position", "orientation", "_place")

    def __init__(self, exchange: Exchange, given: v1.ImuDescription):
        super().__init__(exchange, given.id)
        self.anchor: str = given.anchor  # id of a link, or "origin"
        self.position: Vector = vector(given.position)  # in the anchor's frame [m]
        self.orientation: Quaternion = quaternion(given.orientation)  # in the anchor's frame
        self._place = 6 * exchange.place("imus")

    def _read(self, first: int) -> Vector:
        first += self._place
        return vector(self._exchange.seen.imus[first:first + 3] or (0.0, 0.0, 0.0))

    @property
    def acceleration(self) -> Vector:
        """As an accelerometer feels it [m/s²]: up at rest, 0 in free fall."""
        return self._read(0)

    @property
    def angular_velocity(self) -> Vector:
        """Relative to the world [rad/s]."""
        return self._read(3)


class ContactSensor(Device):
    """Feels what touches a link. Readings are means over the last tick; 0 before the first."""

    __slots__ = ("anchor", "_place")

    def __init__(self, exchange: Exchange, given: v1.ContactSensorDescription):
        super().__init__(exchange, given.id)
        self.anchor: str = given.anchor  # id of the link, or "origin" for the root link
        self._place = 5 * exchange.place("contact_sensors")

    def _read(self, first: int, last: int) -> Sequence[float]:
        readings = self._exchange.seen.contact_sensors
        return readings[self._place + first:self._place + last] or [0.0] * (last - first)

    @property
    def touches(self) -> bool:
        return self._read(0, 1)[0] != 0

    @property
    def force(self) -> Vector:
        """The sum of the forces of all contacts on the link, in its frame [N]."""
        return vector(self._read(1, 4))

    @property
    def strength(self) -> float:
        """The sum of the absolute values of these forces [N]."""
        return self._read(4, 5)[0]


class Sensors:
    """Those of a robot that the scene's controller enables."""

    _names = ("pose", "battery", "imus", "contact_sensors", "proximity_sensors")  # for messages

    pose = Readings("positioning", 7, lambda values: Pose(vector(values[:3]), quaternion(values[3:])),
                    lambda given: bool(given.positioning))
    battery = Readings("batteries", 2, Battery._make, lambda given: bool(given.battery))
    imus = Listed[Imu]("IMU")
    contact_sensors = Listed[ContactSensor]("contact sensor")

    def __init__(self, exchange: Exchange, given: v1.RobotDescription):
        self._exchange = exchange
        self._devices: Dict[str, Sequence[Any]] = {}  # that no list was asked for yet
        self._places = {readings.field: readings.place(exchange, given)
                        for readings in vars(Sensors).values() if isinstance(readings, Readings)}
        self.proximity_sensors: Sequence[ProximitySensor] = tuple(
            ProximitySensor(sensor.anchor, vector(sensor.position), vector(sensor.direction),
                            sensor.range, sensor.angle if sensor.HasField("angle") else None)
            for sensor in given.proximity_sensors)
        self._keep("imus", [Imu(exchange, imu) for imu in given.imus])
        self._keep("contact_sensors", [ContactSensor(exchange, sensor) for sensor in given.contact_sensors])
        places = [exchange.place("proximity") for _ in self.proximity_sensors]  # one after the other
        self._proximity = slice(places[0], places[-1] + 1) if places else slice(0, 0)

    def _keep(self, name: str, devices: Sequence[Any]) -> None:
        """For the property of this name, a Listed."""
        if devices:
            self._devices[name] = devices

    @property
    def proximity(self) -> Sequence[float]:
        """One reading per proximity sensor: 0 (nothing) … 1 (contact)."""
        return self._exchange.seen.proximity[self._proximity] or [0.0] * len(self.proximity_sensors)

    @property
    def sensed(self) -> List[float]:
        """All readings here, one after the other: proximity, pose (7), available charge, IMUs (6 each), contact
        sensors (5 each)."""
        return self._exchange.read(self._sensed_places)

    @cached_property
    def _sensed_places(self) -> List[Places]:
        places = [("proximity", self._proximity.start, self._proximity.stop)] if self.proximity_sensors else []
        pose, battery = 7 * self._places["positioning"], 2 * self._places["batteries"]
        places += [("positioning", pose, pose + 7)] if pose >= 0 else []
        places += [("batteries", battery, battery + 1)] if battery >= 0 else []
        places += [("imus", imu._place, imu._place + 6) for imu in self.imus]
        return places + [("contact_sensors", sensor._place, sensor._place + 5) for sensor in self.contact_sensors]
