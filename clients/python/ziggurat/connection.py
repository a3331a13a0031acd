# SPDX-License-Identifier: MIT
"""One DEALER: sends and receives messages, with time-outs, and detects a closed connection."""

from __future__ import annotations

import time
from typing import Any, Callable, Optional

import zmq
from google.protobuf.message import DecodeError

from . import protocol_pb2 as v1
from .curve import Curve
from .errors import ConnectionLost, Malformed, ProtocolError, Refused, Timeout, printable
from .find_server import find_server
from .transport import LINGER, SLICE, Transport, has_unknown_host

VERSION = v1.Version(major=1, minor=5)


class Wait:
    """For something that the server sends, from now on: what comes in between, as heartbeats, does not extend it."""

    def __init__(self, seconds: Optional[float], what: str = "message", is_in_vain: Callable[[], bool] = lambda: False):
        self._is_in_vain = is_in_vain  # then it is over
        self._seconds = seconds  # of wall time; None: forever
        self._what = what
        self._end = None if seconds is None else time.monotonic() + seconds

    def left(self, most: float) -> float:
        """[s], and not more than that."""
        return most if self._end is None else min(most, max(0.0, self._end - time.monotonic()))

    def is_over(self) -> bool:
        return self._end is not None and time.monotonic() >= self._end or self._is_in_vain()

    def __str__(self) -> str:
        return f"no {self._what} for {self._seconds:g} s"


class Connection:
    """Connects in the background; the server may start later. Without endpoint: see find_server."""

    def __init__(self, endpoint: str, curve: Optional[Curve] = None, has_ended: Callable[[], bool] = lambda: False,
                 context: Optional[zmq.Context[Any]] = None):
        """
        has_ended  whether the server is known to have ended; it is asked while waiting for a welcome
        context    see Transport
        """
        self.endpoint = endpoint or find_server()
        self._has_ended = has_ended
        self.longest_silence: Optional[float] = None  # [s] of wall time; longer, and the connection is lost
        self.transport = Transport(self.endpoint, curve, context)

    @property
    def is_accepted(self) -> bool:
        """By the server: if nothing arrives then, it is slow."""
        return self.transport.is_accepted

    def close(self, linger: float = LINGER) -> None:
        """linger  time to send the last messages [s]"""
        self.transport.close(linger)

    @property
    def closed(self) -> bool:
        return self.transport.closed

    def send(self, message: v1.ClientMessage, is_last: bool = False) -> None:
        """Waits while the queue is full; with the last message only half a second, as a server that reads nothing
        would hold up the end of the program. Raises ConnectionLost if the server has refused or closed the connection:
        what is queued then goes nowhere."""
        self.send_bytes(message.SerializeToString(), is_last)

    def send_bytes(self, data: bytes, is_last: bool = False) -> None:
        """The same of a message that is encoded."""
        while not self.transport.send(data) and not is_last:
            if self.transport.why_closed is not None:
                self.close()
                raise ConnectionLost(f"{self.endpoint}: {self.transport.why_closed}")

    def receive(self, wait: Wait) -> v1.ServerMessage:
        """The next message.

        Raises Timeout, and ConnectionLost when all messages that arrived before have been read. Raises Malformed for what
        is no message; the connection stays open for the Leave.
        """
        message = self.receive_soon()
        return self._decoded(self._receive(wait)) if message is None else message

    def receive_soon(self) -> Optional[v1.ServerMessage]:
        """As receive(), but None if it takes longer than most ticks."""
        if self.transport.closed:
            raise ConnectionLost("the session is closed")
        data = self.transport.receive_soon() if self.transport.why_closed is None else None
        return None if data is None else self._decoded(data)

    def _receive(self, wait: Wait) -> bytes:
        silence = 0.0  # in pieces: a program that was stopped has not waited
        while True:
            rest = wait.left(SLICE)
            began = time.monotonic()
            data = self.transport.receive(rest)
            if data is not None:
                return data
            silence += min(rest, time.monotonic() - began)
            if self.transport.why_closed is not None:
                self.close()
                raise ConnectionLost(f"{self.endpoint}: {self.transport.why_closed}")
            if self.longest_silence is not None and silence >= self.longest_silence:
                raise ConnectionLost(f"{self.endpoint}: the server has been silent for {silence:.1f} s")
            if wait.is_over():
                raise Timeout(f"{self.endpoint}: {wait}")

    def _decoded(self, data: bytes) -> v1.ServerMessage:
        try:
            if self.transport.has_more:
                raise DecodeError("a frame of several")
            return v1.ServerMessage.FromString(data)
        except DecodeError:
            raise Malformed(v1.Error(
                code=v1.Error.MALFORMED, severity=v1.Error.FATAL,
                message=f"{self.endpoint} sent what is no message of the protocol; is it a Ziggurat server?")) from None

    def leave(self, failure: str) -> None:
        """As failed, with the cause, and closes the connection: where there is no session yet that has more to say."""
        if not self.closed:
            self.send(v1.ClientMessage(leave=v1.Leave(reason=v1.Leave.FAILED, message=printable(failure))), is_last=True)
            self.close()

    def _check(self, welcome: v1.Welcome) -> None:
        """H2: the major version is the same."""
        theirs = welcome.version
        if theirs.major == VERSION.major:
            return
        self.close(linger=0)
        raise ProtocolError(v1.Error(
            code=v1.Error.VERSION_MISMATCH, severity=v1.Error.FATAL,
            message=f"{self.endpoint}: the server speaks version {theirs.major}.{theirs.minor} of the protocol, "
                    f"this client {VERSION.major}.{VERSION.minor}"))

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
                message = self.receive(Wait(connect_timeout, is_in_vain=self._has_ended))
            except Timeout:
                if self._has_ended():
                    raise ConnectionLost(f"{self.endpoint}: the server has ended") from None
                if is_patient and self.is_accepted:
                    continue
                if has_unknown_host(self.endpoint):
                    raise ConnectionLost(f"{self.endpoint}: no host of that name is known") from None
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
