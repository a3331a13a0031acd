"""How a client's messages go to the server and back. Both ways speak ZeroMQ's wire protocol."""

from __future__ import annotations

from typing import Optional, Union

import zmq
import zmq.utils.monitor

from .curve import Curve
from .plain_stream import KEYS_ARE_MISSING, LINGER, LONGEST_MESSAGE, SLICE, PlainStream, address_of, check_endpoint

MONITORED = (zmq.EVENT_CONNECTED | zmq.EVENT_DISCONNECTED | zmq.EVENT_HANDSHAKE_SUCCEEDED
             | zmq.EVENT_HANDSHAKE_FAILED_NO_DETAIL | zmq.EVENT_HANDSHAKE_FAILED_PROTOCOL
             | zmq.EVENT_HANDSHAKE_FAILED_AUTH)
# A server that ends, or has no place, also breaks a handshake off: ZeroMQ tries again.
MOST_FAILED_HANDSHAKES = 3


def make_transport(endpoint: str, curve: Optional[Curve]) -> Union["ZeroMq", PlainStream]:
    """Starts to connect. Raises ValueError for an unusable endpoint or keys."""
    check_endpoint(endpoint)
    address = address_of(endpoint) if curve is None else None
    return ZeroMq(endpoint, curve) if address is None else PlainStream(address)


class ZeroMq:
    """A DEALER of libzmq: encrypted, and for endpoints that only libzmq knows. The same functions as PlainStream."""

    def __init__(self, endpoint: str, curve: Optional[Curve]):
        self._has_keys = curve is not None
        self.is_accepted = False
        self._is_open = False  # the handshake has succeeded
        self.why_closed: Optional[str] = None  # messages that came before may still be in the queue
        self._failed_handshakes = 0
        self._socket = zmq.Context.instance().socket(zmq.DEALER)
        self._socket.setsockopt(zmq.IPV6, endpoint.startswith("tcp://["))
        # Also of a program that ends without close(), as by Ctrl-C.
        self._socket.setsockopt(zmq.LINGER, int(1000 * LINGER))
        self._socket.setsockopt(zmq.SNDTIMEO, int(1000 * SLICE))
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
        if self._socket.closed:
            return
        self._socket.disable_monitor()
        self._monitor.close(linger=0)
        self._socket.close(linger=int(1000 * linger))

    @property
    def closed(self) -> bool:
        return self._socket.closed

    @property
    def has_more(self) -> bool:
        return bool(self._socket.getsockopt(zmq.RCVMORE))

    def send(self, data: bytes) -> bool:
        try:
            self._socket.send(data)
            return True
        except zmq.Again:  # ZeroMQ gives the queue of a connection that is refused up
            self.why_closed = self.why_closed or self._next_reason()
            return False

    def receive(self, seconds: float) -> Optional[bytes]:
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

    def _why_lost(self, event: dict) -> Optional[str]:
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
