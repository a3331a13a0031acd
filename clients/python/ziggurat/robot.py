"""A robot of a session, and how its devices are laid out over the session's packed arrays."""

from __future__ import annotations

from collections import Counter
from typing import Any, Callable, Dict, Generic, Iterable, Iterator, List, Optional, Sequence, \
    TypeVar, Union

from . import protocol_pb2 as v1
from .devices import Battery, Camera, Joint, Led, Magnet, Pose, ProximitySensor, Radio, \
    RangeAndBearing, Tag, Turret, Wheels
from .exchange import Exchange

T = TypeVar("T")
_MODES = {v1.JointDescription.POSITION: "position", v1.JointDescription.VELOCITY: "velocity",
          v1.JointDescription.DISABLED: "disabled"}


class Named(Sequence, Generic[T]):
    """Things in order, found by place or by id."""

    def __init__(self, things: Iterable[T], kind: str):
        self._things: List[T] = list(things)
        self._kind = kind
        self._by_id: Dict[str, T] = {}
        for thing in self._things:
            self._by_id.setdefault(thing.id, thing)

    def __getitem__(self, key: Union[int, str, slice]) -> Any:
        if not isinstance(key, str):
            return self._things[key]
        if key in self._by_id:
            return self._by_id[key]
        raise KeyError(f"no {self._kind} {key!r}; there are: "
                       + (", ".join(map(repr, self._by_id)) or "none"))

    def __len__(self) -> int:
        return len(self._things)

    def __iter__(self) -> Iterator[T]:
        return iter(self._things)

    def __contains__(self, key: object) -> bool:
        return key in self._by_id if isinstance(key, str) else key in self._things

    def __repr__(self) -> str:
        return f"[{', '.join(map(repr, self._things))}]"


class Places:
    """Counts the places of readings that one kind of device has in a packed array."""

    def __init__(self) -> None:
        self._next: Counter = Counter()

    def take(self, kind: str, is_there: bool = True) -> int:
        """The next place, or -1 for a device that is not there."""
        if not is_there:
            return -1
        self._next[kind] += 1
        return self._next[kind] - 1


class Robot:
    """Devices are those that the scene's controller enables; range_and_bearing, wheels and turret
    are None for robots without."""

    def __init__(self, exchange: Exchange, places: Places, position: int,
                 given: v1.RobotDescription, tell_leave: Callable[["Robot", str], None]):
        self.id: str = given.id
        self.controller: str = given.controller
        self.params: Dict[str, str] = {p.name: p.value for p in given.params}
        self.gone = False  # it has left the run
        self._exchange = exchange
        self._position = position
        self._tell_leave = tell_leave

        self.joints: Named[Joint] = Named(self._lay_out_joints(places, given), "joint")
        self.radios: Named[Radio] = Named(
            [Radio(exchange, places.take("radio"), radio) for radio in given.radios], "radio")
        self.leds: Named[Led] = Named(
            [Led(exchange, "led_colors", led) for led in given.leds], "LED")
        self.directional_leds: Named[Led] = Named(
            [Led(exchange, "directional_led_colors", led) for led in given.directional_leds],
            "directional LED")
        self.tags: Named[Tag] = Named([Tag(exchange, tag) for tag in given.tags], "tag")
        self.magnets: Named[Magnet] = Named(
            [Magnet(exchange, magnet) for magnet in given.magnets], "magnet")
        self.proximity_sensors: List[ProximitySensor] = [
            ProximitySensor(sensor.anchor, tuple(sensor.position), tuple(sensor.direction),
                            sensor.range,
                            sensor.angle if sensor.HasField("angle") else None) for sensor in given.proximity_sensors]
        first = [places.take("proximity") for _ in self.proximity_sensors][:1]
        self._proximity = first[0] if first else 0
        self.range_and_bearing: Optional[RangeAndBearing] = None
        if given.HasField("range_and_bearing"):
            self.range_and_bearing = RangeAndBearing(exchange, position, given.range_and_bearing)
        self._positioning = places.take("positioning", given.positioning)
        self._battery = places.take("battery", given.battery)
        self.cameras: Named[Camera] = Named(
            [Camera(exchange, camera, places) for camera in given.cameras], "camera")
        self.wheels: Optional[Wheels] = None
        if given.HasField("wheels"):
            self.wheels = Wheels(exchange, places.take("wheels", given.wheels.measures),
                                 given.wheels)
        self.turret: Optional[Turret] = None
        if given.HasField("turret"):
            self.turret = Turret(exchange, places.take("turret", given.turret.measures),
                                 given.turret)

    def _lay_out_joints(self, places: Places, given: v1.RobotDescription) -> List[Joint]:
        joints: Dict[str, Joint] = {}
        for sensor in given.joint_sensors:
            joint = joints.setdefault(sensor.id, Joint(self._exchange, sensor.id))
            joint.sensor_mode = _MODES.get(sensor.mode)
            joint._sensor = places.take("joint")
        for actuator in given.joint_actuators:
            joint = joints.setdefault(actuator.id, Joint(self._exchange, actuator.id))
            joint.actuator_mode = _MODES.get(actuator.mode)
            joint.max_impulse = actuator.max_impulse
            joint._actuator = self._exchange.add("joint_targets", 0.0)
        return list(joints.values())

    @property
    def proximity(self) -> Sequence[float]:
        """One reading per proximity sensor: 0 (nothing) … 1 (contact)."""
        readings = self._exchange.seen.proximity
        count = len(self.proximity_sensors)
        return readings[self._proximity:self._proximity + count] if readings else [0.0] * count

    @property
    def pose(self) -> Optional[Pose]:
        """What the positioning sensor says; None for a robot without, or before the first tick."""
        values = self._exchange.seen.positioning
        if self._positioning < 0 or not values:
            return None
        at = 7 * self._positioning
        return Pose(tuple(values[at:at + 3]), tuple(values[at + 3:at + 7]))

    @property
    def battery(self) -> Optional[Battery]:
        """None for a robot without, or before the first tick."""
        values = self._exchange.seen.batteries
        if self._battery < 0 or not values:
            return None
        return Battery(values[2 * self._battery], values[2 * self._battery + 1])

    def log(self, text: str, error: bool = False) -> None:
        """The server prints it, with the command of this tick."""
        self._exchange.log.append(v1.LogLine(robot=self._position, error=error,
                                             text=text.rstrip("\n")))

    def leave(self) -> None:
        """Out of the run for good: nobody waits for it any more."""
        self._tell_leave(self, "")

    def fail(self, message: str) -> None:
        """The same, as a failure: the run goes on and exits with 3 in the end."""
        self._tell_leave(self, message or "failed")

    def __repr__(self) -> str:
        return f"Robot({self.id!r})"
