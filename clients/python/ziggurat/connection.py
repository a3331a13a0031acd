"""One DEALER: sends and receives messages, with time-outs, and detects a closed connection."""

from __future__ import annotations

import os
import time
from dataclasses import dataclass
from typing import Optional

import zmq
import zmq.utils.monitor
from google.protobuf.message import DecodeError

from . import protocol_pb2 as v1
from .cost import excess, excess_of_robots
from .errors import ConnectionLost, Malformed, ProtocolError, Refused, Timeout, printable
from .find_server import find_server

VERSION = v1.Version(major=1, minor=4)
SLICE = 0.5  # [s] of a wait
LINGER_MS = 1000  # time to send the last messages when a session is closed
LONGEST_MESSAGE = (1 << 30) + (1 << 20)  # of a server: an Observation of 1 GiB and what is around it [bytes]
MONITORED = (zmq.EVENT_CONNECTED | zmq.EVENT_DISCONNECTED | zmq.EVENT_HANDSHAKE_SUCCEEDED
             | zmq.EVENT_HANDSHAKE_FAILED_NO_DETAIL | zmq.EVENT_HANDSHAKE_FAILED_PROTOCOL
             | zmq.EVENT_HANDSHAKE_FAILED_AUTH)
# A server that ends, or has no place, also breaks a handshake off: ZeroMQ tries again.
MOST_FAILED_HANDSHAKES = 3


@dataclass(frozen=True)
class Curve:
    """Keys of an encrypted connection, each 40 characters of Z85."""

    server_key: str
    public_key: str
    secret_key: str

    @staticmethod
    def from_environment() -> Optional["Curve"]:
        """The keys in ZIGGURAT_SERVER_KEY and in the file that ZIGGURAT_CURVE_SECRET names; None if neither
        is there. Raises ValueError if only one is, or the file has no secret key."""
        server_key = os.environ.get("ZIGGURAT_SERVER_KEY", "")
        path = os.environ.get("ZIGGURAT_CURVE_SECRET", "")
        if not server_key and not path:
            return None
        if not server_key or not path:
            raise ValueError("only one of ZIGGURAT_SERVER_KEY and ZIGGURAT_CURVE_SECRET is set; "
                             "an encrypted connection needs both")
        try:
            with open(path, encoding="ascii") as file:
                secret_key = file.read().strip()
            return Curve(server_key, zmq.curve_public(secret_key.encode()).decode(), secret_key)
        except (OSError, ValueError, zmq.ZMQError):
            raise ValueError(f"{path!r}: not a file with one secret key and nothing else; create one with "
                             "'ziggurat keygen'") from None


class Wait:
    """For something that the server sends, from now on: what comes in between, as heartbeats, does not extend it."""

    def __init__(self, seconds: Optional[float], what: str = "message"):
        self._seconds = seconds  # of wall time; None: forever
        self._what = what
        self._end = None if seconds is None else time.monotonic() + seconds

    def left(self, most: float) -> float:
        """[s], and not more than that."""
        return most if self._end is None else min(most, max(0.0, self._end - time.monotonic()))

    def is_over(self) -> bool:
        return self._end is not None and time.monotonic() >= self._end

    def __str__(self) -> str:
        return f"no {self._what} for {self._seconds:g} s"


