# SPDX-License-Identifier: MIT
"""Entities added and removed while a world runs: ctl spawn and remove."""

import csv
import json
import math
import re
import subprocess

import zmq

from harness import FAULT, INTERRUPTED, LUA, SceneTest, main

BOX = '<box id="{}" size="0.1,0.1,0.1" movable="true" mass="1"><body position="{}"/></box>'
PACED = "--real-time", 3  # fewer lines to read


class Spawn(SceneTest):
    def arm(self, id, position):
        """A copy of robot r1 at another position."""
        arm = re.search(r'<prototype id="r1">.*?</prototype>', self.text, re.DOTALL)[0]
        return arm.replace('"r1"', f'"{id}"').replace("0,1,0", position)

    def begin(self, command, *arguments):
        """A run that never ends, and its endpoint."""
        self.url = f"ipc://{self.folder}/endpoint"
        process = self.start(command, self.scene, "--duration", 0, "--endpoint", self.url, *arguments)
        self.wait_for(lambda: (self.folder / "endpoint").exists(), bool, "endpoint")
        return process

    def begin_without_controllers(self, *arguments):
        """A paused world whose robots have no scripts."""
        self.change('script="swing.lua" ', "")
        process = self.begin("serve", *arguments)
        self.wait_for(lambda: self.ctl(self.url, "status"), lambda text: "paused" in text, "pause")
        return process

    def spawn(self, text, **options):
        return self.ctl(self.url, "spawn", "-", text=text, **options)

    def read(self, *patterns):
        return json.loads(self.ctl(self.url, "read", *patterns, "--json"))

    def end(self, process):
        self.interrupt(process)
        outcome = self.finish(process)
        self.assertEqual(outcome.code, INTERRUPTED, outcome.err)
        return outcome

    def test_a_spawned_lua_robot_has_a_process_until_it_is_removed(self):
        process = self.begin("run", *PACED)
        self.read_until(process.stdout, r"^\[5 r0\]")
        self.spawn(self.arm("late", "0,2,0"))
        self.read_until(process.stdout, r"^\[\d+ late\] init")
        self.read_until(process.stdout, r"^\[\d+ late\] step 20")
        self.assertEqual(len(self.lua_processes(2)), 2)
        self.ctl(self.url, "remove", "late")
        self.read_until(process.stdout, r"^\[\d+ late\] destroy")
        self.assertEqual(len(self.lua_processes(2)), 2, "its process waits for other robots")
        tick = int(self.read_until(process.stdout, r"^\[(\d+) r0\]")[1])
        self.read_until(process.stdout, rf"^\[{tick + 20} r0\]")
        self.assertNotIn("late", self.end(process).out)

    def test_a_joint_is_set_and_the_recording_repeats_it(self):
        recording = self.folder / "run.mcap"
        process = self.begin_without_controllers("--record", recording)
        self.assertEqual(self.ctl(self.url, "set-joint", "r0", "shoulder", -0.75, 2), "set at tick 0\n")
        arm = next(link for link in self.read("r0")["entities"][0]["links"] if link["id"] == "arm")
        self.assertAlmostEqual(2 * math.atan2(arm["orientation"][3], arm["orientation"][0]), -0.75, places=12)
        self.assertAlmostEqual(arm["angularVelocity"][2], 2, places=12)
        self.ctl(self.url, "step", 5)
        self.ctl(self.url, "snapshot", "here")
        self.ctl(self.url, "set-joint", "r1", "shoulder", 1)
        self.ctl(self.url, "step", 3)
        self.ctl(self.url, "restore", "here")
        self.ctl(self.url, "step", 2)
        self.assertRegex(self.ctl(self.url, "set-joint", "r0", "knee", 0, code=FAULT), "'r0' has no joint 'knee'; write one of 'shoulder'")
        self.assertRegex(self.ctl(self.url, "set-joint", "r0", "shoulder", "far", code=FAULT), "position .*far")
        self.assertRegex(self.ctl(self.url, "set-joint", "r7", "shoulder", 0, code=FAULT), "no entity 'r7'")
        self.ctl(self.url, "shutdown", "--reason", "seen")
        self.assertEqual(self.finish(process).code, 0)
        outcome = self.ziggurat("verify", recording)
        self.assertEqual(outcome.code, 0, outcome.err)
        self.assertRegex(outcome.out, "^identical")
        outcome = self.ziggurat("fork", recording, "--at", 3, "--ticks", 6, "--without-controllers", "--set",
                                "physics_engines/*/gravity/@g=5")
        self.assertEqual(outcome.code, 0, outcome.err)

    def test_a_move_onto_another_needs_a_word(self):
        process = self.begin_without_controllers()
        self.spawn('<box id="crate" size="0.1,0.1,0.1" movable="true" mass="1"><body position="3,3,0"/></box>')
        self.spawn('<box id="other" size="0.1,0.1,0.1" movable="true" mass="1"><body position="4,3,0"/></box>')
        self.assertEqual(self.ctl(self.url, "is-free", "crate", "4,3.05,0"), "not free: 'other' is there\n")
        self.assertEqual(self.ctl(self.url, "is-free", '<box size="0.1,0.1,0.1"/>', "4,3.1,0"), "free\n")
        self.assertEqual(json.loads(self.ctl(self.url, "is-free", "crate", "4,3.05,0", "--json")), {"free": False, "overlapped": "other"})
        self.assertRegex(self.ctl(self.url, "move", "crate", "4,3.05,0", code=FAULT), "'crate' overlaps 'other' where it is moved to")
        self.ctl(self.url, "move", "crate", "4,3.05,0", "--may-overlap")
        self.assertEqual(self.read("crate")["entities"][0]["position"], [4, 3.05, 0])
        self.assertRegex(self.ctl(self.url, "remove", "crate", "--may-overlap", code=FAULT), "--may-overlap is for move")
        self.end(process)

    def test_spawned_robots_share_processes(self):
        process = self.begin("run", *PACED)
        self.read_until(process.stdout, r"^\[5 r0\]")
        for i in range(20):
            self.spawn(self.arm(f"late{i}", f"0,{i + 2},0"))
        self.read_until(process.stdout, r"^\[\d+ late19\] step 3")
        processes = self.lua_processes(2)
        self.assertEqual(len(processes), 2, "one for the scene's robots, one for the others")
        self.ctl(self.url, "remove", "late3")
        self.ctl(self.url, "reset")
        self.spawn(self.arm("later", "0,2,0"))
        self.read_until(process.stdout, r"^\[\d+ later\] step 3")
        self.assertEqual(self.lua_processes(2), processes)
        self.end(process)

    def test_spawned_robots_have_sixteen_processes_at_most(self):
        """Beside those of the scene's robots."""
        process = self.begin("run", "--real-time", 1, "--lua-processes", 0)
        self.read_until(process.stdout, r"^\[2 r0\]")
        scripted = len(self.lua_processes(3))
        for i in range(18):
            self.spawn(self.arm(f"late{i}", f"0,{i + 2},0"))
        self.read_until(process.stdout, r"^\[\d+ late17\] step")
        self.assertEqual(len(self.lua_processes(16)), scripted + 16)
        self.end(process)

    def test_a_robot_that_is_removed_at_once_is_no_failure(self):
        process = self.begin("run", *PACED)
        self.read_until(process.stdout, r"^\[5 r0\]")
        with zmq.Context() as context, context.socket(zmq.DEALER) as dealer:
            dealer.linger, dealer.rcvtimeo = 0, 20_000
            dealer.connect(self.url)
            dealer.send_json({"hello": {"version": {"major": 1}, "role": "ROLE_SUPERVISOR"}})
            for _ in range(10):  # before the process that it is meant for can ask for it
                dealer.send_json({"request": {"id": 1, "spawn": {"xml": self.arm("late", "0,2,0")}}})
                dealer.send_json({"request": {"id": 2, "remove": {"entity": "late"}}})
            answered = 0
            while answered < 20:
                answer = dealer.recv_json()
                answered += "response" in answer
                self.assertFalse(answer.get("response", {}).get("error"), answer)
        self.spawn(self.arm("late", "0,2,0"))
        self.read_until(process.stdout, r"^\[\d+ late\] step 20")
        self.assertNotRegex(self.end(process).err, "(?m)^ziggurat-lua: ")

    def test_the_world_waits_for_a_robot_without_session(self):
        process = self.begin("serve", *PACED)
        scripted = [subprocess.Popen([LUA, "--connect", self.url, "--quiet"], cwd=self.folder,
                                     env=self.environment)]
        self.started += scripted
        self.read_until(process.stdout, r"^\[5 r0\]")
        self.spawn(self.arm("late", "0,2,0"))
        self.read_until(process.stderr, r"waiting for robot late \(controller 'swing'\) to connect to ipc")
        scripted.append(subprocess.Popen([LUA, "--connect", self.url, "--robot", "late", "--quiet"],
                                         cwd=self.folder, env=self.environment))
        self.started.append(scripted[-1])
        self.read_until(process.stdout, r"^\[\d+ late\] step 5")
        self.ctl(self.url, "remove", "r1")
        self.read_until(process.stdout, r"^\[\d+ late\] step 30")
        self.ctl(self.url, "reset")
        self.assertEqual(scripted[1].wait(60), 0, "a reset removes spawned robots and ends their sessions")
        self.read_until(process.stdout, r"^\[20 r0\]")
        self.assertEqual([e["id"] for e in self.read("r*")["entities"]],
                         ["r0", "r1", "r2"])
        self.end(process)
        self.assertEqual(scripted[0].wait(60), 0)

    def scripted(self, script):
        """A copy of robot r1 that names this script."""
        return self.arm("x", "0,3,0").replace(
            'config="swing" />', f'config="swing"><params script="{script}" speed="1"/></controller>')

    def test_a_spawned_robot_runs_only_scripts_of_the_scene(self):
        outside = self.folder / "outside"
        outside.mkdir()
        (outside / "evil.lua").write_text("top secret")
        (self.folder / "link.lua").symlink_to(outside / "evil.lua")
        process = self.begin("run", *PACED)
        self.read_until(process.stdout, r"^\[5 r0\]")
        answers = set()
        for script in ("/etc/passwd", "/etc/none", outside / "evil.lua", "outside/evil.lua", "link.lua"):
            answer = self.spawn(self.scripted(script), code=1)
            self.assertRegex(answer, "script '.*' is neither a script that the scene names nor")
            self.assertIn("--allow-spawned-scripts DIR", answer)
            answers.add(answer.replace(str(script), ""))
        self.assertEqual(len(answers), 1, "the answer must not tell which files exist")
        self.spawn(self.scripted("swing.lua"))
        self.read_until(process.stdout, r"^\[\d+ x\] step 3")
        self.end(process)

    def test_a_spawned_robot_runs_scripts_below_an_allowed_folder(self):
        allowed = self.folder / "allowed"
        allowed.mkdir()
        (allowed / "mine.lua").write_text("function init() log('mine') end function step() end")
        (allowed / "wrong.lua").write_text("top secret")
        (allowed / "link.lua").symlink_to("/etc/passwd")
        process = self.begin("run", *PACED, "--allow-spawned-scripts", allowed)
        self.read_until(process.stdout, r"^\[5 r0\]")
        self.assertIn("neither", self.spawn(self.scripted("link.lua"), code=1))
        answer = self.spawn(self.scripted("wrong.lua"), code=1)
        self.assertIn("does not compile; the server's output has the reason", answer)
        self.assertNotIn("secret", answer)
        self.spawn(self.scripted("mine.lua"))
        self.read_until(process.stdout, r"^\[\d+ x\] mine")
        self.assertRegex(self.end(process).err, "wrong.lua:1: .*secret")

    def test_a_spawned_entity_reads_no_file(self):
        (self.folder / "secret.obj").write_text("v top secret")
        process = self.begin_without_controllers()
        hull = ('<prototype id="h" movable="true"><body position="0,3,0"/><links ref="a">'
                '<link id="a" geometry="hull" mass="1"><hull file="{}"/></link></links></prototype>')
        for file in ("secret.obj", "none.obj"):
            answer = self.spawn(hull.format(file), code=1)
            self.assertNotIn("secret ", answer)
            self.assertIn("may read no file; use a model of the scene", answer)
        self.end(process)

    def test_a_spawned_hull_is_read_below_an_allowed_folder_only(self):
        corners = "".join(f"v {x} {y} {z}\n" for x in (0, 0.1) for y in (0, 0.1) for z in (0, 0.1))
        (self.folder / "beside.obj").write_text(corners)
        shapes = self.folder / "shapes"
        shapes.mkdir()
        (shapes / "cube.obj").write_text(corners)
        elsewhere = self.folder / "elsewhere"  # the working directory has no effect
        elsewhere.mkdir()
        (elsewhere / "away.obj").write_text(corners)
        self.change('script="swing.lua" ', "")
        self.url = f"ipc://{self.folder}/endpoint"
        process = self.start("serve", self.scene, "--duration", 0, "--endpoint", self.url,
                             "--allow-spawned-scripts", shapes, cwd=elsewhere)
        self.wait_for(lambda: (self.folder / "endpoint").exists(), bool, "endpoint")
        self.wait_for(lambda: self.ctl(self.url, "status"), lambda text: "paused" in text, "pause")
        hull = ('<prototype id="{}" movable="true"><body position="0,{},0.3"/><links ref="a">'
                '<link id="a" geometry="hull" mass="1"><hull file="{}"/></link></links></prototype>')
        self.spawn(hull.format("a", 3, "shapes/cube.obj"))  # relative to the scene's folder
        self.spawn(hull.format("b", 4, "cube.obj"))  # relative to the allowed one
        for file in ("beside.obj", "away.obj"):
            self.assertIn("may read no file", self.spawn(hull.format("c", 5, file), code=1))
        self.end(process)

    def test_a_spawned_entity_has_limits(self):
        process = self.begin_without_controllers()
        links = "".join(f'<link id="l{i}" geometry="box" size="0.1,0.1,0.1" mass="1" '
                        'position="0,0,0"/>' for i in range(257))
        joints = "".join(f'<joint id="j{i}" type="revolute" axis="0,0,1"><parent link="l{i}" '
                         f'position="0.2,0,0"/><child link="l{i + 1}" position="0,0,0"/></joint>'
                         for i in range(256))
        chain = ('<prototype id="chain"><body position="0,3,0"/>'
                 f'<links ref="l0">{links}</links><joints>{joints}</joints></prototype>')
        self.assertIn("'chain' has 257 links; an entity that is spawned may have at most 256",
                      self.spawn(chain, code=1))
        self.assertIn("'heavy' has a mass of 1e+07 kg; an entity that is spawned may have at most 1e+06",
                      self.spawn(BOX.format("heavy", "0,3,0").replace('mass="1"', 'mass="1e7"'), code=1))
        for position in ("1e308,0,0", "0,-1.1e6,0", "nan,0,0"):
            self.ctl(self.url, "move", "box1", position, code=1)
        self.ctl(self.url, "move", "box1", "1e6,0,0")
        self.end(process)

    def test_models_of_spawned_entities_count_after_a_restore_too(self):
        self.change("<arena", f'''<models><prototype id="large">
          <links ref="l"><link id="l" geometry="box" size="0.1,0.1,0.1{"0" * 50_000}" mass="1"/></links></prototype></models><arena''', 1)
        process = self.begin_without_controllers("--max-scene-size", "120K")
        large = '<prototype id="{}" model="large"><body position="{},3,0"/></prototype>'
        self.spawn(large.format("a", 0))
        self.spawn(large.format("b", 1))
        self.assertIn("larger than", self.spawn(large.format("c", 2), code=1))
        self.ctl(self.url, "snapshot", "full")
        self.ctl(self.url, "step", 1)
        self.ctl(self.url, "restore", "full")
        self.assertIn("larger than", self.spawn(large.format("c", 2), code=1))
        self.ctl(self.url, "reset")
        self.spawn(large.format("c", 2))
        self.end(process)

    def test_notices_about_a_spawned_entity_are_printed_by_the_server(self):
        process = self.begin_without_controllers("--lenient")
        self.spawn(BOX.format("crate", "0.05,0.08,0.2").replace("<box ", '<box flavour="oak" '))
        self.assertRegex(self.end(process).err, r'spawn:1:\d+: unknown attribute "flavour" of <box>')

    def test_traces_and_readings_list_present_entities_only(self):
        process = self.begin_without_controllers("--trace", "trace.csv", "--readings", "readings.jsonl")
        self.ctl(self.url, "step", 3)
        self.spawn(self.arm("late", "0,2,0"))
        self.ctl(self.url, "step", 4)
        self.ctl(self.url, "remove", "late")
        self.ctl(self.url, "remove", "r1")
        self.ctl(self.url, "step", 2)
        self.spawn(BOX.format("late", "0,2,0"))
        self.ctl(self.url, "step", 1)
        self.ctl(self.url, "reset")
        self.spawn(BOX.format("other", "0,2,0"))
        self.ctl(self.url, "step", 2)
        self.end(process)
        ticks = {}
        for row in csv.DictReader((self.folder / "trace.csv").read_text().splitlines()):
            if not row["link"]:
                ticks.setdefault(row["entity"], []).append(int(row["tick"]))
        self.assertEqual(ticks["late"], [4, 5, 6, 7, 10])
        self.assertEqual(ticks["r1"], [*range(8), 0, 1, 2])
        self.assertEqual(ticks["other"], [1, 2])
        self.assertEqual(ticks["r0"], [*range(11), 0, 1, 2])
        seen = {}
        for line in (self.folder / "readings.jsonl").read_text().splitlines():
            reading = json.loads(line)
            seen.setdefault(reading["robot"], []).append(int(reading["tick"]))
        self.assertEqual(seen["late"], [3, 4, 5, 6])
        self.assertEqual(seen["r1"][:7], [*range(7)])


if __name__ == "__main__":
    main()
