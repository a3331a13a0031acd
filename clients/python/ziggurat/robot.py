# SPDX-License-Identifier: MIT
"""A robot of a session and its devices."""

from __future__ import annotations

from functools import cached_property
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

from . import protocol_pb2 as v1
from .devices import Camera, DevicesByKind, Joint, Led, Magnet, Radio, RangeAndBearing, Sensors, Tag, Turret, \
    Wheels
from .devices.joint import joints_of
from .devices.led import OFF, number_of
from .exchange import Exchange, Places, joined
from .named import Listed

MOST_MARKERS = 1000  # of a robot at a tick
MOST_MARKER_BYTES = 100  # of a text


class Robot(Sensors):
    """It has the devices that the scene's controller enables. range_and_bearing, wheels and turret
    are None for robots without them."""

    joints = Listed[Joint]("joint")
    radios = Listed[Radio]("radio")
    leds = Listed[Led]("LED")
    directional_leds = Listed[Led]("directional LED")
    tags = Listed[Tag]("tag")
    magnets = Listed[Magnet]("magnet")
    cameras = Listed[Camera]("camera")

    def __init__(self, exchange: Exchange, position: int, given: v1.RobotDescription,
                 find_leave: Callable[[], Optional[Callable[["Robot", str], None]]]):
        """find_leave: the session's function by which a robot leaves; None if there is no session any more."""
        self.id: str = given.id
        self.controller: str = given.controller
        self.params: Dict[str, str] = {p.name: p.value for p in given.params}
        self.gone = False  # it has left the run, or another client has taken it over
        super().__init__(exchange, given)
        self._position = position
        self.draws = given.draws_markers
        self._find_leave = find_leave

        # Devices that describe themselves, by kind: robot.devices["light"][0].value.
        self.devices = DevicesByKind(exchange, given)
        self._keep("joints", joints_of(exchange, given))
        self._keep("radios", [Radio(exchange, radio) for radio in given.radios])
        self._keep("leds", [Led(exchange, "led_colors", led) for led in given.leds])
        self._keep("directional_leds", [Led(exchange, "directional_led_colors", led) for led in given.directional_leds])
        self._keep("tags", [Tag(exchange, tag) for tag in given.tags])
        self._keep("magnets", [Magnet(exchange, magnet) for magnet in given.magnets])
        self._keep("cameras", [Camera(exchange, camera) for camera in given.cameras])
        self.range_and_bearing: Optional[RangeAndBearing] = \
            RangeAndBearing(exchange, position, given.range_and_bearing) \
            if given.HasField("range_and_bearing") else None
        self.wheels: Optional[Wheels] = \
            Wheels(exchange, given.wheels) if given.HasField("wheels") else None
        self.turret: Optional[Turret] = \
            Turret(exchange, given.turret) if given.HasField("turret") else None

    @cached_property
    def _reading_places(self) -> List[Places]:
        """Of all sensors with a fixed number of values; neighbours are one."""
        places = [place for joint in self.joints for place in joint._places] + self._sensed_places
        places += [place for each in (self.wheels, self.turret) if each is not None for place in each._places]
        return joined(places + [place for devices in self.devices.values() for device in devices for place in device._places])

    @cached_property
    def _motors(self) -> List[Tuple[str, int, str]]:
        """Of each driven joint, then of the left and the right wheel: the field of Command, the place there and what it
        takes, for messages."""
        motors = [("joint_targets", joint._actuator, "a target") for joint in self.joints
                  if joint.actuator_mode is not None]
        if self.wheels is not None and self.wheels.drives:
            motors += [("wheel_velocities", self.wheels._place + side, "a velocity") for side in (0, 1)]
        return motors

    def draw_arrow(self, start: Sequence[float], end: Sequence[float], color: Tuple[int, int, int] = OFF) -> None:
        """Draws for people, for one tick: x, y, z in the frame of the robot's origin [m]; a color is (red,
        green, blue). Needs the actuator `debug`; at most 1000 markers a tick."""
        self._draw(at=start, to=end, color=color)

    def draw_ring(self, center: Sequence[float], radius: float, color: Tuple[int, int, int] = OFF) -> None:
        """Likewise, in the robot's xy plane."""
        self._draw(at=center, radius=radius, color=color)

    def draw_text(self, place: Sequence[float], text: str, color: Tuple[int, int, int] = OFF) -> None:
        """Likewise: 1 to 100 bytes."""
        self._draw(at=place, text=text, color=color)

    def _draw(self, color: Tuple[int, int, int], **what: Any) -> None:
        if not self.draws:
            raise AttributeError(f"robot {self.id!r} does not draw: its controller's <actuators> have no debug")
        marker = v1.Marker(robot=self._position, color=number_of(color), **what)
        if len(marker.at) != 3 or len(marker.to) != (3 if "to" in what else 0) \
                or not all(abs(value) <= 1e6 for value in (*marker.at, *marker.to, marker.radius)):
            raise ValueError("places of markers are x, y, z; they and a radius must lie within -1e6 and 1e6")
        if not 0 < what.get("radius", 1):
            raise ValueError("the radius of a ring must be above 0")
        if not 0 < len(what.get("text", "-").encode()) <= MOST_MARKER_BYTES:
            raise ValueError(f"the text of a marker must have 1 to {MOST_MARKER_BYTES} bytes")
        drawn = self._exchange.markers[self._position]
        if len(drawn) >= MOST_MARKERS:
            raise ValueError(f"robot {self.id!r} draws more than {MOST_MARKERS} markers at this tick")
        drawn.append(marker)

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
                 "magnets", "cameras", "devices") + Sensors._names
        devices = {name: getattr(self, name) for name in names}
        absent = [name for name, device in devices.items() if device is None]
        there = [name for name, device in devices.items() if device]
        return f"robot {self.id!r} has no {', '.join(absent)} (None); it has: {', '.join(there) or 'no devices'}"

    def leave(self) -> None:
        """Leaves the run forever: the world no longer waits for this robot."""
        self._leave("")

    def fail(self, message: str) -> None:
        """Leaves as failed: the run continues, and exits with code 3 at its end."""
        self._leave(message or "failed")

    def _leave(self, failure: str) -> None:
        leave = self._find_leave()
        if leave is not None:
            leave(self, failure)

    def __repr__(self) -> str:
        return f"Robot({self.id!r})"
