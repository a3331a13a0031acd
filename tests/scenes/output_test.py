# SPDX-License-Identifier: MIT
"""Output of a run: log lines, files, progress."""

import csv
import json
import os
import pathlib
import pty
import re
import subprocess

from harness import FAULT, FINISHED, LIMIT, LUA, SceneTest, ZIGGURAT, main


class Log(SceneTest):
    def test_lines_are_ordered_by_tick_and_robot_with_any_number_of_processes(self):
        expected = [f"[0 {robot}] init" for robot in ("r0", "r1", "r2")]
        for tick in range(1, 6):
            expected += [f"[{tick} {robot}] step {tick}" for robot in ("r0", "r1", "r2")]
        expected += [f"[5 {robot}] destroy" for robot in ("r0", "r1", "r2")]
        for processes in (1, 2, 0):
            outcome = self.run_scene("--ticks", 5, "--lua-processes", processes)
            self.assertEqual(outcome.lines, expected, f"{processes} processes")

    def test_quiet_prints_only_log_lines_and_hash(self):
        outcome = self.run_scene("--ticks", 1, "--quiet", "--hash", "--seed", 0)
        self.assertEqual(outcome.err, "")
        self.assertEqual(len(outcome.lines), 3 + 3 + 3 + 1)
        self.assertRegex(outcome.lines[-1], r"^hash 1 [0-9a-f]{16}$")

    def test_what_scripts_print_is_printable(self):
        self.write("swing.lua", """function step() end
function init()
   print("\\27[31mred", "\\xc3\\xa9")
   io.write("\\27]52;c;eA==\\7", 1, "\\n")
   io.stderr:write("\\8back\\n")
end""")
        outcome = self.run_scene("--ticks", 1)
        self.assertIn("\\u001b[31mred\té", outcome.lines)
        self.assertIn("\\u001b]52;c;eA==\\u00071", outcome.lines)
        self.assertIn("\\u0008back", outcome.err)
        self.assertNotIn("\x1b", outcome.out + outcome.err)
        self.assertIn("\x1b[31mred", self.run_scene("--ticks", 1, "--trust-scripts").out)

    def test_echo_is_printable(self):
        """`ziggurat-lua --echo`, of scripts and of robots whose ids a server chooses."""
        self.write("swing.lua", """function step() end
function init()
   log("\\27]52;c;eA==\\7 \\xe2\\x80\\xae")
   logerr("\\27[2J\\x9b31m")
end""")
        server = self.start("serve", self.scene, "--ticks", 1)
        endpoint = self.read_until(server.stdout, "^endpoint (.*)$")[1]
        lua = subprocess.run([str(LUA), "--connect", endpoint, "--echo"], cwd=self.folder, env=self.environment,
                             stdin=subprocess.DEVNULL, capture_output=True, timeout=LIMIT)
        self.finish(server)
        self.assertEqual(lua.returncode, FINISHED, lua.stderr)
        self.assertIn(b"[0 r0] \\u001b]52;c;eA==\\u0007 \\u202e", lua.stdout)
        self.assertIn(b"[0 r0] \\u001b[2J", lua.stderr)
        for control in (b"\x1b", b"\x07", b"\x9b", b"\xe2\x80\xae"):
            self.assertNotIn(control, lua.stdout + lua.stderr)

    def test_errors_go_to_stderr(self):
        self.write("swing.lua", "function init() end\nfunction step() logerr('oh') end\n")
        outcome = self.run_scene("--ticks", 2, "--quiet")
        self.assertEqual(outcome.out, "")
        self.assertEqual(outcome.err.splitlines(),
                         [f"[{tick} r{i}] oh" for tick in (1, 2) for i in range(3)])

    def test_streams_that_are_closed_are_no_others(self):
        """What is printed must not go to the first file or socket that is opened."""
        for closed in ("<&-", ">&-", "2>&-", "<&- >&- 2>&-"):
            with self.subTest(closed):
                run = subprocess.run(["sh", "-c", f'exec "$0" run "$1" --ticks 3 --quiet --trace t.csv 2>errors {closed}',
                                      str(ZIGGURAT), str(self.scene)], cwd=self.folder, env=self.environment,
                                     stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, timeout=LIMIT)
                self.assertEqual(run.returncode, FINISHED)
                lines = (self.folder / "t.csv").read_text().splitlines()
                self.assertTrue(all(line.count(",") == 10 for line in lines), lines[:5])

    def test_a_closed_pipe_ends_the_run(self):
        read, write = os.pipe()
        process = self.start("run", self.scene, "--duration", "0", stdout=write)
        os.close(write)
        os.read(read, 10)
        os.close(read)
        outcome = self.finish(process)
        self.assertEqual(outcome.code, FAULT, outcome.err)
        self.assertRegex(outcome.err, r"stdout.*Broken pipe")


