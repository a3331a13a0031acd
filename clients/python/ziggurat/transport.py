# SPDX-License-Identifier: MIT
"""How a client's messages go to the server and back: a DEALER of ZeroMQ."""

from __future__ import annotations

import re
import socket
from typing import Any, Mapping, Optional, cast

import zmq
import zmq.utils.monitor

from .curve import Curve

# Wall times [s].
SLICE = 0.5  # of a wait
SOON = 0.02  # for most ticks
LINGER = 1.0  # time to send the last messages when a session is closed

LONGEST_MESSAGE = (1 << 30) + (1 << 20)  # of a server: an Observation of 1 GiB and what is around it [bytes]
KEYS_ARE_MISSING = "refused key? The endpoint is protected, and this client has no keys; pass curve=Curve(...)"
MONITORED = (zmq.EVENT_CONNECTED | zmq.EVENT_DISCONNECTED | zmq.EVENT_HANDSHAKE_SUCCEEDED
             | zmq.EVENT_HANDSHAKE_FAILED_NO_DETAIL | zmq.EVENT_HANDSHAKE_FAILED_PROTOCOL
             | zmq.EVENT_HANDSHAKE_FAILED_AUTH)
# A server that ends, or has no place, also breaks a handshake off: ZeroMQ tries again.
MOST_FAILED_HANDSHAKES = 3


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
    """Whether the host has a name without address. Asks the system, which may take its time."""
    if not endpoint.startswith("tcp://") or endpoint.startswith("tcp://["):
        return False
    try:
        socket.getaddrinfo(endpoint[len("tcp://"):].rpartition(":")[0], None, socket.AF_INET)
    except (OSError, UnicodeError):
        return True
    return False


class Transport:
    """Connects in the background; the server may start later. Raises ValueError for an unusable endpoint or keys.

    context  of several sockets, which one thread serves; its owner ends it
    """

    def __init__(self, endpoint: str, curve: Optional[Curve], context: Optional[zmq.Context[Any]] = None):
        check_endpoint(endpoint)
        self._has_keys = curve is not None
        self.is_accepted = False  # by the server: if nothing arrives then, it is slow
        self._is_open = False  # the handshake has succeeded
        self.why_closed: Optional[str] = None  # messages that came before may still be in the queue
        self._failed_handshakes = 0
        self.closed = False
        self._owns_context = context is None
        self._context = context or zmq.Context()
        self._socket = self._context.socket(zmq.DEALER)
        self._socket.setsockopt(zmq.IPV6, endpoint.startswith("tcp://["))
        self._socket.setsockopt(zmq.TCP_KEEPALIVE, 1)
        self._socket.setsockopt(zmq.LINGER, 0)  # without close()
        self._socket.setsockopt(zmq.SNDTIMEO, int(1000 * SLICE))
        self._socket.setsockopt(zmq.RCVTIMEO, int(1000 * SOON))
        self._socket.setsockopt(zmq.MAXMSGSIZE, LONGEST_MESSAGE)  # a longer one closes the connection
        # ZeroMQ reconnects by itself, but the server does not know the new connection:
        # detect the end of the first one.
        self._monitor = self._socket.get_monitor_socket(MONITORED)
        self._poller = zmq.Poller()
        self._poller.register(self._socket, zmq.POLLIN)
        self._poller.register(self._monitor, zmq.POLLIN)
        try:
            if curve is not None:
                self._socket.curve_serverkey = curve.server_key.encode()
                self._socket.curve_publickey = curve.public_key.encode()
                self._socket.curve_secretkey = curve.secret_key.encode()
            self._socket.connect(endpoint)
        except zmq.ZMQError as error:
            self.close(0.0)
            raise ValueError(f"endpoint {endpoint!r}: {error}") from None

    def close(self, linger: float) -> None:
        """linger  time to send the last messages [s]"""
        if self.closed:
            return
        self.closed = True
        self._socket.disable_monitor()
        self._monitor.close(linger=0)
        self._socket.close(linger=int(1000 * linger))
        if self._owns_context:
            self._context.term()  # waits for that

    @property
    def has_more(self) -> bool:
        """The last message goes on in another frame."""
        return bool(self._socket.getsockopt(zmq.RCVMORE))

    def send(self, data: bytes) -> bool:
        """Queues a message. False after a while if the queue is full, or the server has refused the connection."""
        try:
            self._socket.send(data)
            return True
        except zmq.Again:  # ZeroMQ gives the queue of a connection that is refused up
            self.why_closed = self.why_closed or self._next_reason()
            return False

    def receive_soon(self) -> Optional[bytes]:
        """Waits for a message that comes soon; None if it does not. It costs a part of receive(), which looks for changes
        of the connection, too."""
        try:
            return cast(bytes, self._socket.recv())
        except zmq.Again:
            return None

    def receive(self, seconds: float) -> Optional[bytes]:
        """Waits for a message; None after this time, and when the connection has changed."""
        ready = dict(self._poller.poll(0 if self.why_closed else int(1000 * seconds)))
        if self._socket not in ready and self._monitor in ready:
            self.why_closed = self.why_closed or self._next_reason()
            ready = dict(self._poller.poll(0))
        return self._socket.recv() if self._socket in ready else None

    def _next_reason(self) -> Optional[str]:
        """Takes the monitor's events up to the first by which the connection is lost, and says why it is."""
        while self._monitor.poll(0):
            why = self._why_lost(zmq.utils.monitor.recv_monitor_message(self._monitor))
            if why is not None:
                return why
        return None

    def _why_lost(self, event: Mapping[str, Any]) -> Optional[str]:
        """Why the connection is lost after this event of its monitor; None if it is not."""
        if event["event"] == zmq.EVENT_CONNECTED:
            self.is_accepted = True
            return None
        if event["event"] == zmq.EVENT_HANDSHAKE_SUCCEEDED:
            self._is_open = True
            return None
        if event["event"] == zmq.EVENT_DISCONNECTED:
            self.is_accepted = False
            return "the connection was closed" if self._is_open else None  # else ZeroMQ tries again
        if event["event"] == zmq.EVENT_HANDSHAKE_FAILED_AUTH:
            return "refused key? The server does not have this client's key in its --curve-clients"
        if (event["event"] == zmq.EVENT_HANDSHAKE_FAILED_PROTOCOL
                and event["value"] == zmq.PROTOCOL_ERROR_ZMTP_MECHANISM_MISMATCH):
            return "the endpoint is not protected; leave out the keys" if self._has_keys else KEYS_ARE_MISSING
        self._failed_handshakes += 1
        if self._has_keys and self._failed_handshakes >= MOST_FAILED_HANDSHAKES:
            return ("refused key? The server breaks off the handshake; compare the server's public "
                    "key with the one that 'ziggurat keygen' has printed")
        return None
