# SPDX-License-Identifier: MIT
from __future__ import annotations

from typing import List, NamedTuple

from .. import protocol_pb2 as v1
from ..exchange import Exchange


class Packet(NamedTuple):
    """A received packet; range and bearings are in the receiver's frame."""

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
        """data_size bytes, broadcast at every tick until changed."""
        return bytes(self._exchange.data[self._begin:self._begin + self.data_size])

    @data.setter
    def data(self, data: bytes) -> None:
        if not self.sends:
            raise AttributeError("this range-and-bearing device does not send")
        if len(data) != self.data_size:
            raise ValueError(
                f"{len(data)} bytes of data; this robot sends packets of {self.data_size}")
        self._exchange.set_data(self._begin, bytes(data))
