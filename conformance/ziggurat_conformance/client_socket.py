# SPDX-License-Identifier: MIT
"""The server's socket in client mode."""

import math
import select
import socket
import time
from dataclasses import dataclass
from typing import Optional

import zmq
import zmq.auth.thread
import zmq.utils.monitor

from .case import Failed
from .server_process import free_port

_LONGEST = 128 << 20  # [bytes]: twice a controller's limit; above, the connection is closed (T4)
_REBINDING = 5.0  # [s] until a port is free again
# Messages that wait to be sent over a connection, beside one that is being sent. Whatever they are, short ones are in
# buffers of the system.
_MOST_TO_SEND = 1
LONGEST_SEND = 10.0  # [s] that one waits for the client to read
_PEER_NAMES = ("Socket-Type", "User-Id")


@dataclass(frozen=True)
class Arrival:
    """A message as it came."""

    routing_id: bytes
    frames: tuple  # zmq.Frame
    socket_type: str
    key: str  # of the client, Z85; empty: a plain connection


class ServerSocket:
    """A ROUTER at a port of its own. It may be closed and opened again there."""

    def __init__(self, secret_key: Optional[bytes] = None, is_open: bool = True):
        """is_open: every key may connect; otherwise none."""
        self._context = zmq.Context()
        self._secret_key = secret_key
        self._authenticator = None
        if secret_key is not None:
            self._authenticator = zmq.auth.thread.ThreadAuthenticator(self._context)
            self._authenticator.start()
            self._authenticator.configure_curve_callback(credentials_provider=_Doorkeeper(is_open))
        self.endpoint = f"tcp://127.0.0.1:{free_port()}"
        self._socket: Optional[zmq.Socket] = None
        self._monitor: Optional[zmq.Socket] = None
        self._connected: set[int] = set()  # descriptors
        self._is_reached = False
        self.open()

    def open(self) -> None:
        self._socket = self._context.socket(zmq.ROUTER)
        self._socket.setsockopt(zmq.LINGER, 0)
        self._socket.setsockopt(zmq.MAXMSGSIZE, _LONGEST)
        self._socket.setsockopt(zmq.RCVHWM, 0)  # unbounded: ZeroMQ would lose the rest when the client closes
        self._socket.setsockopt(zmq.SNDHWM, _MOST_TO_SEND)
        self._socket.setsockopt(zmq.SNDTIMEO, int(1000 * LONGEST_SEND))
        self._socket.setsockopt(zmq.ROUTER_MANDATORY, 1)  # waits for room, and tells if there is none
        if self._secret_key is not None:
            self._socket.curve_secretkey = self._secret_key
            self._socket.curve_server = True
        self._connected, self._is_reached = set(), False
        self._monitor = self._socket.get_monitor_socket(zmq.EVENT_ACCEPTED | zmq.EVENT_DISCONNECTED)
        deadline = time.monotonic() + _REBINDING
        while True:
            try:
                self._socket.bind(self.endpoint)
                return
            except zmq.ZMQError:
                if time.monotonic() > deadline:
                    raise
                time.sleep(0.005)

    def close(self) -> None:
        """Ends all connections."""
        if self._socket is not None:
            self._socket.disable_monitor()
            self._monitor.close(linger=0)
            self._socket.close()
            self._socket = None

    def is_reached(self) -> bool:
        """A client has connected since it was opened."""
        if self._socket is not None:
            self.connections()
        return self._is_reached

    def connections(self) -> int:
        """How many there are now."""
        while self._monitor.poll(0):
            event = zmq.utils.monitor.recv_monitor_message(self._monitor)
            is_new = event["event"] == zmq.EVENT_ACCEPTED
            self._is_reached = self._is_reached or is_new
            (self._connected.add if is_new else self._connected.discard)(event["value"])
        return len(self._connected)

    def destroy(self) -> None:
        self.close()
        if self._authenticator is not None:
            self._authenticator.stop()
        self._context.term()

    def receive(self, seconds: float) -> Optional[Arrival]:
        if self._socket is None:
            time.sleep(max(0.0, seconds))
            return None
        self.connections()  # no more events wait than those of one call
        if not self._socket.poll(max(0, math.ceil(1000 * seconds))):
            return None
        first, *frames = self._socket.recv_multipart(copy=False)
        facts = {name: _fact(frames[-1] if frames else first, name) for name in _PEER_NAMES}
        return Arrival(first.bytes, tuple(frames), facts["Socket-Type"], facts["User-Id"])

    def send(self, routing_id: bytes, data: bytes) -> None:
        """Has no effect if the connection has ended. Raises Failed if the client does not read what came before."""
        try:
            self._socket.send_multipart([routing_id, data])
        except zmq.Again:
            raise Failed(f"the client has read nothing for {LONGEST_SEND:g} s, and what it was sent before fills all buffers; "
                         f"{len(data)} bytes are next") from None
        except zmq.ZMQError as error:
            if error.errno != zmq.EHOSTUNREACH:
                raise


@dataclass(frozen=True)
class _Doorkeeper:
    """Every client may connect, and its key is told with its messages; or none may."""

    is_open: bool

    def callback(self, domain: str, key: bytes) -> bool:
        return self.is_open


def _fact(frame: zmq.Frame, name: str) -> str:
    try:
        return frame.get(name) or ""
    except zmq.ZMQError:
        return ""


_SIGNATURE = b"\xff" + bytes(8) + b"\x7f"
# Up to the version: a client that has read more would see that the mechanisms differ, and not tell its own.
_GREETING = _SIGNATURE + b"\x03\x00"


class PlainGreeter:
    """Greets as a ZMTP server without keys would, and notes what clients ask for."""

    def __init__(self) -> None:
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.endpoint = f"tcp://127.0.0.1:{self._listener.getsockname()[1]}"

    def is_reached(self) -> bool:
        """A client has connected, or waits for it."""
        return bool(select.select([self._listener], [], [], 0)[0])

    def mechanisms(self, seconds: float) -> list:
        """Of every connection within so many seconds: "CURVE", "NULL", …"""
        found = []
        deadline = time.monotonic() + seconds
        while (left := deadline - time.monotonic()) > 0:
            self._listener.settimeout(left)
            try:
                connection, _ = self._listener.accept()
            except TimeoutError:
                break
            with connection:
                connection.settimeout(1.0)
                found.append(_mechanism_of(connection))
        return found

    def destroy(self) -> None:
        self._listener.close()


def _mechanism_of(connection: socket.socket) -> str:
    """Byte 12 of a greeting of 64 bytes begins the name of the mechanism, filled with zeros to 20."""
    greeting = b""
    try:
        connection.sendall(_GREETING)
        while len(greeting) < 32:
            part = connection.recv(64)
            if not part:
                break
            greeting += part
    except OSError:
        pass
    return greeting[12:32].rstrip(b"\0").decode(errors="replace")
