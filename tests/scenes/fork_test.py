# SPDX-License-Identifier: MIT
"""Runs that go on live from a tick of a recorded run."""

import json
import re
import shutil
import subprocess
import sys

from harness import CONTROLLER_FAILED, FAULT, FINISHED, LIMIT, LUA, ZIGGURAT, main
from recorded import ROOT, Recorded

SPEED = re.compile(r"robot\.params\.speed")


class Fork(Recorded):
    def hashes(self, *arguments, code=FINISHED):
        """By tick, of a command that writes them."""
        path = self.folder / "hashes"
        outcome = self.ask(*arguments, "--hash-file", path, code=code)
        lines = [line.split() for line in path.read_text().splitlines()]
        return {int(tick): digits for _, tick, digits in lines}, outcome

    def recorded_hashes(self, recording):
        return self.hashes("replay", recording)[0]


class Same(Fork):
    def test_the_same_controllers_repeat_the_rest(self):
        scenes = [self.scene, ROOT / "scenes/prototype_radio_test.argos", ROOT / "scenes/devices_test.argos",
                  ROOT / "scenes/prototype_srocs_system.argos", ROOT / "scenes/construction/steps.argos"]
        for scene in scenes:
            with self.subTest(scene.name):
                recording, _ = self.record("--ticks", "30", "--seed", "3", scene=scene)
                recorded = self.recorded_hashes(recording)
                forked, outcome = self.hashes("fork", recording, "--at", "13")
                self.assertEqual(forked, {tick: recorded[tick] for tick in range(13, 31)})
                self.assertIn("up to tick 13 the controllers command what they did", outcome.err)

    def test_directors_know_what_was_before(self):
        self.change("</argos-configuration>", '<director id="judge" script="judge.lua"/></argos-configuration>')
        self.write("judge.lua", """
            local seen = 0
            function post_step()
              seen = seen + 1
              for id in pairs(world.entities) do
                if seen % 10 < 2 then world.push(id, {x = 10 * seen, y = 0, z = 0}) end
              end
            end""")
        recording, end = self.record("--ticks", "40")
        outcome = self.ask("fork", recording, "--at", "25", "--hash")
        self.assertEqual(outcome.lines[-1], end)

    def test_outputs_begin_at_that_tick(self):
        recording, _ = self.record("--ticks", "30", "--trace", "whole.csv")
        self.ask("fork", recording, "--at", "12", "--trace", "part.csv", "--quiet")
        whole = (self.folder / "whole.csv").read_text().splitlines()
        part = (self.folder / "part.csv").read_text().splitlines()
        self.assertEqual(part, whole[:1] + [line for line in whole[1:] if int(line.split(",")[0]) >= 12])

    def test_it_can_last_longer(self):
        recording, _ = self.record("--ticks", "20")
        _, end = self.record("--ticks", "40", name="longer.mcap")
        outcome = self.ask("fork", recording, "--at", "15", "--ticks", "40", "--hash", "--quiet")
        self.assertEqual(outcome.lines[-1], end)


