# SPDX-License-Identifier: MIT
"""What each step of docs/tutorial promises is true of its scene."""

import csv
import math
import unittest

from documents import ROOT
from running import Folder

RADIUS, BUMPER, CAMERA = 0.03, 0.101, 0.1  # of a wheel; where tag and camera are on the vehicle's axis [m]


def heading(row):
    return 2 * math.atan2(row["qz"], row["qw"])


def difference(angle):
    return math.remainder(angle, 2 * math.pi)


class Tutorial(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Folder("tutorial")
        cls.work = cls.folder.work / "docs/tutorial"

    @classmethod
    def tearDownClass(cls):
        cls.folder.remove()

    def trace(self, step):
        """Rows of each entity and link of a step's run, by tick; and what its controllers logged."""
        output = self.folder.run(f"ziggurat run docs/tutorial/{step}/scene.argos --trace trace.csv 2>/dev/null")
        found = {}
        with open(self.folder.work / "trace.csv", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                name = (row.pop("entity"), row.pop("link"))
                found.setdefault(name, []).append({key: float(value) for key, value in row.items()})
        return found, output

    def test_01_the_box_falls_and_lies(self):
        crate = self.trace("01-box")[0]["crate", ""]
        landed = next(row["time_s"] for row in crate if row["z"] < 0.001)
        self.assertAlmostEqual(landed, math.sqrt(2 * 1 / 9.8), delta=0.02)  # one tick
        self.assertAlmostEqual(crate[-1]["z"], 0, delta=1e-4)

    def test_02_the_crate_turns_the_wheel_on_its_axle(self):
        rows = self.trace("02-wheel")[0]
        wheel = rows["mill", "wheel"]
        self.assertAlmostEqual(math.dist([wheel[0][axis] for axis in "xyz"], [wheel[-1][axis] for axis in "xyz"]), 0, delta=1e-6)
        turned = 2 * math.acos(min(1, abs(sum(wheel[0][q] * wheel[-1][q] for q in ("qw", "qx", "qy", "qz")))))
        self.assertGreater(turned, 1)
        self.assertLess(rows["crate", ""][-1]["z"], 0.2)

    def test_03_the_vehicle_rolls_down_without_slipping(self):
        rows = self.trace("03-four-wheels")[0]
        vehicle, wheel = rows["vehicle", "base"], rows["vehicle", "front_left"]
        way = math.dist([vehicle[0][axis] for axis in "xz"], [vehicle[-1][axis] for axis in "xz"])
        turned = 0
        for before, after in zip(wheel, wheel[1:]):
            turned += 2 * math.acos(min(1, abs(sum(before[q] * after[q] for q in ("qw", "qx", "qy", "qz")))))
        self.assertGreater(way, 1)
        self.assertAlmostEqual(turned * RADIUS, way, delta=0.02 * way)

    def test_04_the_vehicle_drives_a_metre(self):
        rows, output = self.trace("04-lua")
        self.assertAlmostEqual(rows["vehicle", ""][-1]["x"] - rows["vehicle", ""][0]["x"], 1, delta=0.02)
        self.assertIn("[400 vehicle] 1.000 m", output)

    def test_05_python_drives_it_to_the_same_bits(self):
        self.assertEqual(self.trace("05-python"), self.trace("04-lua"))

    def test_06_the_camera_sees_the_tag_where_it_is(self):
        output = self.trace("06-camera")[1]
        degrees = math.degrees(math.atan2(0.2, 1 - 0.011 - CAMERA))
        self.assertIn(f"[200 vehicle] tag 7, {degrees:.1f} degrees to the left", output)

    def test_07_it_follows_the_tag(self):
        rows = self.trace("07-follow")[0]
        for leader, follower in zip(rows["leader", ""][500:], rows["follower", ""][500:]):
            tag = [leader["x"] - BUMPER * math.cos(heading(leader)), leader["y"] - BUMPER * math.sin(heading(leader))]
            eye = [follower["x"] + CAMERA * math.cos(heading(follower)), follower["y"] + CAMERA * math.sin(heading(follower))]
            self.assertTrue(0.2 < math.dist(tag, eye) < 0.6, (follower["tick"], math.dist(tag, eye)))
            aside = difference(math.atan2(tag[1] - eye[1], tag[0] - eye[0]) - heading(follower))
            self.assertLess(abs(aside), math.radians(20), follower["tick"])

    def test_08_the_second_hears_the_first_a_tick_later(self):
        rows, output = self.trace("08-radios")
        self.assertIn("[101 second] heard 1", output)
        self.assertAlmostEqual(rows["first", ""][-1]["x"] - rows["second", ""][-1]["x"], 0.2 / 50, delta=1e-4)

    def test_10_steering_more_keeps_the_tag_in_the_middle(self):
        self.folder.run("ziggurat sweep docs/tutorial/10-sweep/sweep.toml --quiet")
        table = self.folder.run("ziggurat sweep results docs/tutorial/10-sweep/results --by steer --csv")
        means = [float(line["follower/aside"]) for line in csv.DictReader(table.splitlines())]
        self.assertEqual(len(means), 4)
        self.assertEqual(means, sorted(means, reverse=True))


class Pages(unittest.TestCase):
    def test_each_step_has_a_short_page_with_a_picture(self):
        folders = sorted(path for path in (ROOT / "docs/tutorial").iterdir() if path.is_dir() and path.name != "pictures")
        self.assertEqual([path.name[:2] for path in folders], [f"{number:02}" for number in range(1, 11)])
        for path in folders:
            text = (path / "README.md").read_text(encoding="utf-8")
            self.assertLessEqual(text.count("\n"), 60, path.name)
            for picture in [line.split("](")[1].rstrip(")") for line in text.splitlines() if line.startswith("![")]:
                self.assertLessEqual((path / picture).stat().st_size, 150_000, picture)
            self.assertIn("\n![", text, path.name)


if __name__ == "__main__":
    unittest.main()
