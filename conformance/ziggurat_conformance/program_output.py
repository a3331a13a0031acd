# SPDX-License-Identifier: MIT
"""What a program prints, read as it comes: its beginning and its end are kept."""

import collections
import os
import select
import threading

_AT_ONCE = 1 << 16  # [bytes]
KEPT = 1 << 20  # [bytes] of the beginning, and as many of the end
_LOOKS_EVERY = 0.1  # [s] whether it is to end, while something else still holds the pipe
_LAST_READ = 0.5  # [s] for what is left in the pipe of a program that has ended


class ProgramOutput:
    """A pipe whose writer never waits for long, and that takes no more than 2 * KEPT of memory."""

    def __init__(self) -> None:
        self._reader, self.writer = os.pipe()  # writer: for the program
        self._beginning = bytearray()
        self._end: collections.deque = collections.deque()  # chunks behind the beginning
        self._end_size = self._left_out = 0  # [bytes]
        self._lock = threading.Lock()
        self._is_closing = threading.Event()
        self._thread = threading.Thread(target=self._read, daemon=True)

    def begin(self) -> None:
        """Behind the start of the program, which alone writes from now on."""
        os.close(self.writer)
        self._thread.start()

    def settle(self) -> None:
        """Waits for what a program that has ended left in the pipe."""
        self._thread.join(_LAST_READ)

    def close(self) -> None:
        """Also while something still writes."""
        self._is_closing.set()
        if self._thread.ident is None:
            os.close(self.writer)
            os.close(self._reader)
        else:
            self._thread.join()

    def text(self) -> bytes:
        """The beginning and the end, with a line between them that counts what is left out."""
        with self._lock:
            gap = b"\n... %d bytes left out ...\n" % self._left_out if self._left_out else b""
            return bytes(self._beginning) + gap + b"".join(self._end)

    def last_words(self, size: int = 2000) -> str:
        """The last so many bytes."""
        return self.text()[-size:].decode(errors="replace").strip()

    def _read(self) -> None:
        poll = select.poll()
        poll.register(self._reader, select.POLLIN)
        try:
            while not self._is_closing.is_set():
                if poll.poll(1000 * _LOOKS_EVERY):
                    data = os.read(self._reader, _AT_ONCE)
                    if not data:
                        return
                    self._keep(data)
        finally:
            os.close(self._reader)

    def _keep(self, data: bytes) -> None:
        with self._lock:
            space = KEPT - len(self._beginning)
            self._beginning += data[:space]
            if space >= len(data):
                return
            data = data[space:]
            self._end.append(data)
            self._end_size += len(data)
            while self._end_size - len(self._end[0]) >= KEPT:
                size = len(self._end.popleft())
                self._end_size -= size
                self._left_out += size
