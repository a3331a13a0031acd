# SPDX-License-Identifier: MIT
"""The end of the program: by signals in any situation, and by force; what is left behind."""

import contextlib
import json
import os
import pathlib
import resource
import signal
import socket
import subprocess
import time

from harness import CONTROLLER_FAILED, INTERRUPTED, LIMIT, LUA, SceneTest, ZIGGURAT, main
from waiting import wait_until, wait_until_idle

ENDLESS = ("--duration", "0")
MOST = 1.5  # [s] where nothing else computes; the program promises 1


SLOW_TICK = """<argos-configuration>
  <framework><experiment length="0" ticks_per_second="1" random_seed="1" /></framework>
  <controllers />
  <arena size="100,100,10" center="0,0,5">{}</arena>
  <physics_engines>
    <dynamics3d id="d" iterations="1000000"><gravity g="9.8" /></dynamics3d>
  </physics_engines>
  <media />
</argos-configuration>""".format("".join(
    f'<box id="b{i}" size=".1,.1,.1" movable="true" mass="1"><body position="{i / 2 - 25},0,0" /></box>'
    for i in range(100)))  # they fall without end: what rests costs nothing


def guardian_of(parent):
    """The id of the guardian that this process started."""
    for entry in pathlib.Path("/proc").iterdir():
        try:
            name, _, rest = (entry / "stat").read_text().partition("(")[2].rpartition(")")
        except OSError:  # no process, or gone
            continue
        if name == "zig-guardian" and int(rest.split()[1]) == parent:
            return int(entry.name)
    raise AssertionError("there is no guardian")


def has_ended(pid):
    """Also if its new parent has not asked for it yet."""
    try:
        return pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


