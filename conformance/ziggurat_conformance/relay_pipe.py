"""A client's connection to the relay, and the relay's to the server's socket: bytes of each go to the other."""

import select
import socket
from typing import Callable

from .zmtp_frames import Frames

AT_ONCE = 1 << 16  # [bytes] of a read; no more wait in each direction


class RelayPipe:
    def __init__(self, client: socket.socket, server: socket.socket, count: Callable[[int, int], None]):
        """count: is told of frames and their bytes before the server gets them."""
        self._client, self._server, self._count = client, server, count
        self._frames = Frames()
        self._to_server = self._to_client = b""
        self._has_client = self._has_server = True  # it has not closed its end
        client.setblocking(False)
        client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        server.setblocking(False)

    def register(self, poll: select.poll, is_full: bool) -> None:
        """For what can be moved. is_full: of the client, only what belongs to the frame that has begun is read."""
        reads_client = self._has_client and self._has_server and not self._to_server and (not is_full or self._frames.left)
        reads_server = self._has_client and self._has_server and not self._to_client
        for end, reads, writes in ((self._client, reads_client, self._to_client),
                                   (self._server, reads_server, self._to_server)):
            if reads or writes:
                poll.register(end, (select.POLLIN if reads else 0) | (select.POLLOUT if writes else 0))

    def move(self, ready: set, is_full: bool) -> None:
        """ready: descriptors at which something can be done. Raises Failed for what the client sent."""
        if self._client.fileno() in ready:
            self._to_client = _written(self._client, self._to_client)
            most = min(AT_ONCE, self._frames.left) if is_full else AT_ONCE
            if self._has_client and self._has_server and not self._to_server and most:
                self._read_client(most)
        if self._server.fileno() in ready:
            self._to_server = _written(self._server, self._to_server)
            if self._has_client and self._has_server and not self._to_client:
                self._read_server()

    def is_over(self) -> bool:
        """One end is closed, and the other one has all that came from it."""
        return not self._has_client and not self._to_server or not self._has_server and not self._to_client

    def close(self) -> None:
        self._client.close()
        self._server.close()

    def _read_client(self, most: int) -> None:
        data = _read(self._client, most)
        if data is None:
            return
        self._has_client = bool(data)
        self._count(*self._frames.read(data))
        self._to_server = _written(self._server, data)

    def _read_server(self) -> None:
        data = _read(self._server, AT_ONCE)
        if data is None:
            return
        self._has_server = bool(data)
        self._to_client = _written(self._client, data)


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
