"""An environment for multi-agent learning with the methods of PettingZoo's ParallelEnv, without
that package: agents are robots, a step is a tick."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple, Union

from .errors import ProtocolError
from .robot import Robot
from .server import Server
from .joining import connect
from .session import Session
from .supervisor import Supervisor

Observe = Callable[[Robot], Any]
Act = Callable[[Robot, Any], None]


@dataclass(frozen=True)
class Snapshot:
    """A moment of a ParallelEnv, kept by its server."""

    name: str
    tick: int
    agents: Tuple[str, ...]  # whose task was not over


def all_readings(robot: Robot) -> List[float]:
    """Encoders, proximity, pose (7 numbers) and available charge, of the robot's devices."""
    values = [joint.encoder for joint in robot.joints if joint.sensor_mode is not None]
    values.extend(robot.proximity)
    if robot.pose is not None:
        values.extend((*robot.pose.position, *robot.pose.orientation))
    if robot.battery is not None:
        values.append(robot.battery.available_charge)
    return values


def joint_targets(robot: Robot, action: Sequence[float]) -> None:
    """A target for each motor of the robot, in order."""
    motors = [joint for joint in robot.joints if joint.actuator_mode is not None]
    if len(action) != len(motors):
        raise ValueError(f"{robot.id}: an action has {len(motors)} targets, not {len(action)}")
    for motor, target in zip(motors, action):
        motor.target = target


def parallel_env(scene: Optional[str] = None, **options: Any) -> "ParallelEnv":
    """A ParallelEnv; options are those of the class."""
    return ParallelEnv(scene, **options)


