# SPDX-License-Identifier: MIT
"""Controllers that end or never connect, and interruption by Ctrl-C."""

import json
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from harness import (BIN, CONTROLLER_FAILED, FAULT, FINISHED, INTERRUPTED, LUA, SceneTest, main)

ENDLESS = ("--duration", "0")
OTHER_USER = 54321  # has no processes


class Killed(SceneTest):
    def assert_reports_the_kill(self, outcome, robots):
        self.assertEqual(outcome.code, CONTROLLER_FAILED, outcome.err)
        self.assert_is_sentence(outcome, rf"killed by signal 9 .*tick \d+.*{robots}")
        self.assertEqual(len(re.findall("killed by signal 9", outcome.err)), 1, "one message")

    def test_during_the_run(self):
        trace = self.folder / "trace.csv"
        process = self.start("run", self.scene, *ENDLESS, "--trace", trace)
        self.read_until(process.stdout, r"^\[20 r2\]")
        os.kill(self.lua_processes()[0], signal.SIGKILL)
        outcome = self.finish(process)
        self.assert_reports_the_kill(outcome, "robots r0, r1, r2")
        lines = trace.read_text().splitlines()
        self.assertEqual((len(lines) - 1) % 16, 0, "whole ticks")
        self.assertTrue(trace.read_text().endswith("\n"))
        last = int(lines[-1].split(",")[0])
        self.assertGreaterEqual(last, 20)
        self.assertIn(f"at tick {last}", outcome.err)

    def test_one_of_several(self):
        process = self.start("run", self.scene, *ENDLESS, "--lua-processes", 0)
        self.read_until(process.stdout, r"^\[20 r2\]")
        self.lua_processes(3)
        [(victim, _)] = self.processes("ziggurat-lua", f"{self.runtime}/", "/robots-1")
        os.kill(victim, signal.SIGKILL)
        self.assert_reports_the_kill(self.finish(process), "robot r1")

    def test_a_missing_lua_runner_is_told_with_its_places(self):
        shutil.copy(BIN / "ziggurat", self.folder)
        self.environment["PATH"] = "/nowhere"
        process = subprocess.Popen([self.folder / "ziggurat", "run", self.scene, "--ticks", "5"], env=self.environment,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.started.append(process)
        outcome = self.finish(process)
        self.assertEqual(outcome.code, FAULT, outcome.err)
        self.assert_is_sentence(outcome, rf"there is no ziggurat-lua beside {self.folder}/ziggurat and none in the folders of PATH; ")

    def test_too_few_processes_and_threads_are_told_with_their_limit(self):
        shutil.copy(BIN / "ziggurat", self.folder)
        self.folder.chmod(0o755)
        limits = (1, 2) if os.geteuid() == 0 else (1,)  # another user may have more than that already

        def limit(number):
            resource.setrlimit(resource.RLIMIT_NPROC, (number, number))
            if os.geteuid() == 0:  # for root there is no limit
                os.setgroups([])
                os.setgid(OTHER_USER)
                os.setuid(OTHER_USER)

        for number in limits:
            process = subprocess.Popen([self.folder / "ziggurat", "run", self.scene, "--ticks", "5"], text=True,
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=lambda: limit(number))
            self.started.append(process)
            outcome = self.finish(process)
            self.assertEqual(outcome.code, FAULT, outcome.err)
            self.assert_is_sentence(outcome, "the system allows this user no more processes and threads")

    def test_a_killed_process_is_started_again(self):
        """The scripts begin anew at the present tick, told which; the others notice nothing."""
        script = self.folder / "swing.lua"
        script.write_text(script.read_text().replace('log("init")', 'log("init ", robot.first_tick)'))
        process = self.start("run", self.scene, "--ticks", 400, "--lua-processes", 0, "--restart", "swing=2",
                             "--real-time", 20)
        for tick in (20, 60):
            self.read_until(process.stdout, rf"^\[{tick} r2\]")
            [(victim, _)] = self.processes("ziggurat-lua", f"{self.runtime}/", "/robots-1")
            os.kill(victim, signal.SIGKILL)
        outcome = self.finish(process)
        self.assertEqual(outcome.code, FINISHED, outcome.err)
        for number in (1, 2):
            self.assertRegex(outcome.err, rf"killed by signal 9 .*robot r1; started again \(restart {number}\)")
        [(tick, told)] = re.findall(r"\[(\d+) r1\] init (\d+)", outcome.out)  # of the second restart
        self.assertEqual(tick, told)
        self.assertGreaterEqual(int(told), 60)
        self.assertNotRegex(outcome.out, r" r[02]\] init")
        self.assertRegex(outcome.out, r"\[400 r1\] destroy")

    def test_more_deaths_than_restarts(self):
        process = self.start("run", self.scene, *ENDLESS, "--restart", "1")
        self.read_until(process.stdout, r"^\[20 r2\]")
        first = self.lua_processes()[0]
        os.kill(first, signal.SIGKILL)
        self.read_until(process.stdout, r"^\[60 r2\]")  # may have been printed before
        second = self.wait_for(self.lua_processes, lambda ids: first not in ids, "second process")
        os.kill(second[0], signal.SIGKILL)
        outcome = self.finish(process)
        self.assertEqual(outcome.code, CONTROLLER_FAILED, outcome.err)
        self.assertEqual(len(re.findall("killed by signal 9", outcome.err)), 2)
        self.assertEqual(len(re.findall("started again", outcome.err)), 1)

    def test_restart_names_a_controller_that_the_scene_lacks(self):
        outcome = self.run_scene("--restart", "sving=1", code=1)
        self.assert_is_sentence(outcome, r"--restart: the scene has no controller 'sving'.*swing")

    def test_controller_that_ends_before_it_connects(self):
        outcome = self.run_scene("--controller", "swing=exit 4", code=CONTROLLER_FAILED)
        self.assert_is_sentence(outcome, r"'swing'.*exit code 4 before the first tick.*r0, r1, r2")

    def test_program_that_does_not_exist(self):
        for command, pattern in (("/no/such/program", r"swing=/no/such/program: '/no/such/program' is not there: /no/such has no"),
                                 ("./nothere --fast", r"'./nothere' is not there: .* has no such file"),
                                 ("nothere", r"'nothere' is no program in PATH")):
            outcome = self.run_scene("--controller", "swing=" + command, code=1)
            self.assert_is_sentence(outcome, r"--controller .*" + pattern)
            self.assertNotIn("/bin/sh", outcome.err)


LEAVES_AT_TICK_3 = """
import os, ziggurat
with ziggurat.connect(os.environ["ZIGGURAT_ENDPOINT"], controller="swing") as session:
    for tick in session:
        if tick.number == 3:
            break
"""


class Leaving(SceneTest):
    def setUp(self):
        super().setUp()
        self.write("leaves.py", LEAVES_AT_TICK_3)
        self.environment["PYTHONPATH"] = os.environ["ZIGGURAT_PYTHON_PACKAGE"]
        self.arguments = ("--controller", f"swing={sys.executable} {self.folder}/leaves.py")

    def test_before_the_end_is_told_and_in_the_summary(self):
        outcome = self.run_scene("--ticks", 6, "--summary", self.folder / "s.json", *self.arguments)
        self.assertRegex(outcome.err, r"robots r0, r1, r2 \(controller 'swing'\) left at tick 3: their controller ended")
        self.assertRegex(outcome.err, r"3 left before the end: robot r0 at tick 3")
        left = json.loads((self.folder / "s.json").read_text())["left"]
        self.assertEqual(left[0], {"robot": "r0", "controller": "swing", "tick": 3})

    def test_at_the_last_tick_is_none_before_the_end(self):
        outcome = self.run_scene("--ticks", 3, *self.arguments)
        self.assertNotIn("left", outcome.err)


class Interruption(SceneTest):
    def test_control_c_completes_files_and_calls_destroy(self):
        trace, hashes = self.folder / "trace.csv", self.folder / "hashes"
        process = self.start("run", self.scene, *ENDLESS, "--trace", trace, "--hash",
                             "--hash-file", hashes)
        self.read_until(process.stdout, r"^\[20 r2\]")
        self.interrupt(process)
        outcome = self.finish(process)
        self.assertEqual(outcome.code, INTERRUPTED, outcome.err)
        self.assertEqual(sum(line.endswith("] destroy") for line in outcome.lines), 3)
        self.assertEqual(outcome.lines[-1], hashes.read_text().splitlines()[-1])
        self.assertEqual((len(trace.read_text().splitlines()) - 1) % 16, 0)
        self.assertRegex(outcome.err, "interrupted: ")

    def test_termination_is_the_same(self):
        process = self.start("run", self.scene, *ENDLESS)
        self.read_until(process.stdout, r"^\[2 r2\]")
        process.terminate()
        self.assertEqual(self.finish(process).code, INTERRUPTED)

    def test_before_any_controller_connects(self):
        process = self.start("run", self.scene, "--controller", "swing=echo begun; exec sleep 100")
        self.read_until(process.stdout, "^begun$")
        self.interrupt(process)
        self.assertEqual(self.finish(process).code, INTERRUPTED)

    def test_with_a_script_in_an_endless_loop(self):
        self.write("swing.lua", "function init() end function step() while true do end end")
        process = self.start("run", self.scene)
        self.wait_until_it_computes(self.lua_processes()[0], 0.3)  # starting takes a tenth of it
        self.interrupt(process)
        self.assertEqual(self.finish(process).code, INTERRUPTED)

    def test_second_control_c_does_not_wait(self):
        self.write("swing.lua", "function init() end function step() while true do end end")
        process = self.start("run", self.scene)
        self.wait_until_it_computes(self.lua_processes()[0], 0.3)  # starting takes a tenth of it
        self.interrupt(process)
        self.wait_until_taken(process, signal.SIGINT)
        start = time.monotonic()
        self.interrupt(process)
        self.assertEqual(self.finish(process).code, INTERRUPTED)
        # After one Ctrl-C it waits for 0.4 s for answers, and for 0.2 s more before it kills.
        self.assertFalse(self.is_late(start, 1))

    def test_controllers_end_with_a_killed_server(self):
        process = self.start("run", self.scene, *ENDLESS)
        self.read_until(process.stdout, r"^\[2 r2\]")
        self.lua_processes()
        process.kill()
        process.communicate()
        self.assertEqual(self.left_processes(), [])
        self.wait_for(lambda: list(self.runtime.iterdir()), lambda left: not left,
                      "removal of its folder")


class OtherControllers(SceneTest):
    def make_external(self, command):
        self.change('<lua_controller id="swing">', f'<external_controller id="swing" {command}>')
        self.change("</lua_controller>", "</external_controller>")

    def test_command_of_the_scene(self):
        self.write("probe.sh", 'echo "$ZIGGURAT_CONTROLLER at $ZIGGURAT_ENDPOINT"; exit 5\n')
        self.make_external('command="sh probe.sh"')
        outcome = self.run_scene(code=CONTROLLER_FAILED)
        self.assertRegex(outcome.out, r"^swing at ipc:///\S+\n$")
        self.assertIn("exit code 5", outcome.err)

    def test_a_command_has_all_rights_of_the_user(self):
        """The environment, the user, and files anywhere."""
        self.environment["PROBE"] = "of the user"
        outside = pathlib.Path(tempfile.mkdtemp(prefix="zo", dir="/tmp"))
        self.addCleanup(shutil.rmtree, outside)
        self.make_external(f"command='echo \"$PROBE\" `id -u` &gt; {outside}/told; exit 5'")
        self.run_scene(code=CONTROLLER_FAILED)
        self.assertEqual((outside / "told").read_text(), f"of the user {os.getuid()}\n")

    def test_command_of_the_command_line_controls_the_robots(self):
        by_command = self.hash_of("--controller", f"swing=exec {LUA} --quiet")
        self.assertEqual(by_command, self.hash_of())

    def test_without_command_it_reports_the_robots_it_waits_for(self):
        self.make_external("")
        process = self.start("run", self.scene, "--endpoint", "tcp://127.0.0.1:*")
        match = self.read_until(process.stderr, r"waiting for .*r0, r1, r2.*'swing'.*tcp://127")
        self.assertTrue(match)
        self.interrupt(process)
        self.assertEqual(self.finish(process).code, INTERRUPTED)

    def test_unknown_controller_is_external_with_a_notice(self):
        self.change('<lua_controller id="swing">', '<my_controller id="swing">')
        self.change("</lua_controller>", "</my_controller>")
        outcome = self.ziggurat("check", self.scene)
        self.assertEqual(outcome.code, FINISHED, outcome.err)
        self.assertRegex(outcome.err, r"notice: .*my_controller")

    def test_cpp_example_drives_the_vehicle(self):
        scene = BIN.parents[2] / "scenes/dynamics3d_multi_body_test.argos"
        example = BIN / "example_vehicle"
        if not scene.exists() or not example.exists():
            self.skipTest("the example is not built")
        by_lua = self.hash_of("--ticks", 20, scene=scene)
        by_cpp = self.hash_of("--ticks", 20, "--controller", f"my_controller=exec {example}",
                              scene=scene)
        self.assertEqual(by_lua, by_cpp)


if __name__ == "__main__":
    main()
