# SPDX-License-Identifier: MIT
"""Steps that cases are made of: plain data, and one engine that plays them.

Values in messages may be Tick(), Token(peer) or Text(…): they are filled in when the step is played.
"""

import time
from dataclasses import dataclass, field
from typing import Any, Callable

from . import wire
from .case import Failed, NonStrict, Unimplemented
from .peer import Peer, Transcript, longest_wait
from .server_process import free_port
from .wire import protocol

_LONGEST_END = 5.0  # [s] beyond the usual patience, until a server has ended

# ---- values that are known only in play ----------------------------------------------------------


@dataclass(frozen=True)
class Tick:
    """The tick of the peer's last observation, plus an offset."""

    offset: int = 0
    of: str = ""  # another peer

    def __add__(self, offset: int) -> "Tick":
        return Tick(self.offset + offset, self.of)

    def __sub__(self, offset: int) -> "Tick":
        return self + -offset


@dataclass(frozen=True)
class Token:
    """The session token that a peer was given."""

    of: str


@dataclass(frozen=True)
class Zeros:
    """As many zeros as this peer's robots have values of a kind, times `per`; `wrong` is added."""

    devices: str  # name of a list in RobotDescription
    wrong: int = 0
    value: Any = 0.0
    first: Any = None  # instead of the first zero


# ---- steps ---------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Send:
    peer: str
    message: dict  # of ClientMessage
    times: int = 1  # in a row, as fast as the peer can


@dataclass(frozen=True)
class Frames:
    """Bytes as they are."""

    peer: str
    frames: tuple


@dataclass(frozen=True)
class Hear:
    """The next message is of this kind and matches the pattern."""

    peer: str
    kind: str
    pattern: dict = field(default_factory=dict)
    should: bool = False  # a SHOULD: otherwise it is a MUST
    within: float = 0.0  # [s]; 0 = the usual patience


@dataclass(frozen=True)
class Skip:
    """Messages up to one of this kind don't matter."""

    peer: str
    kind: str
    behind: str = ""  # answers of this kind: each restarts the wait


@dataclass(frozen=True)
class Silence:
    """Nothing but heartbeats comes."""

    peer: str
    seconds: float = 0.2


@dataclass(frozen=True)
class Hang:
    """The connection is closed without a Leave."""

    peer: str


@dataclass(frozen=True)
class Pause:
    seconds: float


@dataclass(frozen=True)
class Interrupt:
    """The server is told to stop, as by Ctrl-C."""


@dataclass(frozen=True)
class ServerEnds:
    """The server's program ends by itself, with this exit code."""

    code: int


@dataclass(frozen=True)
class RefusesToListen:
    """Started with this endpoint, the server's command ends with an error. {port} is a free one."""

    endpoint: str


@dataclass(frozen=True)
class Join:
    """Hello, and Welcome. Patient: as long as robots are taken by a connection that just closed."""

    peer: str
    hello: dict
    pattern: dict = field(default_factory=dict)


@dataclass(frozen=True)
class Check:
    """What patterns can't express; returns what is wrong, or an empty text."""

    title: str
    check: Callable


