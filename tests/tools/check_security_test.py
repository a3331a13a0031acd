#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""tools/check_security.py finds rows without tests and tests that do not exist."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "tools/check_security.py"


class CheckSecurity(unittest.TestCase):
    def run_on(self, text):
        """Exit code and output of the check of a document with this text behind its heading."""
        with tempfile.TemporaryDirectory() as name:
            root = pathlib.Path(name)
            for path, content in {
                    "docs/security.md": "# Security\n\nIntroduction.\n\n## Keys\n\n" + text,
                    "tests/unit/network/keys_test.cpp": "TEST_F(Keys,\n       AreRead) {}\n",
                    "tests/scenes/serve_test.py": "class Serve:\n    def test_listens(self): pass\n",
                    "tests/view/viewer_test.mjs": "  async only_looks(server) {\n"}.items():
                (root / path).parent.mkdir(parents=True, exist_ok=True)
                (root / path).write_text(content)
            done = subprocess.run([sys.executable, SCRIPT, root], capture_output=True, text=True)
            return done.returncode, done.stdout

    def test_takes_names_of_all_kinds(self):
        code, out = self.run_on("| a | Tests |\n|---|---|\n| x | `network:Keys.AreRead`, `network:Keys` |\n"
                                "| y | `serve:listens`, `serve:Serve.test_listens`, `viewer:only_looks` |\n\n"
                                "| other | table |\n|---|---|\n| z | nothing |\n\n- _An advice._\n")
        self.assertEqual((code, out), (0, "docs/security.md names 5 tests, and all exist\n"))

    def test_finds_rows_without_tests(self):
        for row in ("| x | |", "| `network:Keys` | none |"):
            with self.subTest(row):
                self.assertEqual(self.run_on(f"| a | Tests |\n|---|---|\n{row}\n")[0], 1)

    def test_finds_names_without_tests(self):
        for name in ("network:Keys.AreWritten", "network:Key", "serve:answers", "viewer:looks", "nowhere:Keys"):
            with self.subTest(name):
                code, out = self.run_on(f"- One (`{name}`).\n")
                self.assertEqual(code, 1, out)
                self.assertIn(":7: there ", out)


if __name__ == "__main__":
    unittest.main()