class Signals(SceneTest):
    def assert_ends_soon(self, process, number, code=INTERRUPTED):
        start = time.monotonic()
        process.send_signal(number)
        code_found = process.wait(LIMIT)
        self.assertFalse(self.is_late(start, MOST))
        self.assertEqual(code_found, code)

    def test_in_a_tick_that_takes_long(self):
        scene = self.write("slow.argos", SLOW_TICK)
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            hashes = self.folder / "hashes"
            process = self.start("run", scene, "--hash-file", hashes)
            self.wait_for(hashes.exists, bool, "hash file")
            self.wait_until_it_computes(process.pid, 1)
            self.assert_ends_soon(process, number)
            self.assertIn("hash 0 ", hashes.read_text(), "what was written before is there")

    def test_a_limit_of_processor_time_ends_it_as_control_c_does(self):
        summary = self.folder / "s.json"
        scene = self.write("drop.argos", SLOW_TICK.replace("1000000", "10"))  # without controllers, which have limits, too
        process = self.start("run", scene, *ENDLESS, "--summary", summary,
                             preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (1, 100)))
        self.assertEqual(self.finish(process).code, INTERRUPTED)
        self.assertEqual(json.loads(summary.read_text())["ending"], "interrupted")

    def test_output_to_a_pipe_that_is_not_read(self):
        """The world goes on: a reader that stops stops nothing."""
        hashes = self.folder / "hashes"
        for command in ("run", "serve"):
            process = self.start(command, self.scene, *ENDLESS, "--hash-file", hashes)
            if command == "serve":
                self.started.append(subprocess.Popen(
                    [LUA, "--connect", self.read_until(process.stdout, "^endpoint (.*)$")[1], "--quiet"],
                    cwd=self.folder))
            full = 100_000  # [bytes] of hashes: what the robots log meanwhile does not fit into a pipe
            self.wait_for(lambda: hashes.exists() and hashes.stat().st_size, lambda size: size > full,
                          "ticks beyond what the pipe holds")
            self.assert_ends_soon(process, signal.SIGINT)
            hashes.unlink()

    def unread(self):
        """A pipe that is full."""
        reader, writer = os.pipe()
        for end in (reader, writer):
            self.addCleanup(os.close, end)
        os.set_blocking(writer, False)
        with contextlib.suppress(BlockingIOError):
            while True:
                os.write(writer, bytes(4096))
        os.set_blocking(writer, True)
        return writer

    def test_messages_to_a_pipe_that_is_not_read(self):
        recording = self.folder / "r.mcap"
        self.run_scene("--ticks", 1000, "--record", recording, "--quiet")
        for number in (signal.SIGINT, signal.SIGTERM):
            for words, code in ((("top", "tcp://127.0.0.1:1"), 128 + number),
                                (("export", recording, "--jsonl", self.folder / "x.jsonl"), -number)):
                with self.subTest(words[0], number=number):
                    pipe = self.unread()
                    process = subprocess.Popen([str(ZIGGURAT), *map(str, words)], cwd=self.folder, env=self.environment, stdout=pipe,
                                               stderr=pipe)
                    self.started.append(process)
                    wait_until_idle(process.pid)
                    self.assert_ends_soon(process, number, code)

    def test_top_before_it_is_connected(self):
        listener = socket.create_server(("127.0.0.1", 0))  # accepts, and says nothing
        self.addCleanup(listener.close)
        for endpoint in ("tcp://127.0.0.1:1", f"tcp://127.0.0.1:{listener.getsockname()[1]}"):
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                with self.subTest(endpoint, number=number):
                    process = self.start("top", endpoint)
                    self.read_until(process.stderr, "nothing answers")
                    self.assert_ends_soon(process, number, 128 + number)

    def test_trace_to_a_pipe_without_reader(self):
        fifo = self.folder / "t.csv"
        os.mkfifo(fifo)
        process = self.start("run", self.scene, *ENDLESS, "--trace", fifo)
        wait_until_idle(process.pid)
        self.assert_ends_soon(process, signal.SIGTERM)

    def test_trace_to_a_pipe_that_is_not_read(self):
        fifo = self.folder / "t.csv"
        os.mkfifo(fifo)
        reader = os.open(fifo, os.O_RDONLY | os.O_NONBLOCK)
        self.addCleanup(os.close, reader)
        process = self.start("run", self.scene, *ENDLESS, "--trace", fifo, stdout=subprocess.DEVNULL)
        wait_until_idle(process.pid)
        self.assert_ends_soon(process, signal.SIGINT)

    def test_a_controller_that_ignores_everything(self):
        process = self.start("run", self.scene, "--controller",
                             "swing=trap '' TERM INT HUP; echo begun; while :; do sleep 1; done")
        self.read_until(process.stdout, "^begun$")
        self.assert_ends_soon(process, signal.SIGINT)

    def test_a_terminated_process_of_several_ends_the_run(self):
        process = self.begin_endless()
        self.lua_processes(2)
        [(victim, _)] = self.processes("ziggurat-lua", f"{self.runtime}/", "/robots-1")
        os.kill(victim, signal.SIGTERM)
        outcome = self.finish(process)
        self.assertEqual(outcome.code, CONTROLLER_FAILED, outcome.err)
        self.assertRegex(outcome.err, r"ziggurat-lua 2 of 2 .*ended with exit code 143 at tick \d+.*r1, r2")

    def begin_endless(self):
        process = self.start("run", self.scene, *ENDLESS, "--lua-processes", 2)
        self.read_until(process.stdout, r"^\[20 r2\]")
        return process

    def test_a_killed_lua_process_of_several_ends_the_run(self):
        process = self.begin_endless()
        [(victim, _)] = self.processes("ziggurat-lua", f"{self.runtime}/", "/robots-1")
        os.kill(victim, signal.SIGKILL)
        outcome = self.finish(process)
        self.assertEqual(outcome.code, CONTROLLER_FAILED, outcome.err)
        self.assertRegex(outcome.err, r"ziggurat-lua 2 of 2 .*killed by signal 9.*r1, r2")

    def test_a_stopped_lua_process_does_not_keep_it(self):
        process = self.begin_endless()
        [(victim, _)] = self.processes("ziggurat-lua", f"{self.runtime}/", "/robots-1")
        os.kill(victim, signal.SIGSTOP)
        self.interrupt(process)
        self.assertEqual(self.finish(process).code, INTERRUPTED)

    def test_without_guardian_it_leaves_nothing(self):
        for number in (signal.SIGKILL, signal.SIGSTOP):
            process = self.begin_endless()
            guardian = guardian_of(process.pid)
            os.kill(guardian, number)
            self.interrupt(process)
            self.assertEqual(self.finish(process).code, INTERRUPTED)
            self.assertEqual(list(self.runtime.iterdir()), [])
            self.wait_for(lambda: has_ended(guardian), bool, "end of the guardian")


