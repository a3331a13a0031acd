"""Directors: what their acts do to a world, their programs, recordings, deadlines (section 9.1 of protocol.md)."""

import contextlib
import json
import os
import random
import sys
import threading
import time

from harness import BIN, CONTROLLER_FAILED, FAULT, HERE, SceneTest, main

sys.path.insert(0, os.environ["ZIGGURAT_PYTHON_PACKAGE"])

import ziggurat  # noqa: E402
from ziggurat import protocol_pb2 as v1  # noqa: E402

SCENE = """<argos-configuration>
  <framework><experiment length="{length}" ticks_per_second="10" random_seed="1" /></framework>
  <controllers />
  {director}
  <arena size="20, 20, 2">
    <box id="b1" size="0.1,0.1,0.1" movable="true" mass="1"><body position="0,0,0" />
      <leds medium="leds"><led anchor="origin" offset="0,0,0.1" color="red" /></leds></box>
    <box id="b2" size="0.1,0.1,0.1" movable="true" mass="2"><body position="1,0,0" /></box>
    <box id="wall" size="1,1,1" movable="false"><body position="5,0,0" /></box>
  </arena>
  <physics_engines><dynamics3d id="d" iterations="10"><gravity g="9.8" />{floor}</dynamics3d></physics_engines>
  <media><led id="leds" /></media>
</argos-configuration>
"""
EXAMPLES = HERE.parents[1] / "clients/python/examples"
EXPERIMENTS = HERE.parents[1] / "scenes/experiments"
EVERYTHING = ("poses", "links", "joints", "leds", "contacts")


def box(id, position, mass=1):
    return (f'<box id="{id}" size="0.1,0.1,0.1" movable="true" mass="{mass}">'
            f'<body position="{position}" /></box>')


