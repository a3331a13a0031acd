# SPDX-License-Identifier: MIT
"""Core: what a controller program must do, whatever it controls."""

import time

from ..case import Case
from ..client_messages import (BEGUN, HELLO, LEFT, answered, end, error, heartbeat, observation, refusal, ticks,
                               welcome)
from ..client_robots import robot, rover, sights
from ..client_steps import (CheckClient, Ends, HearCorrection, HearFrom, Quiet, Refuse, Remove, SinceMinor,
                            Tell, TellBytes, TellObservation, Wait)
from ..wire import Some


def _own_routing_id(stage) -> str:
    return "" if stage.routing_id[:1] == b"\0" else f"it set the routing id {stage.routing_id!r}"


def _one_connection(stage) -> str:
    count = stage.socket.connections()
    return "" if count == 1 else f"it has {count} connections; one carries the session (T1)"


def storm(stage) -> str:
    """At most five Hellos within two seconds: it waits about a second before each."""
    end = time.monotonic() + 2.0
    count = 0
    while count <= 5 and stage.receive(end - time.monotonic()) is not None:
        stage.tell(refusal("ROBOT_TAKEN", True))
        count += 1
    return f"it said Hello {count} times within two seconds (H10)" if count > 5 else ""


# Field 1999 of any message: a ServerMessage of a kind that 1.0 does not have.
UNKNOWN_KIND = TellBytes(b"\xfa\x7c\x02\x08\x01", b'{"weather": {"rain": true}}')


def _mute(id: str) -> dict:
    """An arm that only senses: its devices send and drive nothing, and one joint is disabled."""
    sensing = {**robot(id), "leds": [], "directional_leds": [], "tags": [], "magnets": [],
               "joint_actuators": [{"id": "hinge", "mode": "DISABLED"}],
               "radios": [{"id": "ear", "range": 3.0, "receives": True}],
               "range_and_bearing": {"range": 3.0, "data_size": 2, "receives": True},
               "wheels": {"axle_length": 0.14, "measures": True}, "turret": {"measures": True}}
    return sensing


_HOLD = {"action": "HOLD", "wall_deadline_ms": 500}

