# SPDX-License-Identifier: MIT
"""Lua scripts that fail, or do not end."""

import json
import os
import time

from harness import CONTROLLER_FAILED, INTERRUPTED, LUA, SceneTest, main

ENDLESS = ("--duration", "0")

STUCK_IN_LIBRARY = """function init() end
function step()
   if robot.id == "r1" then
      return (("a"):rep(1000000)):find(".-.-b")
   end
end
"""

FAILS_AT_TICK_3 = """
    local n = 0
    function init() end
    function step()
       n = n + 1
       if robot.id == "r1" and n == 3 then error("out of luck") end
       log(n)
    end"""


class Failing(SceneTest):
    def test_lua_error_leaves_the_others_running(self):
        self.write("swing.lua", FAILS_AT_TICK_3)
        outcome = self.run_scene("--ticks", 6, code=CONTROLLER_FAILED)
        self.assertEqual([line for line in outcome.lines if "r1" in line],
                         ["[1 r1] 1", "[2 r1] 2"])
        self.assertIn("[6 r0] 6", outcome.lines)
        self.assertRegex(outcome.err, r"r1.*tick 3.*out of luck")
        self.assertEqual(outcome.err.count("out of luck"), 1, "printed once")
        self.assertIn("1 failed: robot r1 at tick 3", outcome.err)

    def test_a_failure_makes_no_lines_of_the_server(self):
        self.write("swing.lua", "function init() end function step() error('why\\n  seed 1, hash 0') end")
        outcome = self.run_scene("--ticks", 2, code=CONTROLLER_FAILED)
        self.assertRegex(outcome.err, r"(?m)^      seed 1, hash 0")
        self.assertNotRegex(outcome.err, r"(?m)^  seed 1, hash 0")

    def test_a_stuck_robot_is_named_with_file_and_line(self):
        self.write("swing.lua", """function init() end
function step()
   if robot.id == "r1" then
      while true do robot.stuck = 1 end
   end
end
""")
        self.expect_waiting_for_line_4()

    def test_a_stuck_library_function_is_named_with_file_and_line(self):
        self.write("swing.lua", STUCK_IN_LIBRARY)
        self.expect_waiting_for_line_4()

    def test_a_library_function_that_does_not_end_ends_its_script_alone(self):
        self.write("swing.lua", STUCK_IN_LIBRARY + "function destroy() log('bye') end")
        outcome = self.run_scene("--ticks", 2, "--lua-processes", 1, code=CONTROLLER_FAILED)
        self.assertRegex(outcome.err, r"robot r1 .* failed at tick 1: .*swing\.lua:4: string\.find computes for more than 5 s "
                                      r"in one call \(in step 1\)")
        self.assertEqual(["[2 r0] bye", "[2 r2] bye"], sorted(line for line in outcome.lines if "bye" in line))

    def test_the_end_of_a_process_names_the_script_that_ran(self):
        self.write("swing.lua", """function init() end
function step()
   if robot.id == "r1" then
      setmetatable({}, {__gc = function() while true do end end})
      collectgarbage()
   end
end
""")
        summary = self.folder / "s.json"
        outcome = self.run_scene("--lua-processes", 1, "--trust-scripts", "--lua-time", 1, "--summary", summary,
                                 code=CONTROLLER_FAILED)
        sentence = r"ended with exit code 3 at tick 1; it controlled robots r0, r1, r2; it ran the script of r1: .*swing\.lua:4$"
        self.assertRegex(outcome.err, "(?m)" + sentence)
        self.assertRegex(json.loads(summary.read_text())["vanished"], sentence)

    def test_a_stuck_coroutine_is_named_with_file_and_line(self):
        self.write("swing.lua", """function init() end
local function work()
   coroutine.yield()
   while robot.id == "r1" do robot.stuck = 1 end
end
function step()
   local go = coroutine.wrap(work)
   go()
   go()
end
""")
        self.expect_waiting_for_line_4()

    def test_a_blocked_call_is_named_with_robot_and_file(self):
        self.write("swing.lua", """function init() end
function step()
   if robot.id == "r1" then os.execute("sleep 1000") end
end
""")
        process = self.start("run", self.scene, *ENDLESS, "--trust-scripts")
        self.read_until(process.stderr, r"waiting for r1: .*swing\.lua$")
        self.interrupt(process)
        self.assertEqual(self.finish(process).code, INTERRUPTED)

    def expect_waiting_for_line_4(self):
        process = self.start("run", self.scene, *ENDLESS, "--trust-scripts")
        self.read_until(process.stderr, r"waiting for r1: .*swing\.lua:4$")
        self.interrupt(process)
        self.assertEqual(self.finish(process).code, INTERRUPTED)

    def test_an_error_in_destroy_is_a_failure(self):
        self.write("swing.lua", "function init() end function step() log('last') end "
                   "function destroy() if robot.id == 'r1' then error('no end') end end")
        outcome = self.run_scene("--ticks", 2, code=CONTROLLER_FAILED)
        self.assertRegex(outcome.err, r"robot r1 .* failed at tick 2: .*no end")
        self.assertEqual((outcome.out + outcome.err).count("no end"), 1, "printed once")
        self.assertIn("1 failed: robot r1 at tick 2", outcome.err)
        self.assertIn("[2 r2] last", outcome.lines)

    def test_a_destroy_that_does_not_end_is_a_failure(self):
        self.write("swing.lua", "function init() end function step() end\n"
                   "function destroy() if robot.id == 'r1' then\nwhile true do end end log('bye') end")
        outcome = self.run_scene("--ticks", 2, "--lua-processes", 1, code=CONTROLLER_FAILED)
        # On a fast machine it is the limit of instructions.
        self.assertRegex(outcome.err, r"robot r1 .* failed at tick 2: .*swing\.lua:3: (computes for more than 3 s in one call|"
                                      r"runs more than 1000 million instructions)")
        for robot in ("r0", "r2"):
            self.assertIn(f"[2 {robot}] bye", outcome.lines)

    def test_a_process_that_does_not_end_is_a_failure_and_names_what_is_lost(self):
        self.write("swing.lua", "function init() end function step() end\n"
                   "function destroy() if robot.id ~= 'r2' then\nwhile true do end end end")
        outcome = self.run_scene("--ticks", 2, "--lua-processes", 1, "--trust-scripts", code=CONTROLLER_FAILED)
        self.assertRegex(outcome.err, r"robot r1 .* failed at tick 2: .*swing\.lua:3: the script still ran 5 s after the end of "
                                      r"the run, and was ended; destroy\(\) of robot r2 did not run; the last log lines and "
                                      r"metrics of robots r0, r1, r2 may be lost")

    def test_long_last_words_after_a_long_destroy_arrive(self):
        self.write("swing.lua", """function init() end function step() end
function destroy()
   if robot.id == "r1" then
      os.execute("sleep 2.3")
      for i = 1, 240 do log(("e"):rep(1000)) end
   end
   metric("result", 42)
end""")
        outcome = self.run_scene("--ticks", 2, "--lua-processes", 1, "--trust-scripts", "--summary", self.folder / "s.json")
        self.assertEqual(240, sum(line.startswith("[2 r1] eee") for line in outcome.lines))
        summary = json.loads((self.folder / "s.json").read_text())
        self.assertEqual({f"r{i}/result": 42 for i in range(3)}, summary["metrics"])

    def test_a_command_that_does_not_end_is_told(self):
        outcome = self.run_scene("--ticks", 2, "--controller", f"swing='{LUA}'; sleep 1000.125")
        self.assertRegex(outcome.err, r"notice: .*\(process \d+\) still ran 1 s after the end of the run, and was ended; "
                                      r"it controlled robots r0, r1, r2")

    def test_fail_fast_ends_at_the_first_error(self):
        self.write("swing.lua", FAILS_AT_TICK_3)
        outcome = self.run_scene("--fail-fast", *ENDLESS, code=CONTROLLER_FAILED)
        self.assertRegex(outcome.err, r"the run ends at tick \d+, as --fail-fast asks")

    def test_a_script_has_256_mebibytes(self):
        self.write("swing.lua", """local function take(mebibytes)
   local all = {}
   for i = 1, mebibytes do all[i] = ("x"):rep(1 << 20) .. i end
end
function init() if robot.id == "r0" then take(200) end end
function step() if robot.id == "r0" then take(300) end end""")
        outcome = self.run_scene("--ticks", 2, code=CONTROLLER_FAILED)
        self.assertRegex(outcome.err, r"r0.*not enough memory.*\(it may have 256 MiB\) \(in step 1")

    def test_a_script_that_computes_for_too_long_ends_alone(self):
        self.write("swing.lua", """function init() end
local text, pattern = ("a"):rep(15), ("a?"):rep(15) .. ("a"):rep(15) .. "b"
function step()
   while robot.id == "r1" do pcall(string.find, text, pattern) end
   log("here")
end
""")
        outcome = self.run_scene("--ticks", 2, "--lua-time", 1, "--lua-processes", 1, code=CONTROLLER_FAILED)
        self.assertRegex(outcome.err, r"r1.*swing\.lua:4: computes for more than 1 s in one call")
        self.assertIn("[2 r2] here", outcome.lines)

    def test_lua_error_at_the_start(self):
        self.write("swing.lua", "function init() error('no start') end function step() end")
        outcome = self.run_scene("--ticks", 2, code=CONTROLLER_FAILED)
        self.assertRegex(outcome.err, r"no start")

    def test_the_run_continues_when_all_have_failed(self):
        self.write("swing.lua", "function init() end function step() error('none left') end")
        outcome = self.run_scene("--ticks", 5, "--hash", code=CONTROLLER_FAILED)
        self.assertRegex(outcome.lines[-1], r"^hash 5 ")


if __name__ == "__main__":
    main()
