# SPDX-License-Identifier: MIT
"""Supervision, takeover, resuming, deadlines and keys: the package against the real server, whose program
is in ZIGGURAT."""

import gc
import itertools
import math
import os
import pathlib
import select
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import zmq
import ziggurat

ROOT = pathlib.Path(__file__).resolve().parents[4]
sys.path.insert(0, str(ROOT / "tests"))

from waiting import HANG, wait_until  # noqa: E402

PROGRAM = os.environ["ZIGGURAT"]
ARMS = ROOT / "conformance" / "scene" / "conformance.argos"  # four robots with a motor each


def serve(*arguments):
    return ziggurat.Server(str(ARMS), command=PROGRAM, arguments=("--duration", "0", *arguments))


def aside(function):
    """Runs a function in a thread; returns its result on request."""
    results = []
    thread = threading.Thread(target=lambda: results.append(function()), daemon=True)
    thread.start()

    def result():
        thread.join(HANG)
        return results[0]

    return result


def numbers_of(session, count):
    return [tick.number for tick in itertools.islice(session, count)]


def angle_between(first, second):
    """The angle [rad] of the rotation that takes one unit quaternion to the other."""
    return 2 * math.acos(min(1.0, abs(sum(a * b for a, b in zip(first, second)))))


class Lifetime(unittest.TestCase):
    def test_a_server_ends_with_a_program_that_is_killed(self):
        program = ("import ziggurat, signal\n"
                   f"server = ziggurat.Server({str(ARMS)!r}, command={PROGRAM!r}, arguments=('--duration', '0'))\n"
                   "print(server.process.pid, flush=True)\n"
                   "signal.pause()\n")
        with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True) as killed:
            server = int(killed.stdout.readline())
            descriptor = os.pidfd_open(server)
            killed.kill()
        try:
            self.assertTrue(select.select([descriptor], [], [], HANG)[0], "it is left")
        finally:
            os.close(descriptor)

    def test_a_server_that_is_closed_leaves_no_descriptor(self):
        def one():
            with serve():
                pass

        one()
        gc.collect()  # sockets of other tests
        before = len(os.listdir("/proc/self/fd"))
        one()
        with self.assertRaisesRegex(FileNotFoundError, "there is no program '/nowhere/ziggurat'; put .* on the PATH"):
            ziggurat.Server(str(ARMS), command="/nowhere/ziggurat")
        with self.assertRaisesRegex(RuntimeError, "did not start: /nowhere.argos: the file does not exist"):
            ziggurat.Server("/nowhere.argos", command=PROGRAM)
        with self.assertRaisesRegex(RuntimeError, "did not start: unknown option '--tiks'; did you mean '--ticks'"):
            serve("--tiks", "3")
        self.assertLessEqual(len(os.listdir("/proc/self/fd")), before)


