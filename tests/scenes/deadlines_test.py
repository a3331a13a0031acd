# SPDX-License-Identifier: MIT
"""Controllers that are stopped, killed and continued, under each deadline policy."""

import json
import os
import re
import signal
import subprocess
import time

from harness import CONTROLLER_FAILED, FAULT, FINISHED, INTERRUPTED, LUA, SceneTest, main


class Deadlines(SceneTest):
    """r1 has a controller of its own, "frail". The others have no deadline, so a busy machine makes none late."""

    def setUp(self):
        super().setUp()
        swing = re.search(r'<lua_controller id="swing">.*?</lua_controller>', self.text, re.DOTALL)[0]
        self.change("</controllers>", swing.replace('"swing"', '"frail"') + "</controllers>")
        r1 = re.search(r'<prototype id="r1">.*?</prototype>', self.text, re.DOTALL)[0]
        self.change(r1, r1.replace('config="swing"', 'config="frail"'))

    def disturb(self, number, *arguments):
        """An endless run with one process per robot. The process of r1 gets the signal after tick 20. It is
        paced: a run does not wait for those who read its output."""
        process = self.start("run", self.scene, "--duration", 0, "--lua-processes", 0, "--real-time", 20,
                             *arguments)
        self.read_until(process.stdout, r"^\[20 r2\]")
        [(self.victim, _)] = self.processes("ziggurat-lua", f"{self.runtime}/", "/robots-1")
        os.kill(self.victim, number)
        return process

    def step_of(self, process, robot):
        """Tick and count of the next line of a robot."""
        found = self.read_until(process.stdout, rf"^\[(\d+) {robot}\] step (\d+)")
        return int(found[1]), int(found[2])

    def continues(self, process, ticks=40):
        """Waits until the run has made so many more ticks; returns the last one."""
        first, _ = self.step_of(process, "r2")
        self.read_until(process.stdout, rf"^\[{first + ticks} r2\]")
        return first + ticks

    def interrupted(self, process):
        self.interrupt(process)
        outcome = self.finish(process)
        self.assertEqual(outcome.code, INTERRUPTED, outcome.err)
        return outcome

    def test_hold_continues_and_accepts_the_late_controller_again(self):
        process = self.disturb(signal.SIGSTOP, "--deadline", "frail=hold:30")
        tick = self.continues(process)
        os.kill(self.victim, signal.SIGCONT)
        found = self.read_until(process.stdout, r"^\[(\d+) r1\] step (\d+)")
        self.assertGreaterEqual(int(found[1]), tick - 40)
        outcome = self.interrupted(process)
        self.assertRegex(outcome.err, r"\(r1\) missed its deadline of 30 ms at tick \d+")
        self.assertRegex(outcome.err, r"controller 'frail' missed its deadline at \d+ ticks")

    def test_drop_removes_the_controller_for_the_rest_of_the_run(self):
        for number in signal.SIGSTOP, signal.SIGKILL:
            with self.subTest(number=number):
                process = self.disturb(number, "--deadline", "frail=drop:200:4")
                self.continues(process, ticks=100)
                outcome = self.interrupted(process)
                self.assertRegex(outcome.err,
                                 r"robot r1 \(controller 'frail'\) is dropped at tick \d+")
                self.assertIn("drop:200:4", outcome.err)

    def test_a_dropped_robot_is_a_failure_unless_it_is_allowed(self):
        summary = self.folder / "s.json"
        for options, code, ending in (((), CONTROLLER_FAILED, "finished"),
                                      (("--allow-drops",), FINISHED, "finished"),
                                      (("--fail-fast",), CONTROLLER_FAILED, "failed_fast")):
            process = self.start("run", self.scene, "--ticks", 60, "--real-time", 2, "--lua-processes", 0,
                                 "--deadline", "frail=drop:100:1", "--summary", summary, *options)
            self.read_until(process.stdout, r"^\[10 r2\]")
            [(victim, _)] = self.processes("ziggurat-lua", f"{self.runtime}/", "/robots-1")
            os.kill(victim, signal.SIGSTOP)
            outcome = self.finish(process)
            self.assertEqual(outcome.code, code, outcome.err)
            found = json.loads(summary.read_text())
            self.assertEqual(found["ending"], ending)
            self.assertEqual(len(found["dropped"]), 1)
            self.assertIn("robot r1 (controller 'frail') is dropped at tick", found["dropped"][0])
            self.assertEqual(found["ticks"] < 60, ending == "failed_fast")

    def test_stop_ends_the_run_with_a_clear_message(self):
        process = self.disturb(signal.SIGSTOP, "--deadline", "frail=stop:2000")
        outcome = self.finish(process)
        self.assertEqual(outcome.code, CONTROLLER_FAILED)
        self.assert_is_sentence(
            outcome, r"controller 'frail' of robot r1 did not answer at tick \d+: .* stop:2000 ")

    def test_deadlines_change_no_result_while_answers_are_in_time(self):
        expected = self.hash_of("--ticks", 40)
        self.assertEqual(self.hash_of("--ticks", 40, "--deadline", "zero:20000"), expected)
        process = self.start("run", self.scene, "--ticks", 40, "--real-time", 4, "--hash",
                             "--lua-processes", 0)  # without deadlines nothing is lost either
        self.read_until(process.stdout, r"^\[5 r2\]")
        [(victim, _)] = self.processes("ziggurat-lua", f"{self.runtime}/", "/robots-1")
        os.kill(victim, signal.SIGSTOP)
        time.sleep(0.5)  # elapsed time is the subject: that of ten ticks
        os.kill(victim, signal.SIGCONT)
        outcome = self.finish(process)
        self.assertEqual((outcome.code, outcome.lines[-1]), (FINISHED, expected))

    def test_the_command_line_overrides_deadlines_of_the_scene(self):
        self.change('<lua_controller id="frail">',
                    '<lua_controller id="frail" deadline="drop" deadline_ms="100" miss_budget="2">')
        checked = self.ziggurat("check", self.scene)
        self.assertIn("(deadlines: frail=drop:100:2)", checked.out)
        for options, policy in (((), "drop:100:2"),
                                (("--hil", "--real-time", 10), "drop:100:2"),
                                (("--deadline", "frail=drop:120:1"), "drop:120:1")):
            with self.subTest(options=options):
                self.assertEqual(self.dropped_robot(*options), ("r1", policy))

    def dropped_robot(self, *options):
        """(robot, policy) of the robot that is dropped after the controller of r1 was stopped."""
        log = self.folder / "log"
        with log.open("w") as stdout:
            process = self.start("run", self.scene, "--duration", 0, "--lua-processes", 0, *options,
                                 stdout=stdout)
        self.wait_for(log.read_text, lambda text: re.search(r"^\[([2-9]\d|\d{3,}) r2\]", text, re.M),
                      "tick 20")
        [(victim, _)] = self.processes("ziggurat-lua", f"{self.runtime}/", "/robots-1")
        os.kill(victim, signal.SIGSTOP)
        found = self.read_until(process.stderr,
                                r"robot (\w+) .* is dropped at tick \d+: .* in a row, (\S+)")
        self.interrupted(process)
        return found[1], found[2]

    def test_a_controller_that_does_not_exist(self):
        outcome = self.run_scene("--deadline", "swong=hold:5", code=FAULT)
        self.assert_is_sentence(outcome, "no controller or director 'swong'; did you mean 'swing'?")


