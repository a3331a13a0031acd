"""Handles of a robot's devices. Reading and setting takes the same time whatever the session holds.

Numbers are SI: m, rad, s, m/s, rad/s; pixels are counted from the top left corner of the image, u
to the right and v down.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, List, NamedTuple, Optional, Tuple, Union

from . import protocol_pb2 as v1
from .exchange import Exchange

MAX_MESSAGE = 1 << 20  # bytes of a radio message
MAX_PAYLOAD = 1 << 16  # bytes of a tag's payload

Vector = Tuple[float, float, float]
Quaternion = Tuple[float, float, float, float]  # w, x, y, z


class Color(NamedTuple):
    """Each part 0 … 255; black is off."""

    red: int
    green: int
    blue: int


OFF = Color(0, 0, 0)


def _color(number: int) -> Color:
    return Color(number >> 16, number >> 8 & 0xFF, number & 0xFF)


def _number(color: Tuple[int, int, int]) -> int:
    red, green, blue = color
    if not all(0 <= part <= 255 for part in (red, green, blue)):
        raise ValueError(f"color {tuple(color)}: each part is 0 … 255")
    return red << 16 | green << 8 | blue


def _finite(value: float, what: str) -> float:
    value = float(value)
    if not math.isfinite(value):
        raise ValueError(f"{what} has to be finite, not {value}")
    return value


class Device:
    """What all handles share."""

    __slots__ = ("id", "_exchange")

    def __init__(self, exchange: Exchange, id: str):
        self.id = id
        self._exchange = exchange

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.id!r})"


class Joint(Device):
    """A joint with an encoder, a motor, or both."""

    __slots__ = ("sensor_mode", "actuator_mode", "max_impulse", "_sensor", "_actuator")

    def __init__(self, exchange: Exchange, id: str):
        super().__init__(exchange, id)
        self.sensor_mode: Optional[str] = None  # "position", "velocity" or "disabled"
        self.actuator_mode: Optional[str] = None  # None: it has no motor
        self.max_impulse = 0.0  # of the motor, a substep [N s] or [N m s]
        self._sensor = self._actuator = -1

    @property
    def encoder(self) -> float:
        """[m], [rad], [m/s] or [rad/s], by sensor_mode; 0 at tick 0."""
        if self._sensor < 0:
            raise AttributeError(f"joint {self.id!r} has no encoder")
        readings = self._exchange.seen.joint_readings
        return readings[self._sensor] if readings else 0.0

    @property
    def target(self) -> float:
        """[m], [rad], [m/s] or [rad/s], by actuator_mode. Stays until changed."""
        if self._actuator < 0:
            raise AttributeError(f"joint {self.id!r} has no motor")
        return self._exchange.values["joint_targets"][self._actuator]

    @target.setter
    def target(self, value: float) -> None:
        if self._actuator < 0:
            raise AttributeError(f"joint {self.id!r} has no motor")
        self._exchange.set("joint_targets", self._actuator, _finite(value, "a target"))


class Radio(Device):
    __slots__ = ("range", "sends", "receives", "_place")

    def __init__(self, exchange: Exchange, place: int, given: v1.RadioDescription):
        super().__init__(exchange, given.id)
        self.range = given.range  # of sending [m]
        self.sends = given.sends
        self.receives = given.receives
        self._place = place

    @property
    def received(self) -> List[bytes]:
        """Messages since the last tick."""
        return self._exchange.heard.get(self._place, [])

    def send(self, message: bytes) -> None:
        """Any number of messages a tick, of at most 1 MiB; each is sent once."""
        if not self.sends:
            raise AttributeError(f"radio {self.id!r} does not send")
        message = bytes(message)
        if len(message) > MAX_MESSAGE:
            raise ValueError(f"a radio message has at most {MAX_MESSAGE} bytes, not {len(message)}")
        self._exchange.messages.append((self._place, message))


class Led(Device):
    """An LED or a directional LED."""

    __slots__ = ("_field", "_place")

    def __init__(self, exchange: Exchange, field: str, given: v1.LedDescription):
        super().__init__(exchange, given.id)
        self._field = field
        self._place = exchange.add(field, given.color)

    @property
    def color(self) -> Color:
        """As it was last set; stays until changed."""
        return _color(self._exchange.values[self._field][self._place])

    @color.setter
    def color(self, color: Tuple[int, int, int]) -> None:
        self._exchange.set(self._field, self._place, _number(color))


class Tag(Device):
    __slots__ = ("_place",)

    def __init__(self, exchange: Exchange, given: v1.TagDescription):
        super().__init__(exchange, given.id)
        self._place = exchange.add("tag_payloads", given.payload)

    @property
    def payload(self) -> bytes:
        return self._exchange.values["tag_payloads"][self._place]

    @payload.setter
    def payload(self, payload: Union[bytes, str]) -> None:
        payload = payload.encode() if isinstance(payload, str) else bytes(payload)
        if len(payload) > MAX_PAYLOAD:
            raise ValueError(f"a payload has at most {MAX_PAYLOAD} bytes, not {len(payload)}")
        self._exchange.set("tag_payloads", self._place, payload)


class Magnet(Device):
    __slots__ = ("_place",)

    def __init__(self, exchange: Exchange, given: v1.MagnetDescription):
        super().__init__(exchange, given.id)
        self._place = exchange.add("magnet_currents", 0.0)

    @property
    def current(self) -> float:
        """A multiple of the magnet's active field."""
        return self._exchange.values["magnet_currents"][self._place]

    @current.setter
    def current(self, value: float) -> None:
        self._exchange.set("magnet_currents", self._place, _finite(value, "a current"))


