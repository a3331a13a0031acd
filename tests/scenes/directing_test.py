# SPDX-License-Identifier: MIT
"""Directors: what their acts do to a world, in which order, over resets and lost connections (section 9.1 of protocol.md)."""

import contextlib
import json
import os
import random
import threading

from directing import EVERYTHING, Directing, box
from harness import LIMIT, main

import ziggurat


class Acts(Directing):
    def image(self, content):
        path = self.folder / "image"
        path.write_bytes(content)
        return path

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

    def test_a_thousand_spawns_in_a_tick(self):
        """One more is refused with the limit, and has no effect; a thousand are done, moved and removed."""
        self.write_scene(floor="")
        self.begin()
        ids = [f"s{i}" for i in range(1001)]

        def spawn(some):
            for i, id in enumerate(some):
                world.spawn(box(id, f"{i % 40 - 20},{i // 40 + 1},5"))

        with self.direct() as world:
            next(world)
            spawn(ids)
            with self.assertRaisesRegex(ziggurat.ProtocolError, "1001 entities; 1000 are allowed"):
                next(world)
            self.assertNotIn("s0", world.entities)
            spawn(ids[:1000])
            next(world)
            self.assertEqual(len(world.entities), 1003)
            for i, id in enumerate(ids[:1000]):
                world.move(id, (i, 100, 5))
            next(world)
            self.assertEqual(world.entities["s999"].position[:2], (999, 100))
            for id in ids[:1000]:
                world.remove(id)
            next(world)
            self.assertEqual(len(world.entities), 3)
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
            ("BAD_VALUE", lambda world: world.paint_floor((0, 0), 0, 0)),
            ("TOO_LARGE", lambda world: world.lay_floor_image(self.image(bytes((2 << 20) + 1)))),
            ("BAD_VALUE", lambda world: world.paint_floor((0, 0), (1, 2, 3), 0)),
            ("BAD_VALUE", lambda world: world.paint_floor((0,), 1, 0)),
            ("BAD_VALUE", lambda world: world.paint_floor((0, 0), 1, 0x1000000)),
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

    def test_an_image_is_laid_on_the_floor(self):
        self.begin()
        with self.direct() as world:
            next(world)
            world.paint_floor((0, 0), 1, 0xFF0000)
            world.lay_floor_image(self.image(b"P6 1 1 255\n\xff\0\0"))
            next(world)
            world.lay_floor_image(self.image(b"GIF89a"))
            next(world)
            self.assertEqual([(each.code, each.field) for each in world.left_out], [("BAD_VALUE", "acts[0].paint_floor.image")])
            world.finish()
        self.end()
        shown = self.ziggurat("export", self.record, "--jsonl", "-", "--topics", "/world").out.splitlines()
        self.assertEqual([bool(json.loads(line)["message"]["floor_picture"]) for line in shown], [False, True])

    def test_a_floor_with_too_many_regions_takes_one_that_hides_them(self):
        self.begin()
        with self.direct() as world:
            next(world)
            for i in range(9_999):
                world.paint_floor((i, 0), 0.25, (255, 0, 0))
            next(world)
            world.paint_floor((-1, 0), (0.5, 0.5), 0x00FF00)
            world.paint_floor((-2, 0), 0.25, 0)
            next(world)
            self.assertEqual([(each.code, each.field) for each in world.left_out], [("TOO_MANY", "acts[1].paint_floor")])
            world.paint_floor((5_000, 0), (11_000, 1), 0xFFFFFF)
            next(world)
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

    def test_an_entity_is_not_moved_onto_another_unless_it_may(self):
        self.begin()
        with self.direct() as world:
            next(world)
            wall = world.entities["wall"].position
            self.assertEqual(world.overlapped("b1", wall), "wall")
            self.assertTrue(world.entities["b1"].is_free((7, 7, 0)))
            self.assertTrue(world.is_free("b1", world.entities["b1"].position), "it does not count itself")
            self.assertTrue(world.is_free('<box size="0.1,0.1,0.1"/>', (7, 7, 0)))
            self.assertEqual(world.overlapped(' <sphere radius="0.05"/>', wall), "wall")
            world.move("b1", wall)
            world.move("b2", (7, 7, 0))
            next(world)
            self.assertEqual([(each.code, each.field) for each in world.left_out], [("BAD_VALUE", "acts[0].move.position")])
            self.assertRegex(str(world.left_out[0]), "'b1' overlaps 'wall' where it is moved to")
            self.assertNotEqual(world.entities["b1"].position[:2], wall[:2])
            self.assertEqual(world.entities["b2"].position[:2], (7, 7))
            self.assertEqual(world.overlapped("b1", (7.02, 7, 0)), "b2")
            world.entities["b1"].move((7.02, 7, 0), may_overlap=True)
            next(world)
            self.assertEqual(world.left_out, [])
            self.assertAlmostEqual(world.entities["b1"].position[0], 7.02, delta=0.1)
            for what, code in (("nobody", "UNKNOWN_ENTITY"), ("<sphere/>", "BAD_VALUE"), ("<light/>", "BAD_VALUE")):
                with self.assertRaises(ziggurat.ProtocolError) as raised:
                    world.is_free(what, (0, 0, 0))
                self.assertEqual(raised.exception.code, code)
            world.finish()
        self.end()

    def test_a_joint_is_set_and_a_wrong_one_refused(self):
        self.begin()
        with self.direct(tell=("poses", "joints")) as world:
            next(world)
            world.spawn('<prototype id="arm" movable="false"><body position="8,8,0"/><links ref="base"><link id="base" geometry="box" '
                        'size="0.1,0.1,0.1" mass="1"/><link id="hand" geometry="box" size="0.1,0.1,0.1" mass="1"/></links><joints>'
                        '<joint id="hinge" type="revolute" axis="0,0,1"><parent link="base" position="0,0,0.1"/>'
                        '<child link="hand" position="0,0,0"/></joint></joints></prototype>')
            next(world)
            arm = world.entities["arm"]
            arm.set_joint("hinge", 1.25, 0.5)
            world.set_joint("arm", "knee", 0)
            with self.assertRaisesRegex(ziggurat.ProtocolError, "'arm' has no joint 'knee'; write one of 'hinge'") as raised:
                next(world)
            self.assertEqual((raised.exception.code, raised.exception.field), ("UNKNOWN_ENTITY", "acts[1].set_joint.joint"))
            self.assertEqual(arm.joints["hinge"].position, 0, "nothing of it was done")
            arm.set_joint("hinge", 1.25, -0.5)
            next(world)
            self.assertAlmostEqual(arm.joints["hinge"].position, 1.25 - 0.5 * world.tick_seconds, delta=1e-3)
            self.assertAlmostEqual(arm.joints["hinge"].velocity, -0.5, delta=1e-2)
            world.finish()
        self.end()

    def test_a_director_may_ask_more_than_a_thousand_times_a_second(self):
        self.begin()
        with self.direct() as world:
            next(world)
            self.assertEqual({world.is_free("b1", (i % 50 + 5, i // 50 + 5, 0)) for i in range(4000)}, {True})
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

    def hash_of_two(self, first, second):
        """Two directors that move the same box; they answer in this order."""
        self.write_scene('<director id="a" /><director id="b" />', length=0.5)
        self.begin()
        worlds = {id: self.direct(id) for id in ("a", "b")}
        watcher = ziggurat.supervise(self.endpoint, observer=True)
        self.addCleanup(watcher.close)
        for _ in range(5):
            for id in (first, second):
                next(worlds[id])
            for id in (first, second):
                worlds[id].move("b1", (1 if id == "a" else 2, 3, 0))
                worlds[id].remove("b2") if "b2" in worlds[id].entities else None
                worlds[id].answer()
                watcher.status()  # is answered behind that
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
        lost.abandon()
        with self.assertRaisesRegex(ziggurat.Refused, "ROBOT_TAKEN"):
            ziggurat.direct("judge", self.endpoint)
        os.environ.update(ZIGGURAT_ENDPOINT=self.endpoint, ZIGGURAT_SESSION_TOKEN=lost.token.hex())
        self.addCleanup(os.environ.pop, "ZIGGURAT_ENDPOINT")
        world = ziggurat.direct("judge", tell=EVERYTHING, wait_timeout=LIMIT)
        tick = next(world)
        self.assertEqual((tick.number, tick.event), (0, ziggurat.Event.RESUME))
        self.assertEqual(set(world.entities), {"b1", "b2", "wall"})
        world.finish()
        self.assertRaises(StopIteration, next, world)
        world.close()
        self.end()


if __name__ == "__main__":
    main()
