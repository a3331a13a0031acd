# SPDX-License-Identifier: MIT
"""Kilobots from end to end: scenes/kilobots.lua finds hops from a seed, and one robot orbits it."""

import csv
import math
import pathlib
import re
import shutil
from collections import deque

from harness import main
from recorded import Recorded

SCENES = pathlib.Path(__file__).resolve().parents[2] / "scenes"
RANGE = 0.1  # of messages [m]


def hops_from(seed, places):
    """The number of messages that it takes to each place, none longer than RANGE."""
    hops, waiting = {seed: 0}, deque([seed])
    while waiting:
        here = waiting.popleft()
        for other, place in places.items():
            if other not in hops and math.dist(places[here], place) < RANGE:
                hops[other] = hops[here] + 1
                waiting.append(other)
    return hops


class Kilobots(Recorded):
    def setUp(self):
        super().setUp()
        for path in SCENES.glob("kilobots.*"):
            shutil.copy(path, self.folder)
        self.scene = self.folder / "kilobots.argos"

    def test_a_gradient_forms_and_a_robot_orbits_the_seed(self):
        trace = self.folder / "trace.csv"
        outcome = self.run_scene("--trace", trace)
        said = {robot: int(hops) for robot, hops in re.findall(r"(kb\d+) is (\d+) hops away", outcome.out)}
        with trace.open() as file:
            origins = [row for row in csv.DictReader(file) if row["link"] == ""]
        places = {row["entity"]: (float(row["x"]), float(row["y"])) for row in origins if row["tick"] == "0"}
        path = [(float(row["x"]), float(row["y"])) for row in origins if row["entity"] == "orbiter"]
        del places["orbiter"]  # it tells nothing
        expected = hops_from("seed", places)
        del expected["seed"]
        self.assertEqual(len(expected), 20)
        self.assertEqual(said, expected)
        for place in path:
            self.assertLess(abs(math.hypot(*place) - 0.05), 0.015)
        bearings = [math.atan2(y, x) for x, y in path]
        turned = sum(math.remainder(b - a, 2 * math.pi) for a, b in zip(bearings, bearings[1:]))
        self.assertGreater(turned, 2 * 2 * math.pi, "it goes around twice")

    def test_a_recording_repeats_it(self):
        recording, _ = self.record("--ticks", "100")
        self.assertRegex(self.ask("verify", recording).out, "^identical")


if __name__ == "__main__":
    main()