class Stage:
    """Where a case is played: a server and the peers that talk to it."""

    def __init__(self, endpoint: str, form: str, patience: float, server=None, keys=None):
        self.endpoint = endpoint
        self.form = form
        self.patience = patience
        self.server = server
        self.keys = keys  # Keys, if the server asks for them
        self.transcript = Transcript()
        self.peers: dict[str, Peer] = {}
        self.tokens: dict[str, bytes] = {}  # also of peers that are gone
        self.memory: dict[str, Any] = {}  # of checks

    def __enter__(self) -> "Stage":
        return self

    def __exit__(self, *_: Any) -> None:
        for peer in self.peers.values():
            peer.release()

    def peer(self, name: str) -> Peer:
        """The peer of that name, connected at its first use. "json" and "binary" use that form."""
        if name not in self.peers:
            keys = self.keys.of(name) if self.keys else None
            form = name if name in wire.FORMS else self.form
            runs = self.server.runs if self.server else lambda: True
            self.peers[name] = Peer(name, self.endpoint, form, self.transcript, keys, runs)
        return self.peers[name]

    def play(self, steps: tuple) -> None:
        for step in steps:
            if isinstance(step, (list, tuple)):
                self.play(tuple(step))
            else:
                _players[type(step)](self, step)

    # ---- one function for each kind of step ----

    def send(self, step: Send) -> None:
        peer = self.peer(step.peer)
        fields = _resolved(self, peer, step.message)
        peer.send(wire.from_dict(protocol.ClientMessage, fields), step.times)

    def frames(self, step: Frames) -> None:
        self.peer(step.peer).send_frames(step.frames)

    def hear(self, step: Hear) -> None:
        peer = self.peer(step.peer)
        pattern = _resolved(self, peer, step.pattern)  # before: Tick() is that of the last observation
        message = _heard(peer, step.within or self.patience, step.kind == "heartbeat")
        complaint = _complaint(step, pattern, message)
        if complaint and step.should:
            raise NonStrict(complaint)
        if complaint:
            raise Failed(complaint)

    def skip(self, step: Skip) -> None:
        peer = self.peer(step.peer)
        deadline = time.monotonic() + self.patience
        last = time.monotonic() + longest_wait(self.patience)
        while time.monotonic() < deadline:
            message = _heard(peer, deadline - time.monotonic(), step.behind == "heartbeat")
            if message is not None and wire.kind_of(message) == step.kind:
                return
            if message is not None and wire.kind_of(message) in ("loading", step.behind):
                deadline = min(time.monotonic() + self.patience, last)
        raise Failed(f"{step.peer} heard no {step.kind} within {self.patience:g} s")

    def silence(self, step: Silence) -> None:
        message = _heard(self.peer(step.peer), step.seconds, False)
        if message is not None:
            raise Failed(f"{step.peer} was told {wire.kind_of(message)}; expected nothing")

    def hang(self, step: Hang) -> None:
        self.peer(step.peer).close()
        del self.peers[step.peer]

    def pause(self, step: Pause) -> None:
        time.sleep(step.seconds)

    def interrupt(self, step: Interrupt) -> None:
        self.transcript.add("server", "───", "is interrupted")
        self.server.interrupt()

    def server_ends(self, step: ServerEnds) -> None:
        code = self.server.exit_code(self.patience + _LONGEST_END)
        if code != step.code:
            raise Failed("the server still runs" if code is None else
                         f"the server ended with exit code {code}; {step.code} is expected")

    def refuses_to_listen(self, step: RefusesToListen) -> None:
        endpoint = step.endpoint.replace("{port}", str(free_port()))
        self.transcript.add("server", "───", f"another one is started at {endpoint}")
        complaint = self.server.refuses_to_listen(endpoint)
        if complaint:
            raise Failed(f"the server is to listen at {endpoint}, unprotected, and must refuse (T8): {complaint}")

    def join(self, step: Join) -> None:
        deadline = time.monotonic() + self.patience
        peer = self.peer(step.peer)
        while True:
            self.send(Send(step.peer, {"hello": step.hello}))
            message = _told(peer, lambda: peer.hear_behind("loading", self.patience))
            taken = (
                message is not None
                and message.HasField("refusal")
                and message.refusal.error.code == protocol.Error.ROBOT_TAKEN
            )
            if not taken or time.monotonic() > deadline:
                break
            time.sleep(0.02)
        complaint = _complaint(Hear(step.peer, "welcome"), step.pattern, message)
        if complaint:
            raise Failed(complaint)
        self.tokens[step.peer] = peer.welcome.session_token

    def check(self, step: Check) -> None:
        complaint = step.check(self)
        if complaint:
            raise Failed(f"{step.title}: {complaint}")


_players: dict = {
    Send: Stage.send,
    Frames: Stage.frames,
    Hear: Stage.hear,
    Skip: Stage.skip,
    Silence: Stage.silence,
    Hang: Stage.hang,
    Pause: Stage.pause,
    Interrupt: Stage.interrupt,
    ServerEnds: Stage.server_ends,
    RefusesToListen: Stage.refuses_to_listen,
    Join: Stage.join,
    Check: Stage.check,
}


def _heard(peer: Peer, patience: float, heartbeats: bool):
    return _told(peer, lambda: peer.hear(patience, heartbeats))


def _told(peer: Peer, hear: Callable):
    try:
        return hear()
    except ValueError as error:
        rules = "T2, T6" if peer.form == wire.JSON else "T2"
        raise Failed(f"{peer.name} was told {error} ({rules})") from None


def _complaint(step: Hear, pattern: dict, message) -> str:
    """What is wrong with a message that was heard; empty if nothing."""
    if message is None:
        return f"{step.peer} heard nothing; {step.kind} is expected"
    kind = wire.kind_of(message)
    told = getattr(message, kind) if kind else message
    error = told.error if kind in ("refusal", "response") else told if kind == "error" else None
    if error is not None and error.code == protocol.Error.UNIMPLEMENTED:
        expected = pattern.get("error", pattern).get("code")
        if expected != "UNIMPLEMENTED":
            raise Unimplemented(error.message)
    if kind != step.kind:
        return f"{step.peer} was told {wire.text_of(message, 300)}; {step.kind} is expected"
    return "; ".join(wire.mismatches(pattern, told, kind))


def _resolved(stage: Stage, peer: Peer, value: Any) -> Any:
    """A message or pattern with the values that are known only now."""
    if isinstance(value, dict):
        return {name: _resolved(stage, peer, inner) for name, inner in value.items()}
    if isinstance(value, list):
        return [_resolved(stage, peer, inner) for inner in value]
    if isinstance(value, Tick):
        return (stage.peer(value.of) if value.of else peer).tick + value.offset
    if isinstance(value, Token):
        return stage.tokens[value.of]
    if isinstance(value, Zeros):
        count = sum(len(getattr(robot, value.devices)) for robot in peer.welcome.robots)
        values = [value.value] * (count + value.wrong)
        if value.first is not None and not values:
            raise Failed(f"Welcome describes no {value.devices}; our scene has some")
        if value.first is not None:
            values[0] = value.first
        return values
    return value
