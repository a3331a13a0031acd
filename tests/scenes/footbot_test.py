# SPDX-License-Identifier: MIT
"""Foot-bots from end to end: cameras on robot and turret, proximity with angles."""

import json
import math
import pathlib

from harness import SceneTest, main

SCENES = pathlib.Path(__file__).resolve().parents[2] / "scenes"

PROXIMITY_SCENE = """<?xml version="1.0" ?>
<argos-configuration>
  <framework>
    <experiment length="0" ticks_per_second="5" random_seed="1" />
  </framework>
  <controllers>
    <lua_controller id="c">
      <actuators />
      <sensors><footbot_proximity implementation="default" /></sensors>
      <params script="proximity.lua" />
    </lua_controller>
  </controllers>
  <arena size="2,2,1" center="0,0,0.5">
    <foot-bot id="fb">
      <body position="0,0,0" orientation="0,0,0" />
      <controller config="c" />
    </foot-bot>
    <box id="wall" size="0.1,1,0.5" movable="false">
      <body position="{wall},0,0" orientation="0,0,0" />
    </box>
  </arena>
  <physics_engines>
    <dynamics2d id="plane" />
  </physics_engines>
  <media />
</argos-configuration>
"""

PROXIMITY_SCRIPT = """
function init()
  assert(#robot.proximity == 24)
  first = robot.proximity[1]
  assert(first.value == 0)
end

function step()
  assert(first == robot.proximity[1])
  for _, sensor in ipairs(robot.proximity) do
    log(string.format("%.9f %.9f", sensor.value, math.deg(sensor.angle)))
  end
end
"""


def runs(ticks):
    """Sorted whole numbers as (first, last) of each run without a gap."""
    found = []
    for tick in ticks:
        if found and tick == found[-1][1] + 1:
            found[-1][1] = tick
        else:
            found.append([tick, tick])
    return [tuple(run) for run in found]


class CameraExample(SceneTest):
    """The reference's run of this scene, in ticks: LEDs seen at 1 to 6, 175 to 187 and from 356 on;
    the tag by the fixed camera from 414 on, at (546.9, 180.0), 9 px further to the left each tick.
    At tick 1 it sees the LEDs at (366.8, 219.6) and (368.3, 149.4). In the reference, speeds of wheels
    and turret take effect from the second substep on, here from the first: u differs by the turn of one
    substep."""

    def setUp(self):
        super().setUp()
        path = self.folder / "readings.jsonl"
        self.outcome = self.run_scene("--ticks", 430, "--readings", path, "--quiet",
                                      scene=SCENES / "footbot_camera_prototype_example.argos")
        readings = [json.loads(line) for line in path.read_text().splitlines()]
        self.seen = {int(reading["tick"]): reading["observation"]["cameras"] for reading in readings}
        self.seen.pop(0, None)

    def ticks(self, camera, kind):
        return [tick for tick, cameras in sorted(self.seen.items()) if cameras[camera].get(kind)]

    def assert_pixel(self, seen, u, v, tolerance):
        self.assertEqual(len(seen), 1)
        self.assertAlmostEqual(seen[0]["center"]["u"], u, delta=tolerance)
        self.assertAlmostEqual(seen[0]["center"]["v"], v, delta=tolerance)

    def test_cameras_see_leds_and_tag_as_in_the_reference(self):
        self.assertEqual(sorted(self.seen), list(range(1, 431)))
        # The LED is 10 px ahead of the directional LED; both move by 53 px per tick, from 593.5 px at
        # tick 367. At tick 368 the directional LED is 4 px inside the image and the LED is outside.
        self.assertEqual(runs(self.ticks("turret_camera", "leds")),
                         [(1, 6), (175, 187), (356, 367)])
        self.assertEqual(runs(self.ticks("turret_camera", "directional_leds")),
                         [(1, 6), (175, 187), (356, 368)])
        self.assertEqual(self.ticks("turret_camera", "tags"), [])
        first = self.seen[1]["turret_camera"]
        pixels = sorted((seen["center"]["v"], seen["center"]["u"])
                        for kind in ("leds", "directional_leds") for seen in first[kind])
        self.assertEqual(len(pixels), 2)
        for (v, u), expected in zip(pixels, ((149.4, 370.3), (219.7, 368.7))):
            self.assertAlmostEqual(v, expected[0], delta=0.2)
            self.assertAlmostEqual(u, expected[1], delta=0.2)

        at_tag = self.ticks("fixed_camera", "tags")
        self.assertEqual(at_tag[0], 414)
        self.assert_pixel(self.seen[414]["fixed_camera"]["tags"], 546.5, 180.0, 0.5)
        for tick in at_tag[1:]:
            before, now = (self.seen[t]["fixed_camera"]["tags"][0]["center"]["u"]
                           for t in (tick - 1, tick))
            self.assertAlmostEqual(now - before, -9, delta=1)

        expected = [f"[{tick} fb] turret_camera detects: directional_leds, leds, "
                    for begin, end in ((1, 6), (175, 187), (356, 367)) for tick in range(begin, end + 1)]
        expected.append("[368 fb] turret_camera detects: directional_leds, ")
        self.assertEqual(self.outcome.lines, expected)


class Proximity(SceneTest):
    def test_has_value_and_angle_of_each_sensor(self):
        face = 0.12  # of the wall [m]
        self.write("proximity.lua", PROXIMITY_SCRIPT)
        scene = self.write("proximity.argos", PROXIMITY_SCENE.format(wall=face + 0.05))
        lines = self.run_scene("--ticks", 1, "--quiet", scene=scene).lines
        self.assertEqual(len(lines), 24)
        near = 0
        for i, line in enumerate(lines):
            value, angle = map(float, line.removeprefix("[1 fb] ").split())
            expected = 7.5 + 15 * i
            expected -= 360 if expected > 180 else 0
            self.assertAlmostEqual(angle, expected, places=6)
            ahead = math.cos(math.radians(expected))
            distance = face / ahead - 0.085036758 if ahead > 0 else math.inf
            near += distance < 0.1
            expected = 0.0100527 / (distance + 0.000163144) if distance < 0.1 else 0
            self.assertAlmostEqual(value, expected, delta=1e-4)
        self.assertEqual(near, 6)  # 7.5, 22.5 and 37.5 degrees to each side


if __name__ == "__main__":
    main()
