# SPDX-License-Identifier: MIT
"""Many worlds at once for learning, with the methods of Gymnasium's VectorEnv, without that package. It needs
numpy."""

from __future__ import annotations

import operator
from dataclasses import dataclass
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple, Union, cast

try:
    import numpy
except ImportError as error:
    raise ImportError(f"{error}. vector_env needs numpy: apt-get install python3-numpy, or pip install "
                      "numpy") from None

import zmq

from .learning import Act, Observe, Randomize, World, all_readings, motor_count, motors, tell_of_nothing
from .robot import Robot
from .session import Session
from .spaces import Box
from .supervisor import Supervisor

Array = numpy.ndarray[Any, Any]


@dataclass(frozen=True)
class VectorSnapshot:
    """A moment of all worlds of a VectorEnv, kept by their servers."""

    names: Tuple[str, ...]  # by world
    ticks: Tuple[int, ...]


class VectorEnv:
    """`n` worlds of `scene`, each in a server process of its own. They compute at the same time.

    robots      ids or globs: those that act, which must have the same devices. All other robots do nothing
    observe     the observation of a robot, a fixed number of values; default all_readings
    act         performs the action of a robot; default motors
    action_space  of one robot, a Box; default -1 to 1 for each motor. Other actions are not refused
    reward      of a robot, after each tick; default 0
    terminated  whether a robot's task is over; default never
    max_ticks   length of an episode; default without end
    autoreset   in the place of an episode that is over the world's next one begins, in the same step
    randomize   as in ParallelEnv
    dtype       of observations
    command     the server's program; arguments: its other options. Several worlds have one thread each without --threads.

    Arrays have the shape (n, …) if one robot acts, otherwise (n, robots, …).
    """

    metadata = {"name": "ziggurat", "render_modes": [], "autoreset_mode": "SameStep"}

    def __init__(self, scene: str, n: int, *, robots: Union[str, Sequence[str]] = "*",
                 observe: Observe = all_readings, act: Act = motors,
                 action_space: Optional[Box] = None,
                 reward: Callable[[Robot], float] = lambda robot: 0.0,
                 terminated: Callable[[Robot], bool] = lambda robot: False,
                 max_ticks: Optional[int] = None, autoreset: bool = True,
                 randomize: Optional[Randomize] = None, dtype: Any = numpy.float64,
                 command: str = "ziggurat", arguments: Sequence[str] = ()):
        if n < 1:
            raise ValueError(f"n is {n}; it must be 1 or more")
        self.num_envs = n
        self._observe, self._act = observe, act
        self._reward, self._terminated = reward, terminated
        self._max_ticks, self._autoreset = max_ticks, autoreset
        self._worlds: List[World] = []
        self._context = zmq.Context()  # one thread sends and receives for all worlds
        is_told = any(word.startswith("--threads") for word in arguments)
        threads = ["--threads", "1"] if n > 1 and not is_told else []  # worlds are stepped side by side
        try:
            for number in range(n):
                self._worlds.append(World(str(scene), number=number, robots=robots, randomize=randomize, keeps_begin=True, command=command,
                                          arguments=["--duration", "0", *threads, *arguments], name="vector_env",
                                          context=self._context))
            self._shape_spaces(action_space, dtype)
        except BaseException:
            self.close()
            raise

    def _shape_spaces(self, action_space: Optional[Box], dtype: Any) -> None:
        """By the first observations, whose length is that of all."""
        first = self._worlds[0].agents
        self.possible_agents = [robot.id for robot in first]
        self.agents = list(self.possible_agents)
        sizes = {robot.id: len(self._observe(robot)) for robot in first}
        counts = {robot.id: motor_count(robot) for robot in first}
        if len(set(sizes.values())) > 1 or (action_space is None and len(set(counts.values())) > 1):
            raise ValueError(f"the robots are not alike: they have observations of {sizes} values and actions of "
                             f"{counts}; choose some of them by robots=…")
        tell_of_nothing(self._observe(first[0]), first[0])
        size, count = next(iter(sizes.values())), next(iter(counts.values()))
        self._agent_observation = Box(-numpy.inf, numpy.inf, (size,), dtype)
        self._agent_action = Box(-1, 1, (count,)) if action_space is None else action_space
        inner = () if len(first) == 1 else (len(first),)
        self._inner = inner
        self.single_observation_space = Box(-numpy.inf, numpy.inf, (*inner, size), dtype)
        self.single_action_space = _repeated(self._agent_action, inner)
        self.observation_space = Box(-numpy.inf, numpy.inf, (self.num_envs, *inner, size), dtype)
        self.action_space = _repeated(self._agent_action, (self.num_envs, *inner))
        self._observations = numpy.zeros((self.num_envs, len(first), size), dtype)

    def agent_observation_space(self, agent: str) -> Box:
        """Of one robot, as PettingZoo's observation_space(agent)."""
        return self._agent_observation

    def agent_action_space(self, agent: str) -> Box:
        return self._agent_action

    def sessions(self) -> List[Session]:
        """By world, for devices that actions and observations do not include."""
        return [world.session for world in self._worlds]

    def supervisors(self) -> List[Supervisor]:
        """By world, to move or spawn entities between two steps."""
        return [world.supervisor for world in self._worlds]

    def reset(self, *, seed: Union[None, int, Sequence[int]] = None,
              options: Optional[Dict[str, Any]] = None) -> Tuple[Array, Dict[str, Any]]:
        """New episodes of all worlds: observations and infos.

        seed     of these episodes: one for each world, or that of the first one, which counts up. Without, each world has
                 the next of the stream of seeds that its last given one began; in the beginning the scene's, which counts
                 up
        options  {"snapshot": s} goes back to what snapshot() gave in place of that; {"mask": m}, by world: only
                 these go back
        """
        options = options or {}
        snapshot: Optional[VectorSnapshot] = options.get("snapshot")
        mask = numpy.asarray(options.get("mask", [True] * self.num_envs), bool)
        if mask.shape != (self.num_envs,):
            raise ValueError(f"the mask has the shape {mask.shape}; it must have {self.num_envs} values")
        seeds = None if seed is None else self._seeds(seed)
        for number in numpy.flatnonzero(mask):
            world = self._worlds[number]
            if snapshot is not None:
                world.restore(snapshot.names[number])
            else:
                world.begin(None if seeds is None else seeds[number])
            self._read(number)
        return self._shaped(self._observations.copy()), self._infos()

    def _seeds(self, seed: Union[int, Sequence[int]]) -> List[int]:
        """By world. Takes numpy's integers, too."""
        if numpy.ndim(seed) == 0:
            return [operator.index(cast(int, seed)) + number for number in range(self.num_envs)]
        seeds = cast(Sequence[int], seed)
        if len(seeds) != self.num_envs:
            raise ValueError(f"there are {len(seeds)} seeds for {self.num_envs} worlds")
        return [operator.index(each) for each in seeds]

    def snapshot(self) -> VectorSnapshot:
        """All worlds as they are, to go back to: what follows is what followed then, bit for bit, with the same
        actions."""
        kept = [world.snapshot() for world in self._worlds]
        return VectorSnapshot(tuple(name for name, _ in kept), tuple(tick for _, tick in kept))

    def step(self, actions: Any) -> Tuple[Array, Array, Array, Array, Dict[str, Any]]:
        """One tick of all worlds: observations, rewards, terminations, truncations and infos.

        Where an episode is over, its world has begun the next one (autoreset); infos["final_observation"]
        has the last observation, and infos["_final_observation"] says where."""
        self.step_async(actions)
        return self.step_wait()

    def step_async(self, actions: Any) -> None:
        """Sends the actions; the worlds compute while this program does something else."""
        actions = numpy.asarray(actions, float)
        if actions.shape != self.action_space.shape:
            raise ValueError(f"actions have the shape {actions.shape}, not {self.action_space.shape}")
        actions = actions.reshape(self.num_envs, len(self.agents), -1)
        for world, world_actions in zip(self._worlds, actions):
            for robot, action in zip(world.agents, world_actions):
                self._act(robot, action)
            world.session.answer()

    def step_wait(self) -> Tuple[Array, Array, Array, Array, Dict[str, Any]]:
        all_rewards, all_terminations, all_truncations, over = [], [], [], []
        for number, world in enumerate(self._worlds):
            goes_on = world.goes_on()
            self._read(number)
            terminated = [bool(self._terminated(robot)) for robot in world.agents]
            ends = not goes_on or (self._max_ticks is not None and world.tick.number - world.first_tick >= self._max_ticks)
            all_rewards.append([self._reward(robot) for robot in world.agents])
            all_terminations.append(terminated)
            all_truncations.append([ends] * len(terminated))
            over.append(ends or all(terminated))
        infos: Dict[str, Any] = {}
        if self._autoreset and any(over):
            infos["final_observation"] = self._shaped(self._observations.copy())
            infos["_final_observation"] = numpy.array(over)
            for number in numpy.flatnonzero(over):
                self._worlds[number].begin()
                self._read(number)
        infos.update(self._infos())
        return (self._shaped(self._observations.copy()), self._shaped(numpy.array(all_rewards, float)),
                self._shaped(numpy.array(all_terminations)), self._shaped(numpy.array(all_truncations)), infos)

    def _read(self, number: int) -> None:
        for place, robot in enumerate(self._worlds[number].agents):
            self._observations[number, place] = self._observe(robot)

    def _shaped(self, array: Array) -> Array:
        """Without the axis of robots if there is one of them."""
        return array if self._inner else array[:, 0]

    def _infos(self) -> Dict[str, Any]:
        return {"tick": numpy.array([world.tick.number for world in self._worlds])}

    def close(self) -> None:
        for world in self._worlds:
            world.close()
        self._worlds = []
        self._context.term()

    def __enter__(self) -> "VectorEnv":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()


def _repeated(space: Box, shape: Sequence[int]) -> Box:
    shape = (*shape, *space.shape)
    return Box(numpy.broadcast_to(space.low, shape), numpy.broadcast_to(space.high, shape), shape, space.dtype)
