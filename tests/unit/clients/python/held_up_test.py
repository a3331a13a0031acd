# SPDX-License-Identifier: MIT
"""A thread that asks for what its own session would have to answer first, before a real server."""

import os
import pathlib
import threading
import unittest

import ziggurat

ROOT = pathlib.Path(__file__).resolve().parents[4]
ARMS = str(ROOT / "conformance" / "scene" / "conformance.argos")


class HeldUp(unittest.TestCase):
    def setUp(self):
        self.server = ziggurat.Server(ARMS, command=os.environ["ZIGGURAT"],
                                      arguments=["--duration", "0", "--allow-director"])
        self.addCleanup(self.server.close)
        self.world = ziggurat.supervise(self.server.endpoint, wait_timeout=60)
        self.addCleanup(self.world.close)

    def connect(self, *robots, **options):
        session = ziggurat.connect(self.server.endpoint, robots or "*", wait_timeout=60, **options)
        self.addCleanup(session.close)
        return session

    def refused(self, call):
        with self.assertRaises(ziggurat.ProtocolError) as caught:
            call()
        self.assertEqual(caught.exception.code, "OUT_OF_STATE")
        self.assertIn("the same program", str(caught.exception))
        self.assertIn("another thread", str(caught.exception))

    def test_a_pause_of_a_program_that_owes_a_command(self):
        session = self.connect()
        self.refused(self.world.pause)  # before its first tick is taken
        self.assertEqual(next(session).number, 0)
        self.refused(self.world.pause)
        self.assertEqual(next(session).number, 1)  # it had no effect
        self.assertEqual(self.world.status().phase, "running")

    def test_of_one_that_directs(self):
        session = self.connect()
        with ziggurat.direct("judge", self.server.endpoint) as judge:
            next(judge)
            thread = threading.Thread(target=lambda: (next(session), next(session)), daemon=True)
            thread.start()
            self.refused(self.world.pause)
            self.assertEqual(next(judge).number, 1)
            thread.join(60)
            self.assertFalse(thread.is_alive())

    def test_what_does_not_wait_is_done(self):
        session = self.connect()
        next(session)
        self.world.snapshot("here")
        self.world.move("arm0", (1, 1, 0))
        self.assertEqual(self.world.read("arm0")["arm0"].position, (1, 1, 0))
        self.assertEqual(self.world.reset(5), 0)
        session.expect_reset()
        self.assertEqual(next(session).number, 0)

    def test_of_another_thread_it_waits_for_the_answer(self):
        session = self.connect()
        next(session)
        stood = []
        thread = threading.Thread(target=lambda: stood.append(self.world.pause()), daemon=True)
        thread.start()
        thread.join(0.3)
        self.assertTrue(thread.is_alive())
        session.answer()
        thread.join(60)
        self.assertEqual(stood, [0])
        self.refused(lambda: self.world.step(1))  # this thread drives the session: it could not answer
        self.world.pause()  # stands already
        self.world.resume()
        self.assertEqual(next(session).number, 1)

    def test_a_session_that_a_thread_is_about_to_begin_is_not_the_callers(self):
        session = self.connect()
        thread = threading.Thread(target=lambda: list(session), daemon=True)
        thread.start()
        self.assertGreaterEqual(self.world.pause(), 0)
        self.assertGreater(self.world.step(2), 1)
        self.world.shutdown("done")
        thread.join(60)

    def test_before_all_controllers_are_there_it_is_answered(self):
        self.connect("arm0")
        self.assertEqual(self.world.pause(), 0)

    def test_whose_deadline_ends_the_wait(self):
        session = self.connect(deadline=ziggurat.Deadline("hold", wall_ms=50))
        next(session)
        self.assertGreaterEqual(self.world.pause(), 0)


if __name__ == "__main__":
    unittest.main()
