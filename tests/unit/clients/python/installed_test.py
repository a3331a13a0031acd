# SPDX-License-Identifier: MIT
"""The package as pip builds it: complete, with its messages, without access to the checkout."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[4]


class Installed(unittest.TestCase):
    def test_a_build_of_the_package_works(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, "setup.py", "--quiet", "egg_info", "--egg-base", folder,
                            "build", "--build-base", folder, "--build-lib", f"{folder}/lib"],
                           cwd=ROOT / "clients" / "python", check=True)
            self.assertTrue((pathlib.Path(folder) / "lib" / "ziggurat" / "py.typed").is_file())
            output = subprocess.run(
                [sys.executable, "-c", "import ziggurat; print(ziggurat.__file__)"], cwd=folder,
                env={**os.environ, "PYTHONPATH": f"{folder}/lib"}, check=True, text=True,
                stdout=subprocess.PIPE).stdout
            self.assertTrue(output.startswith(folder), output)


if __name__ == "__main__":
    unittest.main()
