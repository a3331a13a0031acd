# SPDX-License-Identifier: MIT
"""What the environments for learning have in common: a world with episodes, and what agents observe and do by default."""

from __future__ import annotations

import operator
import os
import random
import warnings
from fnmatch import fnmatchcase
from typing import Any, Callable, List, Optional, Sequence, Tuple, Union

import zmq

from .devices.device import finite
from .errors import ProtocolError, Refused
from .joining import connect
from .robot import Robot
from .server import Server
from .session import Session
from .supervisor import Supervisor
from .ticks import Ending, Tick

Observe = Callable[[Robot], Any]
Act = Callable[[Robot, Any], None]
Randomize = Callable[[Supervisor, Any], None]


def all_readings(robot: Robot) -> List[float]:
    """Of the robot's sensors that have a fixed number of values: joint sensors, Robot.sensed, wheels (4), turret, devices that
    describe themselves.
    Messages, packets and what cameras see are not in it."""
    return robot._exchange.read(robot._reading_places)


def motor_count(robot: Robot) -> int:
    """Values of an action of motors()."""
    return len(robot._motors)


def motors(robot: Robot, action: Sequence[float]) -> None:
    """A target for each motor of the robot, in order, then the speeds of its wheels: left, right [m/s]."""
    if len(action) != len(robot._motors):
        raise ValueError(f"{robot.id}: an action has {motor_count(robot)} values, not {len(action)}: a target for each "
                         "motor, then the speeds of the wheels")
    for (field, place, what), value in zip(robot._motors, action):
        robot._exchange.set(field, place, finite(value, what))


def tell_of_nothing(observation: Any, robot: Robot) -> None:
    """An agent that observes nothing learns nothing."""
    if hasattr(observation, "__len__") and len(observation) == 0:
        warnings.warn(f"the observation of robot {robot.id!r} is empty: its controller enables no sensor of a fixed number "
                      "of values; enable one in the scene, or pass observe=…", stacklevel=4)


def world_seed(seed: int) -> int:
    """The server's seed of an episode. A server draws one where a scene or --seed says 0, so no run has that: in its place
    is the largest that programs in every language can count with, 2^53 - 1."""
    return seed or 2 ** 53 - 1


