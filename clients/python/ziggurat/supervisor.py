# SPDX-License-Identifier: MIT
"""Supervision of a run: pause, step, reset, move, read. The world never waits for a supervisor."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, List, Optional, Sequence, Tuple, Union

from . import protocol_pb2 as v1
from .connection import Connection, Wait
from .curve import Curve
from .devices import Color, Quaternion, Vector
from .devices.device import quaternion, vector
from .devices.led import color_of
from .driven import driven_here
from .errors import ConnectionLost, Malformed, ProtocolError, name_of, printable
from .ticks import Ending


@dataclass(frozen=True)
class SessionStatus:
    client: str
    role: str  # "controller", "director", "supervisor" or "observer"
    state: str  # "ready", "owing", "answered", "paused", "draining" or "lost"
    robots: Tuple[str, ...]
    tick: int  # of its last observation
    wall_waiting: float  # how long the world has waited for it [s]
    wall_last_message: float  # since its last message [s]
    wall_latency: Tuple[float, float, float]  # median, 99th percentile, longest [s]
    misses: int
    director: str = ""  # its id, if it is one


@dataclass(frozen=True)
class SolverStatus:
    """Of the physics, since the world began. Without islands: not known."""

    islands: int  # of bodies that touch, solved over all substeps
    not_converged: int  # of them
    worst_residual: float  # largest violation of the laws of contact [m/s] or [rad/s]


@dataclass(frozen=True)
class Status:
    tick: int
    time_ns: int  # simulated
    phase: str  # "gathering", "running", "paused" or "ending"
    seed: int
    scene: str
    scene_hash: str
    last_tick: int  # 0: no last tick
    sessions: Tuple[SessionStatus, ...]
    free_robots: Tuple[str, ...]  # without a session; the world waits for them
    gone_robots: Tuple[str, ...]
    solver: SolverStatus
    free_directors: Tuple[str, ...] = ()  # without a session; the world waits for them


@dataclass(frozen=True)
class LinkState:
    """In the world, of the link's frame: its origin is the centre of the link's bottom."""

    id: str
    position: Vector  # [m]
    orientation: Quaternion
    velocity: Vector  # [m/s]
    angular_velocity: Vector  # [rad/s]


@dataclass(frozen=True)
class EntityState:
    id: str
    position: Vector  # of the origin in the world [m]
    orientation: Quaternion
    links: Tuple[LinkState, ...]
    led_colors: Tuple[Color, ...]


@dataclass(frozen=True)
class States:
    tick: int
    hash: str  # of the whole state, 16 hexadecimal digits
    entities: Tuple[EntityState, ...]

    def __getitem__(self, id: str) -> EntityState:
        for entity in self.entities:
            if entity.id == id:
                return entity
        raise KeyError(id)


def place_request(what: str, position: Sequence[float], orientation: Sequence[float]) -> v1.IsFreeRequest:
    subject = {"xml" if what.lstrip().startswith("<") else "entity": what}
    return v1.IsFreeRequest(position=position, orientation=orientation, **subject)


def supervise(endpoint: str = "", **options: Any) -> "Supervisor":
    """A Supervisor of the server at this endpoint, otherwise at that of find_server(); options are
    those of the class. Without curve the keys are those of Curve.from_environment()."""
    options["curve"] = options.get("curve") or Curve.from_environment()
    return Supervisor(endpoint, **options)


class Supervisor:
    """Each call returns when the server has carried it out. For an observer, all but status and
    read raise ProtocolError with FORBIDDEN.

    connect_timeout  wall time to wait for the server's welcome [s]
    wait_timeout     wall time to wait for each answer [s]; None: forever. After a Timeout the server may still do
                     what it was asked for
    """

    def __init__(self, endpoint: str, *, observer: bool = False, name: str = "python",
                 version: str = "", curve: Optional[Curve] = None, connect_timeout: float = 10.0,
                 wait_timeout: Optional[float] = None):
        role = v1.ROLE_OBSERVER if observer else v1.ROLE_SUPERVISOR
        self._wait_timeout = wait_timeout
        self._next_id = 0
        self.ending: Optional[Ending] = None  # of the run, once it is over
        self._connection = Connection(endpoint, curve)
        try:
            self.welcome = self._connection.begin(
                v1.Hello(role=role, client_name=name, client_version=version), connect_timeout)
        except BaseException:
            self._connection.close()
            raise

    def _ask(self, **request: Any) -> v1.Response:
        self._next_id += 1
        self._connection.send(
            v1.ClientMessage(request=v1.Request(id=self._next_id, **request)))
        wait = Wait(self._wait_timeout, "answer")
        while True:
            try:
                message = self._connection.receive(wait)
            except Malformed as error:
                self._connection.leave(str(error))
                raise
            kind = message.WhichOneof("message")
            if kind == "response" and message.response.id == self._next_id:
                if message.response.HasField("error"):
                    raise ProtocolError(message.response.error)
                return message.response
            if kind == "error":
                raise ProtocolError(message.error)
            if kind == "end":
                self.ending = Ending(name_of(v1.End.Reason, message.end.reason).lower(),
                                     printable(message.end.message), message.end.tick)
                raise ConnectionLost(f"the run has ended: {self.ending.reason}")

    def status(self) -> Status:
        """Tick, sessions and robots: for which sessions the world waits, and how long."""
        return _status(self._ask(status=v1.StatusRequest()).status)

    def _tick_of(self, **request: Any) -> int:
        """Asks, and returns the tick at which it was done."""
        return int(self._ask(**request).tick)

    def pause(self) -> int:
        """Stops the world after the current tick; returns that tick. ProtocolError with OUT_OF_STATE if the world waits for
        an answer of this thread itself, to a tick of its session: pause from another thread or program."""
        return self._tick_of(pause=v1.PauseRequest(), held_up=driven_here(self._connection.endpoint))

    def resume(self) -> int:
        """Continues a paused world."""
        return self._tick_of(resume=v1.ResumeRequest())

    def step(self, ticks: int = 1) -> int:
        """Runs this many ticks of a paused world; returns the tick at which it stopped. As pause(), not of a thread that
        drives a session itself."""
        return self._tick_of(step=v1.StepRequest(ticks=ticks), held_up=driven_here(self._connection.endpoint))

    def reset(self, seed: Optional[int] = None) -> int:
        """Builds the world again, with the same seed if none is given."""
        return self._tick_of(reset=v1.ResetRequest(seed=seed))

    def snapshot(self, name: str) -> int:
        """Keeps the world under a name: 1 to 64 letters, digits, `-`, `_` and `.`."""
        return self._tick_of(snapshot=v1.SnapshotRequest(name=name))

    def restore(self, name: str) -> int:
        """Back to a snapshot; the tick that the world is at then. Refused while clients have robots
        that can't go back (can_restore of connect)."""
        return self._tick_of(restore=v1.RestoreRequest(name=name))

    def spawn(self, xml: str) -> int:
        """Adds an element, written as in <arena>."""
        return self._tick_of(spawn=v1.SpawnRequest(xml=xml))

    def remove(self, entity: str) -> int:
        return self._tick_of(remove=v1.RemoveRequest(entity=entity))

    def move(self, entity: str, position: Sequence[float], orientation: Sequence[float] = (), *,
             may_overlap: bool = False) -> int:
        """The entity is at rest with its origin at `position` [m]; orientation w, x, y, z. Where others are that is
        refused, unless it may overlap them: they are pushed apart."""
        return self._tick_of(move=v1.MoveRequest(entity=entity, position=position, orientation=orientation,
                                             may_overlap=may_overlap))

    def set_joint(self, entity: str, joint: str, position: float, velocity: float = 0.0) -> int:
        """A revolute or prismatic joint is put to a position [m, rad] from the assembled pose, within its limits, and a
        velocity [m/s, rad/s]. What hangs on it follows; other joints and the root of the entity stay, and motors keep
        their targets."""
        return self._tick_of(set_joint=v1.SetJointRequest(entity=entity, joint=joint, position=position,
                                                      velocity=velocity))

    def overlapped(self, what: str, position: Sequence[float],
                   orientation: Sequence[float] = ()) -> Optional[str]:
        """What an entity, or an element as in <arena>, would overlap there: the first entity's id; None: the place is
        free. The floor does not count, nor does the entity itself.
        what  an id, or an element: of a single body its extents are enough, as in <box size="1,1,1"/>"""
        return self._ask(is_free=place_request(what, position, orientation)).place.overlapped or None

    def is_free(self, what: str, position: Sequence[float], orientation: Sequence[float] = ()) -> bool:
        """Whether that is nothing."""
        return self.overlapped(what, position, orientation) is None

    def read(self, entities: Union[str, Sequence[str]] = ()) -> States:
        """States of the entities that match these ids or globs; without any, of all."""
        wanted = [entities] if isinstance(entities, str) else list(entities)
        response = self._ask(read=v1.ReadRequest(entities=wanted))
        return States(response.tick, response.states.hash,
                      tuple(map(_entity, response.states.entities)))

    def shutdown(self, reason: str = "") -> int:
        """Ends the run, as Ctrl-C does. With a reason that was planned: the run's exit code is 0."""
        return self._tick_of(shutdown=v1.ShutdownRequest(reason=reason or None))

    def close(self) -> None:
        if not self._connection.closed:
            self._connection.send(v1.ClientMessage(leave=v1.Leave(reason=v1.Leave.DONE)), is_last=True)
            self._connection.close()

    def __enter__(self) -> "Supervisor":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()


