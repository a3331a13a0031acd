# SPDX-License-Identifier: MIT
from __future__ import annotations

from typing import Any, List, NamedTuple, Tuple

from .. import protocol_pb2 as v1
from ..exchange import Exchange
from .device import Device
from .led import Color, color_of


class LedReading(NamedTuple):
    color: Color
    center: Tuple[float, float]  # u, v [px]


class TagReading(NamedTuple):
    payload: bytes
    center: Tuple[float, float]  # u, v [px]
    corners: Tuple[Tuple[float, float], ...]  # (-,-), (-,+), (+,+), (+,-) in the tag's frame [px]


class Camera(Device):
    """A pinhole camera: a point at X, Y, Z in its frame (+z forward, +x right, +y down) is seen at
    u = fx X/Z + cx, v = fy Y/Z + cy."""

    __slots__ = ("anchor", "position", "orientation", "near", "far", "focal_length",
                 "principal_point", "width", "height", "_leds", "_directional_leds", "_tags",
                 "_image")

    def __init__(self, exchange: Exchange, given: v1.CameraDescription):
        super().__init__(exchange, given.id)
        self.anchor = given.anchor  # id of a link, or "origin"
        self.position = tuple(given.position)  # in the anchor's frame [m]
        self.orientation = tuple(given.orientation)  # in the anchor's frame: w, x, y, z
        self.near, self.far = given.near, given.far  # along the optical axis [m]
        self.focal_length = tuple(given.focal_length)  # fx, fy [px]
        self.principal_point = tuple(given.principal_point)  # cx, cy [px]
        self.width, self.height = given.width, given.height  # [px]
        self._leds = exchange.place("led", given.detects_leds)
        self._directional_leds = exchange.place("directional_led", given.detects_directional_leds)
        self._tags = exchange.place("tag", given.detects_tags)
        self._image = exchange.place("image", given.image)

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
        begins = self._exchange.begins(kind)
        return range(begins[place], begins[place + 1]) if place + 1 < len(begins) else range(0)

    def _read_leds(self, kind: str, place: int) -> List[LedReading]:
        found = self._found(kind, place)
        colors = getattr(self._exchange.seen, kind + "_colors")
        centers = getattr(self._exchange.seen, kind + "_centers")
        return [LedReading(color_of(colors[i]), (centers[2 * i], centers[2 * i + 1]))
                for i in found]

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
        return [TagReading(seen.tag_payloads[i], (seen.tag_centers[2 * i], seen.tag_centers[2 * i + 1]),
                           tuple((seen.tag_corners[j], seen.tag_corners[j + 1])
                                 for j in range(8 * i, 8 * i + 8, 2)))
                for i in found]

    @property
    def image(self) -> bytes:
        """Width × height × 3 bytes, rows from the top, red green blue; empty at tick 0."""
        if self._image < 0:
            raise AttributeError(f"camera {self.id!r} takes no pictures")
        images = self._exchange.seen.camera_images
        return bytes(images[self._image]) if images else b""

    def image_array(self) -> Any:
        """The image as a numpy array of height, width, 3; needs numpy. None at tick 0."""
        import numpy
        image = self.image
        return numpy.frombuffer(image, numpy.uint8).reshape(self.height, self.width, 3) \
            if image else None
