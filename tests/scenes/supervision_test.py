# SPDX-License-Identifier: MIT
"""Runs observed and controlled from outside: ctl, top, metrics, hardware in the loop."""

import json
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import unittest
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))

from waiting import HANG, wait_until, wait_until_idle  # noqa: E402

BIN = pathlib.Path(os.environ.get("ZIGGURAT_BIN", ROOT / "build/release/bin"))
DROP = ROOT / "scenes/dynamics3d_single_body_test.argos"
VEHICLE = ROOT / "scenes/dynamics3d_multi_body_test.argos"


class Server:
    """ziggurat serve on a free port."""

    def __init__(self, scene, *options):
        self.process = subprocess.Popen(
            [BIN / "ziggurat", "serve", scene, "--endpoint", "tcp://127.0.0.1:*", "--json", *options],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.url = json.loads(self.process.stdout.readline())["endpoint"]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGINT)
        try:
            self.process.communicate(timeout=HANG)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.communicate()

    def ask(self, command, *words, check=True):
        outcome = subprocess.run([BIN / "ziggurat", command, self.url, *words], capture_output=True,
                                 text=True, timeout=HANG)
        if check and outcome.returncode != 0:
            raise AssertionError(f"{command} {words}: {outcome.stderr}")
        return outcome

    def tick(self):
        return int(json.loads(self.ask("ctl", "status", "--json").stdout)["tick"])

    def sessions(self):
        """How many there are, with the one that asks."""
        return len(json.loads(self.ask("ctl", "status", "--json").stdout)["sessions"])

    def wait_for_tick(self, tick):
        wait_until(lambda: self.tick() >= tick, f"the world is at tick {tick}")

    def read(self, *patterns):
        return json.loads(self.ask("ctl", "read", *patterns, "--json").stdout)


