# SPDX-License-Identifier: MIT
"""Where cases for clients are played: a server's socket, and a controller program that connects to it."""

import time
from dataclasses import dataclass
from typing import Any, Optional

from . import wire
from .case import Case, Failed, NonStrict, Unimplemented
from .client_bytes import client_message, form_of
from .client_messages import heartbeat, refusal
from .client_program import ClientProgram
from .client_robots import readings, robot
from .client_socket import ServerSocket
from .client_steps import (CheckClient, Cut, Ends, HearCorrection, HearFrom, HearLate, HearResume, Listen,
                           Mechanisms, Quiet, Refuse, Remove, Restart, SinceMinor, Tell, TellBytes, TellObservation, TellWelcome, Wait)
from .client_variants import TOKEN, environment_for, keys_for, socket_for
from .keys import RESTARTED
from .peer import Transcript
from .rules.fault import Fault, musts
from .rules.observation import time_of
from .rules.secret import is_sent_astray, is_told
from .rules.session import Session, State
from .scene_robots import SceneRobots
from .wire import protocol

_FIRST = 10.0  # [s] from a program's connection to its first message
_LEAST_SILENCE, _BEATS = 3.0, 3  # M3: [s], and in heartbeats, that show a loss where nothing else does
_BEAT = 1000  # [ms] that M6 promises
_BEATEN = (State.READY, State.STEPPING, State.PAUSED, State.DRAINING)
_RULES = {"hello": "H1", "command": "S3", "leave": "L5"}  # that ask for these messages
_LATE = 0.3  # [s] for a Command that need not come
_MOST_AT_ONCE, _MOST_A_SECOND = 2000, 1000  # M7


@dataclass(frozen=True)
class Options:
    """How all cases of a run are played."""

    patience: float  # [s], once the program has connected
    start_patience: float  # [s] until it connects
    form: Optional[str] = None  # the client must use it; None: it chooses
    scene: Optional[SceneRobots] = None  # None: the kit's robots
    controller: str = "steady"  # of these robots, in the client's environment


