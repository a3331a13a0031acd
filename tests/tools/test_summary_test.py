#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""tools/test_summary.py names each case that failed, and the command that runs it alone."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "tools/test_summary.py"


class Summary(unittest.TestCase):
    def of(self, *tests, properties=""):
        """What is said of tests that print a text and end with a code, as /bin/sh -c '…' NAME."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            lines = []
            for number, (text, code, *command) in enumerate(tests):
                (folder / f"{number}.txt").write_text(text)
                words = ["/bin/sh", "-c", f"cat {folder}/{number}.txt; exit {code}", *command]
                lines.append(f"add_test(unit/{number} {' '.join(f'[[{word}]]' for word in words)})\n")
            (folder / "CTestTestfile.cmake").write_text("".join(lines) + properties)
            subprocess.run(["ctest", "--test-dir", folder, "--output-junit", folder / "tests.xml"], capture_output=True)
            done = subprocess.run([sys.executable, SCRIPT, folder], capture_output=True, text=True, check=True)
            return done.stdout

    def test_counts(self):
        self.assertIn("2 of 2 tests passed, 0 failed, 0 not run; 8 cases in 0 min",
                      self.of(("[==========] 5 tests from 2 test suites ran. (1 ms total)\n", 0), ("Ran 3 tests in 1 s\n", 0)))

    def test_names_cases_of_google_test(self):
        said = self.of(("[ RUN      ] A.B\n[  FAILED  ] A.B (1 ms)\n\n 1 FAILED TEST\n", 1),
                       properties='set_tests_properties(unit/0 PROPERTIES ENVIRONMENT "GTEST_SHARD_INDEX=0;FORM=json")\n')
        self.assertRegex(said, r"failed: unit/0\n    A\.B\n        env FORM=json /bin/sh .*--gtest_filter=A\.B\n")

    def test_names_the_case_that_crashed(self):
        self.assertIn("--gtest_filter=A.C\n", self.of(("[ RUN      ] A.B\n[       OK ] A.B (1 ms)\n[ RUN      ] A.C\n", 139)))

    def test_names_cases_of_unittest(self):
        self.assertRegex(self.of(("FAIL: test_b (__main__.A.test_b)\n", 1)), r"    A\.test_b\n        \(cd .* -k A\.test_b\)\n")

    def test_names_cases_of_the_kit_before_the_program(self):
        said = self.of(("..\nfail           T2.two-frames/json: two frames\n", 1, "kit", "--", "program"))
        self.assertIn("kit --only T2.two-frames/json -- program\n", said)

    def test_names_the_test_where_no_case_is_named(self):
        self.assertRegex(self.of(("broken\n", 1)), r"no case is named\n        ctest --test-dir \S+ .*-R '\^unit/0\$'\n")


if __name__ == "__main__":
    unittest.main()
