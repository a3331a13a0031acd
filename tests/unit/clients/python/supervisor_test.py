# SPDX-License-Identifier: MIT
"""The supervisor's calls, against a fake server."""

import unittest

import ziggurat
from ziggurat import protocol_pb2 as v1

from fake_server import welcome
from session_case import SessionCase


class Supervision(SessionCase):
    def ask(self, call, answer, role=v1.ROLE_SUPERVISOR, **options):
        """The result of `call`, with `answer(request)` as the answer; keeps the request."""
        def part(server):
            hello = server.receive()
            self.assertEqual(hello.role, role)
            self.assertEqual(len(hello.robots), 0)
            server.send(welcome=welcome(role=role))
            self.request = server.receive()
            server.send(heartbeat=v1.Heartbeat(sequence=1))
            server.send(response=v1.Response(id=self.request.id + 7, tick=1))  # not ours
            server.send(response=v1.Response(id=self.request.id, **answer))
            server.receive()

        def client():
            with ziggurat.supervise(self.server.endpoint, wait_timeout=60, **options) as world:
                return call(world)

        return self.play(part, client)

    def test_calls_that_answer_with_a_tick(self):
        calls = [(lambda w: w.pause(), "pause", {}), (lambda w: w.resume(), "resume", {}),
                 (lambda w: w.step(3), "step", {"ticks": 3}),
                 (lambda w: w.spawn("<box/>"), "spawn", {"xml": "<box/>"}),
                 (lambda w: w.remove("box"), "remove", {"entity": "box"}),
                 (lambda w: w.shutdown("done"), "shutdown", {"reason": "done"}),
                 (lambda w: w.shutdown(), "shutdown", {})]
        for call, kind, fields in calls:
            with self.subTest(kind):
                self.assertEqual(self.ask(call, {"tick": 5}), 5)
                self.assertEqual(self.request.WhichOneof("request"), kind)
                for name, value in fields.items():
                    self.assertEqual(getattr(getattr(self.request, kind), name), value)

    def test_reset_with_and_without_seed(self):
        self.ask(lambda world: world.reset(), {})
        self.assertEqual(self.request.WhichOneof("request"), "reset")
        self.assertFalse(self.request.reset.HasField("seed"))
        self.ask(lambda world: world.reset(0), {})
        self.assertTrue(self.request.reset.HasField("seed"))

    def test_move(self):
        self.ask(lambda world: world.move("box", (1, 2, 3)), {})
        self.assertEqual(list(self.request.move.position), [1, 2, 3])
        self.assertEqual(list(self.request.move.orientation), [])

    def test_set_joint(self):
        self.assertEqual(self.ask(lambda world: world.set_joint("arm", "hinge", 0.5), {"tick": 4}), 4)
        sent = self.request.set_joint
        self.assertEqual((sent.entity, sent.joint, sent.position, sent.velocity), ("arm", "hinge", 0.5, 0))
        self.ask(lambda world: world.set_joint("arm", "hinge", -1, velocity=2.5), {})
        self.assertEqual((self.request.set_joint.position, self.request.set_joint.velocity), (-1, 2.5))

    def test_read(self):
        link = v1.States.Link(id="base", position=[1, 2, 3], velocity=[4, 5, 6])
        entity = v1.States.Entity(id="box", position=[0, 0, 1], orientation=[1, 0, 0, 0],
                                  links=[link], led_colors=[0x0000FF])
        states = self.ask(lambda world: world.read("b*"),
                          {"tick": 4, "states": v1.States(entities=[entity], hash="ab")},
                          role=v1.ROLE_OBSERVER, observer=True)
        self.assertEqual(list(self.request.read.entities), ["b*"])
        self.assertEqual((states.tick, states.hash), (4, "ab"))
        self.assertEqual(states["box"].links[0].velocity, (4, 5, 6))
        self.assertEqual(states["box"].led_colors, ((0, 0, 255),))
        with self.assertRaises(KeyError):
            states["ball"]

    def test_status(self):
        session = v1.SessionStatus(client="me 1", role=v1.ROLE_CONTROLLER,
                                   state=v1.SessionStatus.OWING, robots=["a"], tick=3,
                                   wall_waiting_s=2.5, misses=1)
        status = self.ask(lambda world: world.status(),
                          {"status": v1.Status(tick=3, phase=v1.Status.RUNNING, seed=7,
                                               sessions=[session], free_robots=["b"],
                                               solver=v1.SolverStatus(islands=9, not_converged=2,
                                                                      worst_residual=0.5))})
        self.assertEqual((status.phase, status.seed, status.free_robots), ("running", 7, ("b",)))
        self.assertEqual(status.sessions[0].role, "controller")
        self.assertEqual(status.sessions[0].state, "owing")
        self.assertEqual(status.sessions[0].wall_waiting, 2.5)
        self.assertEqual(status.solver, ziggurat.SolverStatus(9, 2, 0.5))

    def test_servers_of_later_versions_may_have_more_values(self):
        session = v1.SessionStatus(role=77, state=78)
        status = self.ask(lambda world: world.status(),
                          {"status": v1.Status(phase=79, sessions=[session])})
        self.assertEqual((status.phase, status.sessions[0].role, status.sessions[0].state),
                         ("79", "77", "78"))

    def test_a_refused_request_is_an_exception(self):
        error = v1.Error(code=v1.Error.UNKNOWN_ENTITY, severity=v1.Error.DISCARD, message="No.")
        with self.assertRaises(ziggurat.ProtocolError) as caught:
            self.ask(lambda world: world.remove("x"), {"error": error})
        self.assertEqual(caught.exception.code, "UNKNOWN_ENTITY")


if __name__ == "__main__":
    unittest.main()
