"""A robot of a session and its devices."""

from __future__ import annotations

from typing import Any, Callable, Dict, Generic, Iterable, Iterator, List, Optional, Sequence, \
    TypeVar, Union

from . import protocol_pb2 as v1
from .devices import Camera, Joint, Led, Magnet, ProximitySensor, Radio, RangeAndBearing, Tag, \
    Turret, Wheels
from .devices.battery import battery
from .devices.joint import joints_of
from .devices.positioning import pose
from .devices.proximity import proximity_sensor
from .exchange import Exchange, Readings

T = TypeVar("T")


class Named(Sequence, Generic[T]):
    """A list with access by position or by id."""

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
        raise KeyError(f"no {self._kind} {key!r}; known: "
                       + (", ".join(map(repr, self._by_id)) or "none"))

    def __len__(self) -> int:
        return len(self._things)

    def __iter__(self) -> Iterator[T]:
        return iter(self._things)

    def __contains__(self, key: object) -> bool:
        return key in self._by_id if isinstance(key, str) else key in self._things

    def __repr__(self) -> str:
        return f"[{', '.join(map(repr, self._things))}]"


class Robot:
    """It has the devices that the scene's controller enables. range_and_bearing, wheels and turret
    are None for robots without them."""

    # Of the positioning sensor and of the battery.
    pose = pose
    battery = battery

    def __init__(self, exchange: Exchange, position: int, given: v1.RobotDescription,
                 tell_leave: Callable[["Robot", str], None]):
        self.id: str = given.id
        self.controller: str = given.controller
        self.params: Dict[str, str] = {p.name: p.value for p in given.params}
        self.gone = False  # it has left the run
        self._exchange = exchange
        self._position = position
        self._tell_leave = tell_leave
        self._places = {readings: readings.place(exchange, given)
                        for readings in vars(Robot).values() if isinstance(readings, Readings)}

        self.joints: Named[Joint] = Named(joints_of(exchange, given), "joint")
        self.radios: Named[Radio] = Named([Radio(exchange, r) for r in given.radios], "radio")
        self.leds: Named[Led] = Named([Led(exchange, "led_colors", l) for l in given.leds], "LED")
        self.directional_leds: Named[Led] = Named(
            [Led(exchange, "directional_led_colors", l) for l in given.directional_leds],
            "directional LED")
        self.tags: Named[Tag] = Named([Tag(exchange, tag) for tag in given.tags], "tag")
        self.magnets: Named[Magnet] = Named([Magnet(exchange, m) for m in given.magnets], "magnet")
        self.proximity_sensors: List[ProximitySensor] = \
            [proximity_sensor(sensor) for sensor in given.proximity_sensors]
        self._proximity = [exchange.place("proximity") for _ in self.proximity_sensors]
        self.range_and_bearing: Optional[RangeAndBearing] = \
            RangeAndBearing(exchange, position, given.range_and_bearing) \
            if given.HasField("range_and_bearing") else None
        self.cameras: Named[Camera] = Named([Camera(exchange, c) for c in given.cameras], "camera")
        self.wheels: Optional[Wheels] = \
            Wheels(exchange, given.wheels) if given.HasField("wheels") else None
        self.turret: Optional[Turret] = \
            Turret(exchange, given.turret) if given.HasField("turret") else None

    @property
    def proximity(self) -> Sequence[float]:
        """One reading per proximity sensor: 0 (nothing) … 1 (contact)."""
        readings = self._exchange.seen.proximity
        return [readings[place] if readings else 0.0 for place in self._proximity]

    def log(self, text: str, error: bool = False) -> None:
        """Sends a line to the server's log with the command of this tick."""
        self._exchange.log.append(v1.LogLine(robot=self._position, error=error,
                                             text=text.rstrip("\n")))

    def leave(self) -> None:
        """Leaves the run forever: the world no longer waits for this robot."""
        self._tell_leave(self, "")

    def fail(self, message: str) -> None:
        """Leaves as failed: the run continues, and exits with code 3 at its end."""
        self._tell_leave(self, message or "failed")

    def __repr__(self) -> str:
        return f"Robot({self.id!r})"
