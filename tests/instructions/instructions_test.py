# SPDX-License-Identifier: MIT
"""Instructions of a steady tick, counted by callgrind, against committed figures: slower is a fault, faster is written down.

    instructions_test.py           compares; 3 % either way is a fault
    instructions_test.py --update  writes instructions.txt anew, for a change that is meant

A count is the difference of a long and a short run of determinism_probe, without network, so start-up is not in it.
Counts don't depend on the machine's load, but on compiler, libraries and instruction set: figures are those of the
release build on Debian 12 with AVX2.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor

PROBE = os.environ["ZIGGURAT_PROBE"]
HERE = pathlib.Path(__file__).resolve().parent
SCENES = HERE.parents[1] / "scenes"
FIGURES = HERE / "instructions.txt"
TOLERANCE = 0.03

# Scene, ticks of the short and of the long run.
ROWS = {
    "dynamics3d_single_body_test": (1, 11),
    "dynamics3d_multi_body_test": (5, 45),
    "dynamics3d_magnetism_test": (1, 11),
    "prototype_srocs_system": (5, 25),
    "prototype_radio_test": (10, 410),
    "footbot_camera_prototype_example": (10, 110),
}


def count(scene, ticks):
    """Instructions of a run."""
    with tempfile.NamedTemporaryFile() as profile:
        ended = subprocess.run(
            ["valgrind", "--tool=callgrind", f"--callgrind-out-file={profile.name}", PROBE, str(ticks),
             SCENES / f"{scene}.argos"], capture_output=True, text=True, check=True)
    return int(re.search(r"Collected : (\d+)", ended.stderr)[1])


def measure(row):
    """Scene and instructions per tick."""
    scene, (short, long) = row
    return scene, round((count(scene, long) - count(scene, short)) / (long - short))


def measure_all():
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return dict(pool.map(measure, ROWS.items()))


def read_figures():
    return {scene: int(figure) for scene, figure in (line.split() for line in FIGURES.read_text().splitlines())}


class Instructions(unittest.TestCase):
    def test_each_scene_takes_what_is_written_down(self):
        if "avx2" not in pathlib.Path("/proc/cpuinfo").read_text():
            self.skipTest("the figures are those of a processor with AVX2")
        figures, faults = read_figures(), []
        for scene, now in measure_all().items():
            ratio = now / figures[scene]
            if abs(ratio - 1) > TOLERANCE:
                faults.append(f"{scene}: {now} instructions per tick, {ratio:.3f} of the {figures[scene]} in {FIGURES.name}")
        self.assertEqual(faults, [], "if the change is meant, run this test with --update and commit the file")


if __name__ == "__main__":
    if sys.argv[1:] == ["--update"]:
        FIGURES.write_text("".join(f"{scene} {figure}\n" for scene, figure in measure_all().items()))
    else:
        unittest.main()