class Killed(SceneTest):
    def test_a_shells_children_end_with_the_server(self):
        command = "sleep 1000.25 & sleep 1000.25 & echo begun; wait"
        process = self.start("run", self.scene, "--controller", f"swing={command}")
        self.read_until(process.stdout, "^begun$")
        self.assertEqual(len(self.processes("sleep 1000.25", )) >= 2, True)
        process.kill()
        process.wait()
        self.wait_for(lambda: [t for _, t in self.processes("sleep 1000.25") if t.startswith("sleep")],
                      lambda left: not left, "end of the shell's children")
        self.wait_for(lambda: list(self.runtime.iterdir()), lambda left: not left,
                      "removal of the private folder")

    def test_lua_processes_end_without_guardian_too(self):
        process = self.start("run", self.scene, *ENDLESS, "--lua-processes", 2)
        self.read_until(process.stdout, r"^\[20 r2\]")
        os.kill(guardian_of(process.pid), signal.SIGKILL)
        process.kill()
        process.wait()
        self.assertEqual(self.left_processes(), [])
        self.assertNotEqual(list(self.runtime.iterdir()), [])
        self.run_scene("--ticks", 1, "--quiet")  # removes what is left

    def test_sockets_are_removed(self):
        socket = self.folder / "s"
        process = self.start("serve", self.scene, "--endpoint", f"ipc://{socket}")
        self.read_until(process.stdout, "endpoint")
        self.assertTrue(socket.exists())
        process.kill()
        process.wait()
        self.wait_for(socket.exists, lambda there: not there, "removal of the socket")

    def test_a_server_that_begins_at_the_path_of_a_killed_one_stays(self):
        """Its socket may have the inode of the one before."""
        path = self.folder / "s"
        begin = lambda: self.start("run", self.scene, *ENDLESS, "--real-time", 1, "--endpoint", f"ipc://{path}")
        server = begin()
        self.read_until(server.stdout, r"^\[1 r2\]")
        for _ in range(3):
            guardian = guardian_of(server.pid)
            server.kill()
            server.wait()
            server = begin()
            self.wait_for(lambda: has_ended(guardian), bool, "end of the guardian")
            self.read_until(server.stdout, r"^\[1 r2\]")
            with socket.socket(socket.AF_UNIX) as client:
                client.connect(str(path))
        server.terminate()
        self.finish(server)

    def test_what_dead_programs_left_is_removed_at_the_next_start(self):
        left = self.runtime / "ziggurat-AbCdEf"
        left.mkdir()
        (left / "lock").touch()
        (left / "run").touch()
        process = self.start("run", self.scene, *ENDLESS)
        self.read_until(process.stdout, r"^\[2 r2\]")
        self.assertFalse(left.exists())
        other = self.start("run", self.scene, *ENDLESS)  # leaves the folder of the first alone
        self.read_until(other.stdout, r"^\[2 r2\]")
        self.assertEqual(len(list(self.runtime.iterdir())), 2)
        for each in (process, other):
            each.terminate()
            self.finish(each)

    def test_outputs_are_written_each_second(self):
        trace, hashes = self.folder / "trace.csv", self.folder / "hashes"
        readings = self.folder / "r.jsonl"
        process = self.start("run", self.scene, *ENDLESS, "--real-time", 1, "--trace", trace,
                             "--hash-file", hashes, "--readings", readings)
        self.read_until(process.stdout, r"^\[30 r2\]")  # 2 s after tick 10
        process.kill()
        process.wait()
        for file in (trace, hashes, readings):
            self.assertTrue(file.read_text().endswith("\n"), file)
        self.assertGreaterEqual(int(hashes.read_text().splitlines()[-1].split()[1]), 10)
        self.assertGreaterEqual(int(trace.read_text().splitlines()[-1].split(",")[0]), 10)
        json.loads(readings.read_text().splitlines()[-1])
        self.wait_for(lambda: list(self.runtime.iterdir()), lambda left: not left, "removal")


if __name__ == "__main__":
    main()
