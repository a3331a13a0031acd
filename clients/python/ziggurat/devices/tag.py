# SPDX-License-Identifier: MIT
from __future__ import annotations

from typing import Union

from .. import protocol_pb2 as v1
from ..exchange import Exchange
from .device import Device

MAX_PAYLOAD = 1 << 16  # bytes of a tag's payload


class Tag(Device):
    __slots__ = ("_place",)

    def __init__(self, exchange: Exchange, given: v1.TagDescription):
        super().__init__(exchange, given.id)
        self._place = exchange.add("tag_payloads", given.payload)

    @property
    def payload(self) -> bytes:
        return bytes(self._exchange.values["tag_payloads"][self._place])

    @payload.setter
    def payload(self, payload: Union[bytes, str]) -> None:
        payload = payload.encode() if isinstance(payload, str) else bytes(payload)
        if len(payload) > MAX_PAYLOAD:
            raise ValueError(
                f"a payload of {len(payload)} bytes; at most {MAX_PAYLOAD} are allowed")
        self._exchange.set("tag_payloads", self._place, payload)
