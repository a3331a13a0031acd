# SPDX-License-Identifier: MIT
"""Scenes in the style of courses' labs and of libraries for ARGoS, unchanged: flocking by range and bearing, robots that
flash together, stones as hulls, and a lab all of whose rules are in C++."""

import math
import pathlib
import re
import shutil

from harness import FAULT, FINISHED, SceneTest, main

SCENES = pathlib.Path(__file__).resolve().parent / "foreign"


class Foreign(SceneTest):
    def take(self, name):
        for path in SCENES.glob(f"{name}.*"):
            shutil.copy(path, self.folder)
        self.scene = self.folder / f"{name}.argos"

    def places(self, *arguments):
        """Of each body in the trace, by tick: (x, y, z)."""
        trace = self.folder / "trace.csv"
        outcome = self.run_scene("--trace", trace, *arguments)
        found = {}
        header, *lines = trace.read_text().splitlines()
        names = header.split(",")
        for line in lines:
            row = dict(zip(names, line.split(",")))
            if row["link"]:
                continue
            found.setdefault(row["entity"], []).append(tuple(float(row[axis]) for axis in "xyz"))
        return outcome, found

    def test_robots_flock_at_the_distance_that_they_keep(self):
        self.take("flocking")
        outcome, _ = self.places("--ticks", "300")
        nearest = [int(cm) for cm in re.findall(r"nearest (\d+) cm", outcome.out)]
        self.assertEqual(len(nearest), 8 * 300)
        self.assertLess(sum(nearest[:8]) / 8, 55, "they begin close to each other")
        self.assertAlmostEqual(sum(nearest[-80:]) / 80, 72, delta=8)

    def test_robots_that_see_each_other_flash_together(self):
        self.take("synchronisation")
        outcome = self.run_scene()
        flashes = [int(tick) for tick in re.findall(r"^\[(\d+) f\d\] flash", outcome.out, re.M)]
        last = [tick for tick in flashes if tick > 500]
        self.assertGreater(len(last), 6)
        self.assertLess(len(set(last)), len(last) / 2, f"several flash at a tick: {last}")

    def test_stones_lie_on_a_slab_that_stays(self):
        self.take("heap")
        outcome, places = self.places()
        self.assertRegex(outcome.err, r'heap\.argos:15:\d+: a mass of 5e\+12 kg is one that nothing moves, and is read '
                                      r'as movable="false"')
        self.assertEqual(places["slab"][-1], (0, 0, 0.5))
        self.assertEqual(sorted(round(place[-1][2], 2) for name, place in places.items() if name != "slab"),
                         [0.6] * 4 + [0.66] * 4)

    def test_a_scene_of_libraries_is_told_what_to_write_and_its_robots_stand_still_if_lenient(self):
        self.take("landmarks")
        outcome = self.ziggurat("check", self.scene)
        self.assertEqual(outcome.code, FAULT)
        for sentence in (r":10:\d+: <footbot_landmarks_controller> is a library in C\+\+.*--controller fl=COMMAND",
                         r":18:\d+: unknown element <landmark_memory> in <sensors>",
                         r":26:\d+: <loop_functions> has no script.*<director",
                         r":38:\d+: <thymio> is not supported; write <e-puck>, or model it as a <prototype>"):
            self.assertRegex(outcome.err, sentence)
        outcome, places = self.places("--lenient", "--ticks", "60")
        self.assertEqual(len(places["fb1"]), 61)
        for name in ("fb1", "fb5", "tree"):
            self.assertLess(math.dist(places[name][0], places[name][-1]), 1e-9, name)
        script = self.write("drive.lua", "function init() end function step() robot.wheels.set_velocity(5, 5) end")
        text = self.scene.read_text().replace("<params alpha", f'<params script="{script.name}" alpha')
        self.scene.write_text(text.replace("footbot_landmarks_controller", "lua_controller"))
        _, places = self.places("--lenient", "--ticks", "60", "--seed", "1")  # robots stand where the seed says
        self.assertGreater(math.dist(places["fb1"][0], places["fb1"][-1]), 0.2)

    def test_engines_that_are_not_there_are_told_and_stood_in_for_if_lenient(self):
        self.take("engines")
        outcome = self.ziggurat("check", self.scene)
        self.assertEqual(outcome.code, FAULT)
        self.assertRegex(outcome.err, r":33:5: <physx> is not supported; use <dynamics3d> \(--lenient reads it as one\)")
        outcome, places = self.places("--lenient")
        self.assertEqual(outcome.code, FINISHED, outcome.err)
        self.assertRegex(outcome.err, r":33:5: <physx> is read as <dynamics3d>")
        self.assertRegex(outcome.err, r":37:5: this <dynamics3d> is left out: there is one world")
        self.assertAlmostEqual(places["p1"][-1][2], 0, delta=1e-3, msg="it stands on the engine's floor")

    def test_media_that_nothing_names_stand_in_if_lenient(self):
        self.take("older")
        self.assertEqual(self.ziggurat("check", self.scene).code, FAULT)
        outcome = self.run_scene("--lenient", "--ticks", "5")
        self.assertEqual(outcome.code, FINISHED, outcome.err)
        self.assertRegex(outcome.err, r":12:9: <leds> names no medium of type led that is there")
        self.assertRegex(outcome.err, r":15:9: quadrotor_speed is enabled for entity \"a\", which .*; it goes without")
        self.assertIn("[5 a] heard 7 red 1 yellow 0 light 1", outcome.lines)


if __name__ == "__main__":
    main()
