# SPDX-License-Identifier: MIT
"""What the kit prints about mistakes on the command line and in the program under test."""

import collections
import contextlib
import io
import json
import os
import shlex
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import unittest
from pathlib import Path
from types import SimpleNamespace
from unittest import mock
from xml.etree import ElementTree

from ziggurat_conformance import cli, report, wire
from ziggurat_conformance.case import Level, Verdict
from ziggurat_conformance.peer import Peer, Transcript

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1]))

from waiting import HANG  # noqa: E402

SERVER = [os.environ["ZIGGURAT"], "serve", "{scene}", "--endpoint", "{endpoint}"]
BENT = [sys.executable, "-B", str(HERE / "bent_server.py"), "{endpoint}", "{scene}"]


def run(*arguments):
    """Exit code, stdout, stderr."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = cli.main(list(arguments))
    return code, out.getvalue(), err.getvalue()


class Version(unittest.TestCase):
    def test_is_told(self):
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            code = cli.main(["--version"], version="1.2.3")
        self.assertEqual((0, "ziggurat-conformance 1.2.3\n"), (code, out.getvalue()))


class Mistakes(unittest.TestCase):
    def expect(self, sentence, *arguments):
        code, _, err = run(*arguments)
        self.assertEqual(2, code, err)
        self.assertRegex(err, sentence)
        self.assertNotIn("Traceback", err)

    def test_a_program_that_is_not_there(self):
        self.expect(r"\./nothing: the server can't be started: No such file", "server", "--",
                    "./nothing", "{endpoint}")
        self.expect(r"\./nothing: the controller can't be started: No such file", "client", "--",
                    "./nothing")

    def test_a_server_that_ends_at_once(self):
        self.expect(r"ended at once, with exit code 7; it said:\nno libfoo", "server", "--", "sh", "-c",
                    "echo no libfoo >&2; exit 7")

    def test_names_of_reports_that_can_be_none(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            self.expect(r"--junit is '.*r.argos'; its name must end with \.xml", "client", "--junit",
                        str(folder / "r.argos"), "--", "true")
            self.expect("--html is '.*', a folder; name a file in it", "client", "--html", str(folder), "--", "true")
            self.expect("--html is '.*r.html', whose folder is not there", "client", "--html",
                        str(folder / "no" / "r.html"), "--", "true")

    def test_a_report_that_finds_no_room(self):
        self.expect("/dev/full can't be written: No space left on device", "server", "--only", "S9.stale",
                    "--json", "/dev/full", "--", *SERVER)

    def test_a_pipe_without_reader(self):
        with tempfile.TemporaryDirectory() as folder, mock.patch("ziggurat_conformance.outputs._READER_STARTS", 0.1):
            os.mkfifo(f"{folder}/r.json")
            self.expect("--json is '.*r.json', a pipe without reader; start its reader first", "server", "--json",
                        f"{folder}/r.json", "--", *SERVER)

    def test_lists_that_are_none(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            os.mkfifo(folder / "pipe")
            (folder / "long").write_bytes(b"S9.stale\n" * 200_000)
            (folder / "latin-1").write_bytes(b"\xe9")
            for path, sentence in (("/dev/zero", "/dev/zero is not a regular file"), (folder, "is not a regular file"),
                                   (folder / "pipe", "pipe is not a regular file"),
                                   (folder / "long", "long has more than 1000000 bytes"),
                                   (folder / "latin-1", "latin-1 is not text in UTF-8")):
                self.expect(sentence, "server", "--known-failing", str(path), "--", *SERVER)

    def test_a_server_that_does_not_listen(self):
        self.expect(r"nothing listens at tcp://\S+, which takes the place of \{endpoint\} .*after 0.5 s; "
                    r"the server said nothing", "server", "--start-patience", "0.5", "--", "sleep", "1000")

    def test_an_endpoint_without_server(self):
        self.expect("no server listens at tcp://127.0.0.1:1: Connection refused", "server",
                    "tcp://127.0.0.1:1")
        self.expect("no server listens at ipc:///nowhere/at/all", "server", "ipc:///nowhere/at/all")
        self.expect("'tcp://somewhere' is no endpoint", "server", "tcp://somewhere")
        self.expect("'udp://127.0.0.1:5' is no endpoint", "server", "udp://127.0.0.1:5")

    def test_cases_variants_and_lists_that_are_not_there(self):
        self.expect("no case matches --only nonsense", "server", "--only", "nonsense", "--", *SERVER)
        self.expect("no case asks for 'leas'; the variants are curve, director, lease", "server", "--variant", "leas=x", "--", *SERVER)
        self.expect("--variant 'lease': write NAME=COMMAND", "server", "--variant", "lease", "--", *SERVER)
        self.expect("--known-failing nowhere: No such file", "server", "--known-failing", "nowhere", "--",
                    *SERVER)
        self.expect("nothing to test", "server")


class Stdout(unittest.TestCase):
    """Of the program as a shell starts it."""

    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def play(self, redirection, *arguments, **environment):
        """Exit code, stderr. r.json is written to the folder."""
        words = shlex.join([sys.executable, "-B", "-m", "ziggurat_conformance", *arguments])
        ended = subprocess.run(["bash", "-o", "pipefail", "-c", f"{words} {redirection}"], stderr=subprocess.PIPE, text=True,
                               stdout=subprocess.DEVNULL, env={**os.environ, **environment}, timeout=HANG)
        return ended.returncode, ended.stderr

    def play_a_case(self, redirection, **environment):
        found = self.play(redirection, "server", "--only", "S9.stale", "--form", "binary", "--json",
                          str(self.folder / "r.json"), "--", *SERVER, **environment)
        self.assertEqual(["pass"], [case["verdict"] for case in json.loads((self.folder / "r.json").read_text())["cases"]])
        return found

    def test_that_is_closed(self):
        self.assertEqual((0, ""), self.play_a_case(">&-"))
        self.assertEqual((0, ""), self.play(">&-", "server", "--list"))

    def test_that_has_no_room(self):
        full = (2, "ziggurat-conformance: stdout can't be written: No space left on device\n")
        self.assertEqual(full, self.play_a_case("> /dev/full"))
        for arguments in (["server", "--list"], ["--help"], ["--version"], ["--scene"]):
            self.assertEqual(full, self.play("> /dev/full", *arguments))

    def test_whose_reader_ends(self):
        self.assertEqual((0, ""), self.play_a_case("| true"))
        self.assertEqual((0, ""), self.play("| head -1", "server", "--list"))

    def test_in_another_encoding(self):
        code, err = self.play("", "server", "--only", "S9.stale", "--", *BENT, "any-tick", PYTHONIOENCODING="ascii:strict")
        self.assertEqual((1, ""), (code, err))


class Ending(unittest.TestCase):
    """Of the program beside a server that does not answer."""

    def start(self, endpoint, *options):
        kit = subprocess.Popen([sys.executable, "-B", "-m", "ziggurat_conformance", "server", *options, "--form", "binary",
                                endpoint], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(kit.kill)
        return kit

    def flood(self, **message):
        """The endpoint of a server that says only that, without end."""
        data = wire.encode(wire.from_dict(wire.protocol.ServerMessage, message), wire.BINARY)
        greeting = b"\xff" + bytes(8) + b"\x7f\x03\x00NULL" + bytes(48)
        ready = b"\x05READY\x0bSocket-Type\x00\x00\x00\x06ROUTER"
        frames = (bytes([0, len(data)]) + data) * 100_000
        listener = socket.create_server(("127.0.0.1", 0))

        def send(connection):
            with connection, contextlib.suppress(OSError):
                connection.sendall(greeting + bytes([4, len(ready)]) + ready)
                heard = b""
                while b"READY" not in heard:  # the other end's, behind its greeting
                    heard += connection.recv(1024)
                while True:
                    connection.sendall(frames)

        def accept():
            with contextlib.suppress(OSError):
                while True:
                    threading.Thread(target=send, args=(listener.accept()[0],), daemon=True).start()

        threading.Thread(target=accept, daemon=True).start()
        self.addCleanup(listener.close)
        self.addCleanup(listener.shutdown, socket.SHUT_RDWR)
        return f"tcp://127.0.0.1:{listener.getsockname()[1]}"

    def test_heartbeats_without_end_do_not_extend_a_wait(self):
        kit = self.start(self.flood(heartbeat={"sequence": 1}), "--patience", "0.3", "--only", "S9.stale")
        out, err = kit.communicate(timeout=HANG)
        self.assertEqual((1, ""), (kit.returncode, err))
        self.assertIn("heard nothing; welcome is expected", out)

    def test_loading_without_end_does_not_extend_a_wait_for_ever(self):
        peer = Peer("p", self.flood(loading={}), wire.BINARY, Transcript())
        self.addCleanup(peer.close)
        with mock.patch("ziggurat_conformance.peer.longest_wait", lambda patience: 1.0):
            peer.send(wire.from_dict(wire.protocol.ClientMessage, {"hello": {}}))
            self.assertEqual("loading", wire.kind_of(peer.hear_behind("loading", 0.5)))

    def test_ctrl_c(self):
        listener = socket.create_server(("127.0.0.1", 0))
        self.addCleanup(listener.close)
        kit = self.start(f"tcp://127.0.0.1:{listener.getsockname()[1]}", "--patience", "60")
        for _ in range(2):  # the first one is whether a server listens
            self.addCleanup(listener.accept()[0].close)
        kit.send_signal(signal.SIGINT)
        _, err = kit.communicate(timeout=HANG)
        self.assertEqual((130, "ziggurat-conformance: interrupted; no report was written\n"), (kit.returncode, err))


class Help(unittest.TestCase):
    def test_is_a_command_too(self):
        self.assertIn("server|client", run("help")[1])
        self.assertIn("--variant", run("help", "server")[1])
        self.assertEqual(0, run("help")[0])


class Levels(unittest.TestCase):
    def test_of_one_level(self):
        listed = run("server", "--level", "hil", "--list")[1].splitlines()
        self.assertGreater(len(listed), 2)
        for line in listed[:-1]:
            self.assertIn(" HIL ", line)

    def test_are_reached_by_all_of_their_cases(self):
        cases = [SimpleNamespace(level=level, verdict=Verdict.PASS) for level in Level]
        left_out = collections.Counter({Level.HIL: 1})
        reached = {level: level is not Level.HIL or None for level in Level}
        self.assertEqual(reached, report.badges(cases, left_out))


class Reports(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def play(self, *arguments, patience="10"):
        code, out, _ = run("server", "--patience", patience, "--form", "binary", *arguments, "--json",
                           str(self.folder / "r.json"), "--junit", str(self.folder / "r.xml"), "--html",
                           str(self.folder / "r.html"), "--", *self.server)
        return code, out, json.loads((self.folder / "r.json").read_text())

    def test_of_a_server_that_is_right(self):
        self.server = SERVER
        code, out, report = self.play("--only", "S9.*", "--only", "L7.*", "--only", "K1.listed")
        self.assertEqual(0, code, out)
        self.assertEqual({"Core": None, "Reconnect": None, "HIL": None, "Secure": None},
                         report["badges"], "some cases are no badge")
        self.assertRegex(out, r"Core +open: \d+ not chosen\n")
        self.assertRegex(out, r"\d+ not run: give the server's command for it: --variant lease=…\n")
        self.assertRegex(out, r"Reconnect +open: \d+ not run, \d+ not chosen\n")
        self.assertRegex(out, r"HIL +open: \d+ not chosen\n")
        page = (self.folder / "r.html").read_text()
        self.assertRegex(page, r"Core: open: \d+ not chosen")
        self.assertNotIn("<pre>", page)
        self.assertIn("not run<br><small>give the server&#x27;s command for it", page)

    def test_through_a_pipe(self):
        path = self.folder / "pipe"
        os.mkfifo(path)
        with os.fdopen(os.open(path, os.O_RDONLY | os.O_NONBLOCK)) as reader:  # what is written is less than a pipe holds
            code, out, err = run("server", "--only", "S9.stale", "--form", "binary", "--json", str(path), "--",
                                 *SERVER)
            self.assertEqual((0, ""), (code, err), out)
            self.assertEqual("S9.stale", json.loads(reader.read())["cases"][0]["id"])

    def test_that_can_t_be_written_keep_no_other_from_its_file(self):
        path = self.folder / "r.html"
        code, _, err = run("server", "--only", "S9.stale", "--form", "binary", "--junit", "/dev/full", "--html",
                           str(path), "--", *SERVER)
        self.assertEqual(2, code)
        self.assertEqual("ziggurat-conformance: --junit /dev/full can't be written: No space left on device\n", err)
        self.assertIn("S9.stale", path.read_text())

    def test_of_a_server_that_is_wrong(self):
        self.server = [*BENT, "any-tick"]
        code, out, report = self.play("--only", "S9.*")
        self.assertEqual(1, code, out)
        self.assertFalse(report["badges"]["Core"])
        self.assertRegex(out, r"Core +not reached: \d fail, \d+ not chosen\n")
        page = (self.folder / "r.html").read_text()
        self.assertIn("<h2>S9.stale: A Command for an earlier tick is STALE_TICK</h2>", page)
        self.assertRegex(page, r"<p>.*the tick went on with a message that must be refused: .* \(S9\)</p><pre>")
        suite = ElementTree.parse(self.folder / "r.xml").getroot()
        self.assertEqual(suite.get("failures"), str(len(suite.findall("testcase/failure"))))
        self.assertLess(max(len(line) for line in out.splitlines() if "──▶" in line or "◀──" in line), 250)

    def test_of_a_server_that_dies_in_the_middle(self):
        self.server = [*BENT, "dies"]
        code, out, report = self.play("--only", "S9.*")
        self.assertEqual(1, code, out)
        [stale] = [case for case in report["cases"] if case["id"] == "S9.stale"]
        self.assertRegex(stale["reason"], r"(?s)error is expected; the server had ended, and had said:\n.*\ngoodbye")
        self.assertTrue(any(case["verdict"] == "pass" for case in report["cases"]), "it is started anew")


if __name__ == "__main__":
    unittest.main()