@dataclass(frozen=True)
class ProximitySensor:
    """The mount of a sensor whose reading is in Robot.proximity at the same place."""

    anchor: str  # id of a link, or "origin"
    position: Vector  # start of the ray in the anchor's frame [m]
    direction: Vector  # in the anchor's frame, of length 1
    range: float  # [m]
    angle: Optional[float] = None  # about +z from +x [rad], of foot-bots' own sensors


class Packet(NamedTuple):
    """What a range-and-bearing sensor received, in the receiver's frame."""

    range: float  # [m]
    horizontal_bearing: float  # from +x towards +y, -pi … pi [rad]
    vertical_bearing: float  # above the xy plane, -pi/2 … pi/2 [rad]
    data: bytes


class RangeAndBearing:
    __slots__ = ("range", "data_size", "sends", "receives", "_exchange", "_robot", "_begin")

    def __init__(self, exchange: Exchange, robot: int, given: v1.RangeAndBearingDescription):
        self.range = given.range  # of sending [m]
        self.data_size = given.data_size  # bytes of each packet
        self.sends = given.sends
        self.receives = given.receives
        self._exchange = exchange
        self._robot = robot
        self._begin = len(exchange.data)
        if self.sends:
            exchange.data.extend(bytes(self.data_size))

    @property
    def packets(self) -> List[Packet]:
        return [Packet(p.range, p.horizontal_bearing, p.vertical_bearing, p.data)
                for p in self._exchange.packets.get(self._robot, [])]

    @property
    def data(self) -> bytes:
        """Broadcast at every tick until changed; data_size bytes."""
        return bytes(self._exchange.data[self._begin:self._begin + self.data_size])

    @data.setter
    def data(self, data: bytes) -> None:
        if not self.sends:
            raise AttributeError("this range-and-bearing device does not send")
        if len(data) != self.data_size:
            raise ValueError(f"data have {self.data_size} bytes, not {len(data)}")
        self._exchange.set_data(self._begin, bytes(data))


class Pose(NamedTuple):
    """Of the robot's origin in the world."""

    position: Vector  # [m]
    orientation: Quaternion


class Battery(NamedTuple):
    available_charge: float  # share of the full one, 0 … 1
    time_left: float  # [s], may be infinite


class LedReading(NamedTuple):
    color: Color
    center: Tuple[float, float]  # u, v [px]


class TagReading(NamedTuple):
    payload: bytes
    center: Tuple[float, float]  # u, v [px]
    corners: Tuple[Tuple[float, float], ...]  # (-,-), (-,+), (+,+), (+,-) in the tag's frame [px]


class Wheels:
    """Differential steering."""

    __slots__ = ("axle_length", "drives", "measures", "_exchange", "_place", "_reading")

    def __init__(self, exchange: Exchange, reading: int, given: v1.WheelsDescription):
        self.axle_length = given.axle_length  # [m]
        self.drives = given.drives
        self.measures = given.measures
        self._exchange = exchange
        self._reading = 4 * reading
        if self.drives:
            self._place = exchange.add("wheel_velocities", 0.0)
            exchange.add("wheel_velocities", 0.0)

    def set_velocity(self, left: float, right: float) -> None:
        """Speeds over the floor [m/s]; they stay until changed."""
        if not self.drives:
            raise AttributeError("this robot does not drive its wheels")
        left, right = _finite(left, "a velocity"), _finite(right, "a velocity")
        self._exchange.set("wheel_velocities", self._place, left)
        self._exchange.set("wheel_velocities", self._place + 1, right)

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


