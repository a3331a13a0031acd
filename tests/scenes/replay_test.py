# SPDX-License-Identifier: MIT
"""Recorded runs that are repeated, shown, and exported."""

import csv
import json
import os
import pathlib
import re
import signal
import struct
import subprocess

import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "disturbances"))

from harness import FAULT, INTERRUPTED, LIMIT, LUA, main
from recorded import DIFFERS, ROOT, Recorded, change_inputs
from websocket import PAUSE, RawViewer, STEP


class Replay(Recorded):
    def test_every_scene_gives_the_same_hashes(self):
        scenes = [each for each in sorted((ROOT / "scenes").rglob("*.argos")) if each.parent.name != "models" and not each.is_symlink()]
        self.assertGreater(len(scenes), 10)
        for scene in scenes:
            with self.subTest(scene.name):
                hashes = self.folder / "run.hashes"
                recording, end = self.record("--ticks", "30", "--seed", "3", "--hash-file", hashes,
                                             scene=scene)
                again = self.folder / "again.hashes"
                replayed = self.ask("replay", recording, "--hash", "--quiet", "--hash-file", again)
                self.assertEqual(end, replayed.lines[-1])
                self.assertEqual(hashes.read_text(), again.read_text())
                self.assertRegex(self.ask("verify", recording).out, r"^identical: 31 states")

    def test_writes_the_files_of_the_run(self):
        names = {"--trace": "t.csv", "--readings": "r.jsonl", "--rays": "y.jsonl"}
        recording, _ = self.record("--ticks", "20", *(x for o, n in names.items() for x in (o, n)))
        self.ask("replay", recording, *(x for o, n in names.items() for x in (o, "again_" + n)))
        for name in names.values():
            before = (self.folder / name).read_text().splitlines()
            after = (self.folder / f"again_{name}").read_text().splitlines()
            if name == "r.jsonl":  # the answers to the last tick are no inputs of any step
                before, after = before[:-1], after[:-1]
            self.assertEqual(before, after, name)

    def test_takes_the_pictures_of_the_run(self):
        recording, _ = self.record("--ticks", "10")
        view = ("--at", "0,0.5,9", "--size", "96x64", "--layers", "rays,labels")
        rendered = self.ask("render", self.scene, "--out", "a.png", *view[:1], "0,0.5", *view[2:], "--quiet")
        for options in ((), ("--from-poses",)):
            replayed = self.ask("replay", recording, "--out", "b.png", *view, *options)
            self.assertEqual(replayed.lines, ["b_000.png", "b_001.png"])
            self.assertIn("1 of 3 pictures were not taken", replayed.err)
            if not options:  # otherwise without rays
                for number in ("000", "001"):
                    self.assertEqual((self.folder / f"a_{number}.png").read_bytes(),
                                     (self.folder / f"b_{number}.png").read_bytes())
        self.assertEqual(rendered.lines[-2:], ["a_000.png", "a_001.png"])
        refused = self.ask("replay", recording, "--at", "1", code=FAULT)
        self.assertIn("--at is for pictures; write --out FILE.png", refused.err)

    def test_repeats_what_set_and_param_changed(self):
        text = (self.folder / "arms.argos").read_text()
        (self.folder / "arms.argos").write_text(re.sub(
            r'ticks_per_second="\d+"', 'ticks_per_second="${hz}"', text, count=1).replace(
            "<controllers>", '<parameters hz="10"/><controllers>', 1))
        _, usual = self.record("--ticks", "20")
        recording, end = self.record("--ticks", "20", "--param", "hz=25", "--set",
                                     "physics_engines/*/@iterations=3")
        self.assertNotEqual(usual, end)
        self.assertEqual(end, self.ask("replay", recording, "--hash", "--quiet").lines[-1])

    def test_ends_at_a_tick(self):
        recording, _ = self.record("--ticks", "20")
        outcome = self.ask("replay", recording, "--until", "7", "--hash")
        self.assertRegex(outcome.lines[-1], r"^hash 7 ")

    def test_reads_the_recording_alone(self):
        recording, end = self.record("--ticks", "10")
        for name in ("arms.argos", "swing.lua"):
            (self.folder / name).unlink()
        self.assertEqual(end, self.ask("replay", recording, "--hash", "--quiet").lines[-1])

    def test_a_run_that_was_killed_is_repeated_as_far_as_it_goes(self):
        process = self.start("run", self.scene, "--ticks", "1000000", "--record", "run.mcap",
                             "--lua-processes", "1")
        recording = self.folder / "run.mcap"
        self.wait_for(lambda: recording.exists() and recording.stat().st_size,
                      lambda size: size > 200_000, "recording")
        process.send_signal(signal.SIGKILL)
        process.wait()
        outcome = self.ask("verify", recording)
        self.assertRegex(outcome.out, r"^identical: \d+ states")
        self.assertIn("not closed", outcome.err)

    def test_other_files_are_refused(self):
        outcome = self.ask("replay", self.scene, code=FAULT)
        self.assert_is_sentence(outcome, r"arms\.argos: this is a scene, not a recording; .*ziggurat run .*arms\.argos --record FILE")
        self.assert_is_sentence(self.ask("verify", "nothing.mcap", code=FAULT), r"nothing\.mcap")
        self.assert_is_sentence(self.ask("verify", code=FAULT), r"no recording is given")


