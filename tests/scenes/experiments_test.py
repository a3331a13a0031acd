# SPDX-License-Identifier: MIT
"""Directors' scripts and programs: the examples, what a script may do, and a sweep over a director's metric."""

import csv
import json
import math
import re
import subprocess

from harness import BIN, CONTROLLER_FAILED, FAULT, FINISHED, HERE, LIMIT, LUA, SceneTest, main

ROOT = HERE.parents[1]
EXPERIMENTS = ROOT / "scenes/experiments"
STACKING = ROOT / "scenes/prototype_srocs_system.argos"


class Experiments(SceneTest):
    def summary(self, scene, *arguments, code=FINISHED):
        path = self.folder / "summary.json"
        outcome = self.run_scene("--summary", path, *arguments, scene=scene, code=code)
        return json.loads(path.read_text()), outcome

    def with_director(self, script, name="judge"):
        """The test's scene with a director whose script that is."""
        self.write(f"{name}.lua", script)
        self.change("<framework>", f'<director id="{name}" script="{name}.lua"><params goal="3" /></director>\n  <framework>')

    def test_food_is_collected_and_placed_anew(self):
        scene = EXPERIMENTS / "foraging.argos"
        summary, outcome = self.summary(scene, "--param", "goal=8")
        self.assertEqual((summary["ending"], summary["director"]), ("finished", "food"))
        self.assertEqual(summary["metrics"]["food/collected"], 8)
        items = re.findall(r"collects food(\d+): \d+\n", outcome.out)
        self.assertEqual(len(set(items)), 8, "each item is collected once")
        self.assertGreater(max(map(int, items)), 6, "more than were there at the beginning")
        again, _ = self.summary(scene, "--param", "goal=8")
        self.assertEqual(again["hash"], summary["hash"])
        other, _ = self.summary(scene, "--param", "goal=8", "--seed", "4")
        self.assertNotEqual(other["hash"], summary["hash"])

    def test_a_recording_with_a_director_is_repeated(self):
        recording = self.folder / "run.mcap"
        self.summary(EXPERIMENTS / "foraging.argos", "--param", "goal=3", "--record", recording)
        outcome = self.ziggurat("verify", recording)
        self.assertIn("identical", outcome.out + outcome.err)
        self.assertEqual(outcome.code, FINISHED)

    def test_how_the_share_of_radios_changes_the_time_to_aggregate(self):
        """The worked example, with fewer runs."""
        out = self.folder / "out"
        outcome = self.ziggurat("sweep", EXPERIMENTS / "aggregation.argos", "--param", "share=0.1|1", "--seeds", "1..4",
                                "--out", out, "--jobs", "2", "--duration", "200")
        self.assertEqual(outcome.code, FINISHED, outcome.err)
        with open(out / "results.csv") as file:
            rows = list(csv.DictReader(file))
        times = {share: [float(row["swarm/time_to_aggregate"]) for row in rows if row["share"] == share]
                 for share in ("0.1", "1")}
        self.assertEqual([len(each) for each in times.values()], [4, 4])
        self.assertLess(sum(times["1"]), sum(times["0.1"]))
        for row in rows:
            together = float(row["swarm/spread"]) < 0.7
            self.assertEqual(together, float(row["simulated_s"]) < 200, row)
            self.assertAlmostEqual(float(row["swarm/time_to_aggregate"]), float(row["simulated_s"]), places=6)
        means = self.ziggurat("sweep", "results", out, "--metric", "swarm/time_to_aggregate", "--csv").lines
        self.assertEqual(means[0], "share,runs,failed,swarm/time_to_aggregate,+-95%")
        self.assertEqual(len(means), 3)

    def test_a_judge_in_cpp_ends_the_stacking_scene(self):
        text = STACKING.read_text().replace('file="models/', f'file="{STACKING.parent}/models/')
        text = text.replace("<framework>", f'<director id="judge" command="{BIN}/example_judge" />\n  <framework>', 1)
        summary, _ = self.summary(self.write("judged.argos", text))
        self.assertRegex(summary["result"], r"block1 stands on block2, 0\.\d\d mm aside")
        self.assertLess(summary["metrics"]["judge/aside_mm"], 1)
        self.assertTrue(20 < summary["simulated_s"] < 40, summary["simulated_s"])

    def test_a_script_sees_and_changes_the_world(self):
        self.with_director("""
            local before
            function init()
              before = {}
              for id, entity in pairs(world.entities) do before[id] = entity.position end
              world.spawn('<box id="marker" size="0.1,0.1,0.1" movable="false"><body position="9,9,0"/></box>')
            end
            function post_step(tick)
              if tick == 1 then
                log("marker at ", world.entities.marker.position.x, ", params ", world.params.goal)
                world.move("marker", {x = 8, y = 9, z = 0})
              elseif tick == 2 then
                log("then at ", world.entities.marker.position.x)
                world.remove("marker")
              elseif tick == 3 then
                log("then ", world.entities.marker == nil)
                world.finish("seen")
              end
            end
        """)
        summary, outcome = self.summary(self.scene)
        self.assertEqual(summary["result"], "seen")
        self.assertEqual(summary["ticks"], 3)
        for line in ("[1 judge] marker at 9, params 3", "[2 judge] then at 8", "[3 judge] then 1"):
            self.assertIn(line, outcome.out)

    def test_a_script_asks_whether_a_place_is_free(self):
        self.with_director("""
            function init()
              world.spawn('<box id="a" size="0.1,0.1,0.1" movable="false"><body position="9,9,0"/></box>')
              world.spawn('<box id="b" size="0.1,0.1,0.1" movable="false"><body position="9,8,0"/></box>')
            end
            function post_step(tick)
              if tick == 1 then
                local free, other = world.is_free("a", {x = 9, y = 8, z = 0})
                log("a: ", free, other, ", ", world.is_free("a", {x = 9, y = 9, z = 0}))
                log("ball: ", world.is_free('<sphere radius="0.1"/>', {x = 9, y = 8, z = 0}))
                world.move("a", {x = 9, y = 8, z = 0})
              elseif tick == 2 then
                log("a is at ", world.entities.a.position.y)
                world.move("a", {x = 9, y = 8, z = 0}, nil, {may_overlap = true})
              else
                world.finish("at " .. world.entities.a.position.y)
              end
            end
        """)
        summary, outcome = self.summary(self.scene)
        self.assertEqual(summary["result"], "at 8.0")
        for line in ("[1 judge] a: 0b, 1", "[1 judge] ball: 0b", "[2 judge] a is at 9"):
            self.assertIn(line, outcome.out)
        self.assertRegex(outcome.err, r"judge\.lua:\d+: acts\[0\]\.move\.position: 'a' overlaps 'b' where it is moved to")

    def test_a_script_that_fails_is_named(self):
        self.with_director("function post_step(tick) if tick == 2 then error('no food') end end")
        _, outcome = self.summary(self.scene, "--ticks", "5", code=CONTROLLER_FAILED)
        self.assert_is_sentence(outcome, r"director 'judge'.*judge\.lua:1: no food \(in post_step 2\)")

    def test_an_act_that_is_wrong_is_named(self):
        self.with_director("function post_step(tick) world.remove('missing') end")
        _, outcome = self.summary(self.scene, "--ticks", "5", code=CONTROLLER_FAILED)
        self.assert_is_sentence(outcome, r"director 'judge'.*There is no entity 'missing'.*asked for at tick 1")
        self.assertRegex(outcome.err, r"judge\.lua:1: UNKNOWN_ENTITY")
        self.assertEqual(outcome.err.count("There is no entity"), 1, outcome.err)

    def test_an_endless_loop_is_ended(self):
        self.with_director("function post_step(tick) while tick == 2 do end end")
        _, outcome = self.summary(self.scene, "--ticks", "5", "--lua-instructions", "2", code=CONTROLLER_FAILED)
        self.assert_is_sentence(outcome, r"director 'judge'.*judge\.lua:1: runs more than 2 million instructions")

    def test_a_reset_begins_anew(self):
        """With the director started by hand, and a supervisor that resets the world."""
        self.with_director("""
            local spawned = 0
            local function begin()
              spawned = spawned + 1
              world.spawn('<box id="marker" size="0.1,0.1,0.1" movable="false"><body position="9,9,0"/></box>')
              log("begin ", spawned, " at ", world.tick)
            end
            init, reset = begin, begin
            function post_step(tick) log("marker ", world.entities.marker.position.x) end
        """)
        url = f"ipc://{self.runtime}/s"
        server = self.start("serve", self.scene, "--endpoint", url, "--ticks", "1000000", "--real-time", "2", "--without-directors")
        programs = [subprocess.Popen([LUA, "--connect", url, "--quiet", *more], env=self.environment, cwd=self.folder,
                                     stdout=subprocess.PIPE, text=True) for more in ((), ("--director", "judge", "--echo"))]
        self.started += programs
        self.read_until(programs[1].stdout, r"marker 9")
        self.assertEqual(self.ziggurat("ctl", url, "reset").code, FINISHED)
        self.read_until(programs[1].stdout, r"\[0 judge\] begin 2 at 0")
        self.read_until(programs[1].stdout, r"marker 9")
        self.assertEqual(self.ziggurat("ctl", url, "shutdown").code, FINISHED)
        for program in programs:
            program.communicate(timeout=LIMIT)
        self.finish(server)

    def test_the_sandbox_is_that_of_controllers(self):
        self.with_director("function init() os.execute('touch escaped') end")
        _, outcome = self.summary(self.scene, "--ticks", "5", code=CONTROLLER_FAILED)
        self.assert_is_sentence(outcome, r"os\.execute is not allowed for scripts that are not trusted")
        self.assertFalse((self.folder / "escaped").exists())

    def test_a_push_moves_what_it_pushes(self):
        """A free box of 2 kg, no floor, no gravity: 4 N for 10 ticks of 0.1 s are 2 m/s."""
        scene = self.write("push.argos", """
<argos-configuration>
  <framework><experiment length="2" ticks_per_second="10" random_seed="1" /></framework>
  <director id="hand" script="hand.lua" />
  <controllers />
  <arena size="9, 9, 9">
    <box id="b" size="0.1, 0.1, 0.1" movable="true" mass="2"><body position="0, 0, 1" /></box>
  </arena>
  <physics_engines><dynamics3d id="d" iterations="10" /></physics_engines>
  <media />
</argos-configuration>
""")
        self.write("hand.lua", """
            function pre_step(tick) if tick <= 10 then world.push("b", {x = 4, y = 0, z = 0}) end end
            function post_step(tick) metric("speed", world.entities.b.velocity.x) end
        """)
        summary, _ = self.summary(scene)
        self.assertTrue(math.isclose(summary["metrics"]["hand/speed"], 2, rel_tol=0.01), summary["metrics"])

    def test_ziggurat_lua_says_what_does_not_fit(self):
        outcome = self.start_lua("--director", "judge", "--robot", "a")
        self.assertEqual(outcome.returncode, FAULT)
        self.assertIn("--director runs no robots", outcome.stderr)

    def start_lua(self, *arguments):
        return subprocess.run([BIN / "ziggurat-lua", "--connect", "tcp://127.0.0.1:1", *arguments], text=True,
                              capture_output=True, check=False, env=self.environment, cwd=self.folder)


if __name__ == "__main__":
    main()
