# SPDX-License-Identifier: MIT
from __future__ import annotations

from .. import protocol_pb2 as v1
from ..exchange import Exchange
from .device import Device, finite


class Magnet(Device):
    __slots__ = ("_place",)

    def __init__(self, exchange: Exchange, given: v1.MagnetDescription):
        super().__init__(exchange, given.id)
        self._place = exchange.add("magnet_currents", 0.0)

    @property
    def current(self) -> float:
        """A multiple of the magnet's active field."""
        return float(self._exchange.values["magnet_currents"][self._place])

    @current.setter
    def current(self, value: float) -> None:
        self._exchange.set("magnet_currents", self._place, finite(value, "a current"))