class World:
    """A run with episodes, each from a seed: of a server of its own for `scene`, or of the one at `endpoint`.

    number       of several worlds: added to the seed of the first episode
    randomize    changes the world at the beginning of an episode, see ParallelEnv
    keeps_begin  a seed that is given again begins by a snapshot, which is faster
    context      of libzmq, of the sessions of several worlds
    """

    def __init__(self, scene: Optional[str], endpoint: Optional[str] = None, *, number: int = 0, robots: Union[str, Sequence[str]] = "*",
                 randomize: Optional[Randomize] = None, keeps_begin: bool = False, command: str = "ziggurat",
                 arguments: Sequence[str] = (), name: str = "environment", context: Optional[zmq.Context[Any]] = None):
        self._scene, self._endpoint, self._name = scene, endpoint, name
        self._number = number
        self._robots = [robots] if isinstance(robots, str) else list(robots)
        self._randomize, self._keeps_begin = randomize, keeps_begin
        self._command, self._arguments = command, list(arguments)
        self._context = context
        self.server: Optional[Server] = None
        self._supervisor: Optional[Supervisor] = None
        self._stream: Optional[random.Random] = None  # of seeds, after the one that was given
        self._begin = f"{name}-{os.getpid()}-begin"
        self._begin_seed: Optional[int] = None  # of the snapshot of that name
        self._kept = 0
        self.first_tick = 0 if randomize is None else 1  # of an episode
        self.session: Session = None  # type: ignore[assignment]  # until _open()
        self.agents: List[Robot] = []
        self.seed = 0
        self._fresh_tick: Optional[int] = None  # of the session's first observation, until an episode begins there
        self._open(None)

    @property
    def supervisor(self) -> Supervisor:
        if self._supervisor is None:
            self._supervisor = Supervisor(self.session.endpoint, name=self._name, curve=self.session._curve)
        return self._supervisor

    def _open(self, seed: Optional[int]) -> None:
        """A new server, or a session at the endpoint, up to its first observation."""
        if self._scene is None:
            assert self._endpoint is not None  # one of both is given
            self.session = connect(self._endpoint, self._robots, can_restore=True, name=self._name, context=self._context)
        else:
            seeds = [] if seed is None else ["--seed", str(world_seed(seed))]
            self.server = Server(self._scene, command=self._command,
                                 arguments=["--start-directors", *self._arguments, *seeds])
            # All robots: no other program would connect for the rest, for which the world waits.
            self.session = self.server.session(can_restore=True, name=self._name, context=self._context)
        try:
            self.agents = [robot for robot in self.session.robots
                           if any(fnmatchcase(robot.id, each) or robot.id == each for each in self._robots)]
            if not self.agents:
                raise ValueError(f"robots={self._robots}: the scene has no robot with such an id; it has "
                                 + ", ".join(robot.id for robot in list(self.session.robots)[:8]))
            self.advance()
        except BaseException:
            self.close()
            raise
        self.seed, self._fresh_tick, self._begin_seed = self.session.seed, self.tick.number, None

    @property
    def tick(self) -> Tick:
        """The session's last one: there is one after _open()."""
        assert self.session.tick is not None
        return self.session.tick

    @property
    def _ending(self) -> Ending:
        """Of the session, which has no other tick."""
        assert self.session.ending is not None
        return self.session.ending

    def goes_on(self) -> bool:
        """To the tick whose command was sent, or is sent now. False: the run was finished instead, by a director."""
        if next(self.session, None) is not None:
            return True
        if self._ending.reason == "finished":
            return False
        raise self._early_end()

    def advance(self) -> None:
        """As goes_on(), where there must be another tick."""
        if not self.goes_on():
            raise self._early_end()

    def _early_end(self) -> RuntimeError:
        ending = self._ending
        return RuntimeError(f"the run ended at tick {ending.tick}: {ending.reason} {ending.message}")

    def begin(self, seed: Optional[int] = None) -> None:
        """An episode at tick 0: of this seed, or of the next one of the stream that the last given seed began."""
        is_given = seed is not None
        if seed is not None:
            seed = operator.index(seed)
            self._stream = random.Random(seed)
        elif self._stream is None:
            seed = self.seed + self._number
            self._stream = random.Random(seed)
        else:
            seed = 1 + self._stream.getrandbits(52)
        if is_given and seed == self._begin_seed and self.session.ending is None and self._restored_begin():
            return
        if self.tick.number != self._fresh_tick or world_seed(seed) != self.session.seed:
            self._reset(seed)
        self.seed, self._fresh_tick = seed, None
        if self._randomize is not None:
            self._change()
        if is_given and self._keeps_begin:
            self.supervisor.snapshot(self._begin)  # in place of that of another seed
            self._begin_seed = seed

    def _restored_begin(self) -> bool:
        """Whether the world has gone back. Not if a director can't, as Lua scripts: then it is built."""
        try:
            self.restore(self._begin)
            return True
        except ProtocolError as error:
            if error.code != "OUT_OF_STATE":
                raise
            self._keeps_begin = False
            return False

    def _change(self) -> None:
        """By the program's function. What it changed is sensed at the next tick."""
        import numpy
        assert self._randomize is not None
        self._randomize(self.supervisor, numpy.random.default_rng(self.seed))
        self.advance()

    def _reset(self, seed: int) -> None:
        """By a supervisor, or, if the run has ended or the server allows none, by another server."""
        if self.session.ending is None:
            try:
                self.supervisor.reset(world_seed(seed))
                self.session.expect_reset()
                return self.advance()
            except (ProtocolError, Refused) as error:
                if error.code not in ("UNIMPLEMENTED", "FORBIDDEN") or self.server is None:
                    raise
        elif self.server is None:
            raise RuntimeError("the run has ended; only an environment with a scene of its own can start another")
        self.close()
        self._open(seed)

    def snapshot(self) -> Tuple[str, int]:
        """Its name and tick."""
        self._kept += 1
        name = f"{self._name}-{os.getpid()}-{self._kept}"
        return name, self.supervisor.snapshot(name)

    def restore(self, name: str) -> None:
        self.supervisor.restore(name)
        self.session.expect_reset()
        self.advance()
        self._fresh_tick = None

    def close(self) -> None:
        for part in (self.session, self._supervisor, self.server):
            if part is not None:
                part.close()
        self._supervisor = self.server = None
