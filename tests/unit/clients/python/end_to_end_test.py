# SPDX-License-Identifier: MIT
"""The package against the real server, whose program is in ZIGGURAT."""

import os
import pathlib
import subprocess
import sys
import unittest

import ziggurat

ROOT = pathlib.Path(__file__).resolve().parents[4]
PROGRAM = os.environ["ZIGGURAT"]
VEHICLE = ROOT / "scenes" / "dynamics3d_multi_body_test.argos"


def serve(scene, *arguments):
    # Scripts stand in the scene relative to the root of the checkout.
    os.chdir(ROOT)
    return ziggurat.Server(scene, command=PROGRAM, arguments=arguments)


class EndToEnd(unittest.TestCase):
    def test_the_vehicle_moves_as_with_its_script(self):
        with serve(VEHICLE, "--ticks", "100") as server:
            with ziggurat.connect(server.endpoint) as session:
                wheels = list(session.robots["vehicle"].joints)
                for tick in session:
                    if tick.event is ziggurat.Event.INIT:
                        for wheel in wheels:
                            wheel.target = 1.0
                self.assertEqual(tick.number, 100)
                for wheel in wheels:
                    self.assertAlmostEqual(wheel.encoder, 1.0, delta=0.03)
            self.assertEqual(server.wait(60), 0)

    def test_the_example(self):
        example = ROOT / "clients" / "python" / "examples" / "vehicle.py"
        with serve(VEHICLE, "--ticks", "20") as server:
            subprocess.run([sys.executable, example, server.endpoint], check=True, timeout=60)
            self.assertEqual(server.wait(60), 0)

    def test_the_json_client(self):
        controller = ROOT / "clients" / "json" / "controller.py"
        with serve(VEHICLE, "--ticks", "20") as server:
            subprocess.run([sys.executable, controller, server.endpoint], check=True, timeout=60)
            output, _ = server.process.communicate(timeout=60)
            self.assertEqual(server.process.returncode, 0)
        lines = [line for line in output.splitlines() if line.startswith("[")]
        self.assertEqual(len(lines), 20, output)
        self.assertRegex(lines[-1], r"^\[20 vehicle\] (0\.9[89]|1\.0[0-2])$")

    def test_the_camera_example(self):
        example = ROOT / "clients" / "python" / "examples" / "camera.py"
        with serve(ROOT / "conformance" / "scene" / "conformance.argos", "--ticks", "2") as server:
            subprocess.run([sys.executable, example, server.endpoint], check=True, timeout=60)
            output, _ = server.process.communicate(timeout=60)
        # Each arm's eye looks at the lit lamp on the same arm.
        for robot in ("arm0", "arm1", "arm2", "arm3"):
            self.assertRegex(output, rf"\[2 {robot}\] eye: LED \(255, 0, 0\) at 320\.0, ")

    def test_an_environment_for_learning(self):
        os.chdir(ROOT)
        env = ziggurat.parallel_env(str(VEHICLE), command=PROGRAM, max_ticks=5,
                                    reward=lambda robot: robot.joints[0].encoder)
        self.addCleanup(env.close)
        episodes = []
        for _ in range(2):
            observations, infos = env.reset(seed=3)
            self.assertEqual(env.agents, ["vehicle"])
            self.assertEqual(infos, {"vehicle": {"tick": 0}})
            episode = [observations["vehicle"]]
            while env.agents:
                result = env.step({agent: [1.0] * 4 for agent in env.agents})
                observations, rewards, terminations, truncations, _ = result
                episode.append(observations["vehicle"])
                self.assertFalse(terminations["vehicle"])
                self.assertEqual(rewards["vehicle"], observations["vehicle"][0])
            self.assertTrue(truncations["vehicle"])
            self.assertEqual(len(episode), 6)
            self.assertGreater(rewards["vehicle"], 0.5)
            episodes.append(episode)
        self.assertEqual(episodes[0], episodes[1], "a reset world is a fresh one")
        self.assertEqual(env.session.seed, 3)

    def test_a_hundred_futures_from_one_moment(self):
        os.chdir(ROOT)
        env = ziggurat.parallel_env(str(VEHICLE), command=PROGRAM, arguments=["--duration", "0"])
        self.addCleanup(env.close)
        env.reset(seed=3)
        for _ in range(4):
            env.step({"vehicle": [1.0, 1.0, 0.5, 0.5]})
        moment = env.snapshot()
        self.assertEqual(moment.tick, 4)

        def future(speed):
            states = []
            for _ in range(3):
                observations, *_, infos = env.step({"vehicle": [speed] * 4})
                states.append((infos["vehicle"]["tick"], observations["vehicle"]))
            with ziggurat.Supervisor(env.session.endpoint) as world:
                return states, world.read().hash

        first = future(0.25)
        different = set()
        for number in range(100):
            observations, infos = env.reset(options={"snapshot": moment})
            self.assertEqual(infos["vehicle"]["tick"], 4)
            self.assertEqual(env.agents, ["vehicle"])
            if number % 10 == 0:
                self.assertEqual(future(0.25), first, f"future {number} is the one that was")
            else:
                states, _ = future(0.01 * number)
                different.add(states[-1][1][0])
        self.assertGreater(len(different), 80)
        env.reset(seed=3)
        self.assertEqual(env.session.tick.number, 0)


if __name__ == "__main__":
    unittest.main()
