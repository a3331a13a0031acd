# SPDX-License-Identifier: MIT
from __future__ import annotations

from typing import Dict, List, Optional, Tuple

from .. import protocol_pb2 as v1
from ..exchange import Exchange, Places
from .device import Device, finite

_MODES = {v1.JointDescription.POSITION: "position", v1.JointDescription.VELOCITY: "velocity",
          v1.JointDescription.DISABLED: "disabled"}


class Joint(Device):
    """A joint with an encoder, a motor, or both. Encoders are of its position, its velocity, or of both."""

    __slots__ = ("sensor_mode", "actuator_mode", "max_impulse", "_sensors", "_actuator")

    def __init__(self, exchange: Exchange, id: str):
        super().__init__(exchange, id)
        self.sensor_mode: Optional[str] = None  # of the first one: "position", "velocity" or "disabled"
        self.actuator_mode: Optional[str] = None  # the same; None without a motor
        self.max_impulse = 0.0  # of the motor, a substep [N s] or [N m s]
        self._sensors: Tuple[Tuple[Optional[str], int], ...] = ()  # mode and place of each
        self._actuator = -1

    @property
    def encoder(self) -> float:
        """The reading of the first sensor: [m], [rad], [m/s] or [rad/s], by sensor_mode; 0 at tick 0."""
        if not self._sensors:
            raise AttributeError(f"joint {self.id!r} has no encoder")
        return self._read(self._sensors[0][1])

    @property
    def position(self) -> float:
        """[m] or [rad]; 0 at tick 0."""
        return self._measured("position")

    @property
    def velocity(self) -> float:
        """[m/s] or [rad/s]; 0 at tick 0."""
        return self._measured("velocity")

    @property
    def readings(self) -> List[float]:
        """Those of all its sensors, in the order of the scene."""
        return self._exchange.read(self._places)

    @property
    def _places(self) -> List[Places]:
        return [("joint_readings", place, place + 1) for _, place in self._sensors]

    def _measured(self, mode: str) -> float:
        for each, place in self._sensors:
            if each == mode:
                return self._read(place)
        raise AttributeError(f"joint {self.id!r} has no sensor in mode {mode!r}; add "
                             f"<joint id=\"{self.id}\" mode=\"{mode}\"/> to the controller's <sensors>")

    def _read(self, place: int) -> float:
        readings = self._exchange.seen.joint_readings
        return float(readings[place]) if readings else 0.0

    @property
    def target(self) -> float:
        """[m], [rad], [m/s] or [rad/s], by actuator_mode. Stays until changed."""
        if self._actuator < 0:
            raise AttributeError(f"joint {self.id!r} has no motor")
        return float(self._exchange.values["joint_targets"][self._actuator])

    @target.setter
    def target(self, value: float) -> None:
        if self._actuator < 0:
            raise AttributeError(f"joint {self.id!r} has no motor")
        self._exchange.set("joint_targets", self._actuator, finite(value, "a target"))


def joints_of(exchange: Exchange, given: v1.RobotDescription) -> List[Joint]:
    """Sensors and an actuator with the same id are one joint."""
    joints: Dict[str, Joint] = {}
    for sensor in given.joint_sensors:
        joint = joints.setdefault(sensor.id, Joint(exchange, sensor.id))
        mode = _MODES.get(sensor.mode)
        if not joint._sensors:
            joint.sensor_mode = mode
        joint._sensors += ((mode, exchange.place("joint")),)
    for actuator in given.joint_actuators:
        joint = joints.setdefault(actuator.id, Joint(exchange, actuator.id))
        joint.actuator_mode = _MODES.get(actuator.mode)
        joint.max_impulse = actuator.max_impulse
        joint._actuator = exchange.add("joint_targets", 0.0)
    return list(joints.values())
