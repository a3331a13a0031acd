# SPDX-License-Identifier: MIT
"""The session: its beginning, refusals, ticks and events; against a fake server."""

import unittest

import zmq

import ziggurat
from ziggurat import protocol_pb2 as v1
from ziggurat.connection import Connection

from fake_server import welcome
from waiting import wait_until
from session_case import SessionCase, open_with


class Refused(unittest.TestCase):
    def test_the_sender_is_told(self):
        with zmq.Context() as context, context.socket(zmq.ROUTER) as server:
            server.curve_server = True
            server.curve_secretkey = zmq.curve_keypair()[1]
            port = server.bind_to_random_port("tcp://127.0.0.1")
            connection = Connection(f"tcp://127.0.0.1:{port}")
            self.addCleanup(connection.close)
            # What is sent before the refusal is known is queued.
            with self.assertRaisesRegex(ziggurat.ConnectionLost, "refused key.*this client has no keys"):
                wait_until(lambda: connection.send(v1.ClientMessage()), "the refusal")


class Beginning(SessionCase):
    def test_hello_has_the_options(self):
        def part(server):
            hello = open_with(server)
            self.assertEqual((hello.version.major, hello.version.minor), (1, 5))
            self.assertEqual(hello.role, v1.ROLE_CONTROLLER)
            self.assertEqual(list(hello.robots), ["a*", "b"])
            self.assertEqual(hello.controller, "some")
            self.assertEqual(hello.client_name, "me")
            self.assertTrue(hello.takeover)
            self.assertEqual(hello.deadline_policy.action, v1.DeadlinePolicy.HOLD)
            self.assertEqual(hello.deadline_policy.wall_deadline_ms, 20)
            self.assertEqual(hello.deadline_policy.miss_budget, 3)
            self.assertEqual(server.receive().reason, v1.Leave.DONE)

        def client():
            with self.connect(["a*", "b"], controller="some", name="me", takeover=True,
                              deadline=ziggurat.Deadline("hold", 20, 3)) as session:
                self.assertEqual(session.token, b"token")
                self.assertAlmostEqual(session.tick_seconds, 0.1)
                self.assertEqual(session.seed, 7)
                self.assertEqual(session.robots["one"].params, {"speed": "2"})

        self.play(part, client)

    def test_no_option_means_all_robots(self):
        def part(server):
            self.assertEqual(list(open_with(server).robots), ["*"])

        self.play(part, lambda: self.connect().abandon())

    def test_loading_is_waited_for(self):
        def part(server):
            server.receive()
            for progress in (0.1, 0.5):
                server.send(loading=v1.Loading(progress=progress))
            server.send(welcome=welcome())

        self.play(part, lambda: self.connect().abandon())

    def test_a_refusal_names_the_holder(self):
        def part(server):
            server.receive()
            error = v1.Error(code=v1.Error.ROBOT_TAKEN, severity=v1.Error.FATAL, retryable=True,
                             robot="one", message="Taken.")
            server.send(refusal=v1.Refusal(error=error, holder="other 1"))

        def client():
            with self.assertRaises(ziggurat.Refused) as caught:
                self.connect()
            self.assertEqual(caught.exception.code, "ROBOT_TAKEN")
            self.assertEqual(caught.exception.holder, "other 1")
            self.assertTrue(caught.exception.retryable)
            self.assertIn("one", str(caught.exception))

        self.play(part, client)

    def test_no_server(self):
        with self.assertRaises(ziggurat.ConnectionLost):
            ziggurat.connect("ipc://@no-server", connect_timeout=0.05)

    def test_an_invalid_endpoint(self):
        with self.assertRaises(ValueError):
            ziggurat.connect("nonsense")

    def test_an_unknown_host_is_told_as_such(self):
        """RFC 6761: no name that ends with .invalid has an address."""
        with self.assertRaisesRegex(ziggurat.ConnectionLost, "^tcp://nowhere.invalid:5555: no host of that name is known$"):
            ziggurat.connect("tcp://nowhere.invalid:5555", "*", connect_timeout=0.2)

    def test_an_endpoint_that_no_server_can_listen_at(self):
        keys = ziggurat.Curve(*(key.decode() for key in (*zmq.curve_keypair(), zmq.curve_keypair()[0])))
        for curve in (None, keys):
            for port in ("99999", "65536", "0", "-1", "", "http", "*", "1x", " 1", "9" * 5000):
                for host in ("localhost", "127.0.0.1", "[::1]", "127.0.0.1:0;127.0.0.1"):
                    with self.assertRaisesRegex(ValueError, "it must be a number from 1 to 65535"):
                        ziggurat.connect(f"tcp://{host}:{port}", connect_timeout=0.05, curve=curve)
            for other in ("tcp://", "tcp://:80", "tcp://host", "inproc://x", "ws://localhost:80"):
                with self.assertRaisesRegex(ValueError, "write ipc:///path or tcp://host:port"):
                    ziggurat.connect(other, connect_timeout=0.05, curve=curve)


