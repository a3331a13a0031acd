"""How a client's messages go to a server of this machine and back: frames of ZMTP 3.0, ZeroMQ's wire protocol, over a
socket of the system, with mechanism NULL. No other thread takes part: a tick is one send and one receive."""

from __future__ import annotations

import os
import select
import socket
import struct
import time
from typing import Optional

SLICE = 0.5  # of a wait [s] of wall time
LONGEST_PATH = 107  # of a socket [bytes]
_BETWEEN_ATTEMPTS = 0.05  # to connect, while there is no server [s] of wall time
_AT_ONCE = 1 << 16  # read [bytes]
_GREETING = b"\xff\0\0\0\0\0\0\0\1\x7f\3\0NULL".ljust(64, b"\0")
_READY = b"\4\x29\5READY\x0bSocket-Type\0\0\0\6DEALER\x08Identity\0\0\0\0"
_MORE, _LONG, _COMMAND = 1, 2, 4  # flags of a frame


class LocalTransport:
    """As Transport, for `ipc://path`. Connects when it can; the server may start later."""

    def __init__(self, endpoint: str, longest: int, keys_are_missing: str):
        """longest  message that is taken [bytes]; keys_are_missing: why a protected server is left"""
        path = endpoint[len("ipc://"):]
        if path in ("", "@", "*") or len(os.fsencode(path)) > LONGEST_PATH:
            raise ValueError(f"endpoint {endpoint!r}: the path must have 1 to {LONGEST_PATH} bytes")
        self._address = "\0" + path[1:] if path.startswith("@") else path
        self._longest, self._keys_are_missing = longest, keys_are_missing
        self.is_accepted = False  # by the server: if nothing arrives then, it is slow
        self.why_closed: Optional[str] = None  # messages that came before may still be here
        self.has_more = False  # the last message goes on in another frame
        self._socket: Optional[socket.socket] = None
        self._is_over = False  # by close()
        self._waiting = bytearray()  # to be sent as soon as the handshake is over, or the server reads again
        self._begin()
        self._connect()

    def _begin(self) -> None:
        """Before a handshake."""
        self._input = bytearray()
        self._taken = 0  # of the input [bytes]
        self._needed = 0  # of it, before there can be another frame [bytes]
        self._has_greeting = self._is_open = False

    def _connect(self) -> None:
        client = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        try:
            client.settimeout(SLICE)
            client.connect(self._address)
            client.sendall(_GREETING + _READY)
        except (OSError, socket.timeout):  # no server yet, or one that has no place
            client.close()
            return
        client.setblocking(True)
        slice_of_time = struct.pack("ll", 0, int(1e6 * SLICE))
        client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVTIMEO, slice_of_time)
        client.setsockopt(socket.SOL_SOCKET, socket.SO_SNDTIMEO, slice_of_time)
        self._socket = client
        self.is_accepted = True

    @property
    def closed(self) -> bool:
        return self._is_over

    def close(self, linger: float) -> None:
        """linger  time to send the last messages [s]"""
        if self._is_over:
            return
        self._is_over = True
        end = time.monotonic() + linger
        while linger and self._socket and not self.why_closed and self._waiting and time.monotonic() < end:
            if self._is_open:
                self._flush()
            elif self.receive(min(SLICE, end - time.monotonic())) is not None:
                break
        if self._socket:
            self._socket.close()
            self._socket = None

    def __del__(self) -> None:
        if getattr(self, "_socket", None) is not None:
            self._socket.close()

    def send(self, data: bytes) -> bool:
        """Sends a message, or keeps what the server does not take yet. False after a while if it still takes nothing of
        the message before, or has refused the connection."""
        if self._waiting and self._is_open:
            self._flush()
        if self.why_closed or (self._waiting and self._is_open):
            return False
        size = len(data)
        header = struct.pack(">BB", 0, size) if size < 256 else struct.pack(">BQ", _LONG, size)
        if not self._is_open:
            self._waiting += header + data
            return True
        frame = header + data
        sent = self._write(frame)
        if sent < len(frame):
            self._waiting += frame[sent:]
        return True

    def _flush(self) -> None:
        sent = self._write(self._waiting)
        del self._waiting[:sent]

    def _write(self, data: bytes) -> int:
        """Bytes that were sent: all, but for a server that reads nothing for a while."""
        try:
            return self._socket.send(data)
        except BlockingIOError:
            return 0
        except OSError:
            self._lose()
            return 0

    def _lose(self) -> None:
        """The connection has ended. Within its handshake another is tried: a server that ends, or has no place, breaks it
        off, too."""
        self.is_accepted = False
        if self._is_open:
            self.why_closed = self.why_closed or "the connection was closed"
            return
        self._socket.close()
        self._socket = None
        self._begin()
        time.sleep(_BETWEEN_ATTEMPTS)

    def receive(self, seconds: float) -> Optional[bytes]:
        """Waits for a message; None after this time, and when the connection has changed."""
        message = self._next()
        if message is not None or self.why_closed:
            return message
        end = time.monotonic() + seconds
        while True:
            if self._socket is None:
                self._connect()
            if self._socket is None:
                time.sleep(min(_BETWEEN_ATTEMPTS, max(0.0, end - time.monotonic())))
            elif self._read(seconds):
                message = self._next()
                if message is not None or self.why_closed:
                    return message
            seconds = end - time.monotonic()
            if seconds <= 0:
                return None

    def _is_readable(self, seconds: float) -> bool:
        """Within this time. What waits is sent meanwhile."""
        has_output = self._waiting and self._is_open
        poll = select.poll()
        poll.register(self._socket, select.POLLIN | (select.POLLOUT if has_output else 0))
        found = poll.poll(max(0.0, 1000 * seconds))
        if found and found[0][1] & select.POLLOUT:
            self._flush()
        return bool(found) and found[0][1] & ~select.POLLOUT != 0

    def _read(self, seconds: float) -> bool:
        """More of the input; waits so long, but not longer than a slice. False: none has arrived."""
        try:
            if (seconds < SLICE or self._waiting) and not self._is_readable(seconds):
                return False
            data = self._socket.recv(max(_AT_ONCE, min(self._needed - len(self._input), 1 << 24)))
        except BlockingIOError:
            return False
        except OSError:
            data = b""
        if not data:
            self._lose()
            return False
        self._input += data
        return True

    def _next(self) -> Optional[bytes]:
        """The next message of what has arrived; takes the handshake, too."""
        while len(self._input) - self._taken >= max(self._needed, 2):
            if not self._has_greeting:
                if not self._take_greeting():
                    break
                continue
            flags, at = self._input[self._taken], self._taken + 2
            size = self._input[self._taken + 1]
            if flags & _LONG:
                at = self._taken + 9
                if len(self._input) < at:
                    self._needed = 9
                    break
                size = int.from_bytes(self._input[self._taken + 1:at], "big")
            if size > self._longest or flags & ~(_MORE | _LONG | _COMMAND):
                self.why_closed = "the connection was closed: its messages are none of ZMTP, or too long"
                return None
            if len(self._input) < at + size:
                self._needed = at + size - self._taken
                break
            body = bytes(memoryview(self._input)[at:at + size])
            self._taken, self._needed = at + size, 0
            if not flags & _COMMAND:
                self.has_more = bool(flags & _MORE)
                return body
            if not self._is_open and body.startswith(b"\5READY"):
                self._is_open = True
                if self._waiting:
                    self._flush()
        if self._taken:
            del self._input[:self._taken]
            self._taken = 0
        return None

    def _take_greeting(self) -> bool:
        """Whether all of it is there."""
        if len(self._input) < 64:
            return False
        if self._input[0] != 0xff or self._input[10] < 3:
            self.why_closed = "what listens there does not speak ZMTP 3"
            return False
        if not self._input[12:32].startswith(b"NULL\0"):
            self.why_closed = self._keys_are_missing
            return False
        self._has_greeting = True
        self._taken = 64
        return True
