# SPDX-License-Identifier: MIT
"""The Requests of a session and their Responses (V2)."""

from typing import Iterator

from ..wire import protocol
from .error import error_faults
from .fault import Fault


class Requests:
    def __init__(self) -> None:
        self._waiting: list[int] = []  # ids

    def said(self, request: protocol.Request) -> None:
        self._waiting.append(request.id)

    def told(self, response: protocol.Response) -> Iterator[Fault]:
        if response.id not in self._waiting:
            yield Fault("V2", f"a Response to the request {response.id}, which was not made or is answered")
        elif self._waiting.index(response.id):
            yield Fault("V2", f"the request {self._waiting[0]} is passed over: {response.id} is answered")
        if response.id in self._waiting:
            self._waiting.remove(response.id)
        if not response.HasField("error"):
            return
        yield from error_faults(response.error)
        if response.WhichOneof("result"):
            yield Fault("V2", "a Response has an error and a result")
        if response.error.tick != response.tick:
            yield Fault("M0", f"the Error of a Response has tick {response.error.tick}; the world is at {response.tick} "
                        "(section 6)")
