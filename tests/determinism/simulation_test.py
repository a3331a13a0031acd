# SPDX-License-Identifier: MIT
"""The simulation alone: the same scene, seed and commands give the same hash at every tick: in a second run, after other
scenes in the same process, with any number of threads (Simulation), and by the same sources compiled differently, by another compiler or at another
optimisation level (OtherProgram)."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "bench"))
import scenes as made_scenes
PROBE = os.environ["ZIGGURAT_PROBE"]
SCENES = [TOP / "tests/scenes/arms.argos", *sorted(each for each in (TOP / "scenes").glob("*.argos") if not each.is_symlink())]
TICKS = 40


def hashes(probe, *scenes, threads=1):
    """A list of hash lines per scene."""
    done = subprocess.run([probe, "--threads", str(threads), str(TICKS), *map(str, scenes)], capture_output=True, text=True)
    if done.returncode != 0:
        raise AssertionError(done.stderr)
    return [part.splitlines()[1:] for part in done.stdout.split("scene ")[1:]]


class Same(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """Each scene in a process of its own."""
        cls.alone = [hashes(PROBE, scene)[0] for scene in SCENES]

    def assert_same(self, all_runs, expected):
        self.assertEqual(len(all_runs), len(expected))
        for first, second in zip(all_runs, expected):
            self.assertEqual(len(second), TICKS + 1)
            for a, b in zip(first, second):  # reports the first tick that differs
                self.assertEqual(a, b)
            self.assertEqual(len(first), len(second))


class Simulation(Same):
    def test_the_state_changes_at_every_tick(self):
        for scene, lines in zip(SCENES, self.alone):
            self.assertEqual(len({line.split()[2] for line in lines}), TICKS + 1, scene)

    def test_after_other_scenes(self):
        """Each after those before it, and once more after all that follow it."""
        self.assert_same(hashes(PROBE, *SCENES, *reversed(SCENES)), self.alone + self.alone[::-1])

    def test_with_any_number_of_threads(self):
        """Robots that drive and sense: enough of them that threads share each loop."""
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder) / "swarm.argos"
            made_scenes.swarm(100).write(scene)
            scene.with_name("wander.lua").write_text(made_scenes.WANDER)
            alone = hashes(PROBE, scene)
            for threads in (2, 3, 8):
                self.assert_same(hashes(PROBE, scene, threads=threads), alone)


class OtherProgram(Same):
    def test_it_gives_the_same_hashes(self):
        self.assert_same(hashes(os.environ["ZIGGURAT_PROBE_OTHER"], *SCENES), self.alone)


if __name__ == "__main__":
    unittest.main(verbosity=2)