class ParallelEnv:
    """Starts a server for `scene`, or attaches to the one at `endpoint`.

    observe     returns an agent's observation of its robot; default all_readings
    act         performs an action; default joint_targets
    reward      of an agent, after each tick; default 0
    terminated  whether an agent's task is over; default never
    max_ticks   length of an episode; default the length of the scene
    command     the server's program; arguments: its other options

    The robot of a terminated agent keeps its last commands until the next reset.
    """

    metadata = {"name": "ziggurat", "render_modes": []}

    def __init__(self, scene: Optional[str] = None, *, endpoint: Optional[str] = None,
                 robots: Union[str, Sequence[str]] = "*", observe: Observe = all_readings,
                 act: Act = joint_targets, reward: Callable[[Robot], float] = lambda robot: 0.0,
                 terminated: Callable[[Robot], bool] = lambda robot: False,
                 max_ticks: Optional[int] = None, command: str = "ziggurat",
                 arguments: Sequence[str] = (), observation_spaces: Optional[Dict] = None,
                 action_spaces: Optional[Dict] = None):
        if (scene is None) == (endpoint is None):
            raise ValueError("give either a scene or an endpoint")
        self._scene, self._endpoint = scene, endpoint
        self._robots = robots
        self._observe, self._act = observe, act
        self._reward, self._terminated = reward, terminated
        self._max_ticks = max_ticks
        self._command, self._arguments = command, list(arguments)
        self.observation_spaces = observation_spaces or {}
        self.action_spaces = action_spaces or {}
        self._server: Optional[Server] = None
        self._session: Optional[Session] = None
        self._supervisor: Optional[Supervisor] = None
        self._kept = 0  # snapshots so far
        self.possible_agents: List[str] = []  # known after the first reset
        self.agents: List[str] = []

    def observation_space(self, agent: str) -> Any:
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> Any:
        return self.action_spaces[agent]

    @property
    def session(self) -> Session:
        """The session, for devices that actions and observations do not include."""
        if self._session is None:
            raise RuntimeError("call reset() first")
        return self._session

    def reset(self, seed: Optional[int] = None,
              options: Optional[Dict] = None) -> Tuple[Dict[str, Any], Dict[str, Dict]]:
        """Back to tick 0: observations and infos by agent. Without a seed, the last one again.

        options={"snapshot": s} goes back to what snapshot() gave in place of that; what follows is what
        followed then, bit for bit, with the same actions."""
        snapshot = (options or {}).get("snapshot")
        if snapshot is not None:
            self.restore(snapshot)
        elif not self._reset_world(seed):
            self._start(seed)
        if snapshot is None:
            next(self.session)
        self.possible_agents = [robot.id for robot in self.session.robots]
        if snapshot is None:
            self.agents = list(self.possible_agents)
        return self._observations(), self._infos()

    def snapshot(self) -> "Snapshot":
        """The world as it is, commands and random streams included, to go back to."""
        self._kept += 1
        name = f"env-{os.getpid()}-{self._kept}"
        tick = self._supervise().snapshot(name)
        return Snapshot(name, tick, tuple(self.agents))

    def restore(self, snapshot: "Snapshot") -> None:
        """Back to it. Observations are those of its tick."""
        self._supervise().restore(snapshot.name)
        self.session.expect_reset()
        next(self.session)
        self.agents = list(snapshot.agents)

    def _supervise(self) -> Supervisor:
        if self._supervisor is None:
            self._supervisor = Supervisor(self.session.endpoint, name="parallel_env")
        return self._supervisor

    def step(self, actions: Dict[str, Any]) -> Tuple[Dict, Dict, Dict, Dict, Dict]:
        """One tick: observations, rewards, terminations, truncations and infos by agent."""
        for agent, action in actions.items():
            self._act(self.session.robots[agent], action)
        is_over = next(self.session, None) is None
        tick = self.session.tick.number
        is_over = is_over or (self._max_ticks is not None and tick >= self._max_ticks)
        robots = [self.session.robots[agent] for agent in self.agents]
        observations, infos = self._observations(), self._infos()
        rewards = {robot.id: float(self._reward(robot)) for robot in robots}
        terminations = {robot.id: bool(self._terminated(robot)) for robot in robots}
        truncations = {robot.id: is_over for robot in robots}
        self.agents = [] if is_over else [a for a in self.agents if not terminations[a]]
        return observations, rewards, terminations, truncations, infos

    def _observations(self) -> Dict[str, Any]:
        return {agent: self._observe(self.session.robots[agent]) for agent in self.agents}

    def _infos(self) -> Dict[str, Dict]:
        return {agent: {"tick": self.session.tick.number} for agent in self.agents}

    def _reset_world(self, seed: Optional[int]) -> bool:
        """By a supervisor, if the run has not ended and the server allows supervisors."""
        if self._session is None or self._session.ending is not None:
            return False
        try:
            self._supervise().reset(seed)
            self._session.expect_reset()
        except ProtocolError as error:
            if error.code not in ("UNIMPLEMENTED", "FORBIDDEN") or self._server is None:
                raise
            return False
        return True

    def _start(self, seed: Optional[int]) -> None:
        """Starts a new server, or a first session at the endpoint."""
        if self._session is not None and self._scene is None:
            raise RuntimeError("the run has ended; only a server of parallel_env itself can restart")
        seed = seed if seed is not None or self._session is None else self._session.seed
        self.close()
        if self._scene is not None:
            seeds = [] if seed is None else ["--seed", str(seed)]
            self._server = Server(self._scene, command=self._command,
                                  arguments=[*self._arguments, *seeds])
            self._session = self._server.session(robots=self._robots, can_restore=True)
        else:
            self._session = connect(self._endpoint, self._robots, can_restore=True)
            if seed is not None and seed != self._session.seed:
                self._session_reset_at_start(seed)

    def _session_reset_at_start(self, seed: int) -> None:
        next(self.session)
        if not self._reset_world(seed):
            raise RuntimeError(f"the server runs with seed {self.session.seed} and can't be reset")

    def render(self) -> None:
        """Does nothing: there are no pictures."""

    def close(self) -> None:
        for part in (self._session, self._supervisor, self._server):
            if part is not None:
                part.close()
        self._session = self._supervisor = self._server = None
        self.agents = []
