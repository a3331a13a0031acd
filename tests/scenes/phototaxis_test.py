# SPDX-License-Identifier: MIT
"""A foot-bot's light and ground sensors, distance scanner and coloured-blob camera from end to end: the script
scenes/phototaxis.lua drives to a light, and the recording repeats."""

import json
import math
import pathlib
import shutil

from harness import main
from recorded import Recorded

SCENES = pathlib.Path(__file__).resolve().parents[2] / "scenes"


class Phototaxis(Recorded):
    def setUp(self):
        super().setUp()
        for path in SCENES.glob("phototaxis.*"):
            shutil.copy(path, self.folder)
        self.scene = self.folder / "phototaxis.argos"

    def test_it_reaches_the_light_and_its_readings_have_names(self):
        outcome = self.run_scene("--readings", self.folder / "readings.jsonl")
        arrived = [line for line in outcome.lines if "arrived at tick" in line]
        self.assertEqual(len(arrived), 1, outcome.out)
        self.assertRegex(arrived[0], r"12 long rays, red of the blob: 255$")
        lines = [json.loads(line) for line in (self.folder / "readings.jsonl").read_text().splitlines()]
        devices = lines[-1]["observation"]["devices"]
        lights = devices["footbot_light"]["devices"]
        self.assertEqual(len(lights), 24)
        self.assertTrue(all(0 <= light["values"]["value"] <= 1 for light in lights))
        ground = [sensor["values"]["value"] for sensor in devices["footbot_motor_ground"]["devices"]]
        self.assertAlmostEqual(min(ground), 20 / 255, delta=1e-9)
        blobs = devices["colored_blob_omnidirectional_camera"]["devices"][0]["rows"]
        self.assertEqual([blob["values"]["color"] for blob in blobs], [0xFFFF00])
        self.assertLess(abs(blobs[0]["values"]["angle"]), math.pi / 2)
        commands = lines[-1]["command"]["devices"]
        self.assertEqual(commands["footbot_distance_scanner"]["devices"][0]["values"]["mode"], 2)

    def test_a_recording_repeats_it_without_the_floor_s_file(self):
        recording, _ = self.record("--ticks", "100")
        (self.folder / "phototaxis.ppm").unlink()
        self.assertRegex(self.ask("verify", recording).out, "^identical")


if __name__ == "__main__":
    main()