class Other(Fork):
    def other_script(self):
        text = (self.folder / "swing.lua").read_text()
        self.assertRegex(text, SPEED)
        return self.write("other.lua", text.replace("steps == 10", "steps == 14"))

    def test_another_script(self):
        recording, _ = self.record("--ticks", "30")
        recorded = self.recorded_hashes(recording)
        forked, outcome = self.hashes("fork", recording, "--at", "12", "--script",
                                      f"swing.lua={self.other_script()}")
        self.assertEqual(forked[12], recorded[12])
        self.assertNotEqual(forked[13], recorded[13])
        self.assertRegex(outcome.err, r"otherwise than in the recording, whose commands were applied: 'r0' from tick 10 on")
        outcome = self.ask("fork", recording, "--at", "12", "--script", "nothing.lua=other.lua", code=FAULT)
        self.assert_is_sentence(outcome, r"no script 'nothing\.lua'; its scripts are: .*swing\.lua")

    def test_controllers_know_what_was_before_unless_they_are_fresh(self):
        recording, _ = self.record("--ticks", "30")
        steps = lambda outcome: [int(n) for n in re.findall(r"\[\d+ r0\] step (\d+)", outcome.out)]
        outcome = self.ask("fork", recording, "--at", "12", "--ticks", "14")
        self.assertEqual(steps(outcome), list(range(1, 15)))
        outcome = self.ask("fork", recording, "--at", "12", "--ticks", "14", "--fresh")
        self.assertEqual(steps(outcome), [1, 2])

    def test_other_values_hold_from_that_tick_on(self):
        recording, _ = self.record("--ticks", "30")
        recorded = self.recorded_hashes(recording)
        for change in (["--set", "physics_engines/*/gravity/@g=2"],
                       ["--set", "arena/prototype[@id='r1']/joints/joint/@axis=0,0,1", "--set",
                        "arena/box/@mass=0.5"]):
            forked, _ = self.hashes("fork", recording, "--at", "12", *change)
            self.assertEqual(forked[12], recorded[12])
            self.assertNotEqual(forked[30], recorded[30])
            again, _ = self.hashes("fork", recording, "--at", "12", *change)
            self.assertEqual(forked, again)

    def test_parameters_reach_controllers_and_scene(self):
        self.change('speed="2"', 'speed="${v}"')
        self.change("<controllers>", '<parameters v="2"/><controllers>')
        recording, _ = self.record("--ticks", "30", "--param", "v=2.5")
        recorded = self.recorded_hashes(recording)
        forked, outcome = self.hashes("fork", recording, "--at", "5", "--param", "v=2.75")
        self.assertEqual(forked[5], recorded[5])
        self.assertNotEqual(forked[6], recorded[6], "what they command stays, also from before the fork")
        self.assertIn("'r0' from tick 0 on", outcome.err)

    def test_another_seed_draws_anew_from_there_on(self):
        self.change("<sensors>", '<sensors><positioning implementation="default" pos_noise_range="-0.1:0.1" />')
        recording, _ = self.record("--ticks", "20", "--seed", "3")
        recorded = self.recorded_hashes(recording)
        other, _ = self.hashes("fork", recording, "--at", "9", "--seed", "4")
        same, _ = self.hashes("fork", recording, "--at", "9", "--seed", "3")
        self.assertEqual(other[9], recorded[9])
        self.assertNotEqual(other[10], recorded[10])
        self.assertEqual(same[20], recorded[20])

    def test_a_program_of_the_user(self):
        recording, _ = self.record("--ticks", "20")
        outcome = self.ask("fork", recording, "--at", "9", "--controller", "swing=exit 7",
                           code=CONTROLLER_FAILED)
        self.assertIn("7", outcome.err)


class Refused(Fork):
    def test_what_cannot_be_is_refused(self):
        recording, _ = self.record("--ticks", "20")
        for words, pattern in [
                ((), "no tick is given; write --at TICK"),
                (("--at", "21", "--ticks", "30"), "has no such tick, it ends at tick 20"),
                (("--at", "15", "--ticks", "10"), "write --ticks with a later end"),
                (("--at", "5", "--clock", "beta50"), "unknown option '--clock'"),
                (("--at", "5", "--set", "framework/experiment/@ticks_per_second=20"), "ticks_per_second"),
                (("--at", "5", "--set", "arena/distribute/entity/@quantity=6"), "same entities"),
                (("--at", "5", "--trust-scripts"), "trust-scripts"),
                (("--at", "5", "--record", "run.mcap"), "run.mcap"),
        ]:
            with self.subTest(words):
                self.assert_is_sentence(self.ask("fork", recording, *words, code=FAULT), pattern)

    def test_recorded_commands_are_never_started_by_themselves(self):
        recording, marker = self.record_a_command()
        outcome = self.ask("fork", recording, "--at", "0", "--ticks", "5", code=FAULT)
        self.assert_is_sentence(outcome, "--controller ID=COMMAND: swing; or --trust-recorded-commands")
        self.assertFalse(marker.exists())