CASES = [
    Case("H1.hello-first", "The first message is a Hello", (HELLO,)),
    Case("H2.version", "Its Hello has the version", (HearFrom("hello", {"version": {"major": 1}}),)),
    Case("H3.role", "Its Hello has the role", (HearFrom("hello", {"role": "ROLE_CONTROLLER"}),)),
    Case("H4.asks-for-robots", "It asks for robots in some way", (HELLO,)),
    Case("H9.named", "Its Hello has its name", (HearFrom("hello", {"client_name": Some()}, should=True),)),
    Case("T1.one-dealer", "It connects with one DEALER, and sends one frame each time",
         (*BEGUN, *ticks(1, 2), Quiet(0.3), CheckClient("connections", _one_connection, should=True))),
    Case("T7.routing-id", "It lets ZeroMQ choose its routing id",
         (HELLO, CheckClient("routing id", _own_routing_id, should=True))),
    Case("T4.small-limit", "No message is longer than Welcome allows",
         (HELLO, welcome(max_message_bytes=4096), *ticks(0, 9))),
    Case("T6.form", "It stays in the form that its first message has", (*BEGUN, *ticks(1, 5), end(5), LEFT)),
    Case("H1.waits-for-the-answer", "It waits for the answer to its Hello",
         (HELLO, Quiet(1.0), welcome(), *ticks(0, 0))),
    Case("H1.loading", "Loading is no answer yet",
         (HELLO, Tell({"loading": {"progress": 0.2, "message": "reading"}}), Quiet(0.2),
          Tell({"loading": {"progress": 0.9}}), Quiet(0.2), welcome(), *ticks(0, 1))),
    Case("H12.refused", "A world that can't be loaded is a Refusal like any other",
         (HELLO, Tell({"loading": {"progress": 0.2}}), refusal("OUT_OF_STATE"), Ends(good=False, should=True))),
    Case("H2.later-minor", "A server of a later version is no reason to give up",
         (HELLO, welcome(version={"major": 1, "minor": 0}, server_version="99"), *ticks(0, 2))),
    Case("S14.metrics", "Its metrics, if it has any, are of its robots, with plain names, at most 100 of a robot",
         (HELLO, SinceMinor(3, (welcome(version={"major": 1, "minor": 3}), *ticks(0, 4, epoch=0), end(4), LEFT)))),
    Case("H10.refused", "After a refusal that is not retryable it ends, with another exit code than 0",
         (HELLO, refusal("VERSION_MISMATCH"), Ends(good=False, should=True))),
    Case("H10.no-storm", "A refusal is no reason for a storm of Hellos",
         (HELLO, refusal("ROBOT_TAKEN", True), Wait(0.1), CheckClient("storm", storm, should=True))),
    Case("H11.late", "It begins at whatever tick the world is at",
         (HELLO, welcome(), *ticks(41, 43))),
    Case("H11.waits", "Before the first tick it waits", (HELLO, welcome(), Quiet(0.5), *ticks(0, 1))),
    Case("H13.unasked", "It takes over no robots unless its user asks for it",
         (HearFrom("hello", {"takeover": False}, should=True),)),
    Case("H14.own-policies", "Each robot may have a deadline policy of its own",
         (HELLO, welcome({**robot("arm0"), "deadline_policy": {"action": "WAIT"}},
                         {**robot("arm1"), "deadline_policy": _HOLD}), *ticks(0, 2))),
    Case("S1.first-tick", "It answers tick 0", (HELLO, welcome(), observation(0), answered(0))),
    Case("S1.end-at-once", "A run may end before it began",
         (HELLO, welcome(), end(0), LEFT, Ends(good=True, should=True))),
    Case("S3.answers-each", "It answers each observation with that tick", (*BEGUN, *ticks(1, 50))),
    Case("S3.answers-once", "It answers once", (*BEGUN, observation(1), answered(1), Quiet(), *ticks(2, 2))),
    Case("S3.waits", "It waits for observations and sends nothing meanwhile",
         (*BEGUN, Quiet(1.0), *ticks(1, 2))),
    Case("S3.slow-world", "It takes a slow world as it is",
         (*BEGUN, *[s for tick in range(1, 4) for s in (Wait(0.7), *ticks(tick, tick))])),
    Case("S2.one-robot", "A session may have one robot", (HELLO, welcome(robot("arm0")), *ticks(0, 3))),
    Case("S2.many-robots", "A session may have forty robots",
         (HELLO, welcome(*[robot(f"arm{i}") for i in range(40)]), *ticks(0, 3))),
    Case("S2.other-order", "Robots stand in Welcome's order, whatever was asked for",
         (HELLO, welcome(robot("arm1"), robot("arm0")), *ticks(0, 3))),
    Case("S6.devices", "Values fit the devices that robots have: wheels and turrets too",
         (HELLO, welcome(rover("rover0"), robot("arm0"), rover("rover1")), *ticks(0, 5))),
    Case("S6.poor-robots", "Robots whose devices only sense have no values",
         (HELLO, welcome(_mute("arm0"), robot("arm1")), *ticks(0, 5))),
    Case("D3.messages", "Radio messages come in any number, also empty and long ones",
         (HELLO, welcome(robot("arm0"), robot("arm1")), *ticks(0, 0),
          observation(1, radio_messages=[{"radio": 0, "payload": b""}, {"radio": 0, "payload": b"x" * 100_000},
                                         {"radio": 1, "payload": bytes(range(256))}]),
          answered(1), observation(2), answered(2))),
    Case("D4.packets", "Range-and-bearing packets come in any number",
         (HELLO, welcome(robot("arm0"), robot("arm1")), *ticks(0, 0), observation(1, range_and_bearing=[
             {"robot": 0, "range": 0.5, "horizontal_bearing": 1.0, "vertical_bearing": 0.1,
              "data": b"\x01\x02"}] * 30), answered(1), *ticks(2, 2))),
    Case("D8.cameras", "Cameras see anything in any number, with pictures and without",
         (HELLO, welcome(rover("rover0"), rover("rover1")), *ticks(0, 0, **sights()),
          *ticks(1, 2, **sights(3, 2, 1)), *ticks(3, 4, **sights(0, 1, 40)),
          *ticks(5, 5, **sights(1000)), *ticks(6, 6, **sights()))),
    Case("T5.unknown-kind", "Messages of a kind that it does not know are ignored",
         (*BEGUN, UNKNOWN_KIND, Quiet(0.2, should=True), observation(1), HearFrom("command", should=True))),
    Case("T5.unknown-field", "Fields that it does not know are ignored",
         (*BEGUN, TellObservation(1, is_of_later_version=True), answered(1), *ticks(2, 2))),
    Case("M5.heartbeats-unanswered", "It does not answer heartbeats",
         (*BEGUN, *[heartbeat(n) for n in range(1, 6)], Quiet(), *ticks(1, 2))),
    Case("M5.heartbeat-while-it-works", "A heartbeat behind an observation changes nothing",
         (*BEGUN, observation(1), heartbeat(1), answered(1), Quiet(), *ticks(2, 3))),
    Case("M5.heartbeat-early", "A heartbeat may come right behind Welcome",
         (HELLO, welcome(), heartbeat(1), *ticks(0, 2))),
    Case("M7.no-flood", "It does not send more messages than a session may",
         (*BEGUN, Quiet(0.5), *ticks(1, 3))),
    Case("S10.warning", "A warning is no reason to give up",
         (*BEGUN, error("DEADLINE_MISSED", "WARNING"), *ticks(1, 3))),
    Case("S10.refused", "After a Command that was refused it corrects it, leaves or ends",
         (*BEGUN, observation(1), answered(1), Refuse("BAD_VALUE"), HearCorrection(1))),
    Case("V13.robot-removed", "When a robot of it was removed, it goes on with the others",
         (HELLO, welcome(robot("arm0"), robot("arm1")), *ticks(0, 0), Remove(1), *ticks(1, 3))),
    Case("H13.robot-taken-over", "So it is when another client took one over",
         (*BEGUN, Tell({"error": {"code": "NOT_YOURS", "severity": "WARNING", "robot": "arm0",
                                  "message": "another client took it over"}}), *ticks(1, 3))),
    Case("M3.fatal", "A fatal error ends the session, and shows in the exit code",
         (*BEGUN, error("TOO_MANY", "FATAL"), Ends(good=False, should=True))),
    Case("L11.end", "After the end it leaves and ends well",
         (*BEGUN, *ticks(1, 3), end(3), LEFT, Ends(good=True, should=True))),
    Case("L5.end-while-it-works", "The end may come instead of the next tick, after an answer",
         (*BEGUN, observation(1), answered(1), end(1, "INTERRUPTED"), LEFT, Ends(should=True))),
    Case("L5.no-command-after-end", "After the end it answers no tick any more",
         (*BEGUN, end(0), LEFT, Quiet(0.2))),
    Case("S12.many-ticks", "A thousand ticks", (HELLO, welcome(), *ticks(0, 999))),
]
