# SPDX-License-Identifier: MIT
from __future__ import annotations

from typing import List

from .. import protocol_pb2 as v1
from ..exchange import Exchange
from .device import Device

MAX_MESSAGE = 1 << 20  # bytes of a radio message


class Radio(Device):
    __slots__ = ("range", "sends", "receives", "_place")

    def __init__(self, exchange: Exchange, given: v1.RadioDescription):
        super().__init__(exchange, given.id)
        self.range = given.range  # of sending [m]
        self.sends = given.sends
        self.receives = given.receives
        self._place = exchange.place("radio")

    @property
    def received(self) -> List[bytes]:
        """Messages received in the last tick."""
        return self._exchange.heard.get(self._place, [])

    def send(self, message: bytes) -> None:
        """Sends a message of at most 1 MiB once. Each call sends a message."""
        if not self.sends:
            raise AttributeError(f"radio {self.id!r} does not send")
        message = bytes(message)
        if len(message) > MAX_MESSAGE:
            raise ValueError(
                f"a radio message of {len(message)} bytes; at most {MAX_MESSAGE} are allowed")
        self._exchange.messages.append((self._place, message))