def _status(given: v1.Status) -> Status:
    return Status(given.tick, given.time_ns, name_of(v1.Status.Phase, given.phase).lower(), given.seed,
                  given.scene, given.scene_hash, given.last_tick,
                  tuple(map(_session, given.sessions)), tuple(given.free_robots),
                  tuple(given.gone_robots),
                  SolverStatus(given.solver.islands, given.solver.not_converged,
                               given.solver.worst_residual), tuple(given.free_directors))


def _session(given: v1.SessionStatus) -> SessionStatus:
    latency = given.wall_latency
    role = name_of(v1.Role, given.role).removeprefix("ROLE_").lower()
    state = name_of(v1.SessionStatus.State, given.state).lower()
    return SessionStatus(given.client, role, state, tuple(given.robots),
                         given.tick, given.wall_waiting_s, given.wall_last_message_s,
                         (latency.p50, latency.p99, latency.max), given.misses, given.director)


def _entity(given: v1.States.Entity) -> EntityState:
    links: List[LinkState] = [
        LinkState(link.id, vector(link.position), quaternion(link.orientation), vector(link.velocity),
                  vector(link.angular_velocity)) for link in given.links]
    return EntityState(given.id, vector(given.position), quaternion(given.orientation), tuple(links),
                       tuple(map(color_of, given.led_colors)))
