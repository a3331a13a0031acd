# SPDX-License-Identifier: MIT
"""Directors: their programs, policies and examples, and those from outside (section 9.1 of protocol.md)."""

import json
import os
import sys

from directing import Directing
from harness import BIN, CONTROLLER_FAILED, FAULT, HERE, main

import ziggurat
from ziggurat import protocol_pb2 as v1

EXAMPLES = HERE.parents[1] / "clients/python/examples"
EXPERIMENTS = HERE.parents[1] / "scenes/experiments"


class Programs(Directing):
    def program(self, text):
        self.write("director.py", f"import sys\nsys.path.insert(0, {os.environ['ZIGGURAT_PYTHON_PACKAGE']!r})\n"
                                  f"import ziggurat, os, signal\n{text}")
        return f'command="{sys.executable} director.py"'

    def test_a_program_of_the_scene_directs(self):
        command = self.program("with ziggurat.direct() as world:\n"
                               "    for tick in world:\n"
                               "        if tick.number == 3: world.finish(world.params['word'] + ' ' + world.id)\n")
        self.write_scene(f'<director id="judge" {command}><params word="done" /></director>')
        outcome = self.run_scene("--summary", "summary.json")
        self.assertEqual(json.loads((self.folder / "summary.json").read_text())["result"], "done judge")
        self.assertRegex(outcome.out + outcome.err, "director 'judge' ended the run: done judge")

    def test_a_program_that_dies_ends_the_run(self):
        command = self.program("world = ziggurat.direct()\nnext(world)\nos.kill(os.getpid(), signal.SIGKILL)\n")
        self.write_scene(f'<director id="judge" {command} />')
        outcome = self.run_scene(code=CONTROLLER_FAILED)
        self.assert_is_sentence(outcome, r"director 'judge' \(process \d+\) (ended with exit code 137|was killed by signal 9)")

    def test_a_program_that_dies_or_hangs_is_dropped_by_its_policy(self):
        for end in ("os.kill(os.getpid(), signal.SIGKILL)", "signal.pause()"):
            command = self.program(f"world = ziggurat.direct()\nnext(world)\n{end}\n")
            self.write_scene(f'<director id="judge" {command} deadline="drop" deadline_ms="200" />', length=1)
            outcome = self.run_scene("--allow-drops", "--hash")
            self.assertRegex(outcome.err, "director 'judge' is dropped at tick 0")
            self.write_scene(director="", length=1)
            self.assertEqual(outcome.lines[-1], self.run_scene("--hash").lines[-1])

    def test_a_policy_that_stops_ends_the_run(self):
        command = self.program("world = ziggurat.direct()\nnext(world)\nsignal.pause()\n")
        self.write_scene(f'<director id="judge" {command} deadline="stop" deadline_ms="200" />')
        self.assert_is_sentence(self.run_scene(code=CONTROLLER_FAILED), "director 'judge' did not answer at tick 0")

    def test_a_failure_of_a_director_is_one_of_the_run(self):
        command = self.program("with ziggurat.direct() as world:\n    next(world)\n    raise ValueError('no food')\n")
        self.write_scene(f'<director id="judge" {command} />', length=1)
        self.assert_is_sentence(self.run_scene(code=CONTROLLER_FAILED),
                                "director 'judge' failed at tick 0: ValueError: no food")

    def test_options_name_directors(self):
        command = self.program("world = ziggurat.direct()\nnext(world)\nsignal.pause()\n")
        self.write_scene(f'<director id="judge" {command} />', length=1)
        for arguments in (("--deadline", "judge=hold:50"), ("--hil",)):
            self.assertRegex(self.run_scene(*arguments).err, r"\(director 'judge'\) missed its deadline of (50|90) ms")
        self.assert_is_sentence(self.run_scene("--inject", "judge=loss=1%", code=FAULT),
                                "loses messages of director 'judge', for which the world would wait forever")
        for option in ("--deadline", "--inject"):
            value = "juge=" + ("hold:50" if option == "--deadline" else "latency=1ms")
            self.assert_is_sentence(self.run_scene(option, value, code=FAULT),
                                    f"{option}: the scene has no controller or director 'juge'; did you mean 'judge'")

    def serve(self, *arguments):
        self.run = self.start("serve", self.scene, "--endpoint", self.endpoint, "--real-time", "1000", "--record", self.record,
                              "--hash", "--summary", self.folder / "summary.json", *arguments)

    def test_a_server_starts_what_a_run_starts(self):
        self.write("judge.lua", "function post_step(k) if k == 3 then world.finish('done by ' .. world.id) end end")
        self.write_scene('<director id="judge" script="judge.lua" />')
        self.serve()
        self.assertEqual(self.end()["result"], "done by judge")
        ran = self.run_scene("--hash")
        self.assertEqual(self.outcome.lines[-1], ran.lines[-1])
        command = self.program("with ziggurat.direct() as world:\n    next(world)\n    world.finish('a program')\n")
        self.write_scene(f'<director id="judge" {command} />')
        self.serve()
        self.assertEqual(self.end()["result"], "a program")

    def test_a_server_that_starts_no_directors_waits_for_them(self):
        self.write("judge.lua", "function post_step(k) world.finish('inside') end")
        for element, options in (('<director id="judge" script="judge.lua" />', ("--without-directors",)),
                                 ('<director id="judge" />', ())):
            self.write_scene(element)
            self.serve(*options)
            self.wait_for((self.folder / "e").exists, bool, "socket")
            with self.direct() as world:
                next(world)
                world.finish("outside")
            self.assertEqual(self.end()["result"], "outside")
            self.assertRegex(self.outcome.err, "connect with: .*judge")
            os.remove(self.record)
        self.write_scene('<director id="judge" />')
        self.assert_is_sentence(self.ziggurat("serve", self.scene, "--start-directors"),
                                "director 'judge' has no program that can be started; write script=")

    def test_an_empty_result_has_no_colon(self):
        self.write("judge.lua", "function post_step(k) world.finish() end")
        self.write_scene('<director id="judge" script="judge.lua" />')
        self.assertRegex(self.run_scene().err, r"(?m)director 'judge' ended the run$")

    def test_an_empty_script_is_a_director_from_outside(self):
        self.write_scene('<director id="judge" script="nothere.lua" />')
        self.begin("--set", "director/@script=")
        with self.direct() as world:
            next(world)
            world.finish("from outside")
        self.assertEqual(self.end()["result"], "from outside")

    def test_from_outside_only_if_the_scene_or_an_option_allows_it(self):
        self.write_scene(director="", length=1)
        self.begin("--paused")
        with self.assertRaisesRegex(ziggurat.Refused, "FORBIDDEN.*--allow-director"):
            self.direct()
        with ziggurat.supervise(self.endpoint) as supervisor:
            supervisor.resume()
        self.end()
        os.remove(self.record)
        self.begin("--paused", "--allow-director")
        world = self.direct()
        with ziggurat.supervise(self.endpoint) as supervisor:
            supervisor.resume()
            next(world)
            world.finish("early")
            self.assertRaises(StopIteration, next, world)
        world.close()
        self.assertEqual(self.end()["ticks"], 0)

    def test_bad_messages_without_end_lose_the_director(self):
        self.begin()
        world = self.direct()
        next(world)
        for _ in range(50):
            for direction in (v1.Direction(tick=9), v1.Direction(acts=[v1.DirectorAct()] * 20000),
                              v1.Direction(acts=[v1.DirectorAct(move=v1.MoveRequest(entity="x" * 100000))])):
                world._connection.send(v1.ClientMessage(direction=direction))
        with self.assertRaisesRegex(ziggurat.ProtocolError, "TOO_MANY"):
            for _ in range(200):
                try:
                    next(world)
                except ziggurat.ProtocolError as error:
                    if error.is_fatal:
                        raise
                    world._owes = None
        self.end(code=CONTROLLER_FAILED)
        self.assert_is_sentence(self.outcome, "director 'judge' disconnected at tick 0")

    def test_a_fork_asks_for_the_directors_program(self):
        self.begin("--ticks", "3")
        with self.direct() as world:
            for _ in world:
                pass
        self.end()
        outcome = self.ziggurat("fork", self.record, "--at", "1")
        self.assertEqual(outcome.code, FAULT)
        self.assert_is_sentence(outcome, "--endpoint where it connects")

    def run_example(self, scene, *arguments):
        """The summary of a run that may start the Python examples."""
        self.environment["PYTHONPATH"] = os.environ["ZIGGURAT_PYTHON_PACKAGE"]
        self.environment["PATH"] = f"{os.path.dirname(sys.executable)}:{self.environment['PATH']}"
        self.run_scene("--summary", self.folder / "summary.json", *arguments, scene=scene)
        return json.loads((self.folder / "summary.json").read_text())

    def test_the_judges_of_the_examples_end_the_stacking_scene(self):
        scene = EXAMPLES / "judge.argos"
        lua = ("--set", "director/@command=", "--set", f"director/@script={EXPERIMENTS}/judge.lua")
        in_python, in_lua, again = (self.run_example(scene, *arguments) for arguments in ((), lua, lua))
        for summary in (in_python, in_lua):
            self.assertRegex(summary["result"], r"^block1 stands on block2, \d+\.\d mm aside$")
            self.assertLess(summary["ticks"], 600)
            self.assertLess(summary["metrics"]["judge/aside_mm"], 6)
            self.assertLess(summary["metrics"]["judge/turned_deg"], 10)
        self.assertEqual(in_lua["hash"], again["hash"])
        self.assertEqual((in_lua["result"], in_lua["hash"]), (in_python["result"], in_python["hash"]))
        for name, value in in_python["metrics"].items():
            self.assertAlmostEqual(in_lua["metrics"][name], value, places=3)

    def test_food_in_python_and_cpp_is_collected_and_placed_anew(self):
        text = (EXPERIMENTS / "foraging.argos").read_text()
        text = text.replace("foraging_robot.lua", f"{EXPERIMENTS}/foraging_robot.lua")
        for command in (f"{sys.executable} {EXAMPLES}/foraging.py", f"{BIN}/example_foraging"):
            self.assertIn('script="foraging.lua"', text)
            scene = self.write("foraging.argos", text.replace('script="foraging.lua"', f'command="{command}"'))
            first, again, other = (self.run_example(scene, "--param", "goal=8", "--seed", seed) for seed in (3, 3, 4))
            for summary in (first, other):
                self.assertEqual((summary["ending"], summary["director"]), ("finished", "food"))
                self.assertEqual(summary["metrics"]["food/collected"], 8, "more than the 6 of the beginning")
            self.assertEqual(first["hash"], again["hash"], command)
            self.assertNotEqual(first["hash"], other["hash"], command)

    def test_libraries_are_refused_with_what_to_do(self):
        self.write_scene('<loop_functions library="libfood.so" label="food" />')
        outcome = self.ziggurat("check", self.scene)
        self.assertEqual(outcome.code, FAULT)
        self.assertRegex(outcome.err + outcome.out, r"<loop_functions> has no script.*<director id=")


if __name__ == "__main__":
    main()