class Length(SceneTest):
    def ticks_of(self, *arguments):
        return int(self.hash_of(*arguments).split()[1])

    def test_the_command_line_overrides_the_scene(self):
        self.assertEqual(self.ticks_of(), 20)
        self.assertEqual(self.ticks_of("--ticks", 7), 7)
        self.assertEqual(self.ticks_of("--ticks", 30), 30)
        self.assertEqual(self.ticks_of("--duration", 0.5), 5)
        self.assertEqual(self.ticks_of("--ticks", 0), 0)

    def test_n_ticks_are_n_steps(self):
        outcome = self.run_scene("--ticks", 4, "--quiet")
        self.assertEqual(sum("step" in line for line in outcome.lines), 4 * 3)


class Files(SceneTest):
    def test_trace(self):
        path = self.folder / "trace.csv"
        self.run_scene("--ticks", 3, "--trace", path)
        with open(path, newline="") as file:
            rows = list(csv.reader(file))
        self.assertEqual(",".join(rows[0]), "tick,time_s,entity,link,x,y,z,qw,qx,qy,qz")
        rows = rows[1:]
        per_tick = []
        for i in range(3):
            per_tick += [(f"r{i}", ""), (f"r{i}", "base"), (f"r{i}", "arm")]
        per_tick += [("box0", ""), ("box1", "")] + [(f"can{i}", "") for i in range(5)]
        self.assertEqual([(row[2], row[3]) for row in rows], per_tick * 4)
        self.assertEqual([(row[0], row[1]) for row in rows[::len(per_tick)]],
                         [("0", "0"), ("1", "0.1"), ("2", "0.2"), ("3", "0.3")])
        placed = {(row[2], row[3]): [float(value) for value in row[4:]]
                  for row in rows[:len(per_tick)]}
        self.assertEqual(placed["box0", ""], [0.05, 0.08, 0, 1, 0, 0, 0])
        for value, expected in zip(placed["r0", "arm"], [0, 0, 0.05, 1, 0, 0, 0]):
            self.assertAlmostEqual(value, expected, places=12)
        for row in rows:
            for text in row[4:]:
                self.assertEqual(len(text), len(text.strip()))
                self.assertLessEqual(len(text), 24)

    def test_readings(self):
        path = self.folder / "readings.jsonl"
        self.run_scene("--ticks", 2, "--readings", path)
        lines = [json.loads(line) for line in path.read_text().splitlines()]
        self.assertEqual([(line["tick"], line["robot"]) for line in lines],
                         [(str(tick), f"r{i}") for tick in range(3) for i in range(3)])
        self.assertEqual(lines[0]["observation"]["joint_encoders"], {"shoulder": 0})
        self.assertEqual([line["command"]["joint_targets"]["shoulder"] for line in lines[:3]],
                         [2, 2, -3])
        self.assertGreater(lines[6]["observation"]["joint_encoders"]["shoulder"], 0)
        self.assertEqual(lines[6]["time_s"], 0.2)

    def test_hash_file_ends_with_the_hash(self):
        path = self.folder / "hashes"
        last = self.hash_of("--ticks", 5, "--hash-file", path)
        lines = path.read_text().splitlines()
        self.assertEqual([line.split()[:2] for line in lines], [["hash", str(i)] for i in range(6)])
        self.assertEqual(lines[-1], last)
        self.assertEqual(len(set(line.split()[2] for line in lines)), 6)

    def test_rays_and_images_without_content_are_still_created(self):
        self.run_scene("--ticks", 1, "--rays", self.folder / "rays.jsonl",
                       "--images", self.folder / "images")
        self.assertEqual((self.folder / "rays.jsonl").read_text(), "")
        self.assertEqual(list((self.folder / "images").iterdir()), [])

    def test_summary(self):
        path = self.folder / "summary.json"
        last = self.hash_of("--ticks", 5, "--summary", path)
        summary = json.loads(path.read_text())
        self.assertEqual(summary["ending"], "finished")
        self.assertEqual(summary["ticks"], 5)
        self.assertAlmostEqual(summary["simulated_s"], 0.5)
        self.assertEqual(summary["seed"], 3)
        self.assertEqual(summary["hash"], last.split()[2])
        self.assertEqual(summary["robots"], 3)
        self.assertEqual(summary["failures"], [])
        parts = summary["wall_time_s"]
        self.assertAlmostEqual(sum(parts[name] for name in
                                   ("physics", "exchange", "recording", "pacing")),
                               summary["wall_s"])
        phases = summary["phases_s"]
        self.assertAlmostEqual(sum(phases.values()), summary["wall_s"])
        for name in ("encode", "wait", "forces", "contacts", "solve", "integrate", "sensing"):
            self.assertGreater(phases[name], 0, name)
        self.assertEqual(phases["magnetism"], 0)


