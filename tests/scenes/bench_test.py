# SPDX-License-Identifier: MIT
"""bench/run: its table, what it leaves out, and what Ctrl-C leaves."""

import csv
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(os.environ.get("ZIGGURAT_BIN", ROOT / "build/release/bin"))


class BenchTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.command = [sys.executable, ROOT / "bench/run", "--quick", "--bin", BIN, "--out", self.folder]

    def run_bench(self, *arguments):
        return subprocess.run([*self.command, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def rows(self):
        (table,) = self.folder.glob("*-20??-??-??.csv")
        with open(table, encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def test_rows_and_their_spread_are_written_to_a_table(self):
        outcome = self.run_bench("--only", "vehicle", "foot-bot", "--rounds", "2")
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        rows = self.rows()
        self.assertEqual([row["row"] for row in rows], ["vehicle", "foot-bot-cameras"])
        for row in rows:
            self.assertEqual(row["rounds"], "2")
            self.assertGreaterEqual(float(row["median"]), float(row["least"]))
            self.assertLessEqual(float(row["median"]), float(row["most"]))
            self.assertNotEqual(float(row["most"]), 0)
            self.assertEqual((row["yardstick"], row["times"]), ("", ""))
            self.assertTrue(row["cpu"] and row["commit"] and int(row["cores"]) >= 1)
        self.assertIn("round 2 of 2: vehicle: ", outcome.stderr)
        self.assertIn("| `vehicle` | vehicle [ms per tick] |", outcome.stdout)

    def test_all_rows_are_listed(self):
        listed = self.run_bench("--list").stdout.splitlines()
        names = [line.split()[0] for line in listed]
        self.assertEqual(len(set(names)), len(names))
        self.assertIn("pile-400", names)
        self.assertTrue(any(line.endswith(", beside bare ZeroMQ") for line in listed))

    def test_what_is_not_built_is_left_out_with_a_sentence(self):
        self.command[-3] = self.folder  # programs: none
        outcome = self.run_bench("--only", "pile-50")
        self.assertEqual(outcome.returncode, 1)
        self.assertIn("pile-50 is left out: ", outcome.stderr)
        self.assertIn("bench_bodies is not there", outcome.stderr)
        self.assertNotIn("Traceback", outcome.stderr)

    def test_a_word_that_names_no_row_is_refused(self):
        outcome = self.run_bench("--only", "nothing")
        self.assertEqual(outcome.returncode, 1)
        self.assertIn("no row's name begins with 'nothing'", outcome.stderr)

    def test_the_document_has_all_rows(self):
        outcome = self.run_bench("--docs", "--only", "vehicle")
        self.assertEqual(outcome.returncode, 2)
        self.assertIn("leave out --only and --quick", outcome.stderr)

    def test_ctrl_c_keeps_what_was_measured(self):
        bench = subprocess.Popen([*self.command, "--only", "vehicle", "--rounds", "1000"], stdout=subprocess.PIPE,
                                 stderr=subprocess.PIPE, text=True)
        for line in bench.stderr:
            if line.startswith("round 1 of 1000"):
                break
        # The table is there before the next measurement ends.
        for line in bench.stderr:
            if line.startswith("round 2 of 1000"):
                break
        bench.send_signal(signal.SIGINT)
        out, _ = bench.communicate(timeout=60)
        self.assertEqual(bench.returncode, 130)
        self.assertGreaterEqual(int(self.rows()[0]["rounds"]), 1)
        self.assertIn("| `vehicle` |", out)


if __name__ == "__main__":
    unittest.main()