class Keys(SceneTest):
    def keygen(self, name):
        outcome = self.ziggurat("keygen", "--out", name)
        self.assertEqual(outcome.code, FINISHED, outcome.err)
        return outcome.out.strip()

    def test_only_listed_keys_may_connect(self):
        expected = self.hash_of("--ticks", 20)
        server, listed = self.keygen("server"), self.keygen("listed")
        self.assertEqual((self.folder / "listed.secret").stat().st_mode & 0o777, 0o600)
        self.keygen("unlisted")
        self.write("clients", f"# known keys\n{listed} controller A listed client\n")
        process = self.start("serve", self.scene, "--endpoint", "tcp://127.0.0.1:*", "--hash",
                             "--curve-secret", "server.secret", "--curve-clients", "clients")
        endpoint = re.match(r"endpoint (\S+)", process.stdout.readline())[1]
        lua = [str(LUA), "--connect", endpoint, "--quiet",
               "--server-key", server, "--curve-secret"]
        unlisted = subprocess.Popen([*lua, "unlisted.secret"], cwd=self.folder)
        self.started.append(unlisted)
        self.started.append(subprocess.Popen([*lua, "listed.secret"], cwd=self.folder))
        outcome = self.finish(process)
        self.assertEqual((outcome.code, outcome.lines[-1]), (FINISHED, expected), outcome.err)
        unlisted.kill()
        unlisted.wait()

    def test_a_key_for_robots_that_are_not_there_is_told(self):
        self.keygen("server")
        self.write("clients", f"{self.keygen('listed')} controller robots=zzz*,r0 Alice\n")
        outcome = self.run_scene("--ticks", 2, "--endpoint", "tcp://127.0.0.1:*", "--curve-secret", "server.secret",
                                 "--curve-clients", "clients")
        self.assertIn("notice: --curve-clients: robots=zzz* of the key Alice means no robot of the scene", outcome.err)

    def test_scripts_change_no_file_of_the_run_and_read_no_secret_key(self):
        """Whatever these files are called; the scene starts programs, and the list decides who may connect."""
        scene = self.write("arms.txt", self.text.replace("<framework>", '<include file="more.dat"/><framework>')
                           .replace("swing.lua", "swing.log"))
        self.write("more.dat", "<more/>")
        listed = self.keygen("server")
        self.write("clients.txt", f"{listed} controller\n")
        self.write("swing.log", """function init()
   for _, name in ipairs{"arms.txt", "more.dat", "swing.log", "clients.txt", "server.secret", "hashes.csv", "x.LUA", "notes.txt"} do
      local reads, appends = io.open(name), io.open(name, "a")
      log(name, reads and " is read" or "", appends and " is written" or "", os.rename("data.txt", name) and " is replaced" or "",
          os.remove(name) and " is removed" or "")
   end
end
function step() end""")
        self.write("data.txt", "")
        outcome = self.run_scene("--ticks", 1, "--lua-processes", 1, "--endpoint", "tcp://127.0.0.1:*",
                                 "--curve-secret", "server.secret", "--curve-clients", "clients.txt",
                                 "--hash-file", "hashes.csv", scene=scene)
        self.assertEqual([line.removeprefix("[0 r0] ") for line in outcome.lines if "r0" in line],
                         ["arms.txt is read", "more.dat is read", "swing.log is read", "clients.txt is read",
                          "server.secret", "hashes.csv is read", "x.LUA", "notes.txt is written is replaced is removed"])

    def test_run_starts_its_own_controllers_beside_protected_endpoints(self):
        expected = self.hash_of("--ticks", 5)
        server = self.keygen("server")
        self.write("clients", f"{server} controller\n")
        self.environment["ZIGGURAT_SERVER_KEY"] = server  # must not reach the controllers
        self.environment["ZIGGURAT_CURVE_SECRET"] = "server.secret"
        self.assertEqual(
            self.hash_of("--ticks", 5, "--endpoint", "tcp://0.0.0.0:*", "--curve-secret",
                         "server.secret", "--curve-clients", "clients"), expected)

    def test_keys_are_never_replaced(self):
        self.keygen("one")
        outcome = self.ziggurat("keygen", "--out", "one")
        self.assertEqual(outcome.code, FAULT)
        self.assert_is_sentence(outcome, "one.secret: exists already")


if __name__ == "__main__":
    main()
