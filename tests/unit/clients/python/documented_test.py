"""Blocks of docs/python-client.md run as they stand, beside the server that the document names. Its program is in ZIGGURAT."""

import os
import pathlib
import re
import subprocess
import sys
import unittest

import ziggurat

from fake_server import HANG

ROOT = pathlib.Path(__file__).resolve().parents[4]
PROGRAM = pathlib.Path(os.environ["ZIGGURAT"])
BLOCKS = re.findall(r"^```python\n(.*?)^```$", (ROOT / "docs" / "python-client.md").read_text(), re.DOTALL | re.MULTILINE)
SCENE = ROOT / "clients" / "python" / "examples" / "avoid.argos"
# Drives the robot once the block has its session.
DRIVER = """
import time, ziggurat
with ziggurat.supervise(observer=True) as world:
    while len(world.status().sessions) < 2:
        time.sleep(0.01)
for _ in ziggurat.connect():
    pass
"""
STARTS_ITS_OWN = re.compile("parallel_env|vector_env")
NEEDS_A_DRIVER = re.compile(r"\.supervise\(|\.direct\(")


class Documented(unittest.TestCase):
    def test_each_block_runs(self):
        self.assertGreater(len(BLOCKS), 6)
        for block in BLOCKS:
            with self.subTest(block):
                self.run_block(block)

    def run_block(self, block):
        path = f"{PROGRAM.parent}:{os.environ['PATH']}"
        if STARTS_ITS_OWN.search(block):
            return self.run_program(block, {"PATH": path})
        with ziggurat.Server(SCENE, command=str(PROGRAM), arguments=("--ticks", "500", "--allow-director")) as server:
            environment = {"PATH": path, "ZIGGURAT_ENDPOINT": server.endpoint}
            driver = None
            if NEEDS_A_DRIVER.search(block):
                driver = subprocess.Popen([sys.executable, "-c", DRIVER], env={**os.environ, **environment},
                                          stderr=subprocess.DEVNULL)  # the run may end before it
            try:
                self.run_program(block, environment)
            finally:
                if driver is not None:
                    driver.kill()
                    driver.wait()

    def run_program(self, block, environment):
        done = subprocess.run([sys.executable, "-c", block], env={**os.environ, **environment}, cwd=ROOT, timeout=HANG,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        self.assertEqual(0, done.returncode, done.stdout)


if __name__ == "__main__":
    unittest.main()
