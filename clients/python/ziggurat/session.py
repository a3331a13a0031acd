"""Sessions of controllers: ticks, commands, the end."""

from __future__ import annotations

import enum
from dataclasses import dataclass
from typing import Any, Iterable, Iterator, List, Optional, Sequence, Union

from . import protocol_pb2 as v1
from .connection import Connection, Curve
from .errors import Displaced, ProtocolError, name_of
from .exchange import Exchange
from .named import Named
from .robot import Robot

# Errors for a command that came too late or twice: harmless, as the next observation arrives anyway.
# A command that was sent before a Reset arrived may have a future tick.
_LATE = (v1.Error.STALE_TICK, v1.Error.DUPLICATE_TICK)


class Event(enum.Enum):
    """The kind of a tick."""

    INIT = "init"  # the first observation of a session
    STEP = "step"
    RESET = "reset"  # the world was reset, and all commands with it
    RESUME = "resume"  # the first observation of a resumed session


@dataclass(frozen=True)
class Tick:
    number: int
    time_ns: int  # simulated
    event: Event

    @property
    def time(self) -> float:
        """Simulated [s]."""
        return self.time_ns * 1e-9


@dataclass(frozen=True)
class Ending:
    reason: str  # "finished", "interrupted" or "failed"
    message: str
    tick: int  # the last one


@dataclass(frozen=True)
class SpawnedRobot:
    """A robot that a supervisor spawned. Another session takes it: connect(endpoint, robots=id)."""

    id: str
    controller: str  # its id in the scene
    tick: int  # from which on it stands there


@dataclass(frozen=True)
class Deadline:
    """The action if this controller does not answer in time: "wait", "hold", "zero", "drop" or
    "stop". A wish, which the server may refuse."""

    action: str
    wall_ms: int = 0
    miss_budget: int = 0

    def _message(self) -> v1.DeadlinePolicy:
        return v1.DeadlinePolicy(action=v1.DeadlinePolicy.Action.Value(self.action.upper()),
                                 wall_deadline_ms=self.wall_ms, miss_budget=self.miss_budget)


def connect(endpoint: str = "", robots: Union[str, Sequence[str]] = (), *, controller: str = "",
            name: str = "", version: str = "", deadline: Optional[Deadline] = None,
            takeover: bool = False, curve: Optional[Curve] = None, connect_timeout: float = 10.0,
            wait_timeout: Optional[float] = None) -> "Session":
    """A session with all robots that match both `robots` (ids, or globs with * ? [a-z]) and
    `controller` (its id in the scene); with neither, all robots. Without endpoint it is that of
    find_server().

    connect_timeout  wall time to wait for the server's welcome [s]
    wait_timeout     wall time to wait for a message [s]; None: forever

    Raises ConnectionLost if no server answers, and Refused if the server refuses the session.
    """
    wanted = [robots] if isinstance(robots, str) else list(robots)
    if not wanted and not controller:
        wanted = ["*"]
    hello = v1.Hello(role=v1.ROLE_CONTROLLER, robots=wanted, controller=controller,
                     client_name=name or controller or "python", client_version=version, takeover=takeover)
    if deadline is not None:
        hello.deadline_policy.CopyFrom(deadline._message())
    return Session(endpoint, hello, curve, connect_timeout, wait_timeout)


def resume(endpoint: str, token: bytes, *, name: str = "python", version: str = "",
           takeover: bool = False, curve: Optional[Curve] = None, connect_timeout: float = 10.0,
           wait_timeout: Optional[float] = None) -> "Session":
    """Resumes the session with this token after its connection was lost: same robots, same tick.
    The last commands hold, and the robots have their values; the first tick's event is RESUME."""
    hello = v1.Hello(role=v1.ROLE_CONTROLLER, robots=["*"], client_name=name,
                     client_version=version, session_token=token, takeover=takeover)
    return Session(endpoint, hello, curve, connect_timeout, wait_timeout)


