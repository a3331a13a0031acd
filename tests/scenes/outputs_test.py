# SPDX-License-Identifier: MIT
"""Outputs of all commands: their names tell what they are, and none replaces a file that ziggurat reads."""

import os
import shutil
import unittest

from harness import FAULT, FINISHED, main
from recorded import DIFFERS, Recorded, ROOT

MAGNETS = ROOT / "scenes/dynamics3d_magnetism_test.argos"


class Outputs(Recorded):
    def setUp(self):
        super().setUp()
        self.record("--ticks", 3)
        self.record("--ticks", 3, "--seed", 7, "--set", "physics_engines/*/@iterations=7", name="other.mcap")
        shutil.copy(MAGNETS, self.folder / "magnets.argos")

    def refuses(self, pattern, *arguments):
        """And changes nothing."""
        before = self.contents()
        outcome = self.ask(*arguments, code=FAULT)
        self.assert_is_sentence(outcome, pattern)
        self.assertEqual(self.contents(), before, arguments)

    def contents(self):
        return {path: path.read_bytes() for path in self.folder.rglob("*") if path.is_file()}

    def links_to(self, name, ending):
        soft, hard = self.folder / f"soft{ending}", self.folder / f"hard{ending}"
        for link in (soft, hard):
            link.unlink(missing_ok=True)
        soft.symlink_to(name)
        os.link(self.folder / name, hard)
        return soft, hard

    def test_a_wrong_ending_is_refused_with_the_right_one(self):
        for command, option, ending, names in (
                (("export", "run.mcap"), "--csv", ".csv", ("a.txt", "x.mcap", "x")),
                (("export", "run.mcap"), "--jsonl", ".jsonl", ("x.csv", "x")),
                (("export", "run.mcap"), "--html", ".html", ("x.csv", "x")),
                (("diff", "run.mcap", "other.mcap"), "--plot", ".svg", ("x.png", "x.txt", "x")),
                (("magnetism", "plot", "magnets.argos"), "--out", ".svg", ("x.png", "x.txt", "x")),
                (("info", "run.mcap"), "--repair", ".mcap", ("x.txt", "x")),
                (("run", "arms.argos", "--ticks", 1), "--trace", ".csv", ("x.txt", "x"))):
            for name in names:
                with self.subTest(f"{command[0]} {option} {name}"):
                    self.refuses(rf"{option} is '{name}'; its name must end with \{ending}", *command, option, name)

    def test_scenes_and_scripts_are_not_replaced(self):
        for command, option in ((("export", "run.mcap"), "--csv"), (("export", "run.mcap"), "--jsonl"),
                                (("export", "run.mcap"), "--html"), (("info", "run.mcap"), "--repair"),
                                (("diff", "run.mcap", "other.mcap"), "--plot"),
                                (("magnetism", "plot", "magnets.argos"), "--out"),
                                (("run", "magnets.argos", "--ticks", 1), "--hash-file")):
            for name in ("arms.argos", "swing.lua"):
                with self.subTest(f"{command[0]} {option} {name}"):
                    self.refuses(f"{option} is '{name}'", *command, option, name)
        self.refuses("a scene, which it would replace", "export", "run.mcap", "--csv", self.links_to("arms.argos", ".csv")[0])
        self.refuses("a Lua script, which it would replace", "export", "run.mcap", "--jsonl",
                     self.links_to("swing.lua", ".jsonl")[0])

    def test_an_input_is_not_replaced(self):
        for name in ("run.mcap", "other.mcap"):
            self.refuses(r"--plot is '\w+\.mcap'", "diff", "run.mcap", "other.mcap", "--plot", name)
            for link in self.links_to(name, ".svg"):
                self.refuses("a recording that is compared", "diff", "run.mcap", "other.mcap", "--plot", link)
        for link in self.links_to("magnets.argos", ".svg"):
            self.refuses("a file of the scene", "magnetism", "plot", "magnets.argos", "--out", link)
        for link in self.links_to("run.mcap", ".csv"):
            self.refuses("the recording itself", "export", "run.mcap", "--csv", link)

    def test_pictures_are_checked_with_their_numbers(self):
        for name, out in (("p_001.png", "p.png"), ("q0001.png", "q%04d.png")):
            os.link(self.scene, self.folder / name)
            self.refuses(f"--out is '{name}', the file of the scene too", "render", self.scene, "--at", "0,0.2", "--out", out)

    def test_files_of_a_sweep_are_not_replaced(self):
        self.ask("sweep", self.scene, "--out", "s", "--seeds", "1..2", "--axis", "physics_engines/*/@iterations=5|10",
                 "--ticks", 1, "--quiet")
        plot = ("sweep", "plot", "s", "--y", "ticks", "--file")
        self.refuses(r"its name must end with \.svg", *plot, "s/sweep.sqlite")
        for name in ("s/sweep.sqlite", "s/experiment.json", "s/results.csv"):
            self.ask("sweep", "results", "s")
            for link in self.links_to(name, ".svg"):
                self.refuses("a file that the sweep is kept in", *plot, link)
        for name in ("arms.argos", "swing.lua"):
            for link in self.links_to(name, ".svg"):
                self.refuses("a file of the sweep's scene", *plot, link)
        self.refuses(r"--kubernetes is 'arms\.argos'; its name must end with \.yaml or \.yml", "sweep", self.scene, "--seeds",
                     "1..2", "--out", "t", "--kubernetes", "arms.argos", "--image", "i", "--claim", "c", "--mount",
                     self.folder)

    def test_a_dash_is_stdout(self):
        for words, begin, code in ((("export", "run.mcap", "--csv", "-"), "tick,", FINISHED),
                                   (("export", "run.mcap", "--jsonl", "-"), "{", FINISHED),
                                   (("diff", "run.mcap", "other.mcap", "--plot", "-"), "<svg", DIFFERS),
                                   (("magnetism", "plot", "magnets.argos", "--out", "-"), "<svg", FINISHED)):
            with self.subTest(words):
                outcome = self.ask(*words, code=code)
                self.assertTrue(outcome.out.startswith(begin), outcome.out[:80])
                self.assertTrue(outcome.out.rstrip().endswith("</svg>") or begin != "<svg", outcome.out[-80:])
                self.assertFalse((self.folder / "-").exists())
        self.refuses("stdout is for the object of --json", "diff", "run.mcap", "other.mcap", "--json", "--plot", "-")
        self.refuses("a recording needs a file", "info", "run.mcap", "--repair", "-")

    def test_a_dash_is_stdout_for_sweeps_too(self):
        grid = ("--seeds", "1..2", "--axis", "physics_engines/*/@iterations=5|10", "--ticks", 1, "--quiet")
        self.ask("sweep", self.scene, "--out", "s", *grid)
        outcome = self.ask("sweep", "plot", "s", "--y", "ticks", "--file", "-")
        self.assertEqual(outcome.out, (self.folder / "s/ticks.svg").read_text())
        outcome = self.ask("sweep", self.scene, "--out", "t", *grid, "--kubernetes", "-", "--image", "i", "--claim", "c",
                           "--mount", self.folder)
        self.assertIn("kind: Job", outcome.out.replace('"', ""))
        self.assertEqual(list(self.folder.rglob("-")), [])

    def test_older_outputs_are_replaced(self):
        for _ in range(2):
            self.ask("export", "run.mcap", "--csv", "a.csv", "--jsonl", "a.jsonl")
            self.ask("diff", "run.mcap", "other.mcap", "--plot", "a.svg", code=DIFFERS)
            self.ask("magnetism", "plot", "magnets.argos", "--out", "a.svg")
            self.ask("info", "run.mcap", "--repair", "a.mcap")


if __name__ == "__main__":
    main()
