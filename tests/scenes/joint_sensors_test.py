# SPDX-License-Identifier: MIT
"""A joint with a sensor of its position and one of its velocity: scene, clients, recordings."""

import json
import os
import sys

from harness import FAULT, SceneTest, main

SCRIPT = """
function init() robot.joints.shoulder.set_target(0.5) end
function step()
  local joint = robot.joints.shoulder
  assert(joint.encoder == joint.velocity)   -- which stands first
  log(string.format("%.4f %.4f", joint.position, joint.velocity))
end
"""

PYTHON = """
import ziggurat
with ziggurat.connect() as session:
    for tick in session:
        for robot in session.robots:
            joint = robot.joints["shoulder"]
            joint.target = 0.5
            if tick.number == 10:
                robot.log(f"{joint.position:.4f} {joint.velocity:.4f}")
"""


class Both(SceneTest):
    def setUp(self):
        super().setUp()
        self.change('<joint id="shoulder" mode="velocity" />',
                    '<joint id="shoulder" mode="velocity" /><joint id="shoulder" mode="position" />')

    def test_in_lua_and_in_readings(self):
        self.write("swing.lua", SCRIPT)
        readings = self.folder / "r.jsonl"
        outcome = self.run_scene("--ticks", 10, "--readings", readings)
        position, velocity = (float(each) for each in
                              next(line for line in outcome.lines if line.startswith("[10 r1]")).split()[2:])
        self.assertAlmostEqual(velocity, 0.5, delta=0.02)
        self.assertAlmostEqual(position, 10 * 0.1 * 0.5, delta=0.03)  # [rad]: ten ticks of 0.1 s
        last = [json.loads(line) for line in readings.read_text().splitlines()][-2]["observation"]["joint_encoders"]
        self.assertEqual(set(last), {"shoulder", "shoulder position"})
        self.assertAlmostEqual(last["shoulder"], velocity, delta=1e-4)
        self.assertAlmostEqual(last["shoulder position"], position, delta=1e-4)

    def test_in_python(self):
        self.write("both.py", PYTHON)
        self.environment["PYTHONPATH"] = os.environ["ZIGGURAT_PYTHON_PACKAGE"]
        outcome = self.run_scene("--ticks", 10, "--controller", f"swing={sys.executable} both.py")
        position, velocity = (float(each) for each in
                              next(line for line in outcome.lines if line.startswith("[10 r1]")).split()[2:])
        self.assertAlmostEqual(velocity, 0.5, delta=0.02)
        self.assertAlmostEqual(position, 0.5, delta=0.03)

    def test_two_of_the_same_are_refused(self):
        self.change('mode="position" />', 'mode="velocity" />')
        self.assert_is_sentence(self.run_scene(code=FAULT), r'arms.argos:\d+:\d+: .*id="shoulder" of <joint> is listed twice, first')


if __name__ == "__main__":
    main()