class Supervising(unittest.TestCase):
    def test_a_world_is_paused_stepped_moved_reset_and_ended(self):
        with serve() as server, ziggurat.supervise(server.endpoint) as world:
            self.assertEqual(world.status().phase, "gathering")
            self.assertEqual(len(world.status().free_robots), 4)
            ticks, ended = [], []

            def control():
                with ziggurat.connect(server.endpoint, name="arms") as session:
                    for tick in session:
                        ticks.append((tick.number, tick.event))
                        for robot in session.robots:
                            robot.joints["hinge"].target = 1.0
                    ended.append(session.ending.reason)

            driver = threading.Thread(target=control, daemon=True)
            driver.start()
            wait_until(lambda: world.status().tick >= 3, "three ticks")
            at = world.pause()
            status = world.status()
            self.assertEqual((status.phase, status.tick), ("paused", at))
            [arms] = [s for s in status.sessions if s.role == "controller"]
            self.assertEqual((arms.client, arms.state), ("arms", "paused"))
            self.assertEqual(arms.robots, ("arm0", "arm1", "arm2", "arm3"))

            before = world.read("arm0")
            self.assertEqual(before.tick, at)
            self.assertEqual(world.step(5), at + 5)
            after = world.read("arm*")
            self.assertEqual(len(after.entities), 4)
            # 5 ticks of 0.1 s at 1 rad/s, at whatever tick the pause came.
            turned = angle_between(*(state["arm0"].links[1].orientation for state in (before, after)))
            self.assertAlmostEqual(turned, 0.5, delta=0.01)

            world.move("arm0", (1.0, 1.0, 0.0))
            self.assertEqual(world.read("arm0")["arm0"].position, (1.0, 1.0, 0.0))

            self.assertEqual(world.reset(seed=11), 0)
            self.assertEqual(world.status().seed, 11)
            fresh = world.read("arm0")["arm0"]
            self.assertEqual(tuple(round(x, 9) for x in fresh.position), (0.3, 0.3, 0.0))
            world.resume()
            wait_until(lambda: world.status().tick >= 3, "three ticks")
            self.assertEqual([event for number, event in ticks if number == 0],
                             [ziggurat.Event.INIT, ziggurat.Event.RESET])
            world.shutdown()
            driver.join(HANG)
            self.assertEqual(ended, ["interrupted"])
            self.assertEqual(server.wait(HANG), 130)

    def test_a_paused_world_does_not_move(self):
        """Whenever the pause comes: with the last answer of a tick, and between the ticks of a pace."""
        for pace in (), ("--real-time", "5"):
            with self.subTest(pace), serve(*pace) as server:
                with ziggurat.supervise(server.endpoint) as world:
                    session = ziggurat.connect(server.endpoint)
                    driver = threading.Thread(target=lambda: list(session), daemon=True)
                    driver.start()
                    for _ in range(30 if pace else 200):
                        at = world.pause()
                        time.sleep(0.003)  # elapsed time is the subject
                        status = world.status()
                        self.assertEqual((status.phase, status.tick), ("paused", at))
                        world.resume()
                        wait_until(lambda: world.status().tick > at, "it goes on")
                    world.shutdown()
                    driver.join(HANG)


class Waiting(unittest.TestCase):
    """A server that lives sends heartbeats: they do not extend a wait."""

    def timed(self, function):
        """How long it takes until its Timeout [s], and what that says."""
        began = time.monotonic()
        with self.assertRaises(ziggurat.Timeout) as caught:
            function()
        return time.monotonic() - began, str(caught.exception)

    def check(self, waited, told):
        took, text = waited()
        self.assertRegex(text, told)
        self.assertGreaterEqual(took, 2.5)

    def test_who_waits_for_others_waits_for_wait_timeout(self):
        with serve("--allow-director") as server:
            slow = ziggurat.connect(server.endpoint, ["arm1", "arm2", "arm3"])
            fast = ziggurat.connect(server.endpoint, "arm0", wait_timeout=2.5)
            world = ziggurat.direct("judge", server.endpoint, wait_timeout=2.5)
            supervisor = ziggurat.supervise(server.endpoint, wait_timeout=2.5)
            for session in (slow, fast, world):
                self.assertEqual(next(session).number, 0)
            waits = [(aside(lambda each=each: self.timed(each)), told) for each, told in (
                (lambda: next(fast), "no observation for 2.5 s"),
                (lambda: next(world), "no observation for 2.5 s"),
                (supervisor.pause, "no answer for 2.5 s"))]
            for waited, told in waits:
                self.check(waited, told)
            slow.close()
            world.close()
            self.assertEqual(supervisor.status().phase, "paused")  # the late answer to pause() is none to this
            supervisor.resume()
            self.assertGreaterEqual(next(fast).number, 1)  # the session went on
            fast.close()
            supervisor.close()


class Holding(unittest.TestCase):
    def test_a_takeover_displaces_the_owner(self):
        with serve() as server:
            first = ziggurat.connect(server.endpoint, name="first")
            tick = next(first)
            with ziggurat.connect(server.endpoint, name="second", takeover=True) as second:
                with self.assertRaises(ziggurat.Displaced) as caught:
                    for tick in first:
                        pass
                self.assertIn("second", str(caught.exception))
                self.assertEqual(len(second.robots), 4)
                self.assertGreaterEqual(next(second).number, tick.number)  # the tick that stands

    def test_a_lease_keeps_robots_for_their_token(self):
        with serve("--lease", "60") as server:
            session = ziggurat.connect(server.endpoint, name="first")
            for tick in session:
                for robot in session.robots:
                    robot.joints["hinge"].target = 2.0
                if tick.number == 3:
                    break
            session.abandon()
            with ziggurat.supervise(server.endpoint) as world:
                wait_until(lambda: [s.state for s in world.status().sessions if s.role == "controller"] == ["lost"],
                           "its session is lost")
            with self.assertRaises(ziggurat.Refused) as caught:
                ziggurat.connect(server.endpoint, "arm0")
            self.assertEqual((caught.exception.code, caught.exception.retryable),
                             ("ROBOT_TAKEN", True))
            with ziggurat.resume(server.endpoint, session.token) as again:
                tick = next(again)
                self.assertEqual((tick.number, tick.event), (3, ziggurat.Event.RESUME))
                self.assertEqual({robot.joints["hinge"].target for robot in again.robots}, {2.0})
                encoder = again.robots[0].joints["hinge"].encoder
                tick = next(again)
                self.assertEqual((tick.number, tick.event), (4, ziggurat.Event.STEP))
                self.assertAlmostEqual(again.robots[0].joints["hinge"].encoder - encoder, 0.2,
                                       delta=0.01)  # what was commanded before holds
            with self.assertRaises(ziggurat.Refused) as caught:
                ziggurat.resume(server.endpoint, b"no such token")
            self.assertEqual(caught.exception.code, "NO_SUCH_SESSION")


