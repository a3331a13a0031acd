"""A robot of a session and its devices."""

from __future__ import annotations

from typing import Callable, Dict, Optional

from . import protocol_pb2 as v1
from .devices import Camera, Joint, Led, Magnet, Radio, RangeAndBearing, Sensors, Tag, Turret, \
    Wheels
from .devices.joint import joints_of
from .exchange import Exchange
from .named import Named


class Robot(Sensors):
    """It has the devices that the scene's controller enables. range_and_bearing, wheels and turret
    are None for robots without them."""

    def __init__(self, exchange: Exchange, position: int, given: v1.RobotDescription,
                 tell_leave: Callable[["Robot", str], None]):
        self.id: str = given.id
        self.controller: str = given.controller
        self.params: Dict[str, str] = {p.name: p.value for p in given.params}
        self.gone = False  # it has left the run, or another client has taken it over
        super().__init__(exchange, given)
        self._position = position
        owner = f"robot {self.id!r}"
        self._tell_leave = tell_leave

        self.joints: Named[Joint] = Named(joints_of(exchange, given), "joint", owner)
        self.radios: Named[Radio] = Named([Radio(exchange, r) for r in given.radios], "radio", owner)
        self.leds: Named[Led] = Named([Led(exchange, "led_colors", l) for l in given.leds], "LED", owner)
        self.directional_leds: Named[Led] = Named(
            [Led(exchange, "directional_led_colors", l) for l in given.directional_leds],
            "directional LED", owner)
        self.tags: Named[Tag] = Named([Tag(exchange, tag) for tag in given.tags], "tag", owner)
        self.magnets: Named[Magnet] = Named([Magnet(exchange, m) for m in given.magnets], "magnet", owner)
        self.range_and_bearing: Optional[RangeAndBearing] = \
            RangeAndBearing(exchange, position, given.range_and_bearing) \
            if given.HasField("range_and_bearing") else None
        self.cameras: Named[Camera] = Named([Camera(exchange, c) for c in given.cameras], "camera", owner)
        self.wheels: Optional[Wheels] = \
            Wheels(exchange, given.wheels) if given.HasField("wheels") else None
        self.turret: Optional[Turret] = \
            Turret(exchange, given.turret) if given.HasField("turret") else None

    def log(self, text: str, error: bool = False) -> None:
        """Sends a line to the server's log with the command of this tick."""
        self._exchange.log.append(v1.LogLine(robot=self._position, error=error,
                                             text=text.rstrip("\n")))

    def metric(self, name: str, value: float) -> None:
        """Sets a figure of the run, which the server keeps for each tick; the last value is the final one, in
        --summary under ROBOT/name. Sent with the command of this tick."""
        self._exchange.metrics.set(self._position, name, value)

    def _lacks(self) -> str:
        """What of it is None, and what it has."""
        names = ("range_and_bearing", "wheels", "turret", "joints", "radios", "leds", "directional_leds", "tags",
                 "magnets", "cameras") + Sensors._names
        devices = {name: getattr(self, name) for name in names}
        absent = [name for name, device in devices.items() if device is None]
        there = [name for name, device in devices.items() if device]
        return f"robot {self.id!r} has no {', '.join(absent)} (None); it has: {', '.join(there) or 'no devices'}"

    def leave(self) -> None:
        """Leaves the run forever: the world no longer waits for this robot."""
        self._tell_leave(self, "")

    def fail(self, message: str) -> None:
        """Leaves as failed: the run continues, and exits with code 3 at its end."""
        self._tell_leave(self, message or "failed")

    def __repr__(self) -> str:
        return f"Robot({self.id!r})"