class Turret:
    __slots__ = ("drives", "measures", "_exchange", "_place", "_reading")

    def __init__(self, exchange: Exchange, reading: int, given: v1.TurretDescription):
        self.drives = given.drives
        self.measures = given.measures
        self._exchange = exchange
        self._reading = reading
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
        return rotations[self._reading] if rotations else 0.0

    def _set(self, mode: int, field: str = "", value: float = 0.0) -> None:
        if not self.drives:
            raise AttributeError("this robot does not drive its turret")
        if field:
            self._exchange.set(field, self._place, _finite(value, field))
        self._exchange.set("turret_modes", self._place, mode)

    def rotate_to(self, rotation: float) -> None:
        """Relative to the robot [rad]."""
        self._set(v1.TURRET_POSITION, "turret_rotations", rotation)

    def rotate_at(self, speed: float) -> None:
        """Relative to the robot [rad/s]."""
        self._set(v1.TURRET_SPEED, "turret_speeds", speed)

    def release(self) -> None:
        """It turns with the robot."""
        self._set(v1.TURRET_PASSIVE)


class Camera(Device):
    """A pinhole camera: a point at X, Y, Z in its frame (+z forward, +x right, +y down) is seen at
    u = fx X/Z + cx, v = fy Y/Z + cy."""

    __slots__ = ("anchor", "position", "orientation", "near", "far", "focal_length",
                 "principal_point", "width", "height", "_leds", "_directional_leds", "_tags",
                 "_image")

    def __init__(self, exchange: Exchange, given: v1.CameraDescription, places: Any):
        super().__init__(exchange, given.id)
        self.anchor = given.anchor  # id of a link, or "origin"
        self.position = tuple(given.position)  # in the anchor's frame [m]
        self.orientation = tuple(given.orientation)  # in the anchor's frame: w, x, y, z
        self.near, self.far = given.near, given.far  # along the optical axis [m]
        self.focal_length = tuple(given.focal_length)  # fx, fy [px]
        self.principal_point = tuple(given.principal_point)  # cx, cy [px]
        self.width, self.height = given.width, given.height  # [px]
        self._leds = places.take("led", given.detects_leds)
        self._directional_leds = places.take("directional_led", given.detects_directional_leds)
        self._tags = places.take("tag", given.detects_tags)
        self._image = places.take("image", given.image)

    def detects(self, kind: str) -> bool:
        """Whether it has that detector: "led", "directional_led" or "tag"."""
        places = {"led": self._leds, "directional_led": self._directional_leds, "tag": self._tags}
        return places[kind] >= 0

    @property
    def takes_pictures(self) -> bool:
        return self._image >= 0

    def _found(self, kind: str, place: int) -> range:
        if place < 0:
            raise AttributeError(f"camera {self.id!r} has no {kind}_detector")
        begins = self._exchange.begins.get(kind, [0])
        return range(begins[place], begins[place + 1]) if place + 1 < len(begins) else range(0)

    def _read_leds(self, kind: str, place: int) -> List[LedReading]:
        found = self._found(kind, place)
        colors = getattr(self._exchange.seen, kind + "_colors")
        centers = getattr(self._exchange.seen, kind + "_centers")
        return [LedReading(_color(colors[i]), (centers[2 * i], centers[2 * i + 1])) for i in found]

    @property
    def leds(self) -> List[LedReading]:
        return self._read_leds("led", self._leds)

    @property
    def directional_leds(self) -> List[LedReading]:
        return self._read_leds("directional_led", self._directional_leds)

    @property
    def tags(self) -> List[TagReading]:
        found = self._found("tag", self._tags)
        seen = self._exchange.seen
        return [TagReading(seen.tag_payloads[i], tuple(seen.tag_centers[2 * i:2 * i + 2]),
                           tuple(tuple(seen.tag_corners[j:j + 2]) for j in range(8 * i, 8 * i + 8, 2)))
                for i in found]

    @property
    def image(self) -> bytes:
        """Width × height × 3 bytes, rows from the top, red green blue; empty at tick 0."""
        if self._image < 0:
            raise AttributeError(f"camera {self.id!r} takes no pictures")
        images = self._exchange.seen.camera_images
        return images[self._image] if images else b""

    def image_array(self) -> Any:
        """The image as a numpy array of height, width, 3; needs numpy. None at tick 0."""
        import numpy
        image = self.image
        return numpy.frombuffer(image, numpy.uint8).reshape(self.height, self.width, 3) \
            if image else None
