# SPDX-License-Identifier: MIT
"""Runs the real programs on small scenes, each test in a folder of its own.

ZIGGURAT_BIN names the folder of the programs. Each test fails if it leaves a process, or a file in the
runtime folder.
"""

import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from waiting import HANG, wait_until  # noqa: E402

BIN = pathlib.Path(os.environ.get("ZIGGURAT_BIN", HERE.parents[1] / "build/release/bin"))
ZIGGURAT = BIN / "ziggurat"
LUA = BIN / "ziggurat-lua"

FINISHED, FAULT, CONTROLLER_FAILED, INTERRUPTED = 0, 1, 3, 130
LIMIT = HANG  # [s] of wall time for a run


class Outcome:
    def __init__(self, code, out, err):
        self.code, self.out, self.err = code, out, err

    @property
    def lines(self):
        return self.out.splitlines()


class SceneTest(unittest.TestCase):
    def setUp(self):
        # A short path: sockets live in it.
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="zt", dir="/tmp"))
        self.runtime = self.folder / "run"
        self.runtime.mkdir()
        self.environment = dict(os.environ, XDG_RUNTIME_DIR=str(self.runtime))
        for name in ("arms.argos", "swing.lua"):
            shutil.copy(HERE / name, self.folder)
        self.scene = self.folder / "arms.argos"
        self.text = self.scene.read_text()
        self.started = []

    def tearDown(self):
        for process in self.started:
            if process.poll() is None:
                process.kill()
                process.communicate()
        try:
            self.assertEqual(self.left_processes(), [], "left behind")
            self.wait_for_guardian()
        finally:
            shutil.rmtree(self.folder, ignore_errors=True)

    def wait_for_guardian(self):
        """The guardian of a program that was killed cleans up a moment later; the folder that servers share stays."""
        shared = self.runtime / "ziggurat"
        wait_until(lambda: all(path == shared and not any(shared.iterdir()) for path in self.runtime.iterdir()),
                   "the runtime folder is empty")

    # --- scenes ---------------------------------------------------------------------------------

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def change(self, old, new, count=-1):
        """Replaces text in the test's scene; the text must occur."""
        self.assertIn(old, self.text)
        self.text = self.text.replace(old, new, count)
        self.scene.write_text(self.text)

    # --- runs -----------------------------------------------------------------------------------

    def start(self, *arguments, **options):
        seconds = options.pop("limit", 2 * LIMIT)
        process = subprocess.Popen(
            [str(ZIGGURAT), *map(str, arguments)], cwd=options.pop("cwd", self.folder),
            env=self.environment,
            stdin=subprocess.DEVNULL, stdout=options.pop("stdout", subprocess.PIPE),
            stderr=options.pop("stderr", subprocess.PIPE), text=True, errors="replace", **options)
        self.started.append(process)
        limit = threading.Timer(seconds, process.kill)  # so that no read waits forever
        limit.start()
        self.addCleanup(limit.cancel)
        return process

    def finish(self, process):
        try:
            out, err = process.communicate(timeout=LIMIT)
        except subprocess.TimeoutExpired:
            process.kill()
            out, err = process.communicate()
            self.fail(f"hangs\n--- stdout\n{out}\n--- stderr\n{err}")
        return Outcome(process.returncode, out or "", err or "")

    def ziggurat(self, *arguments):
        return self.finish(self.start(*arguments))

    def ctl(self, url, *words, text=None, code=FINISHED):
        """`ziggurat ctl`: what it prints, or why it fails."""
        done = subprocess.run([ZIGGURAT, "ctl", url, *map(str, words)], input=text, capture_output=True, text=True,
                              timeout=LIMIT, cwd=self.folder, env=self.environment)
        self.assertEqual(done.returncode, code, f"{words}: {done.stderr}")
        return done.stderr if code else done.stdout

    def run_scene(self, *arguments, code=FINISHED, scene=None):
        """Runs the test's scene and expects that exit code."""
        outcome = self.ziggurat("run", scene or self.scene, *arguments)
        self.assertEqual(outcome.code, code, f"\n{outcome.out}\n{outcome.err}")
        return outcome

    def hash_of(self, *arguments, **options):
        """The hash line of a quiet run."""
        return self.run_scene("--hash", "--quiet", *arguments, **options).lines[-1]

    def assert_is_sentence(self, outcome, pattern):
        """One clear message, not a crash report."""
        self.assertRegex(outcome.err, pattern)
        self.assertNotRegex(outcome.err, r"terminate called|Assertion|core dumped|std::|Sanitizer")

    # --- processes ------------------------------------------------------------------------------

    def left_processes(self):
        """Command lines of processes that name the test's folder and do not end soon. Whatever a program
        started must end with it, and not by a timeout of its own."""
        begin = time.monotonic()

        def found():
            return [text for _, text in self.processes(str(self.folder))]

        wait_until(lambda: not found() or self.is_late(begin, 5), "left processes end")
        return found()

    def is_late(self, begin, seconds):
        """More time has passed since `begin` than is `seconds` where nothing else computes: the start and end of a program, at
        this moment, are the measure."""
        took = time.monotonic() - begin
        return took > seconds and took > seconds + 50 * self.moment()

    def moment(self):
        """How long the start and end of a program take now [s]."""
        begin = time.monotonic()
        subprocess.run([ZIGGURAT, "--version"], stdout=subprocess.DEVNULL, check=True)
        return time.monotonic() - begin

    @staticmethod
    def processes(*patterns):
        """(id, command line) of each process whose command line contains all of these."""
        found = []
        for entry in pathlib.Path("/proc").iterdir():
            if not entry.name.isdigit() or int(entry.name) == os.getpid():
                continue
            try:
                text = (entry / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace")
            except OSError:
                continue
            if all(pattern in text for pattern in patterns):
                found.append((int(entry.name), text))
        return sorted(found)

    def lua_processes(self, count=1):
        """Ids of the test's Lua processes; waits until `count` of them run."""
        return self.wait_for(
            lambda: [i for i, _ in self.processes("ziggurat-lua", str(self.runtime))],
            lambda ids: len(ids) >= count, "Lua processes")

    def wait_for(self, look, is_enough, what):
        """What was seen, once it is enough."""
        def seen():
            found = look()
            return is_enough(found) and [found]

        return wait_until(seen, what)[0]

    def read_until(self, stream, pattern):
        """Lines of a stream until one matches; returns the match."""
        seen = []
        for line in stream:
            seen.append(line)
            match = re.search(pattern, line)
            if match:
                return match
        self.fail(f"no line matches {pattern!r}: {seen}")

    def interrupt(self, process):
        process.send_signal(signal.SIGINT)

    def wait_until_it_computes(self, pid, seconds):
        """Until the process has had that much processor time, however busy the machine is."""
        def used():
            fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
            return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

        self.wait_for(used, lambda so_far: so_far >= seconds, f"{seconds} s of processor time")

    def wait_until_taken(self, process, number):
        """Until the process has taken the signal: a second one is lost while the first is pending."""
        def pending():
            status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
            return int(re.search(r"^ShdPnd:\s*(\w+)", status, re.MULTILINE)[1], 16) >> (number - 1) & 1

        self.wait_for(pending, lambda is_pending: not is_pending, "end of the signal's wait")


def main():
    unittest.main(verbosity=2)
