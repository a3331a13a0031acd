"""A connection of the program under test to a relay, and the relay's to the kit's socket: bytes of each go to the other."""

import fcntl
import select
import socket
import struct
import termios
from typing import Callable

from .zmtp_frames import Frames, Sender

AT_ONCE = 1 << 16  # [bytes] of a read; no more wait in each direction


class RelayPipe:
    def __init__(self, program: socket.socket, kit: socket.socket, sender: Sender, count: Callable[[int, int], None]):
        """count: is told of the program's frames and their bytes before the kit gets them."""
        self._program, self._kit, self._count = program, kit, count
        self._frames = Frames(sender)
        self._to_kit = self._to_program = b""
        self._has_program = self._has_kit = True  # it has not closed its end
        for end in (program, kit):
            end.setblocking(False)
            if end.family != socket.AF_UNIX:
                end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def register(self, poll: select.poll, is_full: bool) -> None:
        """For what can be moved. is_full: of the program, only what belongs to the frame that has begun is read."""
        reads_program = self._has_program and self._has_kit and not self._to_kit and (not is_full or self._frames.left)
        reads_kit = self._has_program and self._has_kit and not self._to_program
        for end, reads, writes in ((self._program, reads_program, self._to_program), (self._kit, reads_kit, self._to_kit)):
            if reads or writes:
                poll.register(end, (select.POLLIN if reads else 0) | (select.POLLOUT if writes else 0))

    def move(self, ready: set, is_full: bool) -> None:
        """ready: descriptors at which something can be done. Raises Failed for what the program sent."""
        if self._program.fileno() in ready:
            self._to_program = _written(self._program, self._to_program)
            most = min(AT_ONCE, self._frames.left) if is_full else AT_ONCE
            if self._has_program and self._has_kit and not self._to_kit and most:
                self._read_program(most)
        if self._kit.fileno() in ready:
            self._to_kit = _written(self._kit, self._to_kit)
            if self._has_program and self._has_kit and not self._to_program:
                self._read_kit()

    def is_within_a_frame(self) -> bool:
        """The rest of one is still to come."""
        return self._frames.left > 0

    def unread(self) -> int:
        """[bytes] that the program has sent and that wait."""
        return struct.unpack("i", fcntl.ioctl(self._program, termios.FIONREAD, bytes(4)))[0]

    def is_over(self) -> bool:
        """One end is closed, and the other one has all that came from it."""
        return not self._has_program and not self._to_kit or not self._has_kit and not self._to_program

    def close(self) -> None:
        self._program.close()
        self._kit.close()

    def _read_program(self, most: int) -> None:
        data = _read(self._program, most)
        if data is None:
            return
        self._has_program = bool(data)
        self._count(*self._frames.read(data))
        self._to_kit = _written(self._kit, data)

    def _read_kit(self) -> None:
        data = _read(self._kit, AT_ONCE)
        if data is None:
            return
        self._has_kit = bool(data)
        self._to_program = _written(self._program, data)


def _read(end: socket.socket, most: int):
    """Empty: it is closed. None: there is nothing."""
    try:
        return end.recv(most)
    except BlockingIOError:
        return None
    except OSError:
        return b""


def _written(end: socket.socket, data: bytes) -> bytes:
    """What is left. Nothing of it if the end is closed, which its next read tells."""
    if not data:
        return data
    try:
        return data[end.send(data):]
    except BlockingIOError:
        return data
    except OSError:
        return b""
