# SPDX-License-Identifier: MIT
"""Course labs with a foot-bot's gripper, the floor that a director paints, and flashes that cameras see."""

import json
import pathlib
import re
import shutil

from harness import main
from recorded import Recorded

FOLDER = pathlib.Path(__file__).resolve().parent / "foraging"


class Foraging(Recorded):
    def setUp(self):
        super().setUp()
        for path in FOLDER.iterdir():
            shutil.copy(path, self.folder)
        self.scene = self.folder / "foraging.argos"

    def ticks(self, outcome, event):
        return [int(tick) for tick in re.findall(rf"{event}(?: at tick)? (\d+)", outcome.out)]

    def test_an_item_is_gripped_brought_home_and_released(self):
        summary = self.folder / "summary.json"
        outcome = self.run_scene("--summary", summary)
        (grey,), (gripped,), (home,), (released,) = (
            self.ticks(outcome, event) for event in ("grey", "gripped", "home", "released"))
        # 8 cm/s: a ground sensor 6.3 cm ahead meets the edge at 0.35 m, the body the item at 0.655 m.
        self.assertAlmostEqual(grey, (0.35 - 0.063) / 0.008, delta=2)
        self.assertAlmostEqual(gripped, (0.8 - 0.06 - 0.085) / 0.008, delta=3)
        self.assertLess(gripped, home)
        self.assertEqual(released, home + 1)
        self.assertEqual(json.loads(summary.read_text())["metrics"]["nest/items"], 1)

    def test_two_robots_flash_together_once_they_have_seen_each_other(self):
        flashes = {}
        for line in self.run_scene().lines:
            if found := re.search(r"(fly_\d).*flash (\d+)", line):
                flashes.setdefault(found[1], []).append(int(found[2]))
        self.assertEqual(sorted(flashes), ["fly_1", "fly_2"])
        self.assertNotEqual(flashes["fly_1"][0], flashes["fly_2"][0])
        self.assertEqual(flashes["fly_1"][-10:], flashes["fly_2"][-10:])

    def test_a_recording_repeats_grips_and_colours(self):
        recording, _ = self.record("--ticks", "250")
        self.assertRegex(self.ask("verify", recording).out, "^identical")


if __name__ == "__main__":
    main()