class Deadlines(unittest.TestCase):
    def test_a_late_session_is_told_and_gets_every_tick(self):
        deadline = ziggurat.Deadline("hold", wall_ms=300)
        with serve() as server:
            with ziggurat.connect(server.endpoint, "arm0", deadline=deadline) as late:
                rest = ziggurat.connect(server.endpoint, "arm[1-3]")
                their_numbers = aside(lambda: numbers_of(rest, 6))
                tick = next(late)
                late.robots[0].joints["hinge"].target = 1.0
                with ziggurat.supervise(server.endpoint, observer=True) as watcher:
                    wait_until(lambda: watcher.status().tick >= 2, "two ticks without it")
                self.assertEqual([tick.number, *numbers_of(late, 5)], list(range(6)))
                self.assertEqual(their_numbers(), list(range(6)))
                self.assertGreaterEqual(late.missed, 1)
                self.assertGreaterEqual(late.late, 1)  # its command for the past tick
                # It was sent again: the joint turned, although the first command was lost.
                self.assertGreater(late.robots[0].joints["hinge"].encoder, 0.05)
                rest.abandon()

    def test_a_dropped_session_gets_only_the_end(self):
        deadline = ziggurat.Deadline("drop", wall_ms=100)
        with serve() as server, ziggurat.supervise(server.endpoint) as world:
            late = ziggurat.connect(server.endpoint, "arm0", deadline=deadline)
            with ziggurat.connect(server.endpoint, "arm[1-3]") as rest:
                next(late)
                self.assertEqual(numbers_of(rest, 6), list(range(6)))
                self.assertEqual(world.status().gone_robots, ("arm0",))
                world.shutdown()
                self.assertEqual(numbers_of(late, 6), [])
                self.assertEqual((late.missed, late.ending.reason), (1, "interrupted"))
                late.close()


class Keys(unittest.TestCase):
    def test_a_listed_key_connects_in_its_roles(self):
        server_key, server_secret = zmq.curve_keypair()
        public, secret = zmq.curve_keypair()
        folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        (folder / "secret").touch(0o600)
        (folder / "secret").write_bytes(server_secret)
        (folder / "clients").write_text(f"{public.decode()} controller,observer me\n")
        curve = ziggurat.Curve(server_key.decode(), public.decode(), secret.decode())
        with serve("--curve-secret", str(folder / "secret"), "--curve-clients",
                   str(folder / "clients")) as server:
            with ziggurat.connect(server.endpoint, curve=curve) as session:
                self.assertEqual(numbers_of(session, 3), [0, 1, 2])
                with ziggurat.supervise(server.endpoint, observer=True, curve=curve) as watcher:
                    self.assertEqual(watcher.status().phase, "running")
                with self.assertRaises(ziggurat.Refused) as caught:
                    ziggurat.supervise(server.endpoint, curve=curve)
                self.assertEqual(caught.exception.code, "FORBIDDEN")
            unlisted = ziggurat.Curve(server_key.decode(),
                                      *(key.decode() for key in zmq.curve_keypair()))
            for keys, why in ((unlisted, "does not have this client's key"),
                              (None, "this client has no keys")):
                with self.assertRaisesRegex(ziggurat.ConnectionLost, f"refused key.*{why}"):
                    ziggurat.connect(server.endpoint, curve=keys)


if __name__ == "__main__":
    unittest.main()
