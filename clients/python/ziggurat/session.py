# SPDX-License-Identifier: MIT
"""A session of a controller: ticks, commands, lost connections, the end."""

from __future__ import annotations

import threading
import time
import weakref
from typing import Any, Callable, Dict, Iterable, Iterator, List, Optional, Union, cast

import zmq

from . import driven
from . import protocol_pb2 as v1
from .connection import Connection, Wait
from .curve import Curve
from .errors import ConnectionLost, Displaced, Malformed, ProtocolError, Refused, name_of, printable
from .exchange import Exchange
from .named import Named
from .robot import Robot
from .ticks import Ending, Event, SpawnedRobot, Tick

# Errors for a command that came too late or twice: harmless, as the next observation arrives anyway.
# A command that was sent before a Reset arrived may have a future tick.
_LATE = (v1.Error.STALE_TICK, v1.Error.DUPLICATE_TICK)

# Wall times [s] of a session whose connection was lost.
_SILENCE = 3.0  # of a server, at least
_PATIENCE = 10.0  # as connect_timeout
_BETWEEN_ATTEMPTS = 0.1  # while there is no server
_BETWEEN_HELLOS = 1.0  # to a server that answers
_MOST_IN_VAIN = 3


class Session:
    """An iterator over ticks. The next tick sends the values that were set in this one.

    As a context manager it leaves the run at the end of the block: as failed after an exception, but for sys.exit(0). So
    it does at the end of a program without an exception.
    """

    def __init__(self, endpoint: str, hello: v1.Hello, curve: Optional[Curve],
                 connect_timeout: float, wait_timeout: Optional[float],
                 resume_timeout: Optional[float], has_ended: Callable[[], bool] = lambda: False,
                 context: Optional[zmq.Context[Any]] = None):
        self._connection = Connection(endpoint, curve, has_ended, context)
        self._has_ended, self._context = has_ended, context
        self._curve = curve
        self._hello = hello
        self._resume_timeout = resume_timeout
        self._exchange = Exchange()
        self._wait_timeout = wait_timeout
        self._event = Event.RESUME if hello.session_token else Event.INIT
        self._owes: Optional[int] = None  # the tick that is not answered yet
        try:
            self.welcome = self._connection.begin(hello, connect_timeout)
        except BaseException:
            self._connection.close(linger=0)
            raise
        self._leaves: Dict[int, v1.ClientMessage] = {}  # of robots that left, by position
        self._answered: Optional[bytes] = None  # with this; the last one
        self._is_resumed = False  # the next observation may be the last one again
        self._resumed_in_vain = 0  # times without a new observation
        self._is_over = False  # it is not resumed
        self._watch()
        self.thread: Optional[int] = None  # that drives it, as threading.get_ident()
        self.tick: Optional[Tick] = None  # the current one
        self.ending: Optional[Ending] = None
        self.paused = False
        self._was_reset = False  # at some time
        self._epoch: Optional[int] = None  # of the tick that is not answered yet
        self.snapshot = ""  # the name of the one that the world went back to last
        self.missed = 0  # deadlines
        self.resumed = 0  # lost connections that were replaced
        self.late = 0  # commands that came too late or twice
        self._last_question = 0
        self._heard: Optional[v1.ServerMessage] = None  # instead of the answer to a question: the next message
        # Of controllers that robots of this session have; remove those that you have handled.
        self.spawned: List[SpawnedRobot] = []
        try:
            self._make_robots()
        except BaseException as error:  # Ctrl-C, or no memory
            self.close(f"{type(error).__name__}: {error}")
            raise
        driven.note(self)

    def _make_robots(self) -> None:
        # Without a cycle of references: at its end the program frees them one by one, and the garbage collection
        # does not look through all of them before.
        leave_one = weakref.WeakMethod(self._leave_one)
        self.robots: Named[Robot] = Named(
            (Robot(self._exchange, position, given, leave_one)
             for position, given in enumerate(self.welcome.robots)), "robot")
        self._exchange.begin()
        self._exchange.resume(self.welcome.resumed.commanded)
        self._remove(self.welcome.resumed.gone_robots)

    @property
    def endpoint(self) -> str:
        return self._connection.endpoint

    @property
    def is_over(self) -> bool:
        return self._is_over or self.ending is not None

    @property
    def id_of_one(self) -> str:
        """Of its robots, or of its director."""
        return str(self.welcome.robots[0].id if self.welcome.robots else self.welcome.director.id)

    @property
    def token(self) -> bytes:
        """For `resume`."""
        return bytes(self.welcome.session_token)

    @property
    def tick_seconds(self) -> float:
        """Simulated time of a tick [s]."""
        return float(self.welcome.tick_ns * 1e-9)

    @property
    def seed(self) -> int:
        """The run's: of its start, or of its last reset."""
        return int(self.welcome.seed)

    def robot(self, id: str) -> Robot:
        return cast(Robot, self.robots[id])

    def __iter__(self) -> Iterator[Tick]:
        return self

    def __next__(self) -> Tick:
        """Answers the last tick and waits for the next; StopIteration after the End.

        A lost connection is replaced meanwhile: no tick comes twice, and a lost answer is sent again.
        """
        if self.ending is not None:
            raise StopIteration
        if self._is_over:
            raise ConnectionLost("the session is closed")
        self.thread = threading.get_ident()
        if self._owes is not None:
            self._answer()
        wait = None
        while True:
            try:
                message = self._heard or self._connection.receive_soon()
                if message is None:
                    wait = wait or Wait(self._wait_timeout, "observation")
                    message = self._connection.receive(wait)
                self._heard = None
            except ConnectionLost as loss:
                self._resume(loss)
                wait = None
                continue
            except Malformed as error:
                self.close(str(error))
                raise
            kind = message.WhichOneof("message")
            if kind == "observation" or kind == "world_state":  # a director is told the latter
                seen = getattr(message, kind)
                if self._is_resumed and self._repeats_answer(seen):
                    continue
                return self._observe(seen)
            if kind == "end":
                self.ending = Ending(name_of(v1.End.Reason, message.end.reason).lower(),
                                     printable(message.end.message), message.end.tick)
                raise StopIteration
            self._take(kind, message)

    def _ask(self, **request: Any) -> v1.Response:
        """Asks while a tick waits for the answer."""
        if self._owes is None or self._is_over:
            raise ValueError("the world is asked at a tick, before its answer")
        self._last_question += 1
        self._connection.send(v1.ClientMessage(request=v1.Request(id=self._last_question, **request)))
        wait = Wait(self._wait_timeout, "answer")
        while True:
            message = self._connection.receive(wait)
            kind = message.WhichOneof("message")
            if kind == "response" and message.response.id == self._last_question:
                if message.response.HasField("error"):
                    raise ProtocolError(message.response.error)
                return message.response
            if kind == "error":
                self._take(kind, message)
            elif kind not in (None, "heartbeat", "response"):
                self._heard = message
                raise ConnectionLost(f"{self.endpoint}: the world has gone on without this tick's answer")

    def answer(self) -> None:
        """Answers the last tick now; next() then only waits. Several sessions of one program use the wait so."""
        if self._owes is not None and self.ending is None and not self._is_over:
            self._answer()

    def expect_reset(self) -> None:
        """Does not answer the current tick, because the world is being reset."""
        self._owes = None

    def _take(self, kind: Optional[str], message: v1.ServerMessage) -> None:
        """Handles messages other than ticks and the end; ignores unknown kinds."""
        if kind == "reset":
            self.welcome.seed = message.reset.seed
            self._begin_anew()
        elif kind == "restored":
            self._begin_anew()
            self._exchange.resume(message.restored.commanded)
            self._event = Event.RESTORED
            self.snapshot = message.restored.snapshot
        elif kind == "robot_spawned":
            robot = message.robot_spawned
            self.spawned.append(SpawnedRobot(robot.robot, robot.controller, robot.tick))
        elif kind == "paused":
            self.paused = True
        elif kind == "displaced":
            self._end()
            raise Displaced(f"{message.displaced.by} took robots of this session: "
                            f"{message.displaced.message}")
        elif kind == "error" and (message.error.severity == v1.Error.FATAL
                                  and message.error.code == v1.Error.OUT_OF_STATE):
            self._resume(ConnectionLost(f"{self.endpoint}: the server does not know the connection"))
        elif kind == "error":
            self._fault(message.error)

    def _begin_anew(self) -> None:
        """The world was reset."""
        self._exchange.reset()
        self._event = Event.RESET
        self._was_reset = True
        self._is_resumed = False
        self._owes = None

    def _watch(self) -> None:
        """A connection is lost, too, if the server is silent for longer than it promised. The end of a local
        connection is always told, so a server that is silent there is slow."""
        beat = self.welcome.wall_heartbeat_ms / 1000
        if beat and not self.endpoint.startswith("ipc://"):
            self._connection.longest_silence = max(_SILENCE, 3 * beat)

    def _resume(self, loss: ConnectionLost) -> None:
        """Over another connection. The first one stays until then: if it was closed earlier, the server would
        take the session's robots for free."""
        patience = self._resume_timeout
        if patience is None:
            patience = max(self.welcome.wall_lease_ms / 1000, _PATIENCE)
        self._resumed_in_vain += 1  # the answer itself may be why the server closes the connection
        if not self.token or not patience or self._resumed_in_vain > _MOST_IN_VAIN:
            self._end()
            raise loss
        end = time.monotonic() + patience
        hello = v1.Hello()
        hello.CopyFrom(self._hello)
        hello.session_token = self.token
        pause = _BETWEEN_HELLOS if self._resumed_in_vain > 1 else 0.0
        while True:
            time.sleep(pause)
            connection = Connection(self.endpoint, self._curve, self._has_ended, self._context)
            try:
                welcome = connection.begin(hello, max(0.1, end - time.monotonic()), is_patient=True)
                return self._go_on(connection, welcome)
            except (ConnectionLost, Refused) as error:
                connection.close(linger=0)
                is_refused = isinstance(error, Refused)
                may_retry = error.retryable if isinstance(error, Refused) else True
                if time.monotonic() < end and not self._has_ended() and may_retry:
                    pause = _BETWEEN_HELLOS if is_refused else _BETWEEN_ATTEMPTS
                    continue
                self._end()
                if is_refused:
                    raise error from loss
                raise ConnectionLost(f"{loss}; the session was not resumed within {patience:g} s") from error
            except BaseException:
                connection.close(linger=0)
                raise

    def _go_on(self, connection: Connection, welcome: v1.Welcome) -> None:
        """The session has the robots that it had, in their order."""
        self._heard = None
        self._connection.close(linger=0)
        self._connection = connection
        if [robot.id for robot in welcome.robots] != [robot.id for robot in self.robots]:
            self._end()
            raise ConnectionLost(f"{self.endpoint}: the resumed session has other robots than before")
        was_reset, self.welcome = welcome.seed != self.welcome.seed, welcome
        self._watch()
        self.resumed += 1
        self._is_resumed = self.tick is not None and self._event is not Event.RESET
        if was_reset:
            self._begin_anew()
        self._remove(welcome.resumed.gone_robots)
        self._exchange.repeat()
        for position, leave in self._leaves.items():
            if welcome.HasField("resumed") and position not in welcome.resumed.gone_robots:
                self._connection.send(leave)

    def _repeats_answer(self, observation: v1.Observation) -> bool:
        """The first observation of a resumed session may be the one that was answered before: it is not a tick
        again, and the answer may have been lost. The server takes it or ignores it."""
        if self.tick is None:
            return False
        self._is_resumed = False
        is_other = (self._epoch is not None and observation.HasField("epoch")
                    and observation.epoch != self._epoch)
        if observation.tick < self.tick.number or is_other:
            self._begin_anew()  # while there was no connection
            if is_other and self._hello.can_restore and observation.tick > 0:
                self._exchange.resume(self.welcome.resumed.commanded)
                self._event = Event.RESTORED
        if is_other or observation.tick != self.tick.number or self._answered is None:
            return False
        self._connection.send_bytes(self._answered)
        return True

    def _end(self) -> None:
        self._is_over = True
        self._connection.close()

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
        met_reset = error.code == v1.Error.FUTURE_TICK and (self._was_reset or self.resumed > 0)
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
            self._end()
        elif self.tick is not None:
            self._owes = self.tick.number  # the command was discarded; send another
            self._exchange.repeat()
        raise ProtocolError(error)

    def _observe(self, observation: Union[v1.Observation, v1.WorldState]) -> Tick:
        if isinstance(observation, v1.Observation):
            self._exchange.observe(observation)
        self._owes = observation.tick
        self.paused = self._is_resumed = False
        self._resumed_in_vain = 0
        self._epoch = observation.epoch if observation.HasField("epoch") else None
        self.tick = Tick(observation.tick, observation.time_ns, self._event)
        self._event = Event.STEP
        return self.tick

    def _answer(self) -> None:
        assert self._owes is not None  # __next__() asks
        data = self._exchange.command(self._owes, self._epoch)
        if 0 < self.welcome.max_message_bytes < len(data):
            raise ValueError(f"the command has {len(data)} bytes; the server accepts at most "
                             f"{self.welcome.max_message_bytes}")
        self._connection.send_bytes(data)
        self._answered = data
        self._exchange.sent()
        self._owes = None

    def _leave_one(self, robot: Robot, failure: str) -> None:
        if robot.gone or self._connection.closed:
            return
        reason = v1.Leave.FAILED if failure else v1.Leave.DONE
        lines = [line for line in self._exchange.log if line.robot == robot._position]
        self._exchange.log = [line for line in self._exchange.log if line.robot != robot._position]
        leave = v1.ClientMessage(leave=v1.Leave(
            robots=[robot._position], reason=reason, message=failure, log=lines))
        self._leaves[robot._position] = leave
        self._connection.send(leave)
        robot.gone = True

    def close(self, failure: str = "") -> None:
        """Leaves the run, as failed if there is a message, and closes the connection."""
        if self._connection.closed:
            return
        reason = v1.Leave.FAILED if failure else v1.Leave.DONE
        self._connection.send(v1.ClientMessage(leave=v1.Leave(
            reason=reason, message=failure, log=self._exchange.log,
            metrics=self._exchange.metrics.take())), is_last=True)
        self._exchange.log = []
        self._end()

    def abandon(self) -> None:
        """Closes the connection without a Leave, as in a crash: ziggurat.resume resumes the session."""
        self._is_over = True
        self._connection.close(linger=0)

    def __enter__(self) -> "Session":
        return self

    def __exit__(self, kind: Any, error: Any, trace: Any) -> None:
        hint = self._hint(error)
        if hint and hasattr(error, "add_note"):
            error.add_note(hint)
        is_done = kind is None or kind is SystemExit and error.code in (None, 0)
        self.close("" if is_done else f"{kind.__name__}: {error}" + (f" ({hint})" if hint else ""))

    def _hint(self, error: Any) -> str:
        """What a robot lacks, for the use of a device that is None."""
        if not isinstance(error, AttributeError) or not str(error).startswith("'NoneType' object"):
            return ""
        return "; ".join(robot._lacks() for robot in list(self.robots)[:3])
