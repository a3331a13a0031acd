"""Bytes that are to be sent."""

from __future__ import annotations

from typing import Any, Callable, List, Tuple

_MOST_SENT = 1 << 20  # that are still kept [bytes]


class OutputQueue:
    """A handler of a signal, as that of Ctrl-C, may raise an exception between any two steps of Python. Behind each
    step here a message is queued or not, and what was sent is not sent again."""

    def __init__(self) -> None:
        self._state: Tuple[bytearray, List[int]] = bytearray(), []  # and what was sent of it, in parts [bytes]

    def __len__(self) -> int:
        data, sent = self._state
        return len(data) - sum(sent)

    def add(self, message: bytes) -> None:
        self._state[0].extend(message)

    def clear(self) -> None:
        self._state = bytearray(), []

    def send(self, send: Callable[[Any], int]) -> None:
        """send: a function in C that takes bytes and returns how many it has sent."""
        data, sent = self._state
        with memoryview(data) as whole, whole[sum(sent):] as rest:
            sent.extend(map(send, (rest,)))  # one step, so that what was sent is known when an exception comes
        begin = sum(sent)
        if begin == len(data):
            self.clear()
        elif begin >= _MOST_SENT:
            self._state = data[begin:], []
