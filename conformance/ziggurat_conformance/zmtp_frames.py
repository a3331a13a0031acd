"""Frames of ZMTP 3, ZeroMQ's wire protocol, as far as their sizes, which encrypted connections show, too."""

from dataclasses import dataclass

from .case import Failed


@dataclass(frozen=True)
class Sender:
    """A program under test."""

    name: str
    longest: int  # [bytes] of a frame


CLIENT = Sender("client", 128 << 20)  # twice a controller's limit
SERVER = Sender("server", (1 << 30) + (1 << 20))  # more than one sends
_GREETING = 64  # [bytes]: a signature of 10, the version, and what the kit does not read
_LARGE = 2  # flag of a frame whose size has 8 bytes instead of one


class Frames:
    """Of what a program sends over one connection."""

    def __init__(self, sender: Sender) -> None:
        self._sender = sender
        self.left = 0  # [bytes] of the greeting or frame that has begun
        self._has_greeted = False
        self._head = b""  # of the greeting or frame that comes next, in part

    def read(self, data: bytes) -> tuple:
        """How many frames begin in these bytes, and how many bytes they announce. Raises Failed for what the kit
        does not take."""
        count = size = at = 0
        while at < len(data):
            if self.left:
                skipped = min(self.left, len(data) - at)
                self.left -= skipped
                at += skipped
                continue
            self._head += data[at:at + 1]
            at += 1
            if not self._has_greeted:
                self._greet()
            elif len(self._head) == (9 if self._head[0] & _LARGE else 2):
                self._begin()
                count += 1
                size += self.left
        return count, size

    def _greet(self) -> None:
        """The version, and before it, begins another form of frames."""
        if self._head[0] != 0xFF or len(self._head) == 10 and not self._head[9] & 1:
            raise Failed(f"the {self._sender.name} begins with {self._head!r}; the greeting of ZMTP 3 is expected (T1)")
        if len(self._head) == 11:
            if self._head[10] < 3:
                raise Failed(f"the {self._sender.name} greets as ZMTP {self._head[10]}; ZMTP 3 is expected (T1)")
            self._has_greeted, self.left, self._head = True, _GREETING - 11, b""

    def _begin(self) -> None:
        self.left, self._head = int.from_bytes(self._head[1:], "big"), b""
        if self.left > self._sender.longest:
            raise Failed(f"the {self._sender.name} sends a frame of {self.left} bytes; the kit takes at most {self._sender.longest} (T4)")