class Ticks(SessionCase):
    def test_a_run(self):
        def part(server):
            open_with(server)
            for tick in range(3):
                server.observe(tick)
                self.assertEqual(server.receive().tick, tick)
            server.send(end=v1.End(reason=v1.End.FINISHED, tick=2))
            leave = server.receive()
            self.assertEqual(leave.reason, v1.Leave.DONE)
            self.assertEqual([line.text for line in leave.log], ["last words"])

        def client():
            with self.connect() as session:
                seen = [(tick.number, tick.event.value, round(tick.time, 9)) for tick in session]
                session.robots[0].log("last words\n")
                self.assertEqual(session.ending, ziggurat.Ending("finished", "", 2))
                self.assertIsNone(next(session, None))
            self.assertEqual(seen, [(0, "init", 0), (1, "step", 0.1), (2, "step", 0.2)])

        self.play(part, client)

    def test_messages_other_than_ticks_are_handled(self):
        def part(server):
            open_with(server)
            server.send(heartbeat=v1.Heartbeat(sequence=1))
            server.observe(4)
            server.receive()
            server.send(paused=v1.Paused(tick=4))
            server.socket.send_multipart([server.peer, b"\x9a\x06\x00"])  # an unknown kind, 99
            server.observe(5)
            self.assertEqual(server.receive().tick, 5, "heartbeats and pauses are not answered")
            server.send(end=v1.End(reason=v1.End.INTERRUPTED, message="enough", tick=5))

        def client():
            session = self.connect()
            self.assertEqual([tick.number for tick in session], [4, 5])
            self.assertEqual(session.ending.reason, "interrupted")
            self.assertEqual(session.ending.message, "enough")
            session.close()

        self.play(part, client)

    def test_values_are_sent_when_they_change(self):
        def part(server):
            open_with(server)
            server.observe(0)
            self.assertEqual(list(server.receive().joint_targets), [0.0, 2.5])
            server.observe(1)
            self.assertEqual(list(server.receive().joint_targets), [])
            server.observe(2)
            self.assertEqual(list(server.receive().joint_targets), [1.0, 2.5])
            server.send(error=v1.Error(code=v1.Error.DEADLINE_MISSED, severity=v1.Error.WARNING))
            server.observe(3)
            self.assertEqual(list(server.receive().joint_targets), [1.0, 2.5], "the last may be lost")
            server.send(end=v1.End())

        def client():
            session = self.connect()
            joints = session.robots[0].joints
            for tick in session:
                if tick.number == 0:
                    joints["right"].target = 2.5
                if tick.number == 2:
                    joints["left"].target = 1
            self.assertEqual(session.missed, 1)
            session.close()

        self.play(part, client)

    def test_reset_restores_the_commands(self):
        def part(server):
            open_with(server)
            server.observe(0)
            server.receive()
            server.observe(1)
            server.send(reset=v1.Reset(seed=7))  # what is owed is void
            server.observe(0)
            command = server.receive()
            self.assertEqual(command.tick, 1, "it was on its way")
            server.send(error=v1.Error(code=v1.Error.FUTURE_TICK, severity=v1.Error.DISCARD))
            command = server.receive()
            self.assertEqual(command.tick, 0)
            self.assertEqual(list(command.joint_targets), [])
            server.send(end=v1.End())

        def client():
            session = self.connect()
            robot, events = session.robots[0], []
            for tick in session:
                events.append(tick.event)
                if tick.event is ziggurat.Event.RESET:
                    self.assertEqual(robot.joints["left"].target, 0)
                    self.assertEqual(robot.leds["a"].color, (255, 0, 0))
                else:
                    robot.joints["left"].target = 3
                    robot.leds["a"].color = ziggurat.OFF
            self.assertEqual(events, [ziggurat.Event.INIT, ziggurat.Event.STEP,
                                      ziggurat.Event.RESET])
            session.close()

        self.play(part, client)

    def test_after_a_refused_command_an_answer_is_expected(self):
        def part(server):
            open_with(server)
            server.observe(0)
            server.receive()
            server.send(error=v1.Error(code=v1.Error.BAD_VALUE, severity=v1.Error.DISCARD,
                                      field="joint_targets", message="No."))
            self.assertEqual(server.receive().tick, 0)
            server.send(error=v1.Error(code=v1.Error.DUPLICATE_TICK, severity=v1.Error.DISCARD))
            server.observe(1)

        def client():
            session = self.connect()
            next(session)
            with self.assertRaises(ziggurat.ProtocolError) as caught:
                next(session)
            self.assertEqual(caught.exception.code, "BAD_VALUE")
            self.assertEqual(caught.exception.field, "joint_targets")
            self.assertFalse(caught.exception.is_fatal)
            self.assertEqual(next(session).number, 1)
            self.assertEqual(session.late, 1)
            session.abandon()

        self.play(part, client)

    def test_commands_obey_the_servers_limit(self):
        def part(server):
            open_with(server)
            server.observe(0)

        def client():
            session = self.connect()
            next(session)
            for _ in range(2):
                session.robots[0].radios["mouth"].send(bytes(1 << 20))
            with self.assertRaises(ValueError):
                next(session)
            session.abandon()

        self.play(part, client)


if __name__ == "__main__":
    unittest.main()