class Seed(SceneTest):
    def test_a_drawn_seed_is_printed_and_repeats_the_run(self):
        self.change(' random_seed="3"', "")
        first = self.run_scene("--ticks", 2, "--hash")
        seed = re.search(r"seed (\d+) drawn", first.err).group(1)
        again = self.run_scene("--ticks", 2, "--hash", "--seed", seed)
        self.assertEqual(first.lines[-1], again.lines[-1])
        self.assertNotIn("drawn", again.err)
        other = self.run_scene("--ticks", 2, "--hash", "--seed", int(seed) + 1)
        self.assertNotEqual(first.lines[-1], other.lines[-1])


class Pace(SceneTest):
    def wall_s(self, *arguments):
        path = self.folder / "summary.json"
        self.run_scene("--quiet", "--summary", path, *arguments)
        return json.loads(path.read_text())["wall_s"]

    def test_real_time(self):
        self.assertGreaterEqual(self.wall_s("--ticks", 10, "--real-time"), 0.99)
        self.assertGreaterEqual(self.wall_s("--ticks", 20, "--real-time", 4), 0.49)
        self.assertLess(self.wall_s("--ticks", 10), 0.9)

    def test_the_scene_can_request_real_time(self):
        self.change('random_seed="3"', 'random_seed="3" real_time="true"')
        self.assertGreaterEqual(self.wall_s("--ticks", 10), 0.99)

    def test_changes_no_result(self):
        self.assertEqual(self.hash_of("--ticks", 5), self.hash_of("--ticks", 5, "--real-time", 9))


class Clock(SceneTest):
    def test_beta50_is_slower(self):
        self.assertNotEqual(self.hash_of("--ticks", 5),
                            self.hash_of("--ticks", 5, "--clock", "beta50"))

    def test_a_solver_that_is_named_changes_nothing(self):
        plain = self.hash_of("--ticks", 5)
        self.change("<dynamics3d ", '<dynamics3d solver="sweeps" solver_iterations="20" ')
        self.assertEqual(self.hash_of("--ticks", 5), plain)
        self.assertIn("solver of <dynamics3d> has no effect here", self.ziggurat("check", self.scene).err)


