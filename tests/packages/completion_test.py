# SPDX-License-Identifier: MIT
"""Completion for bash and zsh: commands, options, scenes, and entities of a server that runs."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import time
import unittest

BUILD = pathlib.Path(os.environ["ZIGGURAT_BUILD"])
WORDS = BUILD / "tools/packaging/completion"
BASH = f"""source {WORDS}/ziggurat
COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _ziggurat; printf '%s\\n' "${{COMPREPLY[@]}}" """
ZSH = f"""_describe() {{ print -rl -- ${{(P)2}} }}; _files() {{ print FILES }}
words=("$@"); CURRENT=$#; source {WORDS}/_ziggurat """


class Completion(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.environment = dict(os.environ, PATH=f"{BUILD}/bin:{os.environ['PATH']}", XDG_RUNTIME_DIR=self.folder.name,
                                TMPDIR=self.folder.name)
        self.environment.pop("ZIGGURAT_ENDPOINT", None)

    def complete(self, *words):
        """What bash offers for the last of these words."""
        done = subprocess.run(["bash", "-c", BASH, "bash", *words], env=self.environment, text=True, check=True,
                              stdout=subprocess.PIPE)
        return done.stdout.split()

    def describe(self, *words):
        """What zsh offers, each with its description."""
        done = subprocess.run(["zsh", "-fc", ZSH, "zsh", *words], env=self.environment, text=True, check=True,
                              stdout=subprocess.PIPE)
        return done.stdout.splitlines()

    def test_bash_knows_commands_options_and_scenes(self):
        self.assertEqual(self.complete("ziggurat", "ver"), ["verify"])
        self.assertEqual(self.complete("ziggurat", "run", "--see"), ["--seed"])
        self.assertEqual(self.complete("ziggurat", "sweep", "--kub"), ["--kubernetes"])
        self.assertEqual(self.complete("ziggurat", "run", "veh"), ["vehicle"])
        self.assertEqual(self.complete("ziggurat", "check", "construction/s"),
                         ["construction/staircase", "construction/steps"])
        self.assertEqual(self.complete("ziggurat", "run", "vehicle", "--trace", "x"), [])  # a file: bash's own
        self.assertEqual(self.complete("ziggurat", "ctl", "set"), ["set-joint"])

    def test_entities_are_those_of_the_server(self):
        self.assertEqual(self.complete("ziggurat", "ctl", "move", ""), [])
        server = subprocess.Popen(["ziggurat", "serve", "vehicle", "--paused"], env=self.environment,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            end = time.monotonic() + 30
            while "vehicle" not in self.complete("ziggurat", "ctl", "move", "veh"):
                self.assertLess(time.monotonic(), end)
                time.sleep(0.1)
            if shutil.which("zsh"):
                self.assertIn("vehicle", self.describe("ziggurat", "ctl", "remove", "veh"))
        finally:
            server.terminate()
            server.wait()

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not installed")
    def test_zsh_knows_them_with_descriptions(self):
        self.assertIn("check:report every fault and notice of scene files", self.describe("ziggurat", "ch"))
        self.assertIn("--json:an array on stdout, with name, path and sentence of each",
                      self.describe("ziggurat", "scenes", "--"))
        self.assertIn("vehicle", self.describe("ziggurat", "run", "v"))
        self.assertEqual(self.describe("ziggurat", "run", "vehicle", "--trace", ""), ["FILES"])


if __name__ == "__main__":
    unittest.main()