class Ctl(unittest.TestCase):
    def test_steps_a_world_without_controllers(self):
        with Server(DROP) as server:
            self.assertIn("paused", server.ask("top", "--once").stdout)
            first = server.read()
            server.ask("ctl", "step", "5")
            fallen = server.read()
            self.assertLess(fallen["entities"][5]["position"][2], first["entities"][5]["position"][2])
            status = json.loads(server.ask("ctl", "status", "--json").stdout)
            self.assertEqual("5", status["tick"])
            self.assertRegex(status["sceneHash"], "^[0-9a-f]{16}$")
            server.ask("ctl", "reset")
            self.assertEqual(first["hash"], server.read()["hash"])
            server.ask("ctl", "step", "5")
            self.assertEqual(fallen["hash"], server.read()["hash"])

    def test_moves_and_refuses_wrong_requests_with_a_reason(self):
        with Server(DROP) as server:
            entity = server.read()["entities"][0]["id"]
            server.ask("ctl", "move", entity, "0.1,0.2,0.3", "90,0,0")
            moved = server.read(entity)["entities"][0]
            self.assertEqual([0.1, 0.2, 0.3], [round(v, 9) for v in moved["position"]])
            self.assertAlmostEqual(0.5**0.5, moved["orientation"][3], places=9)
            with tempfile.NamedTemporaryFile() as empty:
                spawned = server.ask("ctl", "spawn", empty.name, check=False)
            self.assertEqual(1, spawned.returncode)
            self.assertIn("BAD_VALUE", spawned.stderr)
            for words, reason in ((("move", "unknown", "0,0,0"), "UNKNOWN_ENTITY"),
                                  (("spawn", os.devnull), "not a regular file"),
                                  (("move", entity, "1,2,3,4"), "position is '1,2,3,4'; it must be x,y,z"),
                                  (("move", entity, "1,2,3", "90"), "orientation is '90'; it must be turns"),
                                  (("paus",), "did you mean 'pause'?")):
                outcome = server.ask("ctl", *words, check=False)
                self.assertEqual(1, outcome.returncode, words)
                self.assertIn(reason, outcome.stderr)

    def test_wrong_words_are_told_also_if_no_server_is_there(self):
        with tempfile.TemporaryDirectory() as folder:
            large, pipe = pathlib.Path(folder, "large"), pathlib.Path(folder, "pipe")
            large.write_bytes(b"<" * ((1 << 20) + 1))
            os.mkfifo(pipe)
            for words, reason in ((("step", "0"), "step is 0; write 1 or more"), (("step", "x"), "step is 'x'"),
                                  (("reset", "--seed", "-1"), "--seed is '-1'"), (("move", "a", "1,2"), "position is '1,2'"),
                                  (("snapshot", "a/b"), "The name of a snapshot has 1 to 64"),
                                  (("restore", ".x"), "does not begin with '.'; '.x' is none"), (("spawn", folder), "is a folder"),
                                  (("spawn", large), "has more than 1048576 bytes"), (("spawn", pipe), "is not a regular file"),
                                  (("spawn", "-"), "standard input has more than 1048576 bytes"),
                                  (("pause", "--seed", "1"), "--seed is for reset")):
                with self.subTest(words), open("/dev/zero", "rb") as endless:
                    outcome = subprocess.run([BIN / "ziggurat", "ctl", f"ipc://{folder}/none", *words], capture_output=True,
                                             text=True, stdin=endless, timeout=HANG)
                    self.assertEqual(1, outcome.returncode)
                    self.assertIn(reason, outcome.stderr)

    def test_a_server_that_is_not_there_is_told_while_it_is_waited_for(self):
        with socket.socket() as closed:
            closed.bind(("127.0.0.1", 0))  # and does not listen
            url = f"tcp://127.0.0.1:{closed.getsockname()[1]}"
            for words in (["top", url], ["ctl", url, "status"]):
                with subprocess.Popen([BIN / "ziggurat", *words], stderr=subprocess.PIPE, text=True) as asking:
                    self.assertIn(f"nothing answers at {url} yet", asking.stderr.readline())
                    asking.kill()

    def test_a_pause_before_controllers_come_is_answered_at_once(self):
        with Server(VEHICLE, "--duration", "0") as server:
            self.assertIn("gathering", server.ask("ctl", "status").stdout)
            server.ask("ctl", "pause")
            self.assertEqual(server.tick(), 0)
            status = server.ask("ctl", "status").stdout
            self.assertIn("paused, tick 0", status)
            self.assertIn("waiting for a client to connect for", status)
            lua = subprocess.Popen([BIN / "ziggurat-lua", "--connect", server.url, "--quiet"],
                                   stdout=subprocess.DEVNULL)
            try:
                server.ask("ctl", "step", "3")  # waits for the controller
                self.assertEqual(server.tick(), 3)
            finally:
                server.ask("ctl", "resume")
                lua.kill()
                lua.wait()

    def test_outputs_have_all_ticks_when_a_pause_or_a_step_is_answered(self):
        with tempfile.TemporaryDirectory() as folder:
            trace, hashes = pathlib.Path(folder, "trace.csv"), pathlib.Path(folder, "hashes")
            with Server(DROP, "--duration", "0", "--trace", trace, "--hash-file", hashes) as server:
                for _ in range(5):
                    server.ask("ctl", "resume")
                    server.ask("ctl", "pause")
                    server.ask("ctl", "step", "2")
                    tick = server.tick()
                    self.assertEqual(hashes.read_text().splitlines()[-1].split()[1], str(tick))
                    self.assertEqual(trace.read_text().splitlines()[-1].split(",")[0], str(tick))

    def test_can_be_paused_from_the_start(self):
        with Server(DROP, "--duration", "0", "--real-time", "--paused") as server:
            self.assertIn("paused, tick 0", server.ask("ctl", "status").stdout)
            server.ask("ctl", "step", "1")
            self.assertEqual(server.tick(), 1)
            server.ask("ctl", "resume")
            server.wait_for_tick(3)

    def test_a_step_waits_for_controllers_of_a_world_that_begins_paused(self):
        with Server(VEHICLE, "--duration", "0", "--paused") as server:
            step = subprocess.Popen([BIN / "ziggurat", "ctl", server.url, "step", "3"], stdout=subprocess.DEVNULL,
                                    stderr=subprocess.PIPE, text=True)
            wait_until_idle(step.pid)
            self.assertIsNone(step.poll())
            lua = subprocess.Popen([BIN / "ziggurat-lua", "--connect", server.url, "--quiet"],
                                   stdout=subprocess.DEVNULL)
            try:
                self.assertEqual(step.communicate(timeout=HANG)[1], "")
                self.assertEqual(server.tick(), 3)
            finally:
                lua.kill()
                lua.wait()

    def test_steps_end_with_the_one_who_asked_for_them(self):
        for number in (signal.SIGINT, signal.SIGKILL):
            for paced in ([], ["--real-time", "5"]):
                with self.subTest(number=number, paced=paced), Server(DROP, "--duration", "0", *paced) as server:
                    server.ask("ctl", "pause")
                    before = server.tick()
                    stepping = subprocess.Popen([BIN / "ziggurat", "ctl", server.url, "step", "1000000000"],
                                                stderr=subprocess.DEVNULL)
                    server.wait_for_tick(before + 1)
                    stepping.send_signal(number)
                    stepping.wait()
                    server.ask("ctl", "step", "1")
                    before = server.tick()
                    for ticks in range(1, 11):
                        server.ask("ctl", "step", "1")
                        self.assertEqual(server.tick(), before + ticks, "it is paused between steps")

    def test_a_reset_ends_steps_of_others(self):
        with Server(DROP, "--duration", "0") as server:
            steps = []
            for _ in range(2):  # the second one waits for the first
                steps.append(subprocess.Popen([BIN / "ziggurat", "ctl", server.url, "step", "1000000000"],
                                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True))
                server.wait_for_tick(1)
            wait_until(lambda: server.sessions() == 2 + 1, "both have a session, and who asks")
            wait_until_idle(steps[1].pid)
            server.ask("ctl", "reset")
            for step in steps:
                _, said = step.communicate(timeout=HANG)
                self.assertEqual(step.returncode, 1)
                self.assertIn("OUT_OF_STATE: A reset or restore has ended these steps", said)
            self.assertEqual(server.tick(), 0)
            server.ask("ctl", "step", "3")
            self.assertEqual(server.tick(), 3)

    def test_resuming_ends_a_step(self):
        with Server(DROP, "--duration", "0") as server:
            stepping = subprocess.Popen([BIN / "ziggurat", "ctl", server.url, "step", "1000000"],
                                        stderr=subprocess.PIPE, text=True)
            server.wait_for_tick(1)
            server.ask("ctl", "resume")
            _, stderr = stepping.communicate(timeout=HANG)
            self.assertEqual(1, stepping.returncode)
            self.assertIn("OUT_OF_STATE", stderr)

    def test_a_planned_shutdown_is_no_interruption(self):
        with tempfile.TemporaryDirectory() as folder:
            summary = pathlib.Path(folder, "summary.json")
            with Server(DROP, "--summary", summary) as server:
                refused = server.ask("ctl", "pause", "--reason", "why", check=False)
                self.assertIn("--reason is for shutdown", refused.stderr)
                server.ask("ctl", "shutdown", "--reason", "the robots are home")
                self.assertEqual(0, server.process.wait(HANG))
            told = json.loads(summary.read_text())
            self.assertEqual(("shut_down", "the robots are home"),
                             (told["ending"], told["shutdown_reason"]))