class Commands(SceneTest):
    def test_check(self):
        outcome = self.ziggurat("check", "--json", self.scene, "nowhere.argos")
        good, missing = json.loads(outcome.out)
        self.assertEqual((good["ok"], good["robots"], good["entities"]), (True, 3, 10))
        self.assertFalse(missing["ok"])
        self.assertEqual(missing["problems"][0]["severity"], "fault")

    def test_check_counts_entities_of_models(self):
        self.write("tile.argos", """<m><models><prototype id="tile" movable="false">
<links ref="l"><link id="l" geometry="box" size="0.1,0.1,0.1"
mass="1"/></links><devices><tags medium="tags">
<tag anchor="l" position="0,0,0.1" orientation="0,0,0" observable_angle="90"
side_length="0.05" payload="hello"/></tags></devices>
</prototype></models></m>""")
        scene = self.write("tiles.argos", """<a><include file="tile.argos"/><framework>
<experiment ticks_per_second="10"/></framework><controllers/><media><tag id="tags"/></media>
<physics_engines><dynamics3d id="d"/></physics_engines><arena size="9,9,9">
<prototype id="a" model="tile"><body position="0,0,0"/></prototype>
<prototype id="b" model="tile"><body position="1,0,0"/></prototype></arena></a>""")
        outcome = self.ziggurat("check", "--json", scene)
        report, = json.loads(outcome.out)
        self.assertTrue(report["ok"], outcome.out)
        self.assertEqual(report["models"], [{"id": "tile", "entities": 2}])
        plain = [problem for problem in report["problems"] if "plain white" in problem["text"]]
        self.assertEqual(len(plain), 1, "of a model once")
        self.assertIn("of model 'tile'", plain[0]["text"])
        self.assertTrue(plain[0]["file"].endswith("tile.argos"))
        self.assertIn('2 entities (2 of model "tile")', self.ziggurat("check", scene).out)

    def test_check_proposes_forces_where_iterations_change(self):
        self.assertNotIn("max_impulse", self.ziggurat("check", self.scene).err)
        self.change('iterations="10"', 'iterations="40"')
        self.assertIn("4 N m with iterations=\"40\", and 1 with 10; write max_torque instead",
                      self.ziggurat("check", self.scene).err)
        self.assertIn("160 N m with iterations=\"40\", and 10 with 10; write max_torque instead",
                      self.ziggurat("check", self.scene, "--clock", "beta50").err)

    def test_messages_are_json(self):
        self.change('mass="2"', 'mass="-2"', 1)
        outcome = self.ziggurat("run", "--json", self.scene)
        for line in outcome.err.splitlines():
            message = json.loads(line)
            self.assertEqual(message["severity"], "fault")
            self.assertGreater(message["line"], 0)

    def test_version_and_help(self):
        self.assertRegex(self.ziggurat("--version").out, r"^ziggurat \d+\.\d+\.\d+\n$")
        for command in ("run", "serve", "check", "help"):
            for arguments in (("help", command), (command, "--help")):
                outcome = self.ziggurat(*arguments)
                self.assertEqual(outcome.code, FINISHED)
                self.assertIn("usage: ziggurat", outcome.out)


    def test_version_and_help_to_a_full_disk(self):
        lua = pathlib.Path(ZIGGURAT).with_name("ziggurat-lua")
        for command in ([ZIGGURAT, "--version"], [ZIGGURAT, "--help"], [ZIGGURAT, "help"], [ZIGGURAT, "help", "run"],
                        [lua, "--version"], [lua, "--help"]):
            with self.subTest(command), open("/dev/full", "w") as full:
                ended = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, timeout=60)
                self.assertEqual(ended.returncode, FAULT)
                self.assertRegex(ended.stderr, r"^ziggurat(-lua)?: stdout cannot be written: No space left on device\n$")


class Progress(SceneTest):
    def stderr_on_a_terminal(self, *arguments):
        ours, theirs = pty.openpty()
        process = self.start("run", self.scene, *arguments, stderr=theirs)
        os.close(theirs)
        text = b""
        while True:
            try:
                piece = os.read(ours, 4096)
            except OSError:
                break
            if not piece:
                break
            text += piece
        os.close(ours)
        self.assertEqual(self.finish(process).code, FINISHED)
        return text.decode()

    def test_progress_is_shown_on_a_terminal_only(self):
        arguments = ("--ticks", "10", "--real-time")
        self.assertRegex(self.stderr_on_a_terminal(*arguments),
                         r"t = 0\.\d+ of .*, real-time factor [\d.]+, \d+ ticks/s")
        self.assertNotIn("t = ", self.stderr_on_a_terminal(*arguments, "--quiet"))
        self.assertNotIn("t = ", self.run_scene(*arguments).err)


if __name__ == "__main__":
    main()
