# SPDX-License-Identifier: MIT
"""Robots that a client takes over from the programs that a run has started: the run goes on with it."""

import os
import re
import sys
import threading
import time

from harness import INTERRUPTED, LIMIT, SceneTest, main
from waiting import wait_until

sys.path.insert(0, os.environ["ZIGGURAT_PYTHON_PACKAGE"])

import ziggurat  # noqa: E402


class TakenOver(SceneTest):
    def begin(self, *arguments):
        """One Lua process for each robot; returns the process of the run and its endpoint."""
        endpoint = f"ipc://{self.folder}/door"
        process = self.start("run", self.scene, "--duration", 0, "--lua-processes", 0, "--real-time", 20,
                             "--endpoint", endpoint, *arguments)
        return process, endpoint

    def take(self, endpoint, *robots):
        """Answers for them until the end, and counts its ticks."""
        session = ziggurat.connect(endpoint, robots, takeover=True, connect_timeout=LIMIT)
        self.addCleanup(session.close)
        self.ticks = 0

        def answer():
            for _ in session:
                self.ticks += 1

        thread = threading.Thread(target=answer, daemon=True)
        thread.start()
        self.addCleanup(thread.join, 60)

    def wait_for_end_of(self, *files):
        """The Lua processes of these robots' files have ended."""
        wait_until(lambda: not self.processes("ziggurat-lua", f"{self.runtime}/", *files), "their Lua processes have ended")

    def goes_on(self, process, ticks):
        end = self.ticks + ticks
        wait_until(lambda: self.ticks >= end or process.poll() is not None, f"{ticks} more ticks")
        self.assertIsNone(process.poll(), "the run has ended")

    def interrupted(self, process):
        self.interrupt(process)
        outcome = self.finish(process)
        self.assertEqual(outcome.code, INTERRUPTED, outcome.err)

    def test_while_it_runs(self):
        process, endpoint = self.begin()
        self.read_until(process.stdout, r"^\[5 r2\]")
        self.take(endpoint, "r1")
        self.wait_for_end_of("/robots-1")
        self.goes_on(process, 150)  # 0.75 s: the run would have ended
        self.interrupted(process)

    def test_before_the_first_tick(self):
        r2 = re.search(r'<prototype id="r2">.*?</prototype>', self.text, re.DOTALL)[0]
        self.change(r2, r2.replace('config="swing"', 'config="late"'))
        swing = re.search(r'<lua_controller id="swing">.*?</lua_controller>', self.text, re.DOTALL)[0]
        late = swing.replace("lua_controller", "external_controller").replace('"swing"', '"late"')
        self.change("</controllers>", re.sub("<params.*?/>", "", late) + "</controllers>")
        process, endpoint = self.begin()
        self.read_until(process.stderr, r"waiting for robot r2 ")
        self.take(endpoint, "r0", "r1")
        self.wait_for_end_of("/robots-")
        time.sleep(1)  # elapsed time is the subject: the run would end within that
        self.take(endpoint, "r2")
        self.goes_on(process, 20)
        self.interrupted(process)


if __name__ == "__main__":
    main()
