"""The session: ticks, events, leaving, errors, the end of a connection; against a fake server."""

import threading
import unittest

import zmq

import ziggurat
from ziggurat import protocol_pb2 as v1

from fake_server import FakeServer, equipped, welcome


class SessionCase(unittest.TestCase):
    """`self.play(server, client)` runs the client in this thread beside the server's part."""

    def setUp(self):
        self.server = FakeServer()
        self.addCleanup(self.server.close)

    def play(self, part, client):
        faults = []

        def run():
            try:
                part(self.server)
            except Exception as fault:
                faults.append(fault)

        thread = threading.Thread(target=run)
        thread.start()
        try:
            return client()
        finally:
            thread.join(10)
            if faults:
                raise faults[0]

    def connect(self, *robots, **options):
        return ziggurat.connect(self.server.endpoint, *robots, wait_timeout=5, **options)


def open_with(server, *robots, **fields):
    hello = server.hear()
    server.say(welcome=welcome(*(robots or [equipped("one")]), **fields))
    return hello


class Beginning(SessionCase):
    def test_hello_says_what_is_wanted(self):
        def part(server):
            hello = open_with(server)
            self.assertEqual((hello.version.major, hello.version.minor), (1, 0))
            self.assertEqual(hello.role, v1.ROLE_CONTROLLER)
            self.assertEqual(list(hello.robots), ["a*", "b"])
            self.assertEqual(hello.controller, "some")
            self.assertEqual(hello.client_name, "me")
            self.assertTrue(hello.takeover)
            self.assertEqual(hello.deadline_policy.action, v1.DeadlinePolicy.HOLD)
            self.assertEqual(hello.deadline_policy.wall_deadline_ms, 20)
            self.assertEqual(hello.deadline_policy.miss_budget, 3)
            self.assertEqual(server.hear().reason, v1.Leave.DONE)

        def client():
            with self.connect(["a*", "b"], controller="some", name="me", takeover=True,
                              deadline=ziggurat.Deadline("hold", 20, 3)) as session:
                self.assertEqual(session.token, b"token")
                self.assertAlmostEqual(session.tick_seconds, 0.1)
                self.assertEqual(session.seed, 7)
                self.assertEqual(session.robots["one"].params, {"speed": "2"})

        self.play(part, client)

    def test_no_wish_is_all_robots(self):
        def part(server):
            self.assertEqual(list(open_with(server).robots), ["*"])

        self.play(part, lambda: self.connect().abandon())

    def test_loading_is_waited_for(self):
        def part(server):
            server.hear()
            for progress in (0.1, 0.5):
                server.say(loading=v1.Loading(progress=progress))
            server.say(welcome=welcome())

        self.play(part, lambda: self.connect().abandon())

    def test_a_refusal_names_the_holder(self):
        def part(server):
            server.hear()
            error = v1.Error(code=v1.Error.ROBOT_TAKEN, severity=v1.Error.FATAL, retryable=True,
                             robot="one", message="Taken.")
            server.say(refusal=v1.Refusal(error=error, holder="somebody 1"))

        def client():
            with self.assertRaises(ziggurat.Refused) as caught:
                self.connect()
            self.assertEqual(caught.exception.code, "ROBOT_TAKEN")
            self.assertEqual(caught.exception.holder, "somebody 1")
            self.assertTrue(caught.exception.retryable)
            self.assertIn("one", str(caught.exception))

        self.play(part, client)

    def test_nobody_listens(self):
        with self.assertRaises(ziggurat.ConnectionLost):
            ziggurat.connect("ipc://@nobody-listens-here", connect_timeout=0.05)

    def test_an_endpoint_that_is_none(self):
        with self.assertRaises(ValueError):
            ziggurat.connect("nonsense")


class Security(SessionCase):
    def setUp(self):
        self.public_key, secret_key = zmq.curve_keypair()
        self.server = FakeServer(secret_key)
        self.addCleanup(self.server.close)

    def keys(self, server_key):
        public_key, secret_key = (key.decode() for key in zmq.curve_keypair())
        return ziggurat.Curve(server_key.decode(), public_key, secret_key)

    def test_keys(self):
        self.play(open_with, lambda: self.connect(curve=self.keys(self.public_key)).abandon())

    def test_another_servers_key_or_none(self):
        other, _ = zmq.curve_keypair()
        for curve in (None, self.keys(other)):
            with self.assertRaises(ziggurat.ConnectionLost):
                self.connect(curve=curve, connect_timeout=0.3)


