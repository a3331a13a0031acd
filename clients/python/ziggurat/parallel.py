# SPDX-License-Identifier: MIT
"""An environment for multi-agent learning with the methods of PettingZoo's ParallelEnv, without
that package: agents are robots, a step is a tick."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple, Union

from .learning import Act, Observe, Randomize, World, all_readings, motor_count, motors, tell_of_nothing
from .robot import Robot
from .session import Session


@dataclass(frozen=True)
class Snapshot:
    """A moment of a ParallelEnv, kept by its server."""

    name: str
    tick: int
    agents: Tuple[str, ...]  # whose task was not over


def parallel_env(scene: Optional[str] = None, **options: Any) -> "ParallelEnv":
    """A ParallelEnv; options are those of the class."""
    return ParallelEnv(scene, **options)


class ParallelEnv:
    """Starts a server for `scene`, or attaches to the one at `endpoint`, when it is first asked for something.

    robots      ids or globs: the agents. In a `scene` all other robots do nothing
    observe     returns an agent's observation of its robot; default all_readings
    act         performs an action; default motors
    reward      of an agent, after each tick; default 0
    terminated  whether an agent's task is over; default never
    max_ticks   length of an episode; default the length of the scene
    randomize   changes the world at the beginning of each episode: called with a Supervisor and a generator of numpy, which
                is seeded by the episode's seed. The episode then begins at tick 1, whose observations are of the
                changed world
    observation_spaces, action_spaces  by agent; by default a Box like the agent's first observation, which needs
                numpy, and one from -1 to 1 for each value of motors
    command     the server's program; arguments: its other options

    The robot of a terminated agent keeps its last commands until the next reset.
    """

    metadata = {"name": "ziggurat", "render_modes": []}

    def __init__(self, scene: Optional[str] = None, *, endpoint: Optional[str] = None,
                 robots: Union[str, Sequence[str]] = "*", observe: Observe = all_readings,
                 act: Act = motors, reward: Callable[[Robot], float] = lambda robot: 0.0,
                 terminated: Callable[[Robot], bool] = lambda robot: False,
                 max_ticks: Optional[int] = None, randomize: Optional[Randomize] = None,
                 command: str = "ziggurat", arguments: Sequence[str] = (),
                 observation_spaces: Optional[Dict[str, Any]] = None, action_spaces: Optional[Dict[str, Any]] = None):
        if (scene is None) == (endpoint is None):
            raise ValueError("give either a scene or an endpoint")
        self._observe, self._act = observe, act
        self._reward, self._terminated = reward, terminated
        self._max_ticks = max_ticks
        self.observation_spaces = dict(observation_spaces or {})
        self.action_spaces = dict(action_spaces or {})
        self._options: Dict[str, Any] = {"scene": None if scene is None else str(scene), "endpoint": endpoint, "robots": robots,
                         "randomize": randomize, "command": command, "arguments": arguments, "name": "parallel_env"}
        self._world: Optional[World] = None
        self.agents: List[str] = []

    def _opened(self) -> World:
        if self._world is None:
            self._world = World(**self._options)
            for robot in self._world.agents:
                tell_of_nothing(self._observe(robot), robot)
        return self._world

    @property
    def possible_agents(self) -> List[str]:
        return [robot.id for robot in self._opened().agents]

    def _robot(self, agent: str) -> Robot:
        self._opened()
        return self.session.robot(agent)

    def observation_space(self, agent: str) -> Any:
        if agent not in self.observation_spaces:
            self.observation_spaces[agent] = _box_like(self._observe(self._robot(agent)))
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> Any:
        if agent not in self.action_spaces:
            from .spaces import Box
            self.action_spaces[agent] = Box(-1, 1, (motor_count(self._robot(agent)),))
        return self.action_spaces[agent]

    @property
    def session(self) -> Session:
        """The session, for devices that actions and observations do not include."""
        if self._world is None:
            raise RuntimeError("call reset() first")
        return self._world.session

    def reset(self, seed: Optional[int] = None,
              options: Optional[Dict[str, Any]] = None) -> Tuple[Dict[str, Any], Dict[str, Dict[str, Any]]]:
        """A new episode: observations and infos by agent. Its seed is the one that is given. Without, it is the next of
        the stream of seeds that the last given one began; if none was given yet, that of the scene or server.

        options={"snapshot": s} goes back to what snapshot() gave in place of that; what follows is what
        followed then, bit for bit, with the same actions."""
        snapshot = (options or {}).get("snapshot")
        if snapshot is not None:
            self.restore(snapshot)
        else:
            self._opened().begin(seed)
            self.agents = self.possible_agents
        return self._observations(), self._infos()

    def snapshot(self) -> "Snapshot":
        """The world as it is, commands and random streams included, to go back to."""
        name, tick = self._opened().snapshot()
        return Snapshot(name, tick, tuple(self.agents))

    def restore(self, snapshot: "Snapshot") -> None:
        """Back to it. Observations are those of its tick."""
        self._opened().restore(snapshot.name)
        self.agents = list(snapshot.agents)

    def step(self, actions: Dict[str, Any]) -> Tuple[Dict[str, Any], Dict[str, Any], Dict[str, Any], Dict[str, Any], Dict[str, Any]]:
        """One tick: observations, rewards, terminations, truncations and infos by agent."""
        for agent, action in actions.items():
            self._act(self.session.robots[agent], action)
        is_over = next(self.session, None) is None
        tick = self._opened().tick.number - self._opened().first_tick
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

    def _infos(self) -> Dict[str, Dict[str, Any]]:
        return {agent: {"tick": self._opened().tick.number} for agent in self.agents}

    def render(self) -> None:
        """Does nothing: there are no pictures."""

    def close(self) -> None:
        if self._world is not None:
            self._world.close()
        self._world = None
        self.agents = []


def _box_like(observation: Any) -> Any:
    import numpy
    from .spaces import Box
    values = numpy.asarray(observation)
    if values.dtype.kind not in "biuf":
        raise ValueError(f"what observe returned is a {type(observation).__name__} and no array of numbers; pass its space "
                         "in observation_spaces={AGENT: …}")
    return Box(-numpy.inf, numpy.inf, values.shape)
