# SPDX-License-Identifier: MIT
"""What tells how a recorded run and another differ: other builds, changed files, other recordings, other controllers."""

import json
import pathlib
import re
import struct

from harness import CONTROLLER_FAILED, FAULT, FINISHED, main
from recorded import DAMAGED, DIFFERS, ROOT, Recorded, change_inputs


class Verify(Recorded):
    def test_inputs_that_were_changed_are_caught(self):
        recording, _ = self.record("--ticks", "10", "--record-compression", "none")

        def packed(*targets):  # repeated doubles, field 1
            return bytes([0x0A, 8 * len(targets)]) + struct.pack(f"<{len(targets)}d", *targets)

        change_inputs(recording, packed(2, 2, -3), packed(2, 2.25, -3))
        outcome = self.ask("verify", recording, code=DIFFERS)
        self.assertRegex(outcome.out, r"^differs: tick 1: 'r1', link '\w+': [\w.]+ is \S+ in the "
                                      r"recording, \S+ now \(hash \w{16} in the recording, \w{16} now\)"
                                      r"; 1 state before it as recorded")
        self.assertIn("the same build recorded it", outcome.out)
        verdict = json.loads(self.ask("verify", recording, "--json", code=DIFFERS).out)
        self.assertEqual((verdict["verdict"], verdict["tick"]), ("differs", 1))
        outcome = self.ask("replay", recording, "--hash-file", "hashes", code=DIFFERS)
        self.assertRegex(outcome.err, "differs: tick 1: 'r1'")

    def test_a_damaged_place_is_told(self):
        recording, _ = self.record("--ticks", "10", "--record-compression", "none")
        data = bytearray(recording.read_bytes())
        place = data.find(struct.pack("<3d", 2, 2, -3))
        data[place + 3] ^= 0x10
        recording.write_bytes(data)
        outcome = self.ask("verify", recording, code=DAMAGED)
        self.assertRegex(outcome.out, r"^damaged: .*: damaged at byte \d+: ")

    def test_a_recording_without_states_is_not_identical(self):
        """Its chunks and its summary are damaged, as by a disk."""
        recording, _ = self.record("--ticks", "10")
        data = bytearray(recording.read_bytes())
        for place in range(len(data) // 3, len(data), 50):
            data[place] ^= 0x10
        recording.write_bytes(data)
        outcome = self.ask("verify", recording, code=DAMAGED)
        self.assertRegex(outcome.out, r"^damaged: .*; 0 states before it as recorded")


    def test_a_recording_of_a_run_without_ticks_is_empty(self):
        recording = self.folder / "run.mcap"
        self.run_scene("--controller", "swing=exit 4", "--record", recording, code=CONTROLLER_FAILED)
        outcome = self.ask("verify", recording, code=DAMAGED)
        self.assertRegex(outcome.out, r"^empty: it holds no tick: the run ended before its first")
        outcome = self.ziggurat("fork", recording, "--at", 1, "--controller", "swing=true")
        self.assert_is_sentence(outcome, "the recording holds no tick")
        outcome = self.ziggurat("check", recording)
        self.assert_is_sentence(outcome, "this is a recording, not a scene; 'ziggurat replay' repeats it")


class OtherBuild(Recorded):
    """A recording that another build made: clang 14 with -O1. Where physics changes on purpose, make it anew:
    `ziggurat run arms.argos --ticks 40 --seed 3 --record arms.mcap --record-topics /state` in tests/scenes."""

    RECORDING = ROOT / "tests/recording/data/arms.mcap"

    def test_it_verifies(self):
        build = json.loads(self.ask("info", self.RECORDING, "--json").out)["run"]["build"]
        recording, _ = self.record("--ticks", "1")
        own = json.loads(self.ask("info", recording, "--json").out)["run"]["build"]
        if build["libm"] != own["libm"]:
            self.skipTest(f"made with the C library {build['libm']}, here is {own['libm']}: sin() and others may differ")
        self.assertRegex(self.ask("verify", self.RECORDING).out, r"^identical: 41 states as recorded")


class Compare(Recorded):
    def test_diff_names_the_first_difference_and_draws_it(self):
        a, _ = self.record("--ticks", "20", "--seed", "3", name="a.mcap")
        b, _ = self.record("--ticks", "20", "--seed", "3", name="b.mcap")
        self.assertIn("identical: 21 states", self.ask("diff", a, b).out)
        self.change('speed="2"', 'speed="2.5"')
        c, _ = self.record("--ticks", "20", "--seed", "3", name="c.mcap")
        outcome = self.ask("diff", a, c, "--plot", "apart.svg", code=DIFFERS)
        self.assertRegex(outcome.out, r"first difference   tick 1: '.*: .* is .* in A, .* in B")
        self.assertRegex(outcome.out, r"first other input  tick 0: commands.joint_targets.values\[0\] is 2 in A, 2.5 in B")
        self.assertIn("<svg", (self.folder / "apart.svg").read_text())
        result = json.loads(self.ask("diff", a, c, "--json", code=DIFFERS).out)
        self.assertEqual(len(result["distances"]), 21)
        self.assertFalse(result["identical"])

    def test_recordings_without_states_are_not_identical(self):
        a, _ = self.record("--ticks", "5", name="a.mcap")
        b = self.folder / "b.mcap"
        self.run_scene("--controller", "swing=exit 4", "--record", b, code=CONTROLLER_FAILED)
        for pair, told in (((b, b), "b.mcap has 0, .*b.mcap has 0"), ((a, b), "a.mcap has 6, .*b.mcap has 0")):
            outcome = self.ask("diff", *pair, code=FAULT)
            self.assert_is_sentence(outcome, "there are no states to compare: .*" + told)
            self.assertEqual(outcome.out, "")

    def test_diff_compares_commands_that_hold(self):
        """A recording has those that changed, and all of them where it begins or an epoch does."""
        whole, _ = self.record("--ticks", "20", name="whole.mcap")
        self.ask("fork", whole, "--at", "8", "--ticks", "15", "--record", "part.mcap", "--quiet")
        result = json.loads(self.ask("diff", whole, "part.mcap", "--json", code=DIFFERS).out)
        self.assertEqual((result["compared"], result["only_a"], result["only_b"]), (8, 13, 0))
        self.assertNotIn("first_inputs", result)

    def test_diff_takes_no_end_for_a_difference(self):
        """Metrics that are set at the end, and acts after it."""
        script = self.folder / "swing.lua"
        script.write_text(script.read_text().replace("function destroy()", "function destroy()\n  metric('all', steps)"))
        a, _ = self.record("--ticks", "20", name="a.mcap")
        b, _ = self.record("--ticks", "10", name="b.mcap")
        self.assert_same_inputs(a, b, 11, 10)
        script.write_text(script.read_text().replace("'all', steps", "'all', 0"))
        c, _ = self.record("--ticks", "10", name="c.mcap")
        self.assertIn("tick 10: metrics[0].value is 10 in A, 0 in B", self.ask("diff", b, c).out)

        box = self.write("box.xml", '<box id="new" size="0.1,0.1,0.1" movable="true" mass="1"><body position="-1,-1,2"/></box>')
        for name, acts in {"d": (), "e": (("spawn", box), ("step", 5))}.items():
            process = self.start("serve", ROOT / "scenes/dynamics3d_single_body_test.argos", "--json", "--record", f"{name}.mcap")
            endpoint = json.loads(process.stdout.readline())["endpoint"]
            for words in (("step", 5), *acts, ("shutdown",)):
                self.assertEqual(self.ziggurat("ctl", endpoint, *words).code, FINISHED)
            self.finish(process)
        self.assert_same_inputs("d.mcap", "e.mcap", 6, 5)

    def assert_same_inputs(self, a, b, both, one):
        for pair in ((a, b), (b, a)):
            result = json.loads(self.ask("diff", *pair, "--json", code=DIFFERS).out)
            self.assertEqual((result["compared"], result["only_a"] + result["only_b"]), (both, one))
            self.assertNotIn("first_inputs", result)


class Controllers(Recorded):
    def test_the_same_controllers_command_the_same(self):
        recording, _ = self.record("--ticks", "20")
        (self.folder / "swing.lua").unlink()  # the embedded one is started
        outcome = self.ask("verify", recording, "--controllers", "--quiet")
        self.assertRegex(outcome.out, r"^identical: the commands of 20 ticks are as recorded\n$")
        self.assertEqual(outcome.err, "")

    def test_restarts_and_missed_deadlines_of_the_recorded_run_are_told_as_causes(self):
        script = self.folder / "swing.lua"
        script.write_text(script.read_text().replace("function step()", """function step()
  if robot.id == "r1" and steps == 8 and robot.first_tick == 0 then os.execute("kill -9 $PPID") end
  if robot.id == "r2" and steps == 8 then os.execute("sleep 0.5") end"""))
        recording, _ = self.record("--ticks", "30", "--lua-processes", "0", "--restart", "1", "--trust-scripts",
                                   "--deadline", "hold:100")
        script.write_text((pathlib.Path(__file__).parent / "swing.lua").read_text())
        for robot, cause in (("r1", r"a controller was restarted then.*robot r1;.*started again \(restart 1\)"),
                             ("r2", r"a deadline was missed then.*\(r2\) missed its deadline of 100 ms")):
            outcome = self.ask("try", recording, "--robot", robot, "--script", "swing.lua", "--quiet", code=DIFFERS)
            self.assertRegex(outcome.lines[0], rf"^differs: tick \d+: '{robot}': .* is .* in the recording, .* now$")
            self.assertRegex(outcome.out, "\n  likely cause: " + cause)
            self.assertEqual((len(outcome.lines), outcome.err), (3, ""))

    def test_another_script_is_told_from_the_recorded_one(self):
        recording, _ = self.record("--ticks", "20")
        robot = re.search(r'<prototype id="([^"]+)"', self.text)[1]
        self.ask("try", recording, "--robot", robot, "--script", "swing.lua", "--quiet")
        other = self.write("other.lua", "function init() end\nfunction step() end\n"
                                        "function reset() end\nfunction destroy() end\n")
        outcome = self.ask("try", recording, "--robot", robot, "--script", other, "--quiet",
                           code=DIFFERS)
        self.assertRegex(outcome.out, rf"^differs: tick \d+: '{robot}': .* is .* in the recording, .* now\n$")

    def test_embedded_scripts_are_sandboxed(self):
        """The recorded run trusted them; `verify --controllers`, `try` and `fork` do not."""
        left, key = self.folder / "left", self.folder / "key"
        key.write_text("secret")
        self.write("swing.lua", f"""function step() end
function init()
   os.execute('touch {left}')
   log(io.open('{key}'):read('a'))
end""")
        recording, _ = self.record("--ticks", "3", "--trust-scripts")
        self.assertTrue(left.exists(), "the scripts really do it")
        left.unlink()
        robot = re.search(r'<prototype id="([^"]+)"', self.text)[1]
        for words in (("verify", recording, "--controllers"), ("fork", recording, "--at", "0", "--ticks", "3"),
                      ("try", recording, "--robot", robot, "--script", "swing.lua")):
            with self.subTest(words[0]):
                outcome = self.ziggurat(*words)
                self.assertNotEqual(outcome.code, FINISHED)
                self.assertRegex(outcome.err, r"swing\.lua:3: .*execute")
                self.assertNotIn("secret", outcome.out + outcome.err)
                self.assertFalse(left.exists())

    def test_recorded_commands_are_never_started_by_themselves(self):
        recording, marker = self.record_a_command()
        outcome = self.ask("verify", recording, "--controllers", code=FAULT)
        self.assert_is_sentence(outcome, "--trust-recorded-commands")
        self.assertFalse(marker.exists())


if __name__ == "__main__":
    main()
