# SPDX-License-Identifier: MIT
"""An eye-bot from end to end: scenes/eye_bot.lua takes off and follows a foot-bot by its camera."""

import csv
import math
import pathlib
import shutil

from harness import main
from recorded import Recorded

SCENES = pathlib.Path(__file__).resolve().parents[2] / "scenes"
TAKEN_OFF = 150  # ticks, with some to catch up


class EyeBot(Recorded):
    def setUp(self):
        super().setUp()
        for path in SCENES.glob("eye_bot.*"):
            shutil.copy(path, self.folder)
        self.scene = self.folder / "eye_bot.argos"

    def test_it_follows_a_foot_bot(self):
        trace = self.folder / "trace.csv"
        self.run_scene("--trace", trace)
        with trace.open() as file:
            origins = [row for row in csv.DictReader(file) if row["link"] == ""]
        paths = {name: [[float(row[axis]) for axis in "xyz"] for row in origins if row["entity"] == name]
                 for name in ("eye", "foot")}
        driven = sum(math.dist(a, b) for a, b in zip(paths["foot"], paths["foot"][1:]))
        self.assertGreater(driven, 3)
        # At the velocity of the offset that it sees it stays behind by the foot-bot's 6 cm/s times 1 s, and by half of
        # the radius of the ring of LEDs at most: the body hides those on the far side.
        for eye, foot in list(zip(paths["eye"], paths["foot"]))[TAKEN_OFF:]:
            self.assertLess(math.dist(eye[:2], foot[:2]), 0.1)
            self.assertLess(abs(eye[2] - 1.5), 0.11)

    def test_a_recording_repeats_it(self):
        recording, _ = self.record("--ticks", "100")
        self.assertRegex(self.ask("verify", recording).out, "^identical")


if __name__ == "__main__":
    main()
