# SPDX-License-Identifier: MIT
"""Ctrl-C: a session leaves, and its program ends soon, whatever the server has sent. Against a fake server."""

import gc
import resource
import signal
import subprocess
import sys
import unittest
import unittest.mock
import weakref

import ziggurat
from ziggurat import protocol_pb2 as v1

from session_case import SessionCase, open_with

# Prints the processor time that it has taken until the signal.
PROGRAM = """
import sys, time, ziggurat
with ziggurat.connect(sys.argv[1]) as session:
    try:
        print(len(session.robots), flush=True)
        for tick in session:
            pass
    except KeyboardInterrupt:
        print(time.process_time(), flush=True)
        raise
"""


def robots(count):
    return [v1.RobotDescription(id=f"r{i}", controller="some", joint_actuators=[v1.JointDescription(id="arm")])
            for i in range(count)]


def computed_by_children():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Interrupted(SessionCase):
    def test_a_hundred_thousand_robots_end_within_a_second_of_computing(self):
        def part(server):
            open_with(server, *robots(100_000))
            leave = server.receive()
            self.assertEqual((leave.reason, leave.message), (v1.Leave.FAILED, "KeyboardInterrupt: "))

        def client():
            before = computed_by_children()
            program = subprocess.Popen([sys.executable, "-c", PROGRAM, self.server.endpoint], text=True,
                                       stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
            self.assertEqual(program.stdout.readline(), "100000\n")
            program.send_signal(signal.SIGINT)
            until_then = float(program.stdout.readline())
            program.communicate()
            self.assertEqual(program.returncode, -signal.SIGINT)
            self.assertLess(computed_by_children() - before - until_then, 1.0)

        self.play(part, client)

    def test_a_robot_is_few_objects_that_are_freed_without_garbage_collection(self):
        def client():
            gc.collect()
            gc.disable()
            self.addCleanup(gc.enable)
            before = len(gc.get_objects())
            session = self.connect()
            self.assertLess(len(gc.get_objects()) - before, 6_000)
            session.abandon()
            is_there = weakref.ref(session)
            del session
            self.assertIsNone(is_there())

        self.play(lambda server: open_with(server, *robots(1000)), client)

    def test_one_that_comes_while_robots_are_made_leaves(self):
        def part(server):
            open_with(server, *robots(2))
            leave = server.receive()
            self.assertEqual((leave.reason, leave.message), (v1.Leave.FAILED, "KeyboardInterrupt: "))

        def client():
            with unittest.mock.patch("ziggurat.session.Robot", side_effect=KeyboardInterrupt):
                with self.assertRaises(KeyboardInterrupt):
                    self.connect()

        self.play(part, client)

    def test_a_server_that_reads_nothing_does_not_hold_up_the_end(self):
        def client():
            session = self.connect()
            while session._connection.transport.send(bytes(1 << 16)):
                pass  # until all queues are full for half a second
            session.close("KeyboardInterrupt: ")

        self.play(open_with, client)


if __name__ == "__main__":
    unittest.main()
