#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""tools/check_members.py finds members that have no initial value, and nothing else."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "tools/check_members.py"


class CheckMembers(unittest.TestCase):
    def run_on(self, text, path="server/a/b.h"):
        """Exit code and output of the check on one header."""
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, path)
            file.parent.mkdir(parents=True)
            file.write_text(text)
            done = subprocess.run([sys.executable, SCRIPT, folder], capture_output=True, text=True)
            return done.returncode, done.stdout

    def test_finds_a_member_without_value(self):
        for member in ["Vector3 offset;", "math::Vector3 low, high;", "math::Quaternion turn;  ///< unit",
                       "Eigen::Matrix3d rotation;"]:
            with self.subTest(member):
                code, out = self.run_on(f"struct A {{\n  {member}\n}};\n")
                self.assertEqual(code, 1, out)
                self.assertTrue(out.startswith("server/a/b.h:2: "), out)

    def test_finds_a_number_of_a_scene(self):
        for member in ["double range;  ///< [m]", "unsigned least, most;", "std::size_t medium;", "bool image;"]:
            with self.subTest(member):
                self.assertEqual(self.run_on(f"struct A {{\n  {member}\n}};\n", "server/scene/b.h")[0], 1)
                self.assertEqual(self.run_on(f"struct A {{\n  {member}\n}};\n")[0], 0)

    def test_leaves_others_alone(self):
        text = ("struct A {\n  Vector3 offset = Vector3::Zero();\n  math::Pose pose;\n};\n"
                "inline Matrix3 f() {\n  Matrix3 m;\n  m << 1, 2, 3;\n  return m;\n}\n"
                "Vector3 g(const Vector3& a);\n")
        self.assertEqual(self.run_on(text)[0], 0)


if __name__ == "__main__":
    unittest.main()
