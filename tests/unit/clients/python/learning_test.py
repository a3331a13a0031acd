# SPDX-License-Identifier: MIT
"""Episodes, seeds and spaces of both environments, against real servers. Skipped without numpy, which is optional."""

import os
import pathlib
import shutil
import tempfile
import time
import unittest
import warnings

try:
    import numpy
except ImportError:
    numpy = None

import ziggurat

ROOT = pathlib.Path(__file__).resolve().parents[4]
PROGRAM = os.environ["ZIGGURAT"]
AVOID = str(ROOT / "clients" / "python" / "examples" / "avoid.argos")
ARMS = str(ROOT / "conformance" / "scene" / "conformance.argos")
DIRECTOR = '<director id="judge" script="judge.lua"/>'


@unittest.skipIf(numpy is None, "numpy is not installed")
class Learning(unittest.TestCase):
    def parallel(self, scene, **options):
        env = ziggurat.parallel_env(scene, command=PROGRAM, **options)
        self.addCleanup(env.close)
        return env

    def vector(self, scene, n, **options):
        env = ziggurat.vector_env(scene, n, command=PROGRAM, **options)
        self.addCleanup(env.close)
        return env

    def changed(self, scene, old, new):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        text = pathlib.Path(scene).read_text()
        self.assertIn(old, text)
        path = pathlib.Path(folder.name, "changed.argos")
        path.write_text(text.replace(old, new, 1))
        shutil.copy(pathlib.Path(scene).with_name("idle.lua"), folder.name)
        return str(path)

    @staticmethod
    def seed_of(env):
        return env._world.supervisor.status().seed

    def test_spaces_are_known_before_the_first_reset(self):
        env = self.parallel(AVOID)
        self.assertEqual(env.possible_agents, ["fb"])
        self.assertEqual(env.action_space("fb").shape, (2,), "the wheels")
        self.assertEqual(env.observation_space("fb").shape, (24,))
        observations, _ = env.reset()
        self.assertIn(observations["fb"], env.observation_space("fb"))
        for _ in range(100):
            observations, *_ = env.step({"fb": [0.3, 0.3]})
        self.assertGreater(max(observations["fb"]), 0, "it has driven to a box")
        with self.assertRaises(KeyError):
            env.action_space("nobody")

    def test_spaces_of_an_observation_of_another_kind_are_asked_for(self):
        env = self.parallel(ARMS, observe=lambda robot: {"x": 1})
        with self.assertRaisesRegex(ValueError, "dict and no array.*observation_spaces"):
            env.observation_space("arm0")

    def test_some_of_the_robots_act_and_the_others_do_nothing(self):
        env = self.parallel(ARMS, robots="arm[12]", arguments=["--duration", "0"])
        env.reset()
        self.assertEqual(env.possible_agents, ["arm1", "arm2"])
        self.assertEqual(set(env.step({"arm1": [1]})[0]), {"arm1", "arm2"})
        with self.assertRaisesRegex(ValueError, "no robot with such an id; it has arm0"):
            self.parallel(ARMS, robots="leg*").reset()

    def test_resets_without_a_seed_go_on_in_the_stream_of_the_last_one(self):
        env = self.parallel(ARMS, arguments=["--duration", "0"])
        seeds = []
        for seed in (7, None, None, 7, None, None, 8, None):
            _, infos = env.reset(seed=seed)
            self.assertEqual(infos["arm0"]["tick"], 0)
            seeds.append(self.seed_of(env))
        self.assertEqual(seeds[:3], seeds[3:6])
        self.assertEqual((seeds[0], seeds[6]), (7, 8))
        self.assertEqual(len(set(seeds)), 5)

    def test_also_by_itself_after_the_end(self):
        env = self.parallel(ARMS, arguments=["--ticks", "2"])
        seeds = []
        env.reset(seed=7)
        for _ in range(2):
            while env.agents:
                env.step({})
            env.reset()
            seeds.append(self.seed_of(env))
        other = self.vector(ARMS, 2, max_ticks=2)
        other.reset(seed=7)
        actions = numpy.zeros(other.action_space.shape)
        seen = []
        for _ in range(4):
            other.step(actions)
            seen.append([each.status().seed for each in other.supervisors()])
        self.assertEqual([each[0] for each in seen], [7, seeds[0], seeds[0], seeds[1]])
        self.assertEqual([each[1] for each in seen][0], 8)
        self.assertEqual(len({each[1] for each in seen}), 3)

    def test_worlds_without_a_seed_are_different(self):
        env = self.vector(ARMS, 3)
        env.reset()
        seeds = [each.status().seed for each in env.supervisors()]
        self.assertEqual(seeds, [seeds[0], seeds[0] + 1, seeds[0] + 2])

    def test_randomize_changes_the_world_of_each_episode(self):
        places = []

        def randomize(world, rng):
            places.append(tuple(rng.uniform(0.5, 1, 2)))
            world.move("arm0", (*places[-1], 0))

        env = self.parallel(ARMS, randomize=randomize, max_ticks=2, arguments=["--duration", "0"])
        for seed in (5, None, 5):
            _, infos = env.reset(seed=seed)
            self.assertEqual(infos["arm0"]["tick"], 1)
            found = env._world.supervisor.read("arm0")["arm0"].position
            self.assertAlmostEqual(found[0], places[-1][0], places=6)
            self.assertAlmostEqual(found[1], places[-1][1], places=6)
            self.assertFalse(any(env.step({})[3].values()))
            self.assertTrue(all(env.step({})[3].values()), "two ticks are an episode")
        self.assertEqual(places[0], places[2])
        self.assertNotEqual(places[0], places[1])
        env = self.vector(ARMS, 2, randomize=randomize)
        env.reset(seed=5)
        self.assertEqual(places[3], places[0])
        env.reset(seed=5)  # by a snapshot of the changed world
        self.assertEqual(len(places), 5)
        found = env.supervisors()[0].read("arm0")["arm0"].position
        self.assertAlmostEqual(found[0], places[0][0], places=6)

    def test_joints_are_set_at_the_beginning_of_an_episode(self):
        angles = []

        def randomize(world, rng):
            angles.append(rng.uniform(-3, 3))
            world.set_joint("arm0", "hinge", angles[-1], velocity=2)

        env = self.parallel(ARMS, randomize=randomize, robots="arm0", arguments=["--duration", "0"])
        for seed in (0, 5, None):
            env.reset(seed=seed)
            found = env._robot("arm0").joints["hinge"].position
            # A motor stops the hand of 8e-5 kg m^2 in the first substep, by at most 0.01 N m s.
            self.assertAlmostEqual(found, angles[-1], delta=2 * 0.05 + 1e-9)
        worlds = self.vector(ARMS, 2, randomize=randomize, robots="arm0")
        observations, _ = worlds.reset(seed=0)
        self.assertEqual(angles[3], angles[0])
        for world in (0, 1):
            self.assertLess(min(abs(observations[world] - angles[3 + world])), 0.1 + 1e-9, "the encoder's")
        with self.assertRaisesRegex(ziggurat.ProtocolError, "UNKNOWN_ENTITY.*write one of 'hinge'"):
            worlds.supervisors()[0].set_joint("arm0", "knee", 0)

    def test_a_seed_of_0_begins_an_episode_as_any_other(self):
        """No world has it: 0 in a scene or in --seed is one that is drawn."""
        env = self.parallel(ARMS, arguments=["--ticks", "2"])
        seeds = []
        for seed in (0, None, 0):
            env.reset(seed=seed)
            seeds.append(self.seed_of(env))
            while env.agents:  # the next reset starts another server
                env.step({})
        self.assertEqual((seeds[0], seeds[2]), (2 ** 53 - 1, 2 ** 53 - 1))
        self.assertNotEqual(seeds[1], seeds[0])
        worlds = self.vector(ARMS, 2)
        for _ in range(2):
            worlds.reset(seed=0)
            self.assertEqual([each.status().seed for each in worlds.supervisors()], [2 ** 53 - 1, 1])
            worlds.step(numpy.zeros(worlds.action_space.shape))

    def test_an_empty_observation_is_told(self):
        env = self.parallel(ARMS, observe=lambda robot: [])
        with self.assertWarnsRegex(UserWarning, "observation of robot 'arm0' is empty"):
            env.reset()
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.parallel(ARMS).reset()

    def quickly(self, make, kind, told):
        began = time.monotonic()
        with self.assertRaisesRegex(kind, told) as caught:
            make()
        self.assertLess(time.monotonic() - began, 5)
        error = caught.exception
        self.assertTrue(error.__cause__ is None and (error.__context__ is None or error.__suppress_context__))

    def test_a_fault_of_the_scene_is_told_at_once(self):
        scene = self.changed(ARMS, 'id="arm1"', 'id="arm0"')
        for make in (lambda: self.vector(scene, 2), lambda: self.parallel(scene).reset()):
            self.quickly(make, RuntimeError, r"^ziggurat serve has ended: .*changed.argos:\d+:\d+: .*arm0")

    def with_director(self, element, script=""):
        scene = self.changed(ARMS, "</framework>", "</framework>" + element)
        pathlib.Path(scene).with_name("judge.lua").write_text(script)
        return scene

    def test_directors_of_the_scene_are_started(self):
        """This one moves the first arm at each tick, and ends each episode in place of tick 4."""
        scene = self.with_director(DIRECTOR, """
            function post_step(tick)
              world.move("arm0", {x = 1, y = tick / 10, z = 0})
              if tick == 3 then world.finish("enough") end
            end""")

        def place(robot):
            return robot.pose.position if robot.pose else (0, 0, 0)

        env = self.parallel(scene, observe=place)
        worlds = self.vector(scene, 2, robots="arm0", observe=place)
        for seed in (4, 4, 5, None):
            observations, _ = env.reset(seed=seed)
            for _ in range(4):
                observations, _, _, truncations, _ = env.step({})
            self.assertAlmostEqual(observations["arm0"][1], 0.2, places=6)
            self.assertTrue(truncations["arm0"])
            self.assertEqual(env.agents, [])
            worlds.reset(seed=seed)
            over = [worlds.step(numpy.zeros(worlds.action_space.shape))[3].tolist() for _ in range(4)]
            self.assertEqual(over, [[False] * 2] * 3 + [[True] * 2])

    def test_a_world_with_a_lua_director_is_built_again_for_the_same_seed(self):
        scene = self.with_director(DIRECTOR, "function post_step(tick) end")
        worlds = self.vector(scene, 1, robots="arm0")
        for _ in range(3):
            _, infos = worlds.reset(seed=6)
            self.assertEqual(infos["tick"].tolist(), [0])
            self.assertEqual(worlds.supervisors()[0].status().seed, 6)
            worlds.step(numpy.zeros(worlds.action_space.shape))

    def test_a_director_that_nothing_can_start_is_told_at_once(self):
        scene = self.with_director('<director id="judge"/>')
        for make in (lambda: self.vector(scene, 1), lambda: self.parallel(scene).reset()):
            self.quickly(make, RuntimeError, r"changed.argos:\d+:\d+: director 'judge' has no program that can be started; write script=")


if __name__ == "__main__":
    unittest.main()
