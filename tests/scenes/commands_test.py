# SPDX-License-Identifier: MIT
"""Programs of a scene's controllers: where they are looked for, what they find, how they end, who starts them again."""

import json
import os
import re
import sys

from harness import CONTROLLER_FAILED, FINISHED, SceneTest, main

TWO = ("swing", "other")
DRIVE = """
import os, sys, time, ziggurat
with ziggurat.connect() as session:
    for tick in session:
        if tick.number == 3 and len(sys.argv) > 1:
            {end}
"""


class Commands(SceneTest):
    """r0 and r1 have the controller `swing`, r2 has `other`."""

    def setUp(self):
        super().setUp()
        self.environment["PYTHONPATH"] = ""
        begin, end = self.text.index("<lua_controller"), self.text.index("</lua_controller>") + len("</lua_controller>")
        controller = self.text[begin:end].replace("lua_controller", "external_controller")
        controller = re.sub(r'<params script="swing.lua" speed="2" />', "<params/>", controller)
        self.other = controller.replace('id="swing"', 'id="other" command="COMMAND2"')
        self.change(self.text[begin:end], controller.replace('id="swing"', 'id="swing" command="COMMAND1"') + self.other)
        self.change("""<controller config="swing">
        <params script="swing.lua" speed="-3" />
      </controller>""", '<controller config="other" />')

    def commands(self, first, second):
        quote = lambda text: text.replace("&", "&amp;").replace('"', "&quot;")
        self.change("COMMAND1", quote(first))
        self.change("COMMAND2", quote(second))

    def drive(self, end, name="drive.py"):
        return self.write(name, DRIVE.replace("{end}", end))

    def test_connect_without_arguments_takes_the_robots_of_its_controller(self):
        self.write("drive.py", """
import ziggurat
with ziggurat.connect() as session:
    print("drives", *[robot.id for robot in session.robots], flush=True)
    for tick in session:
        pass
""")
        self.commands(f"{sys.executable} drive.py", f"{sys.executable} drive.py")
        outcome = self.run_scene("--ticks", 5)
        self.assertEqual(sorted(line for line in outcome.lines if line.startswith("drives")), ["drives r0 r1", "drives r2"])

    def test_files_are_found_beside_the_scene_and_python_finds_its_package(self):
        self.drive("pass")
        self.drive("pass", "my drive.py")
        (self.folder / "elsewhere").mkdir()
        self.commands(f"nice env A=1 {sys.executable} 'my drive.py'", f'{sys.executable} "$ZIGGURAT_SCENE_FOLDER/drive.py"')
        process = self.start("run", self.scene, "--ticks", "5", cwd=self.folder / "elsewhere")
        outcome = self.finish(process)
        self.assertEqual(outcome.code, FINISHED, outcome.err)
        checked = self.finish(self.start("check", self.scene, cwd=self.folder / "elsewhere"))
        self.assertEqual(checked.code, FINISHED, checked.err)
        self.assertNotIn("is not there", checked.out + checked.err)

    def test_check_tells_what_is_not_there(self):
        self.drive("pass")
        self.commands(f"nice {sys.executable} 'no drive.py'", "$ZIGGURAT_SCENE_FOLDER/nothing --fast")
        checked = self.ziggurat("check", self.scene)
        self.assertRegex(checked.out + checked.err, r"'no drive.py' is not there")
        self.assertRegex(checked.out + checked.err, rf"'{self.folder}/nothing' is not there")

    def test_serve_says_how_these_programs_connect(self):
        self.drive("pass")
        self.commands(f"{sys.executable} drive.py", "true")
        process = self.start("serve", self.scene)
        endpoint = self.read_until(process.stdout, "^endpoint (.*)$")[1]
        first = self.read_until(process.stderr, "connect with: (.*)$")[1]
        self.assertEqual(first, f"ZIGGURAT_ENDPOINT={endpoint} ZIGGURAT_CONTROLLER=swing {sys.executable} {self.folder}/drive.py")
        self.read_until(process.stderr, "connect with: .*ZIGGURAT_CONTROLLER=other true$")
        self.interrupt(process)
        self.assertNotIn("ziggurat-lua", self.finish(process).err)

    def ended(self, end, left, without_block=False):
        path = self.drive(end)
        if without_block:
            path.write_text(DRIVE.replace("{end}", end).replace("with ziggurat.connect() as session:",
                                                                "session = ziggurat.connect()\nif True:"))
        self.commands(f"{sys.executable} drive.py leaves", f"{sys.executable} drive.py")
        summary = self.folder / "s.json"
        outcome = self.run_scene("--ticks", 8, "--summary", summary)
        found = json.loads(summary.read_text())
        self.assertEqual(found["ticks"], 8)
        self.assertEqual([each["robot"] for each in found["left"]], left)
        self.assertNotRegex(outcome.err, "fail|SystemExit")

    def test_sys_exit_0_is_no_failure(self):
        self.ended("sys.exit(0)", ["r0", "r1"])

    def test_leaving_the_loop_without_a_block_is_none(self):
        self.ended("break", ["r0", "r1"], without_block=True)

    def test_nor_an_end_without_a_word(self):
        self.ended("os._exit(0)", ["r0", "r1"])

    def test_sys_exit_1_is_one(self):
        self.drive("sys.exit(1)")
        self.commands(f"{sys.executable} drive.py leaves", f"{sys.executable} drive.py")
        outcome = self.run_scene("--ticks", 8, code=CONTROLLER_FAILED)
        self.assertIn("SystemExit: 1", outcome.err)

    def test_one_that_keeps_dying_does_not_keep_others_from_being_restarted(self):
        """`swing` dies as soon as it has connected, again and again; `other` is killed once, by itself."""
        self.write("dies.py", "import os, ziggurat\nnext(ziggurat.connect())\nos._exit(9)\n")
        self.write("once.py", """
import os, pathlib, ziggurat
begun = pathlib.Path(__file__).with_name("begun")
session = ziggurat.connect()
if not begun.exists():
    begun.touch()
    next(session)
    os._exit(9)
pathlib.Path(__file__).with_name("again").touch()
for tick in session:
    pass
""")
        self.commands(f"{sys.executable} dies.py", f"{sys.executable} once.py")
        process = self.start("run", self.scene, "--duration", "0", "--restart", "swing=1000", "--restart", "other=1")
        self.wait_for((self.folder / "begun").exists, bool, "first start")
        self.wait_for((self.folder / "again").exists, bool, "second start")
        self.interrupt(process)
        outcome = self.finish(process)
        before, restarted, _ = outcome.err.partition("the command of controller 'other'")
        self.assertTrue(restarted, outcome.err)
        self.assertLessEqual(before.count("started again"), 2, outcome.err)


if __name__ == "__main__":
    main()