class Processes(Recorded):
    def test_no_command_of_a_recording_is_started(self):
        marker = self.folder / "started"
        self.change('<lua_controller id="swing">',
                    f'<external_controller id="swing" command="touch {marker}; exec {LUA} --script swing.lua --quiet">')
        self.change("</lua_controller>", "</external_controller>")
        recording, _ = self.record("--ticks", 5)
        marker.unlink()
        for words in (("replay", recording), ("verify", recording), ("diff", recording, recording), ("info", recording),
                      ("export", recording, "--csv", self.folder / "poses.csv"),
                      ("replay", recording, "--from-poses", "--trace", "t.csv")):
            with self.subTest(words[0]):
                self.ask(*words)
                self.assertFalse(marker.exists())


class Supervised(Recorded):

    def test_what_is_done_after_the_last_tick_is_repeated(self):
        box = self.write("box.xml", '<box id="new" size="0.1,0.1,0.1" movable="true" mass="1"><body position="0.5,0.5,1"/></box>')
        for number, act in enumerate((("move", "box0", "0.3,0.3,0.5"), ("spawn", box), ("remove", "box0"), ("reset", "--seed", "9"))):
            with self.subTest(act[0]):
                recording = self.folder / f"{number}.mcap"
                process = self.start("run", self.scene, "--record", recording, "--hash", "--paused", "--quiet",
                                     "--endpoint", f"ipc://{self.folder}/{number}")
                for words in (("step", 3), act, ("shutdown",)):
                    self.ctl(f"ipc://{self.folder}/{number}", *words)
                ran = self.finish(process)
                self.assertEqual(self.ask("replay", recording, "--hash", "--quiet").lines[-1], ran.lines[-1])

    def test_what_is_done_before_the_first_tick_is_repeated(self):
        """While the world waits for controllers, at its start and again after a reset."""
        box = self.write("box.xml", '<box id="new" size="0.1,0.1,0.1" movable="true" mass="1"><body position="0.5,0.5,1"/></box>')
        move = ("move", "r1", "0,1,0.5", "30,20,10")
        for name, acts in {"move": (move,), "spawn": (("spawn", box),), "remove": (("spawn", box), ("remove", "new"), ("spawn", box)),
                           "reset": (move, ("reset", "--seed", "9"), ("spawn", box), ("reset",), move),
                           "restore": (move, ("snapshot", "a"), ("reset",), ("spawn", box), ("restore", "a"), ("spawn", box))}.items():
            with self.subTest(name):
                recording = self.folder / f"{name}.mcap"
                process = self.start("serve", self.scene, "--json", "--record", recording, "--hash", "--ticks", 20)
                url = json.loads(process.stdout.readline())["endpoint"]
                for words in acts:
                    self.ctl(url, *words)
                subprocess.run([LUA, "--connect", url, "--quiet"], cwd=self.folder, timeout=LIMIT, env=self.environment)
                self.assertEqual(self.finish(process).code, 0)
                self.assertEqual(self.ask("verify", recording).code, 0)


