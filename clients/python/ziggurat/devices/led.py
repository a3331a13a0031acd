# SPDX-License-Identifier: MIT
from __future__ import annotations

from typing import NamedTuple, Tuple

from .. import protocol_pb2 as v1
from ..exchange import Exchange
from .device import Device


class Color(NamedTuple):
    """Each part 0 … 255; black is off."""

    red: int
    green: int
    blue: int


OFF = Color(0, 0, 0)


def color_of(number: int) -> Color:
    return Color(number >> 16, number >> 8 & 0xFF, number & 0xFF)


def number_of(color: Tuple[int, int, int]) -> int:
    red, green, blue = color
    if not all(0 <= part <= 255 for part in (red, green, blue)):
        raise ValueError(f"color {tuple(color)}: each part must be 0 … 255")
    return red << 16 | green << 8 | blue


class Led(Device):
    """An LED or a directional LED."""

    __slots__ = ("_field", "_place")

    def __init__(self, exchange: Exchange, field: str, given: v1.LedDescription):
        super().__init__(exchange, given.id)
        self._field = field
        self._place = exchange.add(field, given.color)

    @property
    def color(self) -> Color:
        """The last color set, or the scene's. Stays until changed."""
        return color_of(self._exchange.values[self._field][self._place])

    @color.setter
    def color(self, color: Tuple[int, int, int]) -> None:
        self._exchange.set(self._field, self._place, number_of(color))