class Kept(Fork):
    """Recordings that do not begin at tick 0."""

    def test_a_fork_is_recorded_replayed_and_forked_again(self):
        recording, _ = self.record("--ticks", "30")
        other, further = self.folder / "other.mcap", self.folder / "further.mcap"
        forked, _ = self.hashes("fork", recording, "--at", "12", "--set", "physics_engines/*/gravity/@g=2",
                                "--record", other)
        self.assertRegex(self.ask("verify", other).out, r"^identical: 19 states")
        self.assertEqual(self.ask("replay", other, "--video", "film.mp4", "--size", "96x64").err.count("film"), 0)
        self.assertGreater((self.folder / "film.mp4").stat().st_size, 1000)
        again, _ = self.hashes("fork", other, "--at", "20", "--set", "physics_engines/*/gravity/@g=2",
                               "--fresh", "--without-controllers", "--record", further)
        self.assertEqual(again[20], forked[20])
        self.assertRegex(self.ask("verify", further).out, r"^identical: 11 states")

    def connect(self, url, *options):
        self.started.append(subprocess.Popen([LUA, "--connect", url, "--quiet", *options], cwd=self.folder,
                                             stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))

    def serve(self, *arguments, scene=ROOT / "scenes/dynamics3d_single_body_test.argos"):
        process = self.start("serve", scene, "--json", "--seed", "5", *arguments)
        return process, json.loads(process.stdout.readline())["endpoint"]

    def test_acts_of_supervisors_are_part_of_the_past(self):
        recording = self.folder / "run.mcap"
        process, url = self.serve("--record", recording)
        box = self.write("box.xml", '<box id="new" size="0.1,0.1,0.1" movable="true" mass="1">'
                                    '<body position="-1,-1,2"/></box>')
        self.ctl(url, "step", 5)
        self.ctl(url, "spawn", box)
        self.ctl(url, "snapshot", "here")
        self.ctl(url, "step", 4)
        self.ctl(url, "remove", "new")
        self.ctl(url, "step", 3)
        self.ctl(url, "restore", "here")
        self.ctl(url, "step", 9)
        state = json.loads(self.ctl(url, "read", "--json"))
        self.ctl(url, "shutdown")
        self.finish(process)
        outcome = self.ask("fork", recording, "--at", "13", "--ticks", "14", "--fresh", "--hash", "--quiet")
        self.assertEqual(outcome.lines[-1], f"hash 14 {state['hash']}")
        other = self.folder / "other.mcap"
        self.ask("fork", recording, "--at", "8", "--ticks", "20", "--set", "physics_engines/*/gravity/@g=5",
                 "--record", other, "--quiet")
        self.assertRegex(self.ask("verify", other).out, r"^identical: 13 states")

    def test_another_entity_of_the_same_name_after_a_reset(self):
        text = (ROOT / "scenes/dynamics3d_single_body_test.argos").read_text()
        scene = self.write("bodies.argos", text.replace("<media />", '<media><directional_led id="leds"/></media>'))
        place = '<body position="0,0,0.4" orientation="0,0,0"/>'
        large = self.write("large.xml", f'<prototype id="new" movable="true">{place}<links ref="a">'
                           '<link id="a" geometry="box" size="0.02,0.02,0.02" mass="0.1"/>'
                           '<link id="b" geometry="sphere" radius="0.005" mass="0.1" position="0,0,0.02"/></links>'
                           '<joints><joint id="j" type="fixed"><parent link="a"/><child link="b"/></joint></joints>'
                           '<devices><directional_leds medium="leds"><directional_led anchor="a" position="0,0,0.01" '
                           'orientation="0,0,0" observable_angle="80"/></directional_leds></devices></prototype>')
        small = self.write("small.xml", f'<box id="new" size="0.02,0.02,0.02" movable="true" mass="0.1">{place}</box>')
        recording = self.folder / "run.mcap"
        process, url = self.serve("--record", recording, scene=scene)
        for words in (("spawn", large), ("step", 2), ("reset",), ("spawn", large), ("reset",), ("spawn", small),
                      ("step", 6), ("shutdown",)):
            self.ctl(url, *words)
        self.finish(process)
        taken = self.ask("replay", recording, "--out", "p.png", "--at", "0.2,0.4", "--size", "96x64", "--hash")
        for options in ((), ("--fresh",)):
            outcome = self.ask("fork", recording, "--at", "3", "--ticks", "6", "--hash", "--quiet", *options)
            self.assertEqual(outcome.lines[-1], taken.lines[-1])

    def test_robots_that_were_removed_have_no_controllers_any_more(self):
        """Before the first tick, and later: --fresh starts controllers afterwards."""
        for steps in (0, 5):
            recording = self.folder / f"{steps}.mcap"
            process = self.start("serve", self.scene, "--json", "--paused", "--record", recording, "--ticks", 20)
            url = json.loads(process.stdout.readline())["endpoint"]
            if steps:
                self.connect(url)
                self.ctl(url, "step", steps)
            self.ctl(url, "remove", "r0")
            if not steps:
                self.connect(url)
            self.ctl(url, "resume")
            self.assertEqual(self.finish(process).code, 0)
            for more in ((), ("--fresh",)):
                outcome = self.ziggurat("fork", recording, "--at", 10, "--quiet", *more)
                self.assertEqual(outcome.code, 0, outcome.err)
            self.assertEqual(self.ziggurat("verify", recording, "--controllers").code, 0)

    def test_a_run_that_was_restored_from_a_file_replays(self):
        """By a server that begins with the snapshots of an earlier one."""
        snapshots = self.folder / "snapshots"
        snapshots.mkdir()
        process, url = self.serve("--snapshot-folder", snapshots)
        self.ctl(url, "step", 5)
        self.ctl(url, "snapshot", "here")
        self.ctl(url, "shutdown")
        self.finish(process)
        recording = self.folder / "run.mcap"
        process, url = self.serve("--snapshot-folder", snapshots, "--record", recording)
        for steps in (2, 1):
            self.ctl(url, "step", steps)
            self.ctl(url, "restore", "here")
        self.ctl(url, "step", 6)
        state = json.loads(self.ctl(url, "read", "--json"))
        self.ctl(url, "shutdown")
        self.finish(process)
        shutil.rmtree(snapshots)
        outcome = self.ask("replay", recording, "--hash", "--quiet")
        self.assertEqual(outcome.lines[-1], f"hash 11 {state['hash']}")

    def test_scripts_of_spawned_robots_are_embedded_with_what_they_load(self):
        allowed = self.folder / "allowed"
        allowed.mkdir()
        (allowed / "mine.lua").write_text('local helper = require "helper"\nfunction init() end '
                                          "function step() robot.joints.shoulder.set_target(helper.speed) end")
        (allowed / "helper.lua").write_text("return {speed = 1.5}")
        robot = re.search(r'<prototype id="r2">.*?</prototype>', self.scene.read_text(), re.DOTALL)[0]
        new = self.write("new.xml", robot.replace('"r2"', '"new"').replace("0,-1,0", "-1,-1,0")
                         .replace('script="swing.lua"', 'script="allowed/mine.lua"'))
        process, url = self.serve("--paused", "--ticks", "30", "--record", "run.mcap", "--allow-spawned-scripts", allowed,
                                  scene=self.scene)
        self.ctl(url, "spawn", new)
        self.connect(url)
        self.ctl(url, "resume")
        self.assertEqual(self.finish(process).code, FINISHED)
        shutil.rmtree(allowed)
        self.check_controllers("run.mcap")

    def test_a_script_that_was_edited_before_a_spawn_stays_that_of_the_first_robots(self):
        robot = re.search(r'<prototype id="r2">.*?</prototype>', self.scene.read_text(), re.DOTALL)[0]
        new = self.write("new.xml", robot.replace('"r2"', '"new"').replace("0,-1,0", "-1,-1,0"))
        process, url = self.serve("--paused", "--record", "run.mcap", scene=self.scene)
        self.connect(url)
        self.ctl(url, "step", 3)
        script = self.folder / "swing.lua"
        text = script.read_text()
        script.write_text(text.replace("tonumber(robot.params.speed)", "0"))
        self.assertNotEqual(script.read_text(), text)
        self.ctl(url, "spawn", new)
        self.ctl(url, "shutdown")
        self.finish(process)
        self.assertEqual((self.folder / "run.mcap").read_bytes().count(b"function init()"), 1)
        self.assertRegex(self.ask("verify", "run.mcap", "--controllers").lines[-1], "^identical: the commands of ")

    def test_scripts_that_are_named_from_the_root(self):
        self.change('script="swing.lua"', f'script="{self.folder}/swing.lua"')
        recording, _ = self.record()
        self.assertRegex(self.ask("verify", recording, "--controllers").lines[-1], "^identical: the commands of ")

    def serve_restored(self, *restores, options=()):
        """A recorded run that was restored before its first tick, when it had no controllers yet."""
        recording = self.folder / "run.mcap"
        process, url = self.serve("--paused", "--ticks", "30", "--snapshot-folder", self.folder / "snapshots",
                                  "--record", recording, *options, scene=self.scene)
        for words in restores:
            self.ctl(url, *words)
        self.connect(url)
        self.ctl(url, "resume")
        self.assertEqual(self.finish(process).code, FINISHED)
        return recording

    def keep_snapshots(self, *words):
        """Of a served world: `early` at tick 4, `late` after `words` at tick 7."""
        (self.folder / "snapshots").mkdir(exist_ok=True)
        process, url = self.serve("--paused", "--snapshot-folder", self.folder / "snapshots", scene=self.scene)
        self.connect(url)
        for each in (("step", 4), ("snapshot", "early"), *words):
            self.ctl(url, *each)
        if words:
            self.connect(url, "--robot", "new")
        for each in (("step", 3), ("snapshot", "late"), ("shutdown",)):
            self.ctl(url, *each)
        self.finish(process)

    def check_controllers(self, recording, at=20):
        """What they command is as recorded, and a fork with them repeats the rest."""
        recorded = self.recorded_hashes(recording)
        for ask in (("verify", recording, "--controllers"), ("try", recording, "--robot", "r1", "--script", "swing.lua")):
            self.assertRegex(self.ask(*ask).lines[-1], "^identical: the commands of ")
        forked, outcome = self.hashes("fork", recording, "--at", at)
        self.assertEqual(forked, {tick: recorded[tick] for tick in range(at, 31)})
        self.assertIn(f"up to tick {at} the controllers command what they did", outcome.err)
        forked, _ = self.hashes("fork", recording, "--at", at, "--fresh")
        self.assertEqual(forked[at], recorded[at])
        self.hashes("fork", recording, "--at", at, "--set", "physics_engines/*/gravity/@g=2")

    def test_a_run_that_was_restored_before_its_first_tick(self):
        self.keep_snapshots()
        self.check_controllers(self.serve_restored(("restore", "late")))
        self.check_controllers(self.serve_restored(("restore", "late"), ("reset", "--seed", 9), ("restore", "early")))

    def test_robots_come_and_go_with_a_restore_before_the_first_tick(self):
        robot = re.search(r'<prototype id="r2">.*?</prototype>', self.scene.read_text(), re.DOTALL)[0]
        new = self.write("new.xml", robot.replace('"r2"', '"new"').replace("0,-1,0", "-1,-1,0"))
        other = self.write("other.xml", robot.replace('"r2"', '"other"').replace("0,-1,0", "-1,1,0"))
        self.keep_snapshots(("remove", "r0"), ("spawn", new))
        for before in ([("restore", "late")], [("spawn", other), ("restore", "late")],
                       [("restore", "late"), ("restore", "early")], [("remove", "r2"), ("restore", "late")]):
            with self.subTest(before):
                recording = self.serve_restored(*before)
                self.check_controllers(recording)
                outcome = self.ziggurat("try", recording, "--robot", "r0", "--script", "swing.lua")
                self.assertEqual(outcome.code, FAULT, "it was removed, and a robot that comes back has no controller")
                self.assertIn("nothing was compared", outcome.err)


class Example(Fork):
    def test_which_gain_keeps_the_block_from_slipping(self):
        """The example of docs/recordings.md. Friction holds up to a gain of mu g / speed = 6.1."""
        done = subprocess.run([sys.executable, "-B", ROOT / "docs/forks/gains.py", ZIGGURAT, "gains.svg"],
                              cwd=self.folder, env=self.environment, capture_output=True, text=True, timeout=LIMIT)
        self.assertEqual(done.returncode, 0, done.stderr)
        slips = {int(gain): float(slip) for gain, slip in re.findall(r"gain +(\d+): .* ([\d.]+) mm", done.stdout)}
        self.assertEqual(list(slips), [2, 4, 6, 8, 10])
        self.assertLess(max(slips[gain] for gain in (2, 4, 6)), 0.05)
        self.assertGreater(slips[8], 0.5)
        self.assertGreater(slips[10], 2 * slips[8])
        self.assertIn("</svg>", (self.folder / "gains.svg").read_text())


if __name__ == "__main__":
    main()
