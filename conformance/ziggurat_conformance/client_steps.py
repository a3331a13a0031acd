"""Steps of cases that play a server against a controller program, and the engine for them."""

import os
import subprocess
import tempfile
import time
from dataclasses import dataclass, field
from typing import Any, Callable, Optional

import zmq

from . import wire
from .case import Failed, NonStrict
from .peer import Transcript
from .wire import protocol


@dataclass(frozen=True)
class Tell:
    message: dict  # of ServerMessage


@dataclass(frozen=True)
class TellBytes:
    """Bytes instead of a message, in the form that the client speaks."""

    binary: bytes
    json: bytes


@dataclass(frozen=True)
class HearFrom:
    """The client's next message."""

    kind: str
    pattern: dict = field(default_factory=dict)
    should: bool = False


@dataclass(frozen=True)
class Quiet:
    """Nothing comes from the client."""

    seconds: float = 0.3
    should: bool = False


@dataclass(frozen=True)
class Ends:
    """The program ends; `good`: with exit code 0, or not."""

    good: Optional[bool] = None
    should: bool = False


@dataclass(frozen=True)
class Wait:
    seconds: float


_START = 10.0  # [s] until a program's first message


@dataclass(frozen=True)
class CheckClient:
    title: str
    check: Callable
    should: bool = False


class ClientStage:
    """A server's socket, and a controller program that connects to it."""

    def __init__(self, command: list, patience: float):
        self.patience = patience
        self.transcript = Transcript()
        self.form = wire.BINARY
        self.routing_id: Optional[bytes] = None
        self.greeting: Optional[protocol.Hello] = None  # the last
        self.described: list = []  # RobotDescription as told
        self._socket = zmq.Context.instance().socket(zmq.ROUTER)
        self._socket.setsockopt(zmq.LINGER, 0)
        port = self._socket.bind_to_random_port("tcp://127.0.0.1")
        self.endpoint = f"tcp://127.0.0.1:{port}"
        self._output = tempfile.TemporaryFile()
        environment = {**os.environ, "ZIGGURAT_ENDPOINT": self.endpoint,
                       "ZIGGURAT_CONTROLLER": "steady"}
        try:
            self.process = subprocess.Popen(command, env=environment, stdin=subprocess.DEVNULL,
                                            stdout=self._output, stderr=subprocess.STDOUT)
        except OSError as error:
            raise RuntimeError(f"{command[0]}: the controller can't be started: "
                               f"{error.strerror}") from None

    def __enter__(self) -> "ClientStage":
        return self

    def __exit__(self, *_: Any) -> None:
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        self._output.seek(0)
        words = self._output.read()[-2000:].decode(errors="replace").strip()
        if words:
            self.transcript.add("client", "───", f"printed: {words}")
        self._output.close()
        self._socket.close()

    def play(self, steps: tuple) -> None:
        for step in steps:
            if isinstance(step, (list, tuple)):
                self.play(tuple(step))
            else:
                _players[type(step)](self, step)

    def tell(self, step: Tell) -> None:
        message = wire.from_dict(protocol.ServerMessage, step.message)
        if message.HasField("welcome"):
            self.described = list(message.welcome.robots)
        self.transcript.add("server", "──▶", wire.text_of(message))
        self._send(wire.encode(message, self.form))

    def tell_bytes(self, step: TellBytes) -> None:
        data = step.json if self.form == wire.JSON else step.binary
        self.transcript.add("server", "──▶", f"{len(data)} bytes {data[:40]!r}")
        self._send(data)

    def hear(self, step: HearFrom) -> None:
        is_first = self.routing_id is None  # the program may take a while to start
        message = self._receive(max(self.patience, _START) if is_first else self.patience)
        if message is None:
            complaint = f"the client said nothing; expected {step.kind}{self._gone()}"
            if is_first:
                complaint += f": nothing came to {self.endpoint}, its ZIGGURAT_ENDPOINT"
        elif wire.kind_of(message) != step.kind:
            complaint = f"the client said {wire.text_of(message, 300)}; expected {step.kind}"
        else:
            told = getattr(message, step.kind)
            if step.kind == "hello":
                self.greeting = told
            complaints = list(wire.mismatches(step.pattern, told, step.kind))
            if step.kind == "command":
                complaints += command_faults(self.described, told)
            complaint = "; ".join(complaints)
        _judge(complaint, step.should)

    def quiet(self, step: Quiet) -> None:
        message = self._receive(step.seconds)
        if message is not None:
            _judge(f"the client said {wire.text_of(message, 300)}; expected nothing", step.should)

    def ends(self, step: Ends) -> None:
        deadline = time.monotonic() + self.patience
        while self.process.poll() is None and time.monotonic() < deadline:
            self._receive(0.02)
        code = self.process.poll()
        if code is None:
            _judge(f"the program still runs after {self.patience:g} s", step.should)
        elif step.good is not None and step.good != (code == 0):
            expected = "0" if step.good else "another than 0"
            _judge(f"the program ended with exit code {code}; expected {expected}", step.should)

    def wait(self, step: Wait) -> None:
        time.sleep(step.seconds)

    def check(self, step: CheckClient) -> None:
        complaint = step.check(self)
        _judge(f"{step.title}: {complaint}" if complaint else "", step.should)

    def _send(self, data: bytes) -> None:
        if self.routing_id is None:
            raise Failed("the client has not connected")
        self._socket.send_multipart([self.routing_id, data])

    def _receive(self, patience: float):
        deadline = time.monotonic() + patience
        while not self._socket.poll(20):
            if time.monotonic() > deadline or self.process.poll() is not None:
                if not self._socket.poll(0):
                    return None
                break
        frames = self._socket.recv_multipart()
        self.routing_id = frames[0]
        if len(frames) != 2:
            raise Failed(f"the client sent {len(frames) - 1} frames; expected one (T2)")
        self.form = wire.JSON if frames[1][:1] == b"{" else wire.BINARY
        try:
            message = wire.decode(protocol.ClientMessage, frames[1], self.form)
        except ValueError as error:
            raise Failed(f"the client sent {error}") from None
        self.transcript.add("client", "──▶", wire.text_of(message))
        return message

    def _gone(self) -> str:
        code = self.process.poll()
        return "" if code is None else f" (the program ended with exit code {code})"


