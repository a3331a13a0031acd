"""The simulation alone: the same scene, seed and commands give the same hash at every tick: in a second
run, after another scene in the same process (Simulation), and by the same sources compiled differently, by another
compiler or at another optimisation level (OtherProgram)."""

import os
import pathlib
import subprocess
import unittest

TOP = pathlib.Path(__file__).resolve().parents[2]
PROBE = os.environ["ZIGGURAT_PROBE"]
SCENES = [TOP / "tests/scenes/arms.argos", *sorted((TOP / "scenes").glob("*.argos"))]
TICKS = 40


def hashes(probe, *scenes):
    """A list of hash lines per scene."""
    done = subprocess.run([probe, str(TICKS), *map(str, scenes)], capture_output=True, text=True,
                          timeout=300)
    if done.returncode != 0:
        raise AssertionError(done.stderr)
    return [part.splitlines()[1:] for part in done.stdout.split("scene ")[1:]]


class Same(unittest.TestCase):
    def assert_same(self, first, second):
        self.assertEqual(len(first), TICKS + 1)
        for a, b in zip(first, second):  # reports the first tick that differs
            self.assertEqual(a, b)
        self.assertEqual(len(first), len(second))


class Simulation(Same):
    def test_the_state_changes_at_every_tick(self):
        for scene, lines in zip(SCENES, hashes(PROBE, *SCENES)):
            self.assertEqual(len({line.split()[2] for line in lines}), TICKS + 1, scene)

    def test_twice(self):
        for first, second in zip(hashes(PROBE, *SCENES), hashes(PROBE, *SCENES)):
            self.assert_same(first, second)

    def test_after_another_scene(self):
        for scene in SCENES:
            others = [other for other in SCENES if other != scene]
            runs = hashes(PROBE, scene, *others, scene)
            self.assert_same(runs[0], runs[-1])
            self.assert_same(runs[0], hashes(PROBE, scene)[0])


class OtherProgram(Same):
    def test_it_gives_the_same_hashes(self):
        other = os.environ["ZIGGURAT_PROBE_OTHER"]
        for first, second in zip(hashes(PROBE, *SCENES), hashes(other, *SCENES)):
            self.assert_same(first, second)


if __name__ == "__main__":
    unittest.main(verbosity=2)