class ClientStage:
    def __init__(self, command: list, case: Case, options: Options):
        self.options = options
        self.patience = options.patience
        self.transcript = Transcript()
        self.session = Session()
        self.form: Optional[str] = None  # of the session
        self.routing_id: Optional[bytes] = None
        self._has_spoken = False  # the program
        self.key = ""  # of the client
        self.keys = keys_for(case.variant)
        self._played: list = []  # robots of the scene that the client has
        self._token = TOKEN  # of the session, also after it was lost
        self._silence = 0.0  # [s] after which the client sees that this session is lost
        self._knows_token = case.variant == RESTARTED  # the client does
        self._strange_token = ""  # what it said about a token that it can't know
        self._takes_over: Optional[bool] = None  # its first Hello asks for it
        self.last_commands: list = []  # at most two
        self._unkept: list[Fault] = []  # SHOULDs
        self._allowance = float(_MOST_AT_ONCE)  # of M7
        self._counted_at = self._observed_at = self._told_at = time.monotonic()
        self._socket = socket_for(case.variant, self.keys)
        try:
            self.program = ClientProgram(command, environment_for(
                case.variant, self.keys, self._socket.endpoint, options.controller))
        except RuntimeError:
            self._close()
            raise

    def __enter__(self) -> "ClientStage":
        """The program has connected, or ended: no limit of a case contains its start."""
        self.program.await_start(self._socket.is_reached, self.options.start_patience)
        return self

    def __exit__(self, *_: Any) -> None:
        words = self.program.end()
        if words:
            self.transcript.add("client", "───", f"printed: {words}")
        self._close()

    def _close(self) -> None:
        self._socket.destroy()
        if self.keys is not None:
            self.keys.close()

    # ---- one function for each kind of step --------------------------------------------------------

    def play(self, steps: tuple) -> None:
        """Raises Failed, NonStrict or Unimplemented."""
        self._play(steps)
        if is_told(TOKEN, self.program.printed()):
            raise Failed("it prints the token of its session, which is a secret (T10)")
        if self._unkept:
            raise NonStrict("; ".join(map(str, self._unkept[:5])))

    def _play(self, steps: tuple) -> None:
        for step in steps:
            if isinstance(step, (list, tuple)):
                self._play(tuple(step))
            else:
                _players[type(step)](self, step)

    def tell(self, step: Tell) -> None:
        self._tell(wire.from_dict(protocol.ServerMessage, step.message))

    def tell_welcome(self, step: TellWelcome) -> None:
        robots = [wire.from_dict(protocol.RobotDescription, fields) for fields in step.robots]
        welcome = wire.from_dict(protocol.Welcome, {
            "version": {"major": 1, "minor": 0}, "session_token": self._token, "tick_ns": 100_000_000,
            "ticks_per_second": 10, "mode": "MODE_LOCK_STEP", "seed": 7, "scene_hash": "0123456789abcdef",
            "max_message_bytes": 64 << 20, "server_version": "kit", "role": "ROLE_CONTROLLER",
            "wall_heartbeat_ms": _BEAT, **step.fields})
        self._silence = max(_LEAST_SILENCE, _BEATS * welcome.wall_heartbeat_ms / 1000)
        welcome.robots.extend(robots or self._wanted_robots())
        self._knows_token = True
        self._tell(protocol.ServerMessage(welcome=welcome))

    def tell_observation(self, step: TellObservation) -> None:
        welcome = self.session.welcome
        told = {"tick": step.tick, "time_ns": time_of(step.tick, welcome.ticks_per_second),
                **readings(welcome.robots, step.tick), **step.fields}
        message = wire.from_dict(protocol.ServerMessage, {"observation": told})
        self._observed_at = time.monotonic()
        self._tell(message, is_of_later_version=step.is_of_later_version)

    def tell_bytes(self, step: TellBytes) -> None:
        data = step.json if self.form == wire.JSON else step.binary
        self.transcript.add("server", "──▶", f"{len(data)} bytes {data[:40]!r}")
        self.session.told(wire.decode(protocol.ServerMessage, data, self.form))
        self._send(data)

    def hear(self, step: HearFrom) -> None:
        message = self._receive(self._patience())
        while step.kind == "command" and message is not None and message.leave.robots:  # L2: of some robots
            message = self._receive(self.patience)
        late = time.monotonic() - self._observed_at - step.within
        expected = f"{step.kind} is expected ({_RULES[step.kind]})"
        if message is None:
            complaint = f"the client said nothing; {expected}{self._gone()}{self._strange_token}"
            if self.routing_id is None:
                complaint += f": nothing came to {self._socket.endpoint}, its ZIGGURAT_ENDPOINT"
                if self.keys is not None:
                    raise Unimplemented(f"{complaint}, with the keys that it was given (T10)")
        elif wire.kind_of(message) != step.kind:
            complaint = f"the client said {wire.text_of(message, 300)}; {expected}"
        elif step.within and late > 0:
            complaint = f"its {step.kind} came {1000 * late:.0f} ms after the deadline (W1)"
        else:
            complaint = "; ".join(wire.mismatches(step.pattern, getattr(message, step.kind), step.kind))
        _judge(complaint, step.should)

    def hear_late(self, step: HearLate) -> None:
        message = self._receive(self.patience if step.tick is not None else _LATE)
        if message is not None and message.HasField("command") and message.command.tick == step.late:
            self._tell_error("STALE_TICK", "DISCARD", self.session.tick)
            message = self._receive(self.patience) if step.tick is not None else None
        said = "nothing" if message is None else wire.text_of(message, 300)
        if step.tick is None and message is not None:
            _judge(f"the client said {said}; nothing or the Command for tick {step.late} is expected", False)
        if step.tick is not None and not (message and message.HasField("command")
                                          and message.command.tick == step.tick):
            _judge(f"the client said {said}; the Command for tick {step.tick} is expected{self._gone()}", False)

    def remove(self, step: Remove) -> None:
        id = self.session.welcome.robots[step.position].id
        self.tell(Tell({"error": {"code": "NOT_YOURS", "severity": "WARNING", "robot": id,
                                  "message": "a supervisor removed it"}}))
        self.session.left.add(step.position)

    def refuse(self, step: Refuse) -> None:
        self._tell_error(step.code, "DISCARD", self.session.tick)
        self.session.owes = True  # S10

    def hear_correction(self, step: HearCorrection) -> None:
        message = self._receive(self.patience)
        if message is None and self.program.exit_code() is None:
            _judge(f"its Command for tick {step.tick} was refused, so it still owes one; it sends nothing", False)
        elif message is None and self.program.exit_code() == 0:
            _judge("its Command was refused, and it ended with exit code 0", True)
        elif message is not None and wire.kind_of(message) not in ("command", "leave"):
            _judge(f"the client said {wire.text_of(message, 300)}; a Command or a Leave is expected", False)

    def since_minor(self, step: SinceMinor) -> None:
        if self.session.hello.version.minor >= step.minor:
            self._play(step.steps)

    def cut(self, _: Cut) -> None:
        self.transcript.add("server", "───", "closes the connection, and listens again")
        self._socket.close()
        self._lose()
        self._socket.open()

    def restart(self, _: Restart) -> None:
        self.transcript.add("server", "───", "closes; the program is started anew")
        self._socket.close()
        self.program.restart()

    def listen(self, _: Listen) -> None:
        self.transcript.add("server", "───", "listens from now on")
        self._socket.open()

    def hear_resume(self, _: HearResume) -> None:
        limit = self._silence + self._patience()
        deadline = time.monotonic() + limit
        if self.session.state is not State.NEW:
            self._lose(is_connected=True)
        while True:
            message = self._receive(deadline - time.monotonic(), is_new=True, is_silent=True)
            if message is None or time.monotonic() >= deadline and not message.HasField("hello"):
                _judge(f"it did not resume its session within {limit:g} s (M3, L4)"
                       f"{self._gone()}", True)
                return
            if message.HasField("hello"):
                break
            self._tell_error("OUT_OF_STATE", "FATAL", 0)  # it can't know; M3 says what it means
        if message.hello.role != protocol.ROLE_CONTROLLER:
            _judge(f"its Hello has the role {message.hello.role}; it resumes a session of ROLE_CONTROLLER (L4)", False)
        token = message.hello.session_token
        if not token:
            _judge("its Hello begins a new session; one with the session's token resumes it (L4)", True)
        elif token != self._token:
            _judge(f"its Hello has the token {token!r}; its session has {self._token!r} (L4)", False)

    def quiet(self, step: Quiet) -> None:
        message = self._receive(step.seconds, is_silent=True)
        if message is not None:
            _judge(f"the client said {wire.text_of(message, 300)}; nothing is expected", step.should)

    def ends(self, step: Ends) -> None:
        limit = step.within or self.patience
        deadline = time.monotonic() + limit
        while self.program.exit_code() is None and time.monotonic() < deadline:
            self._receive(0.02)
        code = self.program.exit_code()
        if code is None:
            _judge(f"the program still runs after {limit:g} s", step.should)
        elif step.good is not None and step.good != (code == 0):
            expected = "0" if step.good else "another than 0"
            _judge(f"the program ended with exit code {code}; {expected} is expected (L11)", step.should)

    def wait(self, step: Wait) -> None:
        time.sleep(step.seconds)

    def check(self, step: CheckClient) -> None:
        complaint = step.check(self)
        _judge(f"{step.title}: {complaint}" if complaint else "", step.should)

    def mechanisms(self, step: Mechanisms) -> None:
        found = self._socket.mechanisms(step.seconds)
        self.transcript.add("client", "──▶", f"greetings with {', '.join(found[:20]) or 'nothing'}")
        if "NULL" in found and "CURVE" not in found:
            raise Unimplemented("it connects without the keys that it was given (T10)")
        others = sorted(set(found) - {"CURVE", ""})
        if others:
            raise Failed(f"it falls back from CURVE to {', '.join(others)} (K1)")
        if not found:
            raise Unimplemented("it does not connect with the keys that it was given (T10)")

    @property
    def socket(self) -> ServerSocket:
        """For checks."""
        return self._socket

    def _patience(self) -> float:
        """[s] for the next message."""
        return self.patience if self._has_spoken else max(self.patience, _FIRST)

    # ---- messages ----------------------------------------------------------------------------------

    def receive(self, seconds: float) -> Optional[protocol.ClientMessage]:
        """For checks."""
        return self._receive(seconds)

    def _receive(self, seconds: float, is_new: bool = False, is_silent: bool = False) -> Optional[protocol.ClientMessage]:
        """The next message but heartbeats, which are answered. is_new: it may come over another
        connection, and whatever it is, it is no fault. is_silent: without heartbeats to the client meanwhile (M6)."""
        deadline = time.monotonic() + seconds
        while True:
            arrival = self._arrival(deadline, is_silent)
            if arrival is None:
                return None
            message = self._message_of(arrival, is_new)
            faults = self.session.said(message, sum(map(len, arrival.frames)))
            self._unkept += [fault for fault in faults if fault.should]
            broken = [] if is_new and self.session.state is State.NEW else musts(faults)
            if broken:
                raise Failed(f"the client said {wire.text_of(message, 300)}: "
                             + "; ".join(map(str, broken[:5])))
            self._count(message)
            if message.HasField("hello"):
                self._judge_takeover(message.hello)
            if message.HasField("command"):
                self.last_commands = [*self.last_commands[-1:], message.command]
            if not self._refuses_token(message):
                if not message.HasField("heartbeat") or is_new and self.session.state is State.NEW:
                    return message
                self._tell(protocol.ServerMessage(heartbeat={"sequence": message.heartbeat.sequence}))
            if time.monotonic() >= deadline:  # else they could come without end
                return None

    def _judge_takeover(self, hello: protocol.Hello) -> None:
        """Raises Failed unless its user has asked for it. With a token it makes no difference (L8)."""
        if self._takes_over is None:
            self._takes_over = hello.takeover
        if hello.takeover and not hello.session_token and not self._takes_over:
            raise Failed("its Hello has takeover, which its first one had not: it takes robots of others unasked (L10)")

    def _refuses_token(self, message: protocol.ClientMessage) -> bool:
        """As a server does: there is no such session (L4)."""
        if self._knows_token or not message.hello.session_token:
            return False
        self._strange_token = "; its Hello had a token of no session: NO_SUCH_SESSION was the answer (L4)"
        self.tell(refusal("NO_SUCH_SESSION"))
        return True

    def _arrival(self, deadline: float, is_silent: bool):
        while True:
            arrival = self._socket.receive(min(0.02, max(0.0, deadline - time.monotonic())))
            if arrival is not None:
                return arrival
            if time.monotonic() > deadline or self.program.exit_code() is not None:
                return self._socket.receive(0.02)
            if not is_silent and self.session.state in _BEATEN and time.monotonic() - self._told_at > _BEAT / 1000:
                self.tell(heartbeat(0))

    def _message_of(self, arrival, is_new: bool) -> protocol.ClientMessage:
        """Raises Failed for what is no message of the protocol."""
        has_session = self.session.state not in (State.NEW, State.CLOSED)
        if has_session and self.routing_id not in (None, arrival.routing_id) and not is_new:
            raise Failed("it sends over a second connection; one connection carries one session (T1), and silence of less "
                         f"than {self._silence:g} s shows no loss (M3)")
        if arrival.socket_type != "DEALER":
            raise Failed(f"it connects with a {arrival.socket_type}; a DEALER is expected (T1)")
        if len(arrival.frames) != 1:
            raise Failed(f"the client sent {len(arrival.frames)} frames; one is expected (T2)")
        if self.key not in ("", arrival.key):
            raise Failed("it connects with another key than before (L12)")
        size = len(arrival.frames[0])
        limit = self.session.welcome.max_message_bytes if self.session.welcome is not None else 64 << 10
        if size > limit:
            raise Failed(f"the client sent {size} bytes; at most {limit} are allowed (T4)")
        self._has_spoken = True
        self.routing_id, self.key = arrival.routing_id, arrival.key
        data = arrival.frames[0].bytes
        message = self._decoded(data)
        self.transcript.add("client", "──▶", wire.text_of(message))
        if is_sent_astray(TOKEN, message, data):
            raise Failed(f"its {wire.kind_of(message) or 'message'} has the token of its session, which is a secret (T10)")
        return message

    def _decoded(self, data: bytes) -> protocol.ClientMessage:
        form = form_of(data)
        expected = self.options.form or self.form or form
        if form != expected:
            why = "--form asks for it" if self.options.form else "its session began so"
            raise Failed(f"the client sent a message in the {form} form; {expected} is expected: {why} (T6)")
        self.form = form
        return client_message(data)

    def _count(self, message: protocol.ClientMessage) -> None:
        """Messages other than Commands, as M7 counts them."""
        now = time.monotonic()
        self._allowance = min(float(_MOST_AT_ONCE), self._allowance + _MOST_A_SECOND * (now - self._counted_at))
        self._counted_at = now
        self._allowance -= not message.HasField("command")
        if self._allowance < 0:
            raise Failed(f"it sends more than {_MOST_A_SECOND} messages a second (M7)")

    def _tell(self, message: protocol.ServerMessage, is_of_later_version: bool = False) -> None:
        self.transcript.add("server", "──▶", wire.text_of(message))
        own_faults = musts(self.session.told(message))
        if own_faults:
            raise Failed("after what it said, the answer would break a rule: " + "; ".join(map(str, own_faults)))
        encode = wire.encode_as_later_version if is_of_later_version else wire.encode
        self._send(encode(message, self.form))

    def _tell_error(self, code: str, severity: str, tick: int) -> None:
        self.tell(Tell({"error": {"code": code, "severity": severity, "tick": tick,
                                  "message": "told by the conformance kit"}}))

    def _send(self, data: bytes) -> None:
        if self.routing_id is None:
            raise Failed("the client has not connected")
        self._told_at = time.monotonic()
        self._socket.send(self.routing_id, data)

    def _lose(self, is_connected: bool = False) -> None:
        """The session is lost; its connection, too, unless it is silent only."""
        self.session = Session()
        if not is_connected:
            self.routing_id = None

    def _wanted_robots(self) -> list:
        if self.options.scene is None:
            return [wire.from_dict(protocol.RobotDescription, robot(id)) for id in ("arm0", "arm1")]
        if self.session.hello.session_token:
            return self._played or self.options.scene.of(self.options.controller)  # or of the session before the program
        try:
            self._played = self.options.scene.chosen_by(self.session.hello)
        except LookupError as error:
            raise Failed(f"its Hello asks for {error} (H5)") from None
        return self._played

    def _gone(self) -> str:
        code = self.program.exit_code()
        return "" if code is None else f" (the program ended with exit code {code})"


def _judge(complaint: str, should: bool) -> None:
    if complaint and should:
        raise NonStrict(complaint)
    if complaint:
        raise Failed(complaint)


_players: dict = {
    Tell: ClientStage.tell,
    TellWelcome: ClientStage.tell_welcome,
    TellObservation: ClientStage.tell_observation,
    TellBytes: ClientStage.tell_bytes,
    HearFrom: ClientStage.hear,
    HearLate: ClientStage.hear_late,
    Refuse: ClientStage.refuse,
    Remove: ClientStage.remove,
    HearCorrection: ClientStage.hear_correction,
    HearResume: ClientStage.hear_resume,
    SinceMinor: ClientStage.since_minor,
    Cut: ClientStage.cut,
    Restart: ClientStage.restart,
    Listen: ClientStage.listen,
    Quiet: ClientStage.quiet,
    Ends: ClientStage.ends,
    Wait: ClientStage.wait,
    CheckClient: ClientStage.check,
    Mechanisms: ClientStage.mechanisms,
}
