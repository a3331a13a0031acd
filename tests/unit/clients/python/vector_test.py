# SPDX-License-Identifier: MIT
"""Many worlds at once, against real servers. Skipped without numpy, which is optional."""

import os
import pathlib
import tempfile
import unittest

try:
    import numpy
except ImportError:
    numpy = None

import ziggurat

ROOT = pathlib.Path(__file__).resolve().parents[4]
PROGRAM = os.environ["ZIGGURAT"]
VEHICLE = str(ROOT / "scenes" / "dynamics3d_multi_body_test.argos")
AVOID = str(ROOT / "clients" / "python" / "examples" / "avoid.argos")


@unittest.skipIf(numpy is None, "numpy is not installed")
class Spaces(unittest.TestCase):
    def test_a_box_holds_what_it_samples(self):
        from ziggurat.spaces import Box
        for box in (Box(-1, 2, (3, 2)), Box([0, -numpy.inf], [1, numpy.inf]), Box(-numpy.inf, 0, (2,))):
            box.seed(1)
            first = box.sample()
            self.assertIn(first, box)
            self.assertEqual(first.shape, box.shape)
            box.seed(1)
            self.assertTrue((box.sample() == first).all())
        self.assertNotIn(numpy.full((3, 2), 3.0), Box(-1, 2, (3, 2)))
        self.assertNotIn(numpy.zeros(3), Box(-1, 2, (3, 2)))
        self.assertEqual(Box(-1, 1, (2,)), Box([-1, -1], [1, 1]))
        with self.assertRaises(ValueError):
            Box(1, -1, (2,))


@unittest.skipIf(numpy is None, "numpy is not installed")
class Vector(unittest.TestCase):
    def make(self, scene, n, **options):
        os.chdir(ROOT)
        env = ziggurat.vector_env(scene, n, command=PROGRAM, **options)
        self.addCleanup(env.close)
        return env

    def refused(self, scene, why):
        """No server is left of worlds that could not begin."""
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "bad.argos"
            path.write_text(scene)
            for make in (lambda: ziggurat.vector_env(str(path), 2, command=PROGRAM),
                         lambda: ziggurat.parallel_env(str(path), command=PROGRAM).reset()):
                with self.assertRaisesRegex((RuntimeError, ziggurat.Refused), why):
                    make()
            arguments = [file.read_bytes() for file in pathlib.Path("/proc").glob("[0-9]*/cmdline")]
            self.assertFalse([each for each in arguments if str(path).encode() in each])

    def test_a_faulty_scene_is_told_and_leaves_no_server(self):
        self.refused("<argos-configuration/>", "lacks the element <arena>")

    def test_a_scene_without_robots_leaves_no_server(self):
        self.refused("""<argos-configuration>
            <framework><experiment length="0" ticks_per_second="10" random_seed="1"/></framework><controllers/>
            <arena size="4,4,2"/><physics_engines><dynamics3d id="d"/></physics_engines><media/>
            </argos-configuration>""", "no robots")

    def test_each_world_is_the_one_that_it_would_be_alone(self):
        env = self.make(VEHICLE, 3, reward=lambda robot: robot.joints[0].encoder)
        observations, infos = env.reset(seed=5)
        self.assertIn(observations, env.observation_space)
        self.assertEqual(observations.shape, (3, *env.single_observation_space.shape))
        self.assertEqual(env.action_space.shape, (3, 4))
        self.assertEqual(infos["tick"].tolist(), [0, 0, 0])
        actions = numpy.array([[0.5] * 4, [1.0] * 4, [-1.0] * 4])
        for _ in range(5):
            observations, rewards, terminations, truncations, infos = env.step(actions)
        self.assertEqual(infos["tick"].tolist(), [5, 5, 5])
        self.assertTrue((rewards == observations[:, 0]).all())
        self.assertFalse(terminations.any() or truncations.any())
        for number, action in enumerate(actions):
            alone = ziggurat.parallel_env(VEHICLE, command=PROGRAM)
            alone.reset(seed=5 + number)
            for _ in range(5):
                seen, *_ = alone.step({"vehicle": action})
            alone.close()
            self.assertEqual(seen["vehicle"], observations[number].tolist())

    def test_a_snapshot_of_all_worlds_has_exact_futures(self):
        env = self.make(VEHICLE, 2)
        env.reset(seed=3)
        random = numpy.random.default_rng(1)
        actions = random.uniform(-1, 1, (8, *env.action_space.shape))
        for action in actions[:4]:
            env.step(action)
        moment = env.snapshot()
        self.assertEqual(moment.ticks, (4, 4))
        futures = []
        for _ in range(3):
            env.reset(options={"snapshot": moment})
            futures.append(numpy.array([env.step(action)[0] for action in actions[4:]]))
        self.assertTrue((futures[0] == futures[1]).all() and (futures[0] == futures[2]).all())
        _, infos = env.reset(options={"snapshot": moment, "mask": [True, False]})
        self.assertEqual(infos["tick"].tolist(), [4, 8])

    def test_seeds_may_be_of_numpy(self):
        env = self.make(VEHICLE, 2)
        seeds = []
        for seed in (7, numpy.int64(7), numpy.arange(7, 9, dtype=numpy.uint32), [7, numpy.int32(8)]):
            env.reset(seed=seed)
            seeds.append([each.status().seed for each in env.supervisors()])
        self.assertEqual(seeds, [[7, 8]] * 4)
        with self.assertRaises(TypeError):
            env.reset(seed=1.5)

    def test_the_server_keeps_one_begin(self):
        with tempfile.TemporaryDirectory() as folder:
            env = self.make(VEHICLE, 1, arguments=["--snapshot-folder", folder])
            for seed in (1, 2, 3, 1, None):
                env.reset(seed=seed)
                env.step(numpy.full(env.action_space.shape, 0.5))
            self.assertEqual(len(os.listdir(folder)), 1)
            env.snapshot()
            self.assertEqual(len(os.listdir(folder)), 2)

    def test_episodes_end_and_begin_again(self):
        env = self.make(VEHICLE, 2, max_ticks=3)
        first, _ = env.reset()
        for tick in range(1, 8):
            observations, _, _, truncations, infos = env.step(numpy.full(env.action_space.shape, 0.7))
            is_last = tick % 3 == 0
            self.assertEqual(truncations.tolist(), [is_last] * 2)
            self.assertEqual("final_observation" in infos, is_last)
            self.assertEqual(infos["tick"].tolist(), [tick % 3] * 2)
            if is_last:
                self.assertTrue((observations == first).all())
                self.assertFalse((infos["final_observation"] == first).all())

    def test_a_robot_with_wheels(self):
        env = self.make(AVOID, 1)
        self.assertEqual(env.single_action_space.shape, (2,))
        self.assertEqual(env.single_observation_space.shape, (24,))
        observations, _ = env.reset()
        for _ in range(100):
            observations, *_ = env.step([[0.3, 0.3]])
        self.assertGreater(observations.max(), 0, "it is near a box")

    def test_what_is_wrong_is_told(self):
        with self.assertRaisesRegex(ValueError, "n is 0"):
            self.make(VEHICLE, 0)
        env = self.make(VEHICLE, 1)
        with self.assertRaisesRegex(ValueError, r"shape \(4,\), not \(1, 4\)"):
            env.step([0, 0, 0, 0])
        with self.assertRaisesRegex(ValueError, "2 seeds for 1 worlds"):
            env.reset(seed=[1, 2])


if __name__ == "__main__":
    unittest.main()
