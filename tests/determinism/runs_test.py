# SPDX-License-Identifier: MIT
"""Whole runs: the same scene, seed and controllers give the same hash at every tick, with any distribution
of robots over processes and over any transport."""

import json
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "scenes"))

from harness import FINISHED, LUA, SceneTest, main  # noqa: E402


class Runs(SceneTest):
    def setUp(self):
        super().setUp()
        self.expected = self.hashes()
        self.assertEqual(len(set(self.expected)), 21)

    def hashes(self, *arguments):
        path = self.folder / "hashes"
        self.run_scene("--quiet", "--hash-file", path, *arguments)
        return path.read_text().splitlines()

    def test_twice(self):
        self.assertEqual(self.hashes(), self.expected)

    def test_any_number_of_processes(self):
        for processes in (2, 0):
            self.assertEqual(self.hashes("--lua-processes", processes), self.expected)

    def test_tcp_instead_of_ipc(self):
        for parts in (["r0\nr1\nr2\n"], ["r2\n", "r0\nr1\n"]):
            path = self.folder / "tcp"
            process = self.start("serve", self.scene, "--quiet", "--json", "--hash-file", path,
                                 "--endpoint", "tcp://127.0.0.1:*")
            endpoint = json.loads(process.stdout.readline())["endpoint"]
            for i, robots in enumerate(parts):
                self.started.append(subprocess.Popen(
                    [str(LUA), "--connect", endpoint, "--quiet", "--script-folder",
                     str(self.folder), "--robots-file", str(self.write(f"part{i}", robots))]))
            self.assertEqual(self.finish(process).code, FINISHED)
            self.assertEqual(path.read_text().splitlines(), self.expected)

    def test_pace_and_recording_change_nothing(self):
        self.assertEqual(self.hashes("--real-time", "10", "--trace", self.folder / "t.csv",
                                     "--readings", self.folder / "r.jsonl"), self.expected)

    def test_another_seed_gives_other_hashes(self):
        self.assertNotEqual(self.hashes("--seed", 4), self.expected)


if __name__ == "__main__":
    main()
