# SPDX-License-Identifier: MIT
"""Sessions whose connection is lost, against a fake server."""

import os
import unittest

import ziggurat
from ziggurat import protocol_pb2 as v1

from fake_server import equipped, welcome
from session_case import SessionCase, open_with

_UNKNOWN = v1.Error(code=v1.Error.OUT_OF_STATE, severity=v1.Error.FATAL)


class Resuming(SessionCase):
    def test_a_lost_answer_is_sent_again_and_no_tick_comes_twice(self):
        def part(server):
            open_with(server)
            server.observe(3)
            first = server.receive()
            server.send(error=_UNKNOWN)
            self.assertEqual(open_with(server).session_token, b"token")
            server.observe(3)
            self.assertEqual(server.receive(), first)
            server.observe(4)
            command = server.receive()
            self.assertEqual((command.tick, list(command.joint_targets)), (4, [5, 0]))
            server.send(end=v1.End(reason=v1.End.FINISHED, tick=4))
            server.receive()

        def client():
            session = self.connect()
            next(session)
            session.robots[0].joints["left"].target = 5
            session.robots[0].log("once")
            self.assertEqual((next(session).number, session.resumed), (4, 1))
            self.assertRaises(StopIteration, next, session)
            session.close()

        self.play(part, client)

    def test_a_reset_meanwhile_is_told_as_one(self):
        def part(server):
            open_with(server)
            server.observe(3)
            server.receive()
            server.send(error=_UNKNOWN)
            open_with(server)
            server.observe(1)
            self.assertEqual(server.receive().tick, 1)
            server.observe(2)

        def client():
            session = self.connect()
            next(session)
            session.robots[0].joints["left"].target = 5
            tick = next(session)
            self.assertEqual((tick.number, tick.event), (1, ziggurat.Event.RESET))
            self.assertEqual(session.robots[0].joints["left"].target, 0)
            next(session)
            session.abandon()

        self.play(part, client)

    def test_leaves_are_told_again_unless_the_server_has_them(self):
        def part(server):
            open_with(server, equipped("one"), equipped("two"))
            server.observe(0)
            for _ in range(3):
                server.receive()
            server.send(error=_UNKNOWN)
            server.receive()
            server.send(welcome=welcome(equipped("one"), equipped("two"), resumed=v1.Resumed(gone_robots=[0])))
            self.assertEqual(list(server.receive().robots), [1])
            server.observe(0)
            self.assertEqual(server.receive().tick, 0)
            server.observe(1)

        def client():
            session = self.connect()
            next(session)
            for robot in session.robots:
                robot.leave()
            next(session)
            session.abandon()

        self.play(part, client)

    def test_a_session_that_is_over_is_an_error(self):
        def part(server):
            open_with(server)
            server.send(error=_UNKNOWN)
            server.receive()
            server.send(refusal=v1.Refusal(error=v1.Error(code=v1.Error.NO_SUCH_SESSION)))

        def client():
            session = self.connect()
            with self.assertRaises(ziggurat.Refused):
                next(session)
            with self.assertRaises(ziggurat.ConnectionLost):
                next(session)

        self.play(part, client)

    def test_the_token_in_the_environment_is_taken_once(self):
        os.environ.update(ZIGGURAT_ENDPOINT=self.server.endpoint, ZIGGURAT_SESSION_TOKEN="00ffa07a")
        self.addCleanup(os.environ.pop, "ZIGGURAT_ENDPOINT")

        def part(server):
            self.assertEqual(open_with(server).session_token, b"\0\xff\xa0z")

        self.play(part, lambda: ziggurat.connect().abandon())
        self.assertNotIn("ZIGGURAT_SESSION_TOKEN", os.environ)


if __name__ == "__main__":
    unittest.main()