class Disturbed(Recorded):
    ROBOT = """<prototype id="s{n}"><body position="{x},1.7,0"/><controller config="swing"/><links ref="base">
        <link id="base" geometry="box" size="0.1,0.1,0.05" mass="2"/><link id="arm" geometry="box"
        size="0.2,0.02,0.02" mass="0.1" position="0,0,0.05"/></links><joints><joint id="shoulder"
        type="revolute" axis="0,0,1"><parent link="base" position="0,0,0.05"/><child link="arm"
        position="0,0,0"/></joint></joints></prototype>"""

    def tick(self):
        return int(json.loads(self.ctl(self.endpoint, "status", "--json"))["tick"])  # 64 bits are texts in JSON

    def go_on(self, ticks=3):
        begin = self.tick()
        self.wait_for(self.tick, lambda now: now >= begin + ticks or now < begin, "more ticks")

    def disturb(self, n):
        """Kills a controller, which is started again and resumes; stops another, which misses deadlines;
        meanwhile a supervisor does what it can."""
        killed, stopped, *_ = self.lua_processes(3)
        os.kill(killed, signal.SIGKILL)
        os.kill(stopped, signal.SIGSTOP)
        self.ctl(self.endpoint, "move", "box0", f"0.3,{0.1 * n},0.5", "30,20,10")
        self.ctl(self.endpoint, "spawn", self.write("robot.xml", self.ROBOT.format(n=n, x=n)))
        self.go_on()
        os.kill(stopped, signal.SIGCONT)
        self.ctl(self.endpoint, "pause")
        self.ctl(self.endpoint, "remove", f"s{n}")
        self.ctl(self.endpoint, "step", 2)
        self.ctl(self.endpoint, "resume")
        self.go_on()

    def test_a_run_with_everything_that_disturbs_it_is_repeated(self):
        self.endpoint = f"ipc://{self.runtime}/supervisor"
        recording = self.folder / "run.mcap"
        process = self.start("run", self.scene, "--duration", 0, "--lua-processes", 0, "--restart", "swing=9",
                             "--deadline", "swing=hold:100:1000", "--inject", "swing=latency=3ms,jitter=2ms,loss=2%",
                             "--endpoint", self.endpoint, "--record", recording, "--hash-file", "run.hashes",
                             "--quiet", "--real-time", "2", "--seed", "5")
        self.lua_processes(3)
        self.wait_for(lambda: pathlib.Path(self.endpoint[6:]).exists(), bool, "endpoint")
        self.go_on()
        self.disturb(0)
        self.ctl(self.endpoint, "snapshot", "here")
        self.ctl(self.endpoint, "reset", "--seed", 9)
        self.disturb(1)
        self.ctl(self.endpoint, "spawn", self.write("robot.xml", self.ROBOT.format(n=2, x=-1)))
        self.go_on()
        self.ctl(self.endpoint, "reset")
        self.go_on()
        self.ctl(self.endpoint, "shutdown")
        self.finish(process)
        info = json.loads(self.ask("info", recording, "--json").out)
        self.assertTrue(info["is_whole"])
        self.assertEqual(info["epochs"], 3)
        self.ask("replay", recording, "--hash-file", "again.hashes", "--quiet")
        before, after = ((self.folder / name).read_text() for name in ("run.hashes", "again.hashes"))
        self.assertEqual(before, after)
        self.assertEqual(len(before.splitlines()), info["states"])
        self.assertRegex(self.ask("verify", recording).out, rf"^identical: {info['states']} states")
        kinds = set()
        self.ask("export", recording, "--jsonl", "inputs.jsonl", "--topics", "/inputs")
        for line in (self.folder / "inputs.jsonl").read_text().splitlines():
            for act in json.loads(line)["message"].get("acts", []):
                kinds |= set(act)
        self.assertTrue({"move", "spawn", "remove", "reset", "snapshot", "pause", "resume"} <= kinds, kinds)


