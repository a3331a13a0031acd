# SPDX-License-Identifier: MIT
"""Options of a run: the command line wins over the settings file, that over the scene."""

import re

from harness import FAULT, FINISHED, SceneTest, main

class SettingsTest(SceneTest):
    def with_run(self, attributes):
        self.change("<framework>", f"<framework><run {attributes} />")

    def run_with(self, *options, code=FINISHED):
        outcome = self.ziggurat("run", self.scene, "--ticks", 2, *options)
        self.assertEqual(outcome.code, code, outcome.err)
        return outcome

    def limit(self, *options):
        """Of Lua's memory, as the error of a script tells it that takes more than any of those here."""
        self.write("swing.lua", "function init() end function step() data = string.rep('x', 2^28) end")
        outcome = self.ziggurat("run", self.scene, "--ticks", 1, *options)
        self.assertRegex(outcome.err, r"\d+ MiB")
        return int(re.search(r"(\d+) MiB", outcome.err)[1])

    def test_the_nearest_place_counts(self):
        settings = self.write("s.toml", "[lua]\nlua-memory = 40\n")
        self.with_run('lua_memory="30"')
        self.assertEqual(self.limit(), 30)
        self.assertEqual(self.limit("--settings", settings), 40)
        self.assertEqual(self.limit("--settings", settings, "--lua-memory", 50), 50)
        self.assertEqual(self.limit("--set", "framework/run/@lua_memory=60"), 60)

    def test_flags_are_switched_on_and_off(self):
        self.with_run('hil="true"')
        paced = "p50"
        self.assertIn(paced, self.run_with().err)
        self.assertNotIn(paced, self.run_with("--settings", self.write("off.toml", "hil = false\n")).err)
        self.assertNotIn(paced, self.run_with("--set", "framework/run/@hil=false").err)

    def test_lists_and_outputs_come_from_the_file(self):
        settings = self.write("s.toml", 'ticks = 3\nquiet = true\nhash = true\n'
                              'set = ["physics_engines/*/@iterations=5"]\n[outputs]\ntrace = "t.csv"\n')
        outcome = self.ziggurat("run", self.scene, "--settings", settings)
        self.assertRegex(outcome.lines[-1], "^hash 3 ")
        self.assertEqual(outcome.err, "")
        self.assertTrue((self.folder / "t.csv").read_text().startswith("tick,"))
        by_line = self.ziggurat("run", self.scene, "--duration", "0.2", "--settings", settings)
        self.assertRegex(by_line.lines[-1], "^hash 2 ", "the length of the file does not count, too")

    def test_faults_name_file_line_and_what_is_meant(self):
        for text, message in (("quiet = true\nlua-memry = 2\n", r"s.toml:2:1: unknown key .lua-memry.; did you mean 'lua-memory'"),
                              ("[luaa]\n", r"s.toml:1:2: unknown table .luaa.; did you mean 'lua'"),
                              ("lua-memory = 0\n", r"s.toml:1:14: --lua-memory is 0; it must be from 1"),
                              ("hil = 1\n", "s.toml:1:7: hil must be true or false"),
                              ("seed = [1, 2]\n", "s.toml:1:8: seed has one value"),
                              ('settings = "x"\n', "s.toml:1:1: unknown key"),
                              ("seed = 1\n[run]\nseed = 2\n", r"s.toml:\d:1: seed is given twice"),
                              ("seed 1\n", "s.toml:1:")):
            with self.subTest(text):
                self.assert_is_sentence(self.run_with("--settings", self.write("s.toml", text), code=FAULT), message)
        self.assert_is_sentence(self.run_with("--settings", "none.toml", code=FAULT), "none.toml")

    def test_faults_of_the_scene_name_their_lines(self):
        self.with_run('lua_memory="0" gatee="p99&lt;2ms" hil="1" inject="latency=1ms what=ever"')
        outcome = self.run_with(code=FAULT)
        for message in ("--lua-memory is 0", 'did you mean "gate"', "must be true or false", "inject"):
            self.assertRegex(outcome.err, rf"arms.argos:\d+:\d+: .*{message}")
        self.assertEqual(self.ziggurat("check", self.scene).code, FAULT)

    def test_help_shows_common_options_and_all(self):
        for command, most in (("run", 30), ("fork", 30), ("serve", 26), ("replay", 30)):
            short, whole = (self.ziggurat("help", command, *more).out for more in ((), ("--all",)))
            options = [{line.split()[0] for line in text.splitlines() if line.startswith("  --")} for text in (short, whole)]
            self.assertLess(options[0], options[1])
            self.assertLessEqual(len(options[0]), most, command)
            self.assertIn(f"and {len(options[1]) - len(options[0])} more: ziggurat help {command} --all", short)


if __name__ == "__main__":
    main()
