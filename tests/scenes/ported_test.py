# SPDX-License-Identifier: MIT
"""The examples of docs/coming-from-argos.md: a director in two languages, a controller in two."""

import json
import os
import re
import shlex
import shutil
import sys

from harness import BIN, HERE, SceneTest, main

ROOT = HERE.parents[1]
DOCUMENT = ROOT / "docs/coming-from-argos.md"
FOLDER = ROOT / "docs/coming-from-argos"


class Ported(SceneTest):
    def setUp(self):
        super().setUp()
        self.environment["PATH"] = f"{BIN}{os.pathsep}{self.environment['PATH']}"
        for path in FOLDER.iterdir():
            shutil.copy(path, self.folder)
        self.scene = self.folder / "nest.argos"

    def summary(self, *arguments):
        path = self.folder / "summary.json"
        self.run_scene("--summary", path, *arguments)
        return json.loads(path.read_text())

    def test_the_director_in_lua_ends_the_run_at_the_third_visit(self):
        summary = self.summary()
        self.assertEqual(summary["metrics"], {"nest/visits": 3})
        self.assertEqual(summary["failures"], [])
        self.assertLess(summary["ticks"], 3000)

    def test_the_director_in_python_has_the_same_rule(self):
        python = f"director/@command={shlex.quote(sys.executable)} nest.py"
        in_python, in_lua = self.summary("--set", "director/@script=", "--set", python), self.summary()
        self.assertEqual(in_python["metrics"], in_lua["metrics"])
        self.assertEqual(in_python["ticks"], in_lua["ticks"])

    def test_the_controller_in_cpp_reaches_the_states_of_the_script(self):
        in_cpp, in_lua = self.summary("--controller", "wander=example_wander"), self.summary()
        self.assertEqual(in_cpp["hash"], in_lua["hash"])
        self.assertEqual(in_cpp["robots"], 2)

    def test_the_controller_takes_the_place_of_a_library(self):
        text = self.scene.read_text().replace("<lua_controller ", '<wander_controller library="libwander" ')
        self.scene.write_text(text.replace("</lua_controller>", "</wander_controller>"))
        self.assertEqual(self.summary("--controller", "wander=example_wander")["metrics"], {"nest/visits": 3})

    def test_the_document_has_the_examples_as_they_are(self):
        blocks = re.findall(r"```\w+\n(.*?)```", DOCUMENT.read_text(), re.DOTALL)
        for path in (FOLDER / "nest.lua", FOLDER / "nest.py", ROOT / "clients/cpp/examples/wander.cpp"):
            text = path.read_text().removeprefix("// SPDX-License-Identifier: MIT\n")
            self.assertIn(text, blocks, path.name)


if __name__ == "__main__":
    main()