def _judge(complaint: str, should: bool) -> None:
    if complaint and should:
        raise NonStrict(complaint)
    if complaint:
        raise Failed(complaint)


_PER_ROBOT = {
    "joint_targets": "joint_actuators",
    "led_colors": "leds",
    "directional_led_colors": "directional_leds",
    "tag_payloads": "tags",
    "magnet_currents": "magnets",
}


def command_faults(robots: list, command: protocol.Command) -> list:
    """What a server would refuse of a command (S6 to S8, D1)."""
    faults = []
    if any(position >= len(robots) for position in command.robots):
        return ["a position beyond the session's robots (S7)"]
    spoken_for = [robots[position] for position in command.robots] or robots
    for name, devices in _PER_ROBOT.items():
        values = getattr(command, name)
        expected = sum(len(getattr(robot, devices)) for robot in spoken_for)
        if len(values) not in (0, expected):
            faults.append(f"{name} has {len(values)} values; expected none or {expected} (S6)")
    driven = sum(robot.wheels.drives for robot in spoken_for)
    turrets = sum(robot.turret.drives for robot in spoken_for)
    for name, expected in (("wheel_velocities", 2 * driven), ("turret_modes", turrets),
                      ("turret_rotations", turrets), ("turret_speeds", turrets)):
        if len(getattr(command, name)) not in (0, expected):
            faults.append(f"{name} is not as long as its robots' devices (S6, D6, D7)")
    if any(mode not in (1, 2, 3) for mode in command.turret_modes):
        faults.append("a turret mode that does not exist (D7)")
    for name in ("joint_targets", "magnet_currents", "wheel_velocities", "turret_rotations",
                 "turret_speeds"):
        if any(value != value or abs(value) == float("inf") for value in getattr(command, name)):
            faults.append(f"{name} are not finite (S8)")
    radios = sum(len(robot.radios) for robot in robots)
    if any(message.radio >= radios for message in command.radio_messages):
        faults.append("a message of a radio that is not there (D1)")
    return faults


_players: dict = {
    Tell: ClientStage.tell,
    TellBytes: ClientStage.tell_bytes,
    HearFrom: ClientStage.hear,
    Quiet: ClientStage.quiet,
    Ends: ClientStage.ends,
    Wait: ClientStage.wait,
    CheckClient: ClientStage.check,
}