class Directing(SceneTest):
    def setUp(self):
        super().setUp()
        self.endpoint = f"ipc://{self.folder}/e"
        self.record = self.folder / "run.mcap"
        self.write_scene()

    def write_scene(self, director='<director id="judge" />', floor="<floor />", length=0):
        self.scene.write_text(SCENE.format(director=director, floor=floor, length=length))

    def begin(self, *arguments):
        """Starts the run, which waits for a client."""
        self.run = self.start("run", self.scene, "--endpoint", self.endpoint, "--record", self.record, "--hash",
                              "--summary", self.folder / "summary.json", *arguments)
        self.wait_for((self.folder / "e").exists, bool, "socket")

    def direct(self, id="judge", **options):
        options.setdefault("tell", EVERYTHING)
        world = ziggurat.direct(id, self.endpoint, wait_timeout=30, **options)
        self.addCleanup(world.abandon)
        return world

    def end(self, code=0):
        """The end of the run; returns its summary, once the recording has been found to repeat it."""
        outcome = self.finish(self.run)
        self.assertEqual(outcome.code, code, outcome.err)
        self.outcome = outcome
        verified = self.ziggurat("verify", self.record)
        self.assertEqual(verified.code, 0, verified.out + verified.err)
        return json.loads((self.folder / "summary.json").read_text())

    def test_it_ends_the_run_with_a_result(self):
        self.begin()
        with self.direct() as world:
            for tick in world:
                world.metric("height", world.entities["b1"].position[2])
                if tick.number == 7:
                    world.log("it stands")
                    world.move("b1", (3, 3, 3))  # has no effect: the run ends with this tick
                    world.finish("stands")
            self.assertEqual((world.ending.reason, world.ending.message, world.ending.tick), ("finished", "stands", 7))
            self.assertNotEqual(world.entities["b1"].position[:2], (3, 3))
        summary = self.end()
        self.assertEqual((summary["ending"], summary["director"], summary["result"], summary["ticks"]),
                         ("finished", "judge", "stands", 7))
        self.assertAlmostEqual(summary["metrics"]["judge/height"], 0, places=3)
        self.assertRegex(self.outcome.err + self.outcome.out, r"\[7 judge\] it stands")

    def test_entities_are_moved_spawned_and_removed_between_two_ticks(self):
        self.begin()
        with self.direct() as world:
            next(world)
            self.assertEqual(set(world.entities), {"b1", "b2", "wall"})
            world.entities["b1"].move((2, 2, 0.5))
            world.entities["b2"].remove()
            world.spawn(box("b2", "-1,0,0", mass=3))
            world.spawn(box("b3", "-2,0,0"))
            next(world)
            self.assertEqual(world.entities["b1"].position[:2], (2, 2))
            self.assertLess(world.entities["b1"].position[2], 0.5)
            self.assertGreater(world.entities["b1"].position[2], 0.4)
            self.assertEqual(set(world.entities), {"b1", "b2", "b3", "wall"})
            self.assertAlmostEqual(world.entities["b2"].position[0], -1, places=6)
            self.assertEqual([entity.id for entity in world.order], ["b1", "b2", "wall", "b2", "b3"])
            world.finish()
        self.end()

    def test_a_push_acts_for_one_tick(self):
        """Free fall: only the push moves it sideways. v = F t / m."""
        self.write_scene(floor="")
        self.begin()
        with self.direct() as world:
            next(world)
            world.entities["b2"].push(force=(4, 0, 0), torque=(0, 0, 0.01))
            next(world)
            motion = world.entities["b2"].links[""]
            self.assertAlmostEqual(motion.velocity[0], 4 * 0.1 / 2, places=6)
            inertia = 2 * (0.1 ** 2 + 0.1 ** 2) / 12
            self.assertAlmostEqual(motion.angular_velocity[2], 0.01 * 0.1 / inertia, delta=0.02)
            next(world)
            self.assertAlmostEqual(world.entities["b2"].links[""].velocity[0], 0.2, places=6)
            world.finish()
        self.end()

    def test_a_push_wakes_what_rests_and_does_not_move_what_is_fixed(self):
        self.begin()
        with self.direct() as world:
            for tick in world:
                if tick.number >= 30:
                    world.entities["b1"].push(force=(30, 0, 0))
                    world.entities["wall"].push(force=(1e6, 0, 0))
                if tick.number == 35:
                    break
            self.assertGreater(world.entities["b1"].position[0], 0.1)
            self.assertEqual(world.entities["wall"].position, (5, 0, 0))
            world.finish()
            self.assertRaises(StopIteration, next, world)
        self.end()

    def test_leds_of_passive_entities_are_shown(self):
        self.begin()
        with self.direct() as world:
            next(world)
            self.assertEqual(tuple(world.entities["b1"].led_colors[0]), (255, 0, 0))
            world.entities["b1"].show(led_colors=[(0, 0, 255)])
            next(world)
            self.assertEqual(tuple(world.entities["b1"].led_colors[0]), (0, 0, 255))
            for field, values in (("led_colors", [1, 2]), ("tag_payloads", [b"x"])):
                world.entities["b1"].show(**{field: values})
                with self.assertRaisesRegex(ziggurat.ProtocolError, "BAD_VALUE.*show"):
                    next(world)
            world.finish()
        self.end()

    def test_contacts_name_the_links_that_touch(self):
        self.begin()
        with self.direct(entities="b*") as world:
            next(world)
            self.assertEqual(world.contacts, [])
            next(world)
            touching = {(contact.link[0], contact.other) for contact in world.contacts}
            self.assertEqual(touching, {("b1", None), ("b2", None)})
            weight = sum(contact.force[2] for contact in world.contacts)
            self.assertAlmostEqual(weight, 3 * 9.8, delta=0.5)
            world.finish()
        self.end()

    def test_a_wrong_act_leaves_out_the_whole_direction(self):
        self.begin()
        wrong = [
            ("UNKNOWN_ENTITY", lambda world: world.move("nobody", (0, 0, 0))),
            ("BAD_VALUE", lambda world: world.move("b2", (0, 0))),
            ("BAD_VALUE", lambda world: world.move("b2", (0, 0, 2e6))),
            ("BAD_VALUE", lambda world: world.move("b2", (0, 0, 0), (0, 0, 0, 0))),
            ("BAD_VALUE", lambda world: world.move("b2", (float("nan"), 0, 0))),
            ("BAD_VALUE", lambda world: world.spawn("<box/>")),
            ("BAD_VALUE", lambda world: world.spawn(box("b1", "7,7,0"))),
            ("BAD_VALUE", lambda world: world.spawn(box("judge", "7,7,0"))),
            ("BAD_VALUE", lambda world: world.spawn(box("heavy", "7,7,0", mass="2e6"))),
            ("TOO_LARGE", lambda world: world.spawn(box("x", "7,7,0") + " " * (1 << 20))),
            ("UNKNOWN_ENTITY", lambda world: world.remove("")),
            ("UNKNOWN_ENTITY", lambda world: world.entities["b2"].push(force=(1, 0, 0), link="arm")),
            ("UNKNOWN_ENTITY", lambda world: (world.remove("b2"), world.move("b2", (0, 0, 3)))),
            ("UNKNOWN_ENTITY", lambda world: (world.spawn(box("n", "7,7,0")), world.remove("n"))),
            ("BAD_VALUE", lambda world: (world.spawn(box("n", "7,7,0")), world.spawn(box("n", "8,7,0")))),
        ]
        with self.direct() as world:
            next(world)
            for code, ask in wrong:
                world.move("b1", (9, 9, 0))
                ask(world)
                with self.assertRaises(ziggurat.ProtocolError) as raised:
                    next(world)
                self.assertEqual(raised.exception.code, code)
                self.assertRegex(raised.exception.field, r"^acts\[[12]\]")
            next(world)
            self.assertEqual(world.tick.number, 1)
            self.assertNotEqual(world.entities["b1"].position[:2], (9, 9))
            self.assertEqual(set(world.entities), {"b1", "b2", "wall"})
            world.finish()
        self.end()

    def test_an_entity_is_not_spawned_where_another_stands(self):
        self.begin()
        with self.direct() as world:
            next(world)
            world.spawn(box("n1", "7,7,0"))
            world.spawn(box("n2", "7.05,7,0"))
            world.spawn(box("n3", "8,7,0"))
            next(world)
            self.assertEqual(set(world.entities), {"b1", "b2", "wall", "n1", "n3"})
            self.assertEqual([(each.code, each.field) for each in world.left_out], [("BAD_VALUE", "acts[1].spawn.xml")])
            next(world)
            self.assertEqual(world.left_out, [])
            world.finish()
        self.end()

    def test_acts_that_are_left_out_fill_no_terminal(self):
        self.begin()
        with self.direct() as world:
            for tick in world:
                for i in range(20):
                    world.spawn(box(f"n{tick.number}_{i}", "0,0,0"))  # where b1 stands
                if tick.number == 20:
                    self.assertEqual(len(world.left_out), 20, "it is told of each")
                    world.finish()
        self.end()
        lines = [line for line in self.outcome.err.splitlines() if "director 'judge', tick" in line]
        self.assertIn(len(lines), range(1, 10), "one in 10 s, of 400")

    def test_options_name_directors(self):
        command = self.program("world = ziggurat.direct()\nnext(world)\ntime.sleep(1000)\n")
        self.write_scene(f'<director id="judge" {command} />', length=1)
        for arguments in (("--deadline", "judge=hold:50"), ("--hil",)):
            self.assertRegex(self.run_scene(*arguments).err, r"\(director 'judge'\) missed its deadline of (50|90) ms")
        self.assert_is_sentence(self.run_scene("--inject", "judge=loss=1%", code=FAULT),
                                "loses messages of director 'judge', for which the world would wait forever")
        for option in ("--deadline", "--inject"):
            value = "juge=" + ("hold:50" if option == "--deadline" else "latency=1ms")
            self.assert_is_sentence(self.run_scene(option, value, code=FAULT),
                                    f"{option}: the scene has no controller or director 'juge'; did you mean 'judge'")

    def test_an_empty_script_is_a_director_from_outside(self):
        self.write_scene('<director id="judge" script="nothere.lua" />')
        self.begin("--set", "director/@script=")
        with self.direct() as world:
            next(world)
            world.finish("from outside")
        self.assertEqual(self.end()["result"], "from outside")

    def hash_of_two(self, first, second):
        """Two directors that move the same box; they answer in this order."""
        self.write_scene('<director id="a" /><director id="b" />', length=0.5)
        self.begin()
        worlds = {id: self.direct(id) for id in ("a", "b")}
        for _ in range(5):
            for id in (first, second):
                next(worlds[id])
            for id in (first, second):
                worlds[id].move("b1", (1 if id == "a" else 2, 3, 0))
                worlds[id].remove("b2") if "b2" in worlds[id].entities else None
                worlds[id].answer()
                time.sleep(0.02)
        for world in worlds.values():
            next(world)
            place = world.entities["b1"].position[0]
        for world in worlds.values():
            world.answer()
        for world in worlds.values():
            self.assertRaises(StopIteration, next, world)
            world.close()
        self.end()
        self.assertAlmostEqual(place, 2, places=6)
        return self.outcome.lines[-1]

    def test_the_order_of_answers_has_no_effect(self):
        first = self.hash_of_two("a", "b")
        os.remove(self.record)
        self.assertEqual(self.hash_of_two("b", "a"), first)

    def test_a_reset_begins_anew(self):
        self.begin("--paused")
        with self.direct() as world, ziggurat.supervise(self.endpoint) as supervisor:
            next(world)
            world.spawn(box("n", "7,7,0"))
            world.answer()
            supervisor.resume()
            next(world)
            self.assertIn("n", world.entities)
            shown = self.ziggurat("ctl", self.endpoint, "status").out
            self.assertRegex(shown, r"waiting for .* \(director 'judge'\) for ")
            self.assertEqual([each.director for each in supervisor.status().sessions][:1], ["judge"])
            world.expect_reset()
            supervisor.reset()
            tick = next(world)
            self.assertEqual((tick.number, tick.event), (0, ziggurat.Event.RESET))
            self.assertEqual(set(world.entities), {"b1", "b2", "wall"})
            world.finish("again")
            self.assertRaises(StopIteration, next, world)
        self.assertEqual(self.end()["result"], "again")

    def test_a_restored_world_is_told_and_only_if_the_director_can_go_back(self):
        self.begin("--paused")
        world = self.direct()
        supervisor = ziggurat.supervise(self.endpoint)
        next(world)
        world.answer()
        supervisor.pause()
        supervisor.snapshot("s")
        with self.assertRaisesRegex(ziggurat.ProtocolError, "OUT_OF_STATE.*judge"):
            supervisor.restore("s")
        world.abandon()
        world = self.direct(takeover=True, can_restore=True)
        next(world)
        world.answer()
        supervisor.resume()
        next(world)
        world.expect_reset()
        supervisor.restore("s")
        tick = next(world)
        self.assertEqual((tick.number, tick.event), (0, ziggurat.Event.RESTORED))
        world.finish()
        self.assertRaises(StopIteration, next, world)
        supervisor.close()
        world.close()
        self.end()

    def test_director_and_supervisor_at_once_are_repeated(self):
        """In any order, also before the first tick: end() verifies the recording."""
        self.begin()
        draw = random.Random(5)
        with ziggurat.supervise(self.endpoint) as supervisor:
            def disturb(count):
                for number in range(count):
                    act = draw.choice([lambda: supervisor.spawn(box(f"s{draw.randrange(9)}", f"{draw.randrange(9)},3,0")),
                                       lambda: supervisor.remove(f"s{draw.randrange(9)}"), supervisor.reset,
                                       lambda: supervisor.move("b1", (draw.random(), 5, 0)),
                                       lambda: supervisor.snapshot("s"), lambda: supervisor.restore("s")])
                    with contextlib.suppress(ziggurat.ProtocolError):
                        act()

            disturb(20)
            supervisor.move("b1", (1, 6, 0))
            supervisor.spawn(box("early", "2,6,0"))
            with self.direct(can_restore=True) as world:
                others = threading.Thread(target=disturb, args=(60,))
                others.start()
                count = 0
                for tick in world:
                    count += 1
                    if "b2" in world.entities:
                        world.entities["b2"].push(force=(draw.random(), 0, 0))
                    if count % 3 == 0:
                        world.spawn(box(f"d{count}", f"{count % 9},-3,0"))
                    if count > 100 and not others.is_alive():
                        world.finish()
        self.end()

    def test_a_director_that_was_lost_resumes(self):
        self.begin("--lease", "30")
        lost = self.direct()
        next(lost)
        os.environ.update(ZIGGURAT_ENDPOINT=self.endpoint, ZIGGURAT_SESSION_TOKEN=lost.token.hex())
        self.addCleanup(os.environ.pop, "ZIGGURAT_ENDPOINT")
        lost.abandon()
        with self.assertRaisesRegex(ziggurat.Refused, "ROBOT_TAKEN"):
            ziggurat.direct("judge", self.endpoint)
        world = ziggurat.direct("judge", tell=EVERYTHING, wait_timeout=30)
        tick = next(world)
        self.assertEqual((tick.number, tick.event), (0, ziggurat.Event.RESUME))
        self.assertEqual(set(world.entities), {"b1", "b2", "wall"})
        world.finish()
        self.assertRaises(StopIteration, next, world)
        world.close()
        self.end()

    def program(self, text):
        self.write("director.py", f"import sys\nsys.path.insert(0, {os.environ['ZIGGURAT_PYTHON_PACKAGE']!r})\n"
                                  f"import ziggurat, os, signal, time\n{text}")
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
        for end in ("os.kill(os.getpid(), signal.SIGKILL)", "time.sleep(1000)"):
            command = self.program(f"world = ziggurat.direct()\nnext(world)\n{end}\n")
            self.write_scene(f'<director id="judge" {command} deadline="drop" deadline_ms="200" />', length=1)
            outcome = self.run_scene("--allow-drops", "--hash")
            self.assertRegex(outcome.err, "director 'judge' is dropped at tick 0")
            self.write_scene(director="", length=1)
            self.assertEqual(outcome.lines[-1], self.run_scene("--hash").lines[-1])

    def test_a_policy_that_stops_ends_the_run(self):
        command = self.program("world = ziggurat.direct()\nnext(world)\ntime.sleep(1000)\n")
        self.write_scene(f'<director id="judge" {command} deadline="stop" deadline_ms="200" />')
        self.assert_is_sentence(self.run_scene(code=CONTROLLER_FAILED), "director 'judge' did not answer at tick 0")

    def test_a_failure_of_a_director_is_one_of_the_run(self):
        command = self.program("with ziggurat.direct() as world:\n    next(world)\n    raise ValueError('no food')\n")
        self.write_scene(f'<director id="judge" {command} />', length=1)
        self.assert_is_sentence(self.run_scene(code=CONTROLLER_FAILED),
                                "director 'judge' failed at tick 0: ValueError: no food")

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