class FromPoses(Recorded):
    def test_the_recorded_poses_are_written_without_simulating(self):
        """Also those of a recording whose commands are wrong: a replay of it would differ."""
        recording, _ = self.record("--ticks", "20", "--trace", "run.csv", "--record-compression", "none")
        change_inputs(recording, struct.pack("<3d", 2, 2, -3), struct.pack("<3d", 2, 2.25, -3))
        self.ask("verify", recording, code=DIFFERS)
        outcome = self.ask("replay", recording, "--from-poses", "--trace", "shown.csv")
        self.assertIn("shown: 21 states, nothing simulated", outcome.err)
        with open(self.folder / "run.csv") as a, open(self.folder / "shown.csv") as b:
            before, after = list(csv.DictReader(a)), list(csv.DictReader(b))
        self.assertEqual(len(before), len(after))
        for one, other in zip(before, after):
            for name in one:
                if name in ("tick", "time_s", "entity", "link") or one["link"]:
                    self.assertEqual(one[name], other[name], (name, one))
                else:
                    self.assertAlmostEqual(float(one[name]), float(other[name]), places=12)

    def test_it_is_shown(self):
        recording, _ = self.record("--ticks", "5")
        process = self.start("replay", recording, "--from-poses", "--view", "127.0.0.1:0", "--real-time", "1000")
        self.assertIn("http://127.0.0.1:", process.stderr.readline())
        self.interrupt(process)
        self.finish(process)

    def test_steps_end_when_the_viewer_leaves(self):
        recording, _ = self.record("--ticks", "40")
        process = self.start("replay", recording, "--view", "127.0.0.1:0", "--real-time", "4")
        port, token = self.read_until(process.stderr, r"http://127\.0\.0\.1:(\d+)/\?token=(\S+)").groups()
        with RawViewer(int(port), token) as first:
            channels = first.hear_operation("advertise")["channels"]
            first.say(op="subscribe", subscriptions=[{"id": 1, "channelId": channels[0]["id"]}])
            first.call(PAUSE, 1, b"{}")
            self.assertTrue(first.hear_answer(1)[0])
            first.call(STEP, 2, b'{"ticks": 10}')
        with RawViewer(int(port), token) as second:
            number, was_done = 0, False
            while not was_done:  # the steps of the first have ended then
                number += 1
                second.call(STEP, number, b'{"ticks": 1}')
                was_done, _ = second.hear_answer(number)
        self.interrupt(process)
        self.assertEqual(self.finish(process).code, INTERRUPTED)

    def test_what_needs_more_than_poses_is_refused(self):
        recording, _ = self.record("--ticks", "3")
        for option in (["--hash"], ["--hash-file", "x"], ["--readings", "x.jsonl"], ["--rays", "x.jsonl"],
                       ["--images", "x"], ["--summary", "x.json"]):
            outcome = self.ask("replay", recording, "--from-poses", *option, code=FAULT)
            self.assert_is_sentence(outcome, f"--from-poses simulates nothing, and {option[0]} needs more")
        recording, _ = self.record("--ticks", "3", "--record-topics", "/poses")
        self.assert_is_sentence(self.ask("replay", recording, "--from-poses", code=FAULT), "no topic /state")


class Export(Recorded):
    def test_csv_has_the_poses_of_the_trace(self):
        recording, _ = self.record("--ticks", "10", "--trace", "trace.csv")
        self.ask("export", recording, "--csv", "poses.csv")
        with open(self.folder / "trace.csv") as a, open(self.folder / "poses.csv") as b:
            trace, poses = list(csv.DictReader(a)), list(csv.DictReader(b))
        self.assertEqual(len(trace), len(poses))
        for before, after in zip(trace, poses):
            for name in before:
                if name in ("tick", "time_s", "entity", "link") or before["link"]:
                    self.assertEqual(before[name], after[name], (name, before))
                else:
                    self.assertAlmostEqual(float(before[name]), float(after[name]), places=12)

    def test_jsonl_has_the_messages_of_the_chosen_topics(self):
        recording, _ = self.record("--ticks", "10")
        self.ask("export", recording, "--jsonl", "out.jsonl", "--topics", "/robots/*/command")
        lines = [json.loads(line) for line in (self.folder / "out.jsonl").read_text().splitlines()]
        self.assertTrue(lines)
        self.assertTrue(all(re.fullmatch(r"/robots/.*/command", line["topic"]) for line in lines))
        self.assertIn("tick", lines[0]["message"])
        self.ask("export", recording, "--jsonl", "out.jsonl", "--topics", "/nothing", code=FAULT)
        self.ask("export", recording, code=FAULT)


if __name__ == "__main__":
    main()
