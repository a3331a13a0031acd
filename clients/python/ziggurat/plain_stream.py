"""A connection without encryption: ZeroMQ's wire protocol (RFC 37) on a socket of Python's. libzmq reads ahead, as
many frames as a server likes to send: here one frame is read at a time, so that its longest is all that a server can
make a client keep."""

from __future__ import annotations

import errno
import math
import os
import re
import select
import socket
import threading
import time
from typing import Any, List, Optional, Tuple

from .output_queue import OutputQueue

# Wall times [s].
SLICE = 0.5  # of a wait
LINGER = 1.0  # time to send the last messages when a session is closed
_BETWEEN_TRIES = 0.1
_BETWEEN_LOOKS = 0.02  # at whether a host was found
_LONGEST_HANDSHAKE = 30.0

LONGEST_MESSAGE = (1 << 30) + (1 << 20)  # of a server: an Observation of 1 GiB and what is around it [bytes]
_LONGEST_COMMAND = 2048  # [bytes]
_LONGEST_QUEUE = 64 << 20  # of what is to be sent: above it, sending waits [bytes]
_LEAST_READ, _MOST_READ = 1 << 16, 1 << 20  # at once [bytes]
_LONGEST_PATH = 107  # of a socket [bytes]

_MORE, _LONG, _COMMAND = 1, 2, 4  # flags of a frame
_GREETING = b"\xff" + bytes(7) + b"\x01\x7f\x03\x01" + b"NULL".ljust(52, b"\0")
_FIRST = 11  # of the greeting: its signature and major version [bytes]
_READY = b"\x05READY\x0bSocket-Type\0\0\0\x06"

_CLOSED, _LOOKING_UP, _CONNECTING, _GREETS, _IS_READY, _OPEN = range(6)  # stages

KEYS_ARE_MISSING = "refused key? The endpoint is protected, and this client has no keys; pass curve=Curve(...)"


class Address:
    """A path, or a port of a host."""

    def __init__(self, family: int, host: str, port: str = ""):
        self._family = family
        self._host = host  # or the path
        self._port = port

    def find(self) -> Optional["Found"]:
        """Starts to look up a host, on a thread of its own: that can take a minute."""
        found = Found()
        if self._family == socket.AF_UNIX:
            found.answer = [(self._family, self._host)]
        else:
            self._look_up(found, socket.AI_NUMERICHOST)
            if not found.answer:
                found.answer = None
                threading.Thread(target=self._look_up, args=(found, 0), daemon=True).start()
        return found

    def _look_up(self, found: "Found", flags: int) -> None:
        if self._family == socket.AF_INET6:
            flags |= socket.AI_V4MAPPED
        try:
            found.answer = [(entry[0], entry[4]) for entry in socket.getaddrinfo(
                self._host, self._port, self._family, socket.SOCK_STREAM, 0, flags | socket.AI_NUMERICSERV)]
        except (OSError, UnicodeError):
            found.answer = []


class Found:
    """What became of a look-up: family and address of sockets, the first is taken; none yet."""

    def __init__(self) -> None:
        self.answer: Optional[List[Tuple[int, Any]]] = None


def check_endpoint(endpoint: str) -> None:
    """Raises ValueError for one that no server can listen at: it is not waited for."""
    if endpoint.startswith("ipc://"):
        return
    parts = re.fullmatch(r"tcp://(.+):([^:]*)", endpoint, re.DOTALL)
    if parts is None:
        raise ValueError(f"endpoint {endpoint!r} is none; write ipc:///path or tcp://host:port")
    if re.fullmatch(r"[0-9]+", parts[2]) is None or not 0 < int(parts[2][:20]) < 1 << 16:
        raise ValueError(f"endpoint {endpoint!r}: the port is {parts[2]!r}; it must be a number from 1 to 65535")


def has_unknown_host(endpoint: str) -> bool:
    """Whether the host has a name without address. Asks for a second at most."""
    address = None if endpoint.startswith("ipc://") else address_of(endpoint)
    if address is None:
        return False
    found = address.find()
    end = time.monotonic() + 1.0
    while found.answer is None and time.monotonic() < end:
        time.sleep(_BETWEEN_LOOKS)
    return found.answer == []


def address_of(endpoint: str) -> Optional[Address]:
    """None for what only libzmq connects to: what is neither ipc:///path nor tcp://host:port."""
    if endpoint.startswith("ipc://"):
        path = endpoint[len("ipc://"):]
        is_plain = path and path[0] not in "@*" and len(os.fsencode(path)) <= _LONGEST_PATH and "\0" not in path
        return Address(socket.AF_UNIX, path) if is_plain else None
    parts = re.fullmatch(r"tcp://(?:\[([0-9A-Za-z.:%_-]+)\]|([0-9A-Za-z._-]+)):([0-9]{1,5})", endpoint)
    if parts is None or not 0 < int(parts[3]) < 1 << 16:
        return None
    return Address(socket.AF_INET6, parts[1], parts[3]) if parts[1] else Address(socket.AF_INET, parts[2], parts[3])


