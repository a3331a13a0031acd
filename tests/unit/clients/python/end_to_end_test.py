"""The package against the real server, whose program is in ZIGGURAT."""

import os
import pathlib
import re
import signal
import subprocess
import sys
import threading
import unittest

import ziggurat

ROOT = pathlib.Path(__file__).resolve().parents[4]
PROGRAM = os.environ["ZIGGURAT"]
VEHICLE = ROOT / "scenes" / "dynamics3d_multi_body_test.argos"
DEVICES = ROOT / "scenes" / "devices_test.argos"


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

    def test_a_spawned_robot_is_controlled_until_it_is_removed(self):
        text = re.search(r'<prototype id="vehicle".*?</prototype>', VEHICLE.read_text(), re.DOTALL)[0]
        late = text.replace('id="vehicle"', 'id="late"').replace('position="0,0,0"',
                                                                 'position="0,3,0"', 1)
        self.assertNotEqual(late, text)
        driven = []

        def drive():
            with ziggurat.connect(server.endpoint, "late") as session:
                wheel = session.robots["late"].joints[0]
                for _ in session:
                    wheel.target = 1.0
                    driven.append(wheel.encoder)
                driven.append(session.ending.reason)

        with serve(VEHICLE) as server, ziggurat.supervise(server.endpoint) as world:
            with ziggurat.connect(server.endpoint, "vehicle") as session:
                for tick in session:
                    if tick.number == 3:
                        self.assertEqual(world.spawn(late), 3)
                        with self.assertRaisesRegex(ziggurat.ProtocolError, "BAD_VALUE"):
                            world.spawn(late)
                        thread = threading.Thread(target=drive)
                        thread.start()
                    if tick.number == 30:
                        world.remove("late")
                        thread.join(60)
                        self.assertFalse(thread.is_alive())
                    if tick.number == 40:
                        break
        self.assertAlmostEqual(driven[-2], 1.0, delta=0.05)
        self.assertEqual(driven[-1], "finished")

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

    def test_devices(self):
        with serve(DEVICES, "--ticks", "20") as server:
            with ziggurat.connect(server.endpoint) as session:
                robots = list(session.robots)
                for _ in session:
                    for robot in robots:
                        for led in (*robot.leds, *robot.directional_leds):
                            led.color = (0, 0, 255)
                        for radio in robot.radios:
                            if radio.sends:
                                radio.send(b"hello")
                        if robot.range_and_bearing is not None and robot.range_and_bearing.sends:
                            size = robot.range_and_bearing.data_size
                            robot.range_and_bearing.data = bytes(range(size))
                poses = [robot.pose for robot in robots if robot.pose is not None]
                self.assertTrue(poses)
                for pose in poses:
                    self.assertAlmostEqual(sum(part ** 2 for part in pose.orientation), 1)
            self.assertEqual(server.wait(60), 0)

    def test_the_camera_example(self):
        example = ROOT / "clients" / "python" / "examples" / "camera.py"
        with serve(ROOT / "conformance" / "scene" / "conformance.argos", "--ticks", "2") as server:
            subprocess.run([sys.executable, example, server.endpoint], check=True, timeout=60)
            output, _ = server.process.communicate(timeout=60)
        # Each arm's eye looks at the lit lamp on the same arm.
        for robot in ("arm0", "arm1", "arm2", "arm3"):
            self.assertRegex(output, rf"\[2 {robot}\] eye: LED \(255, 0, 0\) at 320\.0, ")

    def test_a_lost_session_is_resumed_at_the_same_tick(self):
        with serve(VEHICLE, "--ticks", "10") as server:
            session = ziggurat.connect(server.endpoint)
            for tick in session:
                if tick.number == 4:
                    break
            session.abandon()
            with ziggurat.resume(server.endpoint, session.token) as again:
                numbers = [tick.number for tick in again]
            self.assertEqual(numbers, list(range(4, 11)))
            self.assertEqual(server.wait(60), 0)

    def test_a_killed_server_is_detected(self):
        with serve(VEHICLE) as server:
            session = ziggurat.connect(server.endpoint)
            next(session)
            server.process.send_signal(signal.SIGKILL)
            with self.assertRaises(ziggurat.ConnectionLost):
                for _ in session:
                    pass

    def test_a_robot_that_is_taken(self):
        with serve(VEHICLE) as server:
            with ziggurat.connect(server.endpoint, name="first"):
                with self.assertRaises(ziggurat.Refused) as caught:
                    ziggurat.connect(server.endpoint)
                self.assertEqual(caught.exception.code, "ROBOT_TAKEN")
                self.assertEqual(caught.exception.holder, "first")

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