class Metrics(unittest.TestCase):
    def test_report_the_missing_robots(self):
        with Server(VEHICLE, "--metrics", "127.0.0.1:0") as server:
            url = None
            for line in server.process.stderr:
                if "metrics at " in line:
                    url = "http://" + line.split("metrics at http://")[1].split('"')[0].strip()
                    break
            metrics = wait_until(lambda: urllib.request.urlopen(url + "/metrics", timeout=HANG).read().decode(),
                                 "the first copy is published")
            status = json.load(urllib.request.urlopen(url + "/status", timeout=HANG))
        self.assertEqual("GATHERING", status["phase"])
        self.assertIn("\nziggurat_free_robots 1\n", metrics)


class Hil(unittest.TestCase):
    def run_vehicle(self, *options):
        # Each answer has 20 s: a busy machine misses none.
        return subprocess.run(
            [BIN / "ziggurat", "run", VEHICLE, "--hil", "--real-time", "2", "--ticks", "10",
             "--deadline", "hold:20000", *options],
            capture_output=True, text=True, timeout=HANG)

    def test_a_report_card_and_a_gate(self):
        with tempfile.TemporaryDirectory() as folder:
            card = pathlib.Path(folder) / "card.json"
            good = self.run_vehicle("--gate", "max<30s,misses<100%", "--report-card", card)
            self.assertEqual(0, good.returncode, good.stderr)
            report = json.loads(card.read_text())
            self.assertTrue(report["passed"])
            self.assertEqual(report["controllers"][0]["answers"], 11)  # to the ticks 0 to 10
            picture = pathlib.Path(folder) / "card.svg"
            bad = self.run_vehicle("--gate", "max<0.001us", "--report-card", picture)
            self.assertEqual(4, bad.returncode, bad.stderr)
            self.assertIn("gate: not met", bad.stderr)
            self.assertIn("<svg", picture.read_text())


if __name__ == "__main__":
    unittest.main()
