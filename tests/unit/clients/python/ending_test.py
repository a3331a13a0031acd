# SPDX-License-Identifier: MIT
"""The end of a session: leaving, errors, a lost connection; against a fake server."""

import unittest

import zmq

import ziggurat
from ziggurat import protocol_pb2 as v1

from fake_server import equipped, welcome
from session_case import SessionCase, open_with


class Leaving(SessionCase):
    def test_a_context_of_several_sessions_stays_and_the_leave_is_sent(self):
        def part(server):
            open_with(server)
            server.observe(0)
            self.assertEqual(server.receive().reason, v1.Leave.DONE)

        def client():
            with zmq.Context() as context:
                with self.connect(context=context) as session:
                    next(session)
                self.assertFalse(context.closed)

        self.play(part, client)

    def test_use_of_a_device_that_is_not_there_tells_what_the_robot_has(self):
        def part(server):
            open_with(server, v1.RobotDescription(id="bare", joint_sensors=[v1.JointDescription(id="arm")]))
            server.observe(0)
            self.assertRegex(server.receive().message,
                             r"AttributeError: .*robot 'bare' has no .*wheels.*; it has: joints\)$")

        def client():
            with self.assertRaises(AttributeError):
                with self.connect() as session:
                    next(session)
                    session.robots["bare"].wheels.left = 1

        self.play(part, client)

    def test_a_misspelt_attribute_is_not_one_of_a_device_that_is_not_there(self):
        def part(server):
            open_with(server)
            server.observe(0)
            self.assertNotIn("it has", server.receive().message)

        def client():
            with self.assertRaises(AttributeError):
                with self.connect() as session:
                    next(session)
                    session.robots[0].joints["left"].taget = 1

        self.play(part, client)

    def test_an_exception_leaves_as_failed(self):
        def part(server):
            open_with(server)
            server.observe(0)
            leave = server.receive()
            self.assertEqual(leave.reason, v1.Leave.FAILED)
            self.assertEqual(leave.message, "ZeroDivisionError: division by zero")

        def client():
            with self.assertRaises(ZeroDivisionError):
                with self.connect() as session:
                    next(session)
                    1 / 0

        self.play(part, client)

    def test_a_robot_fails_and_the_others_continue(self):
        def part(server):
            open_with(server, equipped("one"), equipped("two"))
            server.observe(0)
            leave = server.receive()
            self.assertEqual(list(leave.robots), [1])
            self.assertEqual(leave.message, "oh")
            self.assertEqual([line.text for line in leave.log], ["before"])
            command = server.receive()
            self.assertEqual([(line.robot, line.text, line.error) for line in command.log],
                             [(0, "fine", True)])
            self.assertEqual(len(command.joint_targets), 4, "those that left keep their place")
            server.send(end=v1.End())

        def client():
            session = self.connect()
            for _ in session:
                session.robots["one"].log("fine", error=True)
                session.robots["two"].log("before")
                session.robots["one"].joints["left"].target = 1
                session.robots["two"].fail("oh")
                session.robots["two"].leave()  # it has already
            self.assertTrue(session.robots["two"].gone)
            session.close()
            session.close()

        self.play(part, client)


class Losing(SessionCase):
    def test_a_closed_connection_is_detected(self):
        def part(server):
            open_with(server)
            server.observe(0)
            server.receive()
            server.close()

        def client():
            session = ziggurat.connect(self.server.endpoint, resume_timeout=0)  # by default 10 s are spent on trying
            next(session)
            with self.assertRaises(ziggurat.ConnectionLost):
                next(session)
            with self.assertRaises(ziggurat.ConnectionLost):
                next(session)

        self.play(part, client)

    def test_silence_is_a_timeout(self):
        def client():
            session = ziggurat.connect(self.server.endpoint, wait_timeout=0.05)
            with self.assertRaises(ziggurat.Timeout):
                next(session)
            session.abandon()

        self.play(open_with, client)

    def test_a_resumed_one_begins_with_what_was_commanded(self):
        def part(server):
            hello = server.receive()
            robots = [v1.RobotDescription(id=one, joint_actuators=[v1.JointDescription(
                id="hinge", mode=v1.JointDescription.VELOCITY)]) for one in ("a", "b")]
            resumed = v1.Resumed(commanded=v1.Command(joint_targets=[3, 4]), gone_robots=[1, 9])
            server.send(welcome=welcome(*robots, resumed=resumed))
            self.assertEqual(hello.session_token, b"token")
            server.observe(5)
            self.assertEqual(list(server.receive().joint_targets), [7, 4])
            server.observe(6)

        def client():
            session = ziggurat.resume(self.server.endpoint, b"token", wait_timeout=60)
            self.assertEqual([r.joints["hinge"].target for r in session.robots], [3, 4])
            self.assertEqual([r.gone for r in session.robots], [False, True])
            tick = next(session)
            self.assertEqual((tick.number, tick.event), (5, ziggurat.Event.RESUME))
            session.robots["a"].joints["hinge"].target = 7
            self.assertEqual(next(session).event, ziggurat.Event.STEP)
            session.abandon()

        self.play(part, client)

    def test_dropped_and_spawned_robots(self):
        def part(server):
            open_with(server, equipped("one"), equipped("two"))
            server.send(error=v1.Error(code=v1.Error.ROBOTS_DROPPED, severity=v1.Error.WARNING,
                                       dropped=v1.Dropped(robots=[1])))
            server.send(robot_spawned=v1.RobotSpawned(robot="c", controller="swarm", tick=3))
            server.send(end=v1.End())

        def client():
            session = self.connect()
            self.assertEqual(list(session), [])
            self.assertEqual([r.gone for r in session.robots], [False, True])
            self.assertEqual(session.spawned, [ziggurat.SpawnedRobot("c", "swarm", 3)])
            session.abandon()

        self.play(part, client)

    def test_being_displaced(self):
        def part(server):
            open_with(server)
            server.send(displaced=v1.Displaced(by="usurper", message="Go."))

        def client():
            with self.assertRaisesRegex(ziggurat.Displaced, "usurper"):
                with self.connect() as session:
                    next(session)

        self.play(part, client)

    def test_a_fatal_error_ends_the_session(self):
        def part(server):
            open_with(server)
            server.send(error=v1.Error(code=v1.Error.TOO_MANY, severity=v1.Error.FATAL))

        def client():
            session = self.connect()
            with self.assertRaises(ziggurat.ProtocolError) as caught:
                next(session)
            self.assertTrue(caught.exception.is_fatal)
            with self.assertRaises(ziggurat.ConnectionLost):
                next(session)

        self.play(part, client)


if __name__ == "__main__":
    unittest.main()
