# SPDX-License-Identifier: MIT
"""metric(name, value) of controllers: in the summary, readings, recordings and at --metrics."""

import json

from harness import CONTROLLER_FAILED, SceneTest, main

SCRIPT = """
local steps = 0
function init() metric("started", 1) end
function step()
   steps = steps + 1
   metric("steps", steps)
   if steps == 2 then robot.metric("second.step", steps / 4) end
end
function destroy() metric("total", 10 * steps) end
"""


class Metrics(SceneTest):
    def setUp(self):
        super().setUp()
        (self.folder / "swing.lua").write_text(SCRIPT)

    def summary(self, *arguments, command="run", scene=None):
        path = self.folder / "summary.json"
        outcome = self.ziggurat(command, scene or self.scene, "--summary", path, *arguments)
        self.assertEqual(outcome.code, 0, outcome.err)
        return json.loads(path.read_text())

    def readings(self):
        lines = map(json.loads, (self.folder / "readings.jsonl").read_text().splitlines())
        return [(line["tick"], line["robot"], line["metrics"]) for line in lines if line["metrics"]]

    def test_last_values_are_in_the_summary(self):
        summary = self.summary("--duration", "0.5")
        robots = {key.partition("/")[0] for key in summary["metrics"]}
        self.assertEqual(len(robots), summary["robots"])
        ticks = summary["ticks"]
        for robot in robots:
            expected = {"started": 1, "steps": ticks, "second.step": 0.5, "total": 10 * ticks}
            self.assertEqual({name: summary["metrics"][f"{robot}/{name}"] for name in expected}, expected)
        self.assertEqual(len(summary["metrics"]), 4 * len(robots))

    def test_readings_have_them_at_their_tick(self):
        self.summary("--duration", "0.5", "--readings", self.folder / "readings.jsonl")
        found = self.readings()
        robot = found[0][1]
        of_one = {tick: metrics for tick, name, metrics in found if name == robot}
        self.assertEqual(of_one["0"], {"started": 1})
        self.assertEqual(of_one["1"], {"steps": 1})
        self.assertEqual(of_one["2"], {"steps": 2, "second.step": 0.5})

    def test_a_replay_has_the_same(self):
        record = self.folder / "run.mcap"
        before = self.summary("--duration", "0.5", "--record", record, "--readings", self.folder / "readings.jsonl")
        lines = self.readings()
        (self.folder / "readings.jsonl").unlink()
        after = self.summary("--readings", self.folder / "readings.jsonl", command="replay", scene=record)
        self.assertEqual(after["metrics"], before["metrics"])
        last = max(int(tick) for tick, _, _ in lines)
        self.assertEqual([line for line in self.readings() if int(line[0]) < last],
                         [line for line in lines if int(line[0]) < last])

    def test_a_reset_forgets_them(self):
        (self.folder / "swing.lua").write_text(
            "function init() metric('before', 1) end\nfunction step() end\nfunction reset() metric('after', 2) end")
        endpoint = f"ipc://{self.folder}/e"
        process = self.start("run", self.scene, "--endpoint", endpoint, "--paused", "--summary",
                             self.folder / "summary.json")
        self.wait_for((self.folder / "e").exists, bool, "socket")
        # After a reset the world stands once tick 0 is complete; `pause` waits for that.
        for arguments in (("pause",), ("step",), ("reset",), ("pause",), ("step",), ("shutdown", "--reason", "seen")):
            outcome = self.ziggurat("ctl", endpoint, *arguments)
            self.assertEqual(outcome.code, 0, outcome.err)
        self.assertEqual(self.finish(process).code, 0)
        names = {key.partition("/")[2] for key in json.loads((self.folder / "summary.json").read_text())["metrics"]}
        self.assertEqual(names, {"after"})

    def test_a_wrong_name_fails_the_script_with_its_line(self):
        (self.folder / "swing.lua").write_text("function init()\n metric('two words', 1)\nend\nfunction step() end")
        outcome = self.run_scene("--duration", "0.5", code=CONTROLLER_FAILED)
        self.assert_is_sentence(outcome, r"swing\.lua:2: the name of a metric must have 1 to 64 letters")


if __name__ == "__main__":
    main()