class Ticks(SessionCase):
    def test_a_run(self):
        def part(server):
            open_with(server)
            for tick in range(3):
                server.observe(tick)
                self.assertEqual(server.hear().tick, tick)
            server.say(end=v1.End(reason=v1.End.FINISHED, tick=2))
            leave = server.hear()
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

    def test_what_is_no_tick_is_passed_over(self):
        def part(server):
            open_with(server)
            server.say(heartbeat=v1.Heartbeat(sequence=1))
            server.observe(4)
            server.hear()
            server.say(paused=v1.Paused(tick=4))
            server.socket.send_multipart([server.peer, b"\x9a\x06\x00"])  # an unknown kind, 99
            server.observe(5)
            self.assertEqual(server.hear().tick, 5, "heartbeats and pauses are not answered")
            server.say(end=v1.End(reason=v1.End.INTERRUPTED, message="enough", tick=5))

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
            self.assertEqual(list(server.hear().joint_targets), [0.0, 2.5])
            server.observe(1)
            self.assertEqual(list(server.hear().joint_targets), [])
            server.observe(2)
            self.assertEqual(list(server.hear().joint_targets), [1.0, 2.5])
            server.say(error=v1.Error(code=v1.Error.DEADLINE_MISSED, severity=v1.Error.WARNING))
            server.observe(3)
            self.assertEqual(list(server.hear().joint_targets), [1.0, 2.5], "the last may be lost")
            server.say(end=v1.End())

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

    def test_reset_takes_commands_back(self):
        def part(server):
            open_with(server)
            server.observe(0)
            server.hear()
            server.observe(1)
            server.say(reset=v1.Reset(seed=7))  # what is owed is void
            server.observe(0)
            command = server.hear()
            self.assertEqual(command.tick, 1, "it was on its way")
            server.say(error=v1.Error(code=v1.Error.FUTURE_TICK, severity=v1.Error.DISCARD))
            command = server.hear()
            self.assertEqual(command.tick, 0)
            self.assertEqual(list(command.joint_targets), [])
            server.say(end=v1.End())

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

    def test_a_command_that_was_refused_is_owed_still(self):
        def part(server):
            open_with(server)
            server.observe(0)
            server.hear()
            server.say(error=v1.Error(code=v1.Error.BAD_VALUE, severity=v1.Error.DISCARD,
                                      field="joint_targets", message="No."))
            self.assertEqual(server.hear().tick, 0)
            server.say(error=v1.Error(code=v1.Error.DUPLICATE_TICK, severity=v1.Error.DISCARD))
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

    def test_commands_keep_to_the_servers_limit(self):
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


class Leaving(SessionCase):
    def test_an_exception_leaves_as_failed(self):
        def part(server):
            open_with(server)
            server.observe(0)
            leave = server.hear()
            self.assertEqual(leave.reason, v1.Leave.FAILED)
            self.assertEqual(leave.message, "ZeroDivisionError: division by zero")

        def client():
            with self.assertRaises(ZeroDivisionError):
                with self.connect() as session:
                    next(session)
                    1 / 0

        self.play(part, client)

    def test_a_robot_fails_and_the_others_go_on(self):
        def part(server):
            open_with(server, equipped("one"), equipped("two"))
            server.observe(0)
            leave = server.hear()
            self.assertEqual(list(leave.robots), [1])
            self.assertEqual(leave.message, "oh")
            self.assertEqual([line.text for line in leave.log], ["before"])
            command = server.hear()
            self.assertEqual([(line.robot, line.text, line.error) for line in command.log],
                             [(0, "fine", True)])
            self.assertEqual(len(command.joint_targets), 4, "those that left keep their place")
            server.say(end=v1.End())

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
    def test_a_server_that_dies_is_noticed(self):
        def part(server):
            open_with(server)
            server.observe(0)
            server.hear()
            server.close()

        def client():
            session = ziggurat.connect(self.server.endpoint)
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

    def test_resuming(self):
        def part(server):
            open_with(server)
            server.observe(3)
            hello = open_with(server)
            self.assertEqual(hello.session_token, b"token")
            server.observe(3)
            self.assertEqual(server.hear().tick, 3)
            server.observe(4)

        def client():
            session = self.connect()
            next(session)
            session.abandon()
            again = ziggurat.resume(self.server.endpoint, session.token, wait_timeout=5)
            tick = next(again)
            self.assertEqual((tick.number, tick.event), (3, ziggurat.Event.RESUME))
            self.assertEqual(next(again).event, ziggurat.Event.STEP)
            again.abandon()

        self.play(part, client)

    def test_being_displaced(self):
        def part(server):
            open_with(server)
            server.say(displaced=v1.Displaced(by="usurper", message="Go."))

        def client():
            with self.assertRaisesRegex(ziggurat.Displaced, "usurper"):
                with self.connect() as session:
                    next(session)

        self.play(part, client)

    def test_a_fatal_error_ends_the_session(self):
        def part(server):
            open_with(server)
            server.say(error=v1.Error(code=v1.Error.TOO_MANY, severity=v1.Error.FATAL))

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
