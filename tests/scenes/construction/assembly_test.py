# SPDX-License-Identifier: MIT
"""The robots' controller in C++ (clients/cpp/examples/assembly): by the same rule table it does what the Lua scripts do."""

import pathlib
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

import perturb

PROGRAM = perturb.BIN / "example_assembly"
CPP = f"--controller=robot={PROGRAM}"


def with_robot_in_cpp(change, robot):
    """The change, with another controller for one robot: in_cpp."""
    def both(tree, number):
        controller = ElementTree.parse(perturb.ROOT / "scenes/models/robot.argos").find("controllers/lua_controller")
        controller.set("id", "in_cpp")
        tree.find("controllers").append(controller)
        tree.find(f"arena/prototype[@id='{robot}']/controller").set("config", "in_cpp")
        return change(tree, number)
    both.rules, both.scene = change.rules, change.scene
    return both


class Building(unittest.TestCase):
    def assert_built(self, number, change, *options, kills=0):
        verdict, changes, log = perturb.run(number, options, change, kills=kills)
        self.assertEqual(verdict.faults, [], f"{changes}\n" + "\n".join(log))
        self.assertEqual(changes.count("killed"), kills, changes)

    def test_two_robots_in_cpp(self):
        self.assert_built(4, perturb.perturb_steps("rules_cross"), CPP)

    @unittest.skipUnless(perturb.TAKES_ALL, "./quickstart test-all runs it")
    def test_one_robot_in_cpp_and_one_in_lua_by_another_table(self):
        self.assert_built(0, with_robot_in_cpp(perturb.perturb_steps("rules_stairs"), "robot1"),
                          f"--controller=in_cpp={PROGRAM}")

    @unittest.skipUnless(perturb.TAKES_ALL, "./quickstart test-all runs it")
    def test_robots_in_cpp_that_are_killed_and_started_again(self):
        self.assert_built(4, perturb.perturb_steps("rules_cross"), CPP, kills=1)


class SameRuns(unittest.TestCase):
    def test_both_controllers_do_the_same(self):
        in_lua = perturb.last_hash(perturb.STEPS, 150)
        self.assertRegex(in_lua, "^hash 1500 [0-9a-f]{16}$")
        self.assertEqual(in_lua, perturb.last_hash(perturb.STEPS, 150, CPP))


class WrongTables(unittest.TestCase):
    """The file is read before the program connects."""

    def message_for(self, text):
        with tempfile.TemporaryDirectory(prefix="zc", dir="/tmp") as folder:
            table = pathlib.Path(folder) / "rules_wrong.lua"
            table.write_text(text)
            result = subprocess.run([PROGRAM, table], capture_output=True, text=True)
            self.assertEqual(result.returncode, 1)
            self.assertRegex(result.stderr, f"^assembly: {table}: ")
            return result.stderr.partition("rules_wrong.lua: ")[2].strip()

    def test_each_mistake_is_named(self):
        good = 'state = "core", height = 1, shows = {255, 0, 0}, place = "above", becomes = "upper"'
        for row, message in (
                (good.replace('"above"', '"under"'), 'row 2: \'place\' is "under"; write "above" or "before"'),
                (good.replace('255', '256'), "row 2: 'shows' is not from 0 to 255"),
                (good.replace('{255, 0, 0}', '"red"'), "row 2: 'shows' is missing; write {red, green, blue}, from 0 to 255"),
                (good.replace('height', 'hight'), "row 2: 'height' is not from 0 to 255"),
                (good.replace('"core"', 'nil'), "row 2: 'state' is not a string"),
                (good.replace('"upper"', 'nil'), "row 2: 'becomes' is not a string"),
                (good + ', sides = {"top"}', 'row 2: \'sides\' has something else than "front", "left", "back", "right"'),
                (good + ", sides = {}", 'row 2: \'sides\' is not a list, as {"front", "back"}')):
            with self.subTest(row=row):
                self.assertEqual(self.message_for(f'return {{seed = "core", {{{good}}}, {{{row}}}}}'), message)

    def test_a_table_without_a_seed(self):
        self.assertEqual(self.message_for("return {}"), "'seed' is not a string")

    def test_no_table(self):
        self.assertEqual(self.message_for("return 3"), "it returns no table")

    def test_a_table_that_never_ends(self):
        self.assertIn("not done after 1000000 instructions", self.message_for("while true do end"))

    def test_a_table_that_asks_for_libraries(self):
        self.assertIn("a nil value (global 'require')", self.message_for('return require "io"'))


if __name__ == "__main__":
    unittest.main(verbosity=2)
