# SPDX-License-Identifier: MIT
"""The environment for learning, attached to a server with a supervisor: against a fake one."""

import unittest

import ziggurat
from ziggurat import protocol_pb2 as v1

from fake_server import equipped, welcome
from session_case import SessionCase


class Parallel(SessionCase):
    def test_reset_asks_the_supervisor(self):
        def part(server):
            server.receive()
            server.send(welcome=welcome(equipped("one"), equipped("two")))
            controller = server.peer
            server.observe(0)
            command = server.receive()
            self.assertEqual(list(command.joint_targets), [1, 2, 0, 0])
            self.assertEqual(list(command.wheel_velocities), [3, 4, 0, 0])
            server.observe(1, joint_readings=[1, 2, 3, 4])
            self.assertEqual(server.receive().role, v1.ROLE_SUPERVISOR)
            server.send(welcome=welcome(role=v1.ROLE_SUPERVISOR))
            request, supervisor = server.receive(), server.peer
            self.assertEqual(request.reset.seed, 5)
            server.peer = controller
            server.send(reset=v1.Reset(seed=5))
            server.observe(0)
            server.peer = supervisor
            server.send(response=v1.Response(id=request.id))
            command = server.receive()
            self.assertEqual((command.tick, list(command.joint_targets)), (0, []))
            server.send(end=v1.End(reason=v1.End.FINISHED))

        def client():
            env = ziggurat.parallel_env(
                endpoint=self.server.endpoint, reward=lambda robot: robot.joints["arm"].encoder,
                terminated=lambda robot: robot.id == "two",
                observe=lambda robot: robot.joints["left"].encoder)
            self.addCleanup(env.close)
            observations, infos = env.reset()
            self.assertEqual(observations, {"one": 0, "two": 0})
            self.assertEqual(infos["one"]["tick"], 0)
            observations, rewards, terminations, truncations, _ = env.step({"one": [1, 2, 3, 4]})
            self.assertEqual(observations, {"one": 1, "two": 3})
            self.assertEqual(rewards, {"one": 2, "two": 4})
            self.assertEqual(terminations, {"one": False, "two": True})
            self.assertEqual(truncations, {"one": False, "two": False})
            self.assertEqual(env.agents, ["one"])
            self.assertEqual(env.reset(seed=5)[0], {"one": 0, "two": 0})
            self.assertEqual(env.agents, ["one", "two"])
            self.assertEqual(env.possible_agents, ["one", "two"])
            with self.assertRaises(ValueError):
                env.step({"one": [1]})
            result = env.step({})
            self.assertEqual(result[3], {"one": True, "two": True}, "the run is over")
            self.assertEqual(env.agents, [])
            with self.assertRaisesRegex(RuntimeError, "ended"):
                env.reset()

        self.play(part, client)

    def test_all_readings(self):
        def part(server):
            server.receive()
            server.send(welcome=welcome(equipped("one")))
            server.observe(1, joint_readings=[1, 2], proximity=[3, 4], positioning=range(7),
                           batteries=[0.5, 9], wheels=[5, 6, 7, 8], turret_rotations=[9], imus=range(6),
                           contact_sensors=[1, 2, 3, 4, 5])

        def client():
            env = ziggurat.parallel_env(endpoint=self.server.endpoint)
            self.addCleanup(env.close)
            observations, _ = env.reset()
            self.assertEqual(observations["one"], [1, 2, 3, 4, 0, 1, 2, 3, 4, 5, 6, 0.5,
                                                   0, 1, 2, 3, 4, 5, 1, 2, 3, 4, 5, 5, 6, 7, 8, 9])

        self.play(part, client)

    def test_one_of_scene_and_endpoint(self):
        with self.assertRaises(ValueError):
            ziggurat.parallel_env()
        with self.assertRaises(ValueError):
            ziggurat.parallel_env("scene", endpoint="tcp://127.0.0.1:1")


if __name__ == "__main__":
    unittest.main()