class Session:
    """An iterator over ticks. The next tick sends the values that were set in this one.

    As a context manager it leaves the run at the end of the block: as failed after an exception.
    """

    def __init__(self, endpoint: str, hello: v1.Hello, curve: Optional[Curve],
                 connect_timeout: float, wait_timeout: Optional[float]):
        self._connection = Connection(endpoint, curve)
        self._exchange = Exchange()
        self._wait_timeout = wait_timeout
        self._event = Event.RESUME if hello.session_token else Event.INIT
        self._owes: Optional[int] = None  # the tick that is not answered yet
        try:
            self.welcome = self._connection.begin(hello, connect_timeout)
        except BaseException:
            self._connection.close()
            raise
        self.robots: Named[Robot] = Named(
            [Robot(self._exchange, position, given, self._leave_one)
             for position, given in enumerate(self.welcome.robots)], "robot")
        self._exchange.begin()
        self._exchange.resume(self.welcome.resumed.commanded)
        self._remove(self.welcome.resumed.gone_robots)
        self.tick: Optional[Tick] = None  # the current one
        self.ending: Optional[Ending] = None
        self.paused = False
        self._was_reset = False  # at some time
        self.missed = 0  # deadlines
        self.late = 0  # commands that came too late or twice
        # Of controllers that robots of this session have; remove those that you have handled.
        self.spawned: List[SpawnedRobot] = []

    @property
    def endpoint(self) -> str:
        return self._connection.endpoint

    @property
    def token(self) -> bytes:
        """For `resume`."""
        return self.welcome.session_token

    @property
    def tick_seconds(self) -> float:
        """Simulated time of a tick [s]."""
        return self.welcome.tick_ns * 1e-9

    @property
    def seed(self) -> int:
        return self.welcome.seed

    def robot(self, id: str) -> Robot:
        return self.robots[id]

    def __iter__(self) -> Iterator[Tick]:
        return self

    def __next__(self) -> Tick:
        """Answers the last tick and waits for the next; StopIteration after the End."""
        if self.ending is not None:
            raise StopIteration
        if self._owes is not None:
            self._answer()
        while True:
            message = self._connection.receive(self._wait_timeout)
            kind = message.WhichOneof("message")
            if kind == "observation":
                return self._observe(message.observation)
            if kind == "end":
                self.ending = Ending(name_of(v1.End.Reason, message.end.reason).lower(),
                                     message.end.message, message.end.tick)
                raise StopIteration
            self._take(kind, message)

    def expect_reset(self) -> None:
        """Does not answer the current tick, because the world is being reset."""
        self._owes = None

    def _take(self, kind: Optional[str], message: v1.ServerMessage) -> None:
        """Handles messages other than ticks and the end; ignores unknown kinds."""
        if kind == "reset":
            self._exchange.reset()
            self._event = Event.RESET
            self._was_reset = True
            self._owes = None
        elif kind == "robot_spawned":
            robot = message.robot_spawned
            self.spawned.append(SpawnedRobot(robot.robot, robot.controller, robot.tick))
        elif kind == "paused":
            self.paused = True
        elif kind == "displaced":
            self._connection.close()
            raise Displaced(f"{message.displaced.by} took robots of this session: "
                            f"{message.displaced.message}")
        elif kind == "error":
            self._fault(message.error)

    def _remove(self, positions: Iterable[int]) -> None:
        """The server has taken these robots out of the run."""
        for position in positions:
            if position < len(self.robots):
                self.robots[position].gone = True

    def _fault(self, error: v1.Error) -> None:
        if error.code == v1.Error.DEADLINE_MISSED:
            self.missed += 1
            self._exchange.repeat()
            return
        met_reset = error.code == v1.Error.FUTURE_TICK and self._was_reset
        if (error.code in _LATE or met_reset) and error.severity != v1.Error.FATAL:
            self.late += 1
            if self._was_reset:  # an answer from before the reset may have been taken instead
                self._exchange.repeat()
            return
        if error.severity == v1.Error.WARNING:
            self._remove(error.dropped.robots)
            if error.code == v1.Error.NOT_YOURS and error.robot in self.robots:
                self.robots[error.robot].gone = True  # removed, or taken over by another client
            return
        if error.severity == v1.Error.FATAL:
            self._connection.close()
        elif self.tick is not None:
            self._owes = self.tick.number  # the command was discarded; send another
            self._exchange.repeat()
        raise ProtocolError(error)

    def _observe(self, observation: v1.Observation) -> Tick:
        self._exchange.observe(observation)
        self._owes = observation.tick
        self.paused = False
        self.tick = Tick(observation.tick, observation.time_ns, self._event)
        self._event = Event.STEP
        return self.tick

    def _answer(self) -> None:
        message = self._exchange.command(self._owes)
        size = message.ByteSize()
        if 0 < self.welcome.max_message_bytes < size:
            raise ValueError(f"the command has {size} bytes; the server accepts at most "
                             f"{self.welcome.max_message_bytes}")
        self._connection.send(message)
        self._exchange.sent()
        self._owes = None

    def _leave_one(self, robot: Robot, failure: str) -> None:
        if robot.gone or self._connection.closed:
            return
        reason = v1.Leave.FAILED if failure else v1.Leave.DONE
        lines = [line for line in self._exchange.log if line.robot == robot._position]
        self._exchange.log = [line for line in self._exchange.log if line.robot != robot._position]
        self._connection.send(v1.ClientMessage(leave=v1.Leave(
            robots=[robot._position], reason=reason, message=failure, log=lines)))
        robot.gone = True

    def close(self, failure: str = "") -> None:
        """Leaves the run, as failed if there is a message, and closes the connection."""
        if self._connection.closed:
            return
        reason = v1.Leave.FAILED if failure else v1.Leave.DONE
        self._connection.send(v1.ClientMessage(leave=v1.Leave(
            reason=reason, message=failure, log=self._exchange.log)))
        self._exchange.log = []
        self._connection.close()

    def abandon(self) -> None:
        """Closes the connection without a Leave, as in a crash: the session can be resumed."""
        self._connection.close(linger_ms=0)

    def __enter__(self) -> "Session":
        return self

    def __exit__(self, kind: Any, error: Any, trace: Any) -> None:
        self.close("" if kind is None else f"{kind.__name__}: {error}")
