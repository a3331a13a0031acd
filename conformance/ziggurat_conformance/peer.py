# SPDX-License-Identifier: MIT
"""One connection to the server under test."""

import math
import time
from typing import Callable, Optional

import zmq

from . import wire
from .case import Failed
from .keys import MISLED, PLAIN, UNLISTED
from .printable import printable
from .rules.answers import Answers
from .rules.fault import musts
from .rules.session import Session
from .rules.text_form import server_text_faults
from .wire import protocol


_LONGEST_MESSAGE = (1 << 30) + (1 << 20)  # [bytes]: more than a server sends; above, the connection is closed
# [s] that a message waits for room in the queue; ZeroMQ has no queue for a connection that was refused.
_LONGEST_SEND, _LONGEST_SEND_IF_REFUSED = 60.0, 2.0
_LOOKS_EVERY = 0.2  # [s] whether the server has ended; what it said last has come by then

_BELOW = "\n" + 25 * " "  # a line of the transcript begins with time, peer and direction


def longest_wait(patience: float) -> float:
    """[s] For what comes behind any number of messages that extend the wait, as Loading."""
    return max(60.0, 10 * patience)


class Transcript:
    """What went over all connections of a case, for the report of its failure."""

    def __init__(self) -> None:
        self.start = time.monotonic()
        self.lines: list[tuple[float, str, str, str]] = []

    def add(self, peer: str, direction: str, text: str) -> None:
        """Further lines of a text are indented: none looks like one of the transcript."""
        self.lines.append((time.monotonic() - self.start, peer, direction, printable(text).replace("\n", _BELOW)))

    def text(self) -> str:
        return "\n".join(
            f"{at:8.3f} s  {peer:>8} {direction} {text}" for at, peer, direction, text in self.lines
        )


class Peer:
    """A DEALER that remembers what it was told."""

    def __init__(self, name: str, endpoint: str, form: str, transcript: Transcript, keys=None,
                 runs: Callable[[], bool] = lambda: True):
        """runs: whether the server does."""
        self.name = name
        self.form = form
        self.transcript = transcript
        self.welcome: Optional[protocol.Welcome] = None
        self.refusal: Optional[protocol.Refusal] = None
        self.tick = 0  # of the last observation
        self.observation: Optional[protocol.Observation] = None
        self.heartbeats: list[int] = []
        self._server_runs = runs
        self._session = Session()
        self._answers = Answers()
        self.socket = zmq.Context.instance().socket(zmq.DEALER)
        self.socket.setsockopt(zmq.LINGER, 0)
        self.socket.setsockopt(zmq.MAXMSGSIZE, _LONGEST_MESSAGE)
        self._may_be_refused = name in (PLAIN, MISLED, UNLISTED)
        longest = _LONGEST_SEND_IF_REFUSED if self._may_be_refused else _LONGEST_SEND
        self.socket.setsockopt(zmq.SNDTIMEO, int(1000 * longest))
        if keys:
            self.socket.curve_serverkey, self.socket.curve_publickey, self.socket.curve_secretkey = (
                keys
            )
        self.socket.connect(endpoint)

    def send(self, message: protocol.ClientMessage, times: int = 1) -> None:
        self.transcript.add(self.name, "──▶", wire.text_of(message) + (f", {times} times" if times > 1 else ""))
        data = wire.encode(message, self.form)
        state = self._session.state
        faults = self._session.said(message, len(data))
        if self._session.is_certain:
            self._answers.said(state, message, faults)
        for _ in range(times):
            self._send((data,))

    def send_frames(self, frames: tuple[bytes, ...]) -> None:
        shown = ", ".join(f"{len(f)} bytes {f[:24]!r}{'…' if len(f) > 24 else ''}" for f in frames)
        self.transcript.add(self.name, "──▶", f"frames: {shown}")
        self._session.is_certain = False
        self._send(frames)

    def hear(self, patience: float, heartbeats: bool = False) -> Optional[protocol.ServerMessage]:
        """The next message, within so many seconds, and as long as the server runs. Heartbeats of the server are noted and
        passed over unless asked for; they do not extend the wait."""
        deadline = time.monotonic() + patience
        while True:
            is_last = not self._server_runs()
            left = max(0.0, deadline - time.monotonic())
            if not self.socket.poll(math.ceil(1000 * min(left, _LOOKS_EVERY)) + 1):
                if is_last or left <= _LOOKS_EVERY:
                    return None
                continue
            message = self._receive()
            if wire.kind_of(message) == "heartbeat" and not heartbeats:
                self.heartbeats.append(message.heartbeat.sequence)
                if time.monotonic() >= deadline:
                    return None
                continue
            self._remember(message)
            return message

    def hear_behind(self, kind: str, patience: float) -> Optional[protocol.ServerMessage]:
        """The next message that is not of this kind; each that is restarts the wait."""
        deadline = time.monotonic() + longest_wait(patience)
        while True:
            message = self.hear(patience)
            if message is None or wire.kind_of(message) != kind or time.monotonic() >= deadline:
                return message

    def close(self) -> None:
        self.transcript.add(self.name, "───", "closes its connection")
        self.release()

    def release(self) -> None:
        """Ends the connection without a line in the transcript."""
        self.socket.close()

    def _send(self, frames: tuple[bytes, ...]) -> None:
        try:
            self.socket.send_multipart(frames)
        except zmq.Again:
            if not self._may_be_refused:
                raise Failed(f"{self.name} can't send: the server has taken nothing for {_LONGEST_SEND:g} s") from None
            self.transcript.add(self.name, "───", "can't send: the connection was refused")

    def _receive(self) -> protocol.ServerMessage:
        frames = self.socket.recv_multipart()
        if len(frames) != 1:
            raise ValueError(f"the server sent {len(frames)} frames; expected one")
        message = wire.decode(protocol.ServerMessage, frames[0], self.form)
        self.transcript.add(self.name, "◀──", wire.text_of(message))
        self._judge(message, frames[0])
        return message

    def _judge(self, message: protocol.ServerMessage, data: bytes) -> None:
        """Raises Failed for a message that breaks a rule, whatever the case expects."""
        faults = list(server_text_faults(data, message)) if self.form == wire.JSON else []
        if self._session.is_certain:
            faults += self._answers.told(self._session, message)
        broken = musts([*faults, *self._session.told(message)])
        if broken:
            raise Failed(f"{self.name} was told {wire.text_of(message, 300)}: "
                         + "; ".join(map(str, broken[:5])))

    def _remember(self, message: protocol.ServerMessage) -> None:
        if message.HasField("welcome"):
            self.welcome = message.welcome
        if message.HasField("refusal"):
            self.refusal = message.refusal
        if message.HasField("observation"):
            self.observation = message.observation
            self.tick = message.observation.tick
        if message.HasField("world_state"):
            self.tick = message.world_state.tick
