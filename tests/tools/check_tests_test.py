#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""tools/check_tests.py finds files that no test runs, and cases that are switched off."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "tools/check_tests.py"
RIGHT = {
    "tests/unit/text/CMakeLists.txt": "ziggurat_unit_test(text SOURCES names_test.cpp)\n",
    "tests/unit/text/names_test.cpp": "TEST(Names, AreRead) {}\n",
    "tests/scenes/CMakeLists.txt": "foreach(name serve construction/stack)  # not replay\n",
    "tests/scenes/serve_test.py": "def test_listens(self): pass\n",
    "tests/scenes/construction/stack_test.py": "",
    "tests/fuzz/CMakeLists.txt": "ziggurat_fuzzer(scene)\n",
    "tests/fuzz/scene_fuzzer.cpp": "",
    "tests/tools/check_words_test.py": "",
    "tools/check": "tests/tools/check_words_test.py",
}


class CheckTests(unittest.TestCase):
    def run_on(self, changes):
        """Exit code and output of the check of a right tree with these files changed."""
        with tempfile.TemporaryDirectory() as name:
            root = pathlib.Path(name)
            for path, content in {**RIGHT, **changes}.items():
                (root / path).parent.mkdir(parents=True, exist_ok=True)
                (root / path).write_text(content)
            done = subprocess.run([sys.executable, SCRIPT, root], capture_output=True, text=True)
            return done.returncode, done.stdout

    def test_takes_what_is_named(self):
        self.assertEqual(self.run_on({}), (0, "5 files of tests: a test runs each\n"))

    def test_finds_files_that_are_not_named(self):
        for path in ("tests/unit/text/numbers_test.cpp", "tests/unit/names_test.cpp", "tests/scenes/replay_test.py",
                     "tests/web/page_test.mjs", "tests/fuzz/wire_fuzzer.cpp", "tests/tools/check_sizes_test.py"):
            with self.subTest(path):
                code, out = self.run_on({path: ""})
                self.assertEqual(code, 1)
                self.assertIn(f"{path}:1: no test runs this file", out)

    def test_finds_cases_that_are_switched_off(self):
        for path, text in (("tests/unit/text/names_test.cpp", "TEST(Names, DISABLED_AreRead) {}\n"),
                           ("tests/scenes/serve_test.py", "@unittest.skip('later')\ndef test_listens(self): pass\n")):
            with self.subTest(path):
                code, out = self.run_on({path: text})
                self.assertEqual(code, 1)
                self.assertIn(f"{path}:1: this case is switched off", out)


if __name__ == "__main__":
    unittest.main()