class PlainStream:
    def __init__(self, address: Address):
        """Starts to connect; the server may start later."""
        self._address = address
        self._found: Optional[Found] = None
        self._socket: Optional[socket.socket] = None
        self._poll: Any = None
        self._stage = _CLOSED
        self._next_try = 0.0
        self._handshake_end = 0.0
        self._has_greeted = self._was_open = False
        self._handshake = b""  # of our end, what is not sent yet
        self._output = OutputQueue()  # messages; sent when the connection is open
        self._input = bytearray()
        self._missing = 0  # of the first frame of the input [bytes]
        self.has_more = False  # the last message goes on in another frame
        self.why_closed: Optional[str] = None  # all messages that came before have been received
        self.closed = False  # by this end
        self._go_on()

    @property
    def is_accepted(self) -> bool:
        """By the server: if nothing arrives then, it is slow."""
        return self._stage >= _GREETS

    def close(self, linger: float) -> None:
        """linger  time to send the last messages [s]"""
        if self.closed:
            return
        end = time.monotonic() + linger
        while self._stage == _OPEN and self._output and linger > 0 and time.monotonic() < end:
            self._wait(0.01, select.POLLOUT)
        # What has arrived is read: the server would take an unread rest for a broken connection.
        while linger > 0 and self._stage >= _GREETS and time.monotonic() < end and self._fill():
            self._input.clear()
        self.closed = True
        self._drop()

    def send(self, data: bytes) -> bool:
        """Queues a message. False after a while if the queue is full, and at once if the server has refused the
        connection."""
        if self._stage != _OPEN or len(self._output) >= _LONGEST_QUEUE:
            end = time.monotonic() + SLICE
            while True:
                self._shake_hands()
                if self.why_closed is not None and not self._was_open:
                    return False
                if len(self._output) < _LONGEST_QUEUE:
                    break
                if self.why_closed is not None or time.monotonic() >= end:
                    return False
                if self._wait(SLICE, select.POLLRDHUP if self._stage == _OPEN else select.POLLIN):
                    self._fill() if self._stage != _OPEN else self._drop()  # the server is gone
        size = len(data)
        header = bytes((0, size)) if size < 256 else b"\x02" + size.to_bytes(8, "big")
        self._output.add(header + data)
        self._flush()
        return True

    def receive(self, seconds: float) -> Optional[bytes]:
        """Waits for a message; None after this time, and if the connection is closed."""
        end = time.monotonic() + seconds
        while True:
            if self._stage != _OPEN:
                self._shake_hands()
            message = self._take() if self._stage == _OPEN else None
            if message is not None:
                return message
            left = end - time.monotonic()
            if self.why_closed is not None:
                return None
            if self._wait(max(0.0, left), select.POLLIN):
                self._fill()
            elif left <= 0:
                return None
            if left < -SLICE:  # a server that sends commands without end
                return None

    def _go_on(self) -> None:
        """Goes on with connecting, as far as that does not wait."""
        if self._stage == _CLOSED and self._may_connect() and time.monotonic() >= self._next_try:
            self._next_try = time.monotonic() + _BETWEEN_TRIES
            self._found = self._address.find()
            self._stage = _LOOKING_UP
        if self._stage == _LOOKING_UP and self._found is not None and self._found.answer is not None:
            self._connect(self._found.answer)
        if self._stage == _CONNECTING and self._poll.poll(0):
            if self._socket.getsockopt(socket.SOL_SOCKET, socket.SO_ERROR) != 0:
                self._drop()
            else:
                self._greet()
        if self._stage in (_GREETS, _IS_READY) and time.monotonic() >= self._handshake_end:
            self._drop()

    def _may_connect(self) -> bool:
        return not self._was_open and not self.closed and self.why_closed is None

    def _connect(self, found: List[Tuple[int, Any]]) -> None:
        self._stage = _CLOSED
        if not found:
            return
        family, address = found[0]
        try:
            self._socket = socket.socket(family, socket.SOCK_STREAM)
            self._socket.setblocking(False)
            if family != socket.AF_UNIX:
                self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
            fault = self._socket.connect_ex(address)
        except OSError:
            return self._drop()
        if fault not in (0, errno.EINPROGRESS):
            return self._drop()
        self._poll = select.poll()
        self._poll.register(self._socket, select.POLLOUT)
        self._stage = _CONNECTING
        if fault == 0:
            self._greet()

    def _greet(self) -> None:
        self._stage = _GREETS
        self._poll.modify(self._socket, select.POLLIN)
        self._handshake_end = time.monotonic() + _LONGEST_HANDSHAKE
        self._input.clear()
        self._missing = 0
        # The rest when an answer begins: libzmq closes a connection of another mechanism without one if it knows that at
        # once.
        self._handshake = _GREETING[:_FIRST]
        self._has_greeted = False
        self._flush()

    def _drop(self) -> None:
        if self._socket is not None:
            self._socket.close()
        self._socket = None
        self._poll = None
        self._handshake = b""
        if self._stage == _OPEN:
            self._output.clear()
            self.why_closed = "the connection was closed"
        self._stage = _CLOSED

    def _shake_hands(self) -> None:
        """As far as that does not wait."""
        while self._stage != _OPEN:
            self._go_on()
            before = self._stage, len(self._input)
            if self._stage == _GREETS:
                self._take_greeting()
            elif self._stage == _IS_READY:
                self._take()
            if self._stage not in (_GREETS, _IS_READY):
                return
            if before == (self._stage, len(self._input)) and not self._fill():
                return

    def _take_greeting(self) -> None:
        given = self._input
        is_wrong = given[:1] not in (b"", b"\xff") or (len(given) >= 10 and not given[9] & 1) or (
            len(given) > 10 and given[10] < 3)
        mechanism = bytes(given[12:32]).rstrip(b"\0") if len(given) >= len(_GREETING) else b"NULL"
        if is_wrong or mechanism != b"NULL":
            if not is_wrong and mechanism == b"CURVE":
                self.why_closed = KEYS_ARE_MISSING
            return self._drop()
        if len(given) >= _FIRST and not self._has_greeted:
            self._has_greeted = True
            self._handshake += _GREETING[_FIRST:]
        if len(given) >= len(_GREETING):
            del given[:len(_GREETING)]
            self._stage = _IS_READY
            # Not earlier: who closes the connection without reading it resets that, and the greeting can get lost.
            ready = _READY + b"DEALER"
            self._handshake += bytes((_COMMAND, len(ready))) + ready
        self._flush()

    def _take(self) -> Optional[bytes]:
        """The first message of the input, if it is whole; also handles commands before it."""
        given = self._input
        while len(given) >= 2:
            flags = given[0]
            begin = 9 if flags & _LONG else 2
            if len(given) < begin:
                break
            size = int.from_bytes(given[1:begin], "big")
            is_command = bool(flags & _COMMAND)
            longest = _LONGEST_COMMAND if is_command else LONGEST_MESSAGE
            if flags > 7 or size > longest or not (is_command or self._stage == _OPEN):
                self._drop()
                break
            self._missing = begin + size - len(given)
            if self._missing > 0:
                break
            with memoryview(given) as view:
                body = bytes(view[begin:begin + size])
            del given[:begin + size]
            if not is_command:
                self.has_more = bool(flags & _MORE)
                return body
            self._take_command(body)
            if self._stage != _OPEN:
                break
        return None

    def _take_command(self, body: bytes) -> None:
        if self._stage == _IS_READY:
            # A connection to a free port of this machine can be one to itself.
            if not body.startswith(b"\x05READY") or (_READY[6:] + b"ROUTER").lower() not in body.lower():
                return self._drop()
            self._stage = _OPEN
            self._was_open = True
            self._flush()
        elif body.startswith(b"\x04PING") and len(body) >= 7 and len(self._output) < _MOST_READ:
            pong = b"\x04PONG" + body[7:]
            self._output.add(bytes((_COMMAND, len(pong))) + pong if len(pong) < 256 else b"")
            self._flush()

    def _wait(self, seconds: float, events: int) -> bool:
        """Waits until something arrives, or may be sent, or it is time to go on with connecting; whether something has
        arrived. events: POLLIN, or POLLRDHUP to leave what arrives where it is."""
        if self._stage == _CLOSED:
            seconds = min(seconds, max(0.0, self._next_try - time.monotonic()))
        if self._stage == _LOOKING_UP:
            seconds = min(seconds, _BETWEEN_LOOKS)
        if self._poll is None:
            time.sleep(seconds)
            return False
        if self._stage in (_GREETS, _IS_READY):
            seconds = min(seconds, max(0.0, self._handshake_end - time.monotonic()))
        has_output = self._handshake or (self._output and self._stage == _OPEN)
        if self._stage == _CONNECTING or has_output or events != select.POLLIN:
            self._poll.modify(self._socket, events | select.POLLOUT)
            ready = self._poll.poll(math.ceil(1000 * seconds))
            self._poll.modify(self._socket, select.POLLIN if self._stage != _CONNECTING else select.POLLOUT)
            if has_output:
                self._flush()
        else:
            ready = self._poll.poll(math.ceil(1000 * seconds))
        return bool(ready) and self._stage >= _GREETS and bool(ready[0][1] & ~select.POLLOUT)

    def _flush(self) -> None:
        """Sends what the connection takes now."""
        try:
            if self._handshake:
                self._handshake = self._handshake[self._socket.send(self._handshake):]
            if self._stage == _OPEN and self._output and not self._handshake:
                self._output.send(self._socket.send)
        except OSError:
            pass  # it takes nothing now; or it is broken, and what the server sent before may still be read

    def _fill(self) -> bool:
        """Reads what has arrived; whether there was something. The end of the connection closes this end, too."""
        try:
            data = self._socket.recv(min(max(self._missing, _LEAST_READ), _MOST_READ))
        except BlockingIOError:
            return False
        except OSError:
            data = b""
        self._input += data
        if not data:
            self._drop()
        return bool(data)
