# SPDX-License-Identifier: MIT
"""Programs under test that print without end, leave others behind, or are running when the kit is ended."""

import contextlib
import json
import os
import select
import shlex
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from ziggurat_conformance.process_group import ProcessGroup
from ziggurat_conformance.program_output import KEPT

HERE = Path(__file__).resolve().parent
TINY = shlex.join([sys.executable, "-B", str(HERE / "tiny_client.py")])
sys.path.insert(0, str(HERE.parents[1]))

from waiting import HANG, wait_until, wait_until_idle  # noqa: E402


def runs(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def is_full(out):
    """Whether a descriptor is a pipe that takes no more."""
    return out != subprocess.DEVNULL and not select.select([], [out], [], 0)[1]


class Programs(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def script(self, end):
        """Leaves a program behind, whose number it writes, and goes on as `end` says."""
        return ["sh", "-c", f"sleep 1000 & echo $! > {self.folder}/pid.new; mv {self.folder}/pid.new {self.folder}/pid; {end}"]

    def start(self, *arguments):
        kit = subprocess.Popen([sys.executable, "-B", "-m", "ziggurat_conformance", *arguments], text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(kit.kill)
        return kit

    def left(self):
        wait_until((self.folder / "pid").exists, "it has not started")
        return int((self.folder / "pid").read_text())


class WhatTheyStart(Programs):
    def assert_ends(self, pid):
        wait_until(lambda: not runs(pid), "a program that the program under test has started still runs")

    def test_ends_with_a_client(self):
        kit = self.start("client", "--only", "H1.hello-first", "--", *self.script(TINY))
        out, err = kit.communicate(timeout=HANG)
        self.assertEqual((0, ""), (kit.returncode, err), out)
        self.assert_ends(self.left())

    def test_ends_with_a_server(self):
        kit = self.start("server", "--only", "S9.stale", "--form", "binary", "--", *self.script(
            shlex.join([os.environ["ZIGGURAT"], "serve", "{scene}", "--endpoint", "{endpoint}"])))
        kit.communicate(timeout=HANG)
        self.assert_ends(self.left())

    def test_ends_with_a_kit_that_a_signal_ends(self):
        for number, how in ((signal.SIGINT, "interrupted"), (signal.SIGTERM, "ended by SIGTERM"),
                            (signal.SIGHUP, "ended by SIGHUP")):
            for mode in ("client", "server"):
                with self.subTest(how, mode=mode):
                    (self.folder / "pid").unlink(missing_ok=True)
                    kit = self.start(mode, "--patience", "60", "--", *self.script("sleep 1001"))
                    pid = self.left()
                    kit.send_signal(number)
                    _, err = kit.communicate(timeout=HANG)
                    self.assertEqual((128 + number, f"ziggurat-conformance: {how}; no report was written\n"),
                                     (kit.returncode, err))
                    self.assert_ends(pid)


class Signals(Programs):
    """They end the kit in a moment, also while what it prints is not read."""

    def unread(self):
        """A pipe that is full."""
        reader, writer = os.pipe()
        self.addCleanup(os.close, reader)
        os.set_blocking(writer, False)
        with contextlib.suppress(BlockingIOError):
            while True:
                os.write(writer, bytes(4096))
        os.set_blocking(writer, True)
        return writer

    def closed(self):
        reader, writer = os.pipe()
        os.close(reader)
        return writer

    def assert_ends(self, out, err, numbers):
        """Its last words, if err is a pipe of this test's."""
        (self.folder / "pid").unlink(missing_ok=True)
        kit = subprocess.Popen([sys.executable, "-B", "-m", "ziggurat_conformance", "client", "-v", "--patience", "0.1", "--",
                                *self.script("exit 0")], stdout=out, stderr=err, text=True)
        self.addCleanup(kit.kill)
        first = self.left()
        wait_until(lambda: self.left() != first or is_full(out), "it prints its lines")
        if is_full(out):
            wait_until_idle(kit.pid)  # it waits for their reader
        for number in numbers:
            kit.send_signal(number)
        _, words = kit.communicate(timeout=HANG)
        self.assertIn(kit.returncode, [128 + number for number in numbers])
        return words

    def test_end_it_while_its_output_is_not_read(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            for pipe in (self.unread, self.closed):
                with self.subTest(number=number, pipe=pipe.__name__):
                    out = pipe()
                    self.addCleanup(os.close, out)
                    self.assert_ends(out, out, [number])

    def test_leave_last_words_where_they_are_read(self):
        out = self.unread()
        self.addCleanup(os.close, out)
        self.assertEqual("ziggurat-conformance: interrupted; no report was written\n",
                         self.assert_ends(out, subprocess.PIPE, [signal.SIGINT]))

    def test_are_one_if_many_come(self):
        for _ in range(5):
            words = self.assert_ends(subprocess.DEVNULL, subprocess.PIPE, [signal.SIGINT, signal.SIGTERM] * 4)
            self.assertRegex(words, r"\Aziggurat-conformance: (interrupted|ended by SIGTERM); no report was written\n\Z")

    def test_end_it_while_its_modules_are_loaded(self):
        (self.folder / "google").mkdir()
        (self.folder / "google/protobuf.py").write_text(
            f"import pathlib, signal; pathlib.Path({str(self.folder / 'loads')!r}).touch(); signal.pause()")
        kit = subprocess.Popen([os.environ["ZIGGURAT_KIT"], "--version"], stderr=subprocess.PIPE,
                               env={**os.environ, "PYTHONPATH": str(self.folder)})
        self.addCleanup(kit.kill)
        wait_until((self.folder / "loads").exists, "it has not started")
        kit.send_signal(signal.SIGINT)
        self.assertEqual(b"", kit.communicate(timeout=HANG)[1])
        self.assertEqual(-signal.SIGINT, kit.returncode)


class WhatTheyPrint(Programs):
    def test_is_kept_in_part_without_a_stop(self):
        size = 64 << 20
        group = ProcessGroup(["sh", "-c", f"echo first; head -c {size} /dev/zero; echo last"])
        self.addCleanup(group.end)
        self.assertEqual(0, group.wait(HANG))
        text = group.printed()
        self.assertTrue(text.startswith(b"first\n\0") and text.endswith(b"\0last\n"))
        self.assertLess(len(text), 2 * KEPT + 100_000)
        self.assertIn(b" bytes left out ...", text)

    def test_takes_no_place_in_the_file_system(self):
        kit = self.start("client", "--only", "H1.hello-first", "--", "sh", "-c", f"head -c 99999999 /dev/zero; echo > "
                         f"{self.folder}/done; {TINY}")
        wait_until((self.folder / "done").exists, "it waits for a reader")
        files = [os.stat(f"/proc/{kit.pid}/fd/{name}").st_size for name in os.listdir(f"/proc/{kit.pid}/fd")]
        self.assertLess(sum(files), 1 << 20)
        out, err = kit.communicate(timeout=HANG)
        self.assertEqual((0, ""), (kit.returncode, err), out)

    def test_has_no_effect_on_a_terminal(self):
        words = r"printf '\033]52;c;eA==\007 \342\200\256 \303\251\n   0.001 s  client forged\n\377'; exit 3"
        report = self.folder / "report.json"
        kit = self.start("client", "--only", "H1.hello-first", "--json", str(report), "--", "sh", "-c", words)
        out, _ = kit.communicate(timeout=HANG)
        for text in (out, json.loads(report.read_text())["cases"][0]["transcript"]):
            self.assertIn("printed: \\u001b]52;c;eA==\\u0007 \\u202e é\n", text)
            self.assertIn("\n" + 25 * " " + "   0.001 s  client forged\n", text.replace("\n" + 15 * " ", "\n") if text is out else text)
            self.assertFalse(set("\x1b\x07\u202e") & set(text))
        kit = self.start("server", "--only", "S9.stale", "--", "sh", "-c", words)
        _, err = kit.communicate(timeout=HANG)
        self.assertIn("\\u001b]52;c;eA==\\u0007 \\u202e é\n", err)

    def test_by_one_that_escapes_holds_nothing_up(self):
        group = ProcessGroup(["setsid", "-f", "sh", "-c", f"echo $$ > {self.folder}/pid; exec cat /dev/zero"])
        wait_until(lambda: (self.folder / "pid").exists() and (self.folder / "pid").read_text(), "it has not started")
        pid = int((self.folder / "pid").read_text())
        group.end()
        wait_until(lambda: not runs(pid), "it does not see that the pipe has no reader")


if __name__ == "__main__":
    unittest.main()