class Connection:
    """Connects in the background; the server may start later. Without endpoint: see find_server."""

    def __init__(self, endpoint: str, curve: Optional[Curve] = None):
        self.endpoint = endpoint = endpoint or find_server()
        self._has_keys = curve is not None
        self.is_accepted = False  # by the server: if nothing arrives then, it is slow
        self._is_open = False  # the handshake has succeeded
        self._why_closed: Optional[str] = None  # messages that came before may still be in the queue
        self.longest_silence: Optional[float] = None  # [s] of wall time; longer, and the connection is lost
        self._failed_handshakes = 0
        self.socket = zmq.Context.instance().socket(zmq.DEALER)
        self.socket.setsockopt(zmq.IPV6, endpoint.startswith("tcp://["))
        self.socket.setsockopt(zmq.LINGER, LINGER_MS)  # also of a program that ends without close(), as by Ctrl-C
        self.socket.setsockopt(zmq.SNDTIMEO, int(1000 * SLICE))
        self.socket.setsockopt(zmq.MAXMSGSIZE, LONGEST_MESSAGE)  # a longer one closes the connection
        if curve is not None:
            self.socket.curve_serverkey = curve.server_key.encode()
            self.socket.curve_publickey = curve.public_key.encode()
            self.socket.curve_secretkey = curve.secret_key.encode()
        # ZeroMQ reconnects by itself, but the server does not know the new connection:
        # detect the end of the first one.
        self.monitor = self.socket.get_monitor_socket(MONITORED)
        self.poller = zmq.Poller()
        self.poller.register(self.socket, zmq.POLLIN)
        self.poller.register(self.monitor, zmq.POLLIN)
        try:
            self.socket.connect(endpoint)
        except zmq.ZMQError as error:
            self.close()
            raise ValueError(f"endpoint {endpoint!r}: {error}") from None

    def close(self, linger_ms: int = LINGER_MS) -> None:
        if self.socket.closed:
            return
        self.socket.disable_monitor()
        self.monitor.close(linger=0)
        self.socket.close(linger=linger_ms)

    @property
    def closed(self) -> bool:
        return self.socket.closed

    def send(self, message: v1.ClientMessage, is_last: bool = False) -> None:
        """Waits while the queue is full; with the last message only half a second, as a server that reads nothing
        would hold up the end of the program. Raises ConnectionLost if the server has refused the connection: ZeroMQ
        has given it up, and there is no queue any more."""
        data = message.SerializeToString()
        while True:
            try:
                return self.socket.send(data)
            except zmq.Again:
                if is_last:
                    return
                why = self._next_reason()
                if why is not None:
                    self.close()
                    raise ConnectionLost(f"{self.endpoint}: {why}") from None

    def receive(self, wait: Wait) -> v1.ServerMessage:
        """The next message.

        Raises Timeout, and ConnectionLost when all messages that arrived before have been read. Raises Malformed for what
        is no message; the connection stays open for the Leave.
        """
        if self.closed:
            raise ConnectionLost("the session is closed")
        silence = 0.0  # in pieces: a program that was stopped has not waited
        while True:
            rest = wait.left(SLICE)
            if self._why_closed is not None:
                rest = 0.0
            began = time.monotonic()
            ready = dict(self.poller.poll(int(1000 * rest)))
            silence += min(rest, time.monotonic() - began)
            if self.socket in ready:
                return self._decoded(self.socket.recv())
            if self._why_closed is not None:
                self.close()
                raise ConnectionLost(f"{self.endpoint}: {self._why_closed}")
            if self.monitor in ready:
                self._why_closed = self._next_reason()
                continue
            if self.longest_silence is not None and silence >= self.longest_silence:
                raise ConnectionLost(f"{self.endpoint}: the server has been silent for {silence:.1f} s")
            if wait.is_over():
                raise Timeout(f"{self.endpoint}: {wait}")

    def _decoded(self, data: bytes) -> v1.ServerMessage:
        fault = excess(data)
        if not fault:
            try:
                return v1.ServerMessage.FromString(data)
            except DecodeError:
                fault = "what is no message of the protocol; is it a Ziggurat server?"
        raise Malformed(v1.Error(code=v1.Error.MALFORMED, severity=v1.Error.FATAL,
                                 message=f"{self.endpoint} sent {fault}"))

    def leave(self, failure: str) -> None:
        """As failed, with the cause, and closes the connection: where there is no session yet that has more to say."""
        if not self.closed:
            self.send(v1.ClientMessage(leave=v1.Leave(reason=v1.Leave.FAILED, message=printable(failure))), is_last=True)
            self.close()

    def _check(self, welcome: v1.Welcome) -> None:
        """H2: the major version is the same. And there can be handles for all robots."""
        fault = excess_of_robots(welcome)
        if fault:
            raise Malformed(v1.Error(code=v1.Error.MALFORMED, severity=v1.Error.FATAL,
                                     message=f"{self.endpoint} sent {fault}"))
        theirs = welcome.version
        if theirs.major == VERSION.major:
            return
        self.close(linger_ms=0)
        raise ProtocolError(v1.Error(
            code=v1.Error.VERSION_MISMATCH, severity=v1.Error.FATAL,
            message=f"{self.endpoint}: the server speaks version {theirs.major}.{theirs.minor} of the protocol, "
                    f"this client {VERSION.major}.{VERSION.minor}"))

    def _next_reason(self) -> Optional[str]:
        """Takes the monitor's events up to the first by which the connection is lost, and says why it is."""
        while self.monitor.poll(0):
            why = self._why_lost(zmq.utils.monitor.recv_monitor_message(self.monitor))
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
            return ("the endpoint is not protected; leave out the keys" if self._has_keys else
                    "refused key? The endpoint is protected, and this client has no keys; "
                    "pass curve=Curve(...)")
        self._failed_handshakes += 1
        if self._has_keys and self._failed_handshakes >= MOST_FAILED_HANDSHAKES:
            return ("refused key? The server breaks off the handshake; compare the server's public "
                    "key with the one that 'ziggurat keygen' has printed")
        return None

    def begin(self, hello: v1.Hello, connect_timeout: float, is_patient: bool = False) -> v1.Welcome:
        """Sends Hello and waits for the Welcome. Each Loading restarts the time-out. Leaves if it is one that the client
        does not take: the server may have given it robots.

        is_patient  it does not count while the server has accepted the connection
        """
        hello.version.CopyFrom(VERSION)
        self.send(v1.ClientMessage(hello=hello))
        try:
            return self._welcome(connect_timeout, is_patient)
        except Malformed as error:
            self.leave(str(error))
            raise

    def _welcome(self, connect_timeout: float, is_patient: bool) -> v1.Welcome:
        while True:
            try:
                message = self.receive(Wait(connect_timeout))
            except Timeout:
                if is_patient and self.is_accepted:
                    continue
                raise ConnectionLost(
                    f"no welcome at {self.endpoint} within {connect_timeout:g} s") from None
            kind = message.WhichOneof("message")
            if kind == "welcome":
                self._check(message.welcome)
                return message.welcome
            if kind == "refusal":
                raise Refused(message.refusal)
            if kind == "error":
                raise Refused(v1.Refusal(error=message.error))
