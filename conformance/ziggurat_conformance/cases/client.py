"""What a controller program must do, whatever it controls."""

from ..case import Case, Level
from ..client_steps import CheckClient, Ends, HearFrom, Quiet, Tell, TellBytes, Wait
from ..server_scene import IDLE_SCRIPT
from ..wire import AtLeast, Count, OneOf, Some

_JOINT = {"id": "hinge", "mode": "POSITION"}
_MOTOR = {"id": "hinge", "mode": "VELOCITY", "max_impulse": 0.01}


def robot(id: str) -> dict:
    """An arm as our scene has it."""
    return {
        "id": id, "controller": "steady", "script": IDLE_SCRIPT,
        "params": [{"name": "speed", "value": "0.5"}, {"name": "script", "value": "idle.lua"}],
        "joint_sensors": [_JOINT], "joint_actuators": [_MOTOR],
        "radios": [{"id": "mouth", "range": 3.0, "sends": True, "receives": True}],
        "leds": [{"id": "lamp", "color": 0xFF0000}],
        "directional_leds": [{"id": "beam", "color": 0x00FF00}],
        "tags": [{"id": "label", "payload": b"0"}],
        "magnets": [{"id": "coil"}],
        "proximity_sensors": [{"anchor": "hand", "position": [0.05, 0.0, 0.02],
                               "direction": [1.0, 0.0, 0.0], "range": 0.2}],
        "range_and_bearing": {"range": 3.0, "data_size": 2, "sends": True, "receives": True},
        "positioning": True, "battery": True,
    }


def rover(id: str) -> dict:
    """An arm on wheels, with a turret and a camera that has all detectors and takes pictures."""
    return {
        **robot(id),
        "cameras": [{"id": "eye", "anchor": "origin", "position": [0.1, 0.0, 0.2],
                     "orientation": [0.5, -0.5, 0.5, -0.5], "near": 0.1, "far": 2.0,
                     "focal_length": [800.0, 800.0], "principal_point": [2.0, 1.0], "width": 4,
                     "height": 2, "detects_leds": True, "detects_directional_leds": True,
                     "detects_tags": True, "image": True}],
        "wheels": {"axle_length": 0.14, "drives": True, "measures": True},
        "turret": {"drives": True, "measures": True},
    }


def sights(led: int = 0, directional_led: int = 0, tag: int = 0, image: bytes = b"") -> dict:
    """What two rovers read: the first sees nothing, the second so many of each."""
    seen = {"wheels": [0.1, 0.2, 0.01, 0.02] * 2, "turret_rotations": [0.5, -0.5],
            "tag_payloads": [b"\0\xff"] * tag, "tag_corners": [0.5] * 8 * tag,
            "camera_images": [b"", image]}
    for name, count in (("led", led), ("directional_led", directional_led), ("tag", tag)):
        seen[f"{name}_counts"] = [0, count]
        seen[f"{name}_centers"] = [1.5, -2.5] * count
    for name, count in (("led", led), ("directional_led", directional_led)):
        seen[f"{name}_colors"] = [0xFF8001] * count
    return seen


def welcome(*robots: dict, **fields) -> Tell:
    told = {
        "version": {"major": 1, "minor": 0}, "session_token": b"0123456789abcdef",
        "tick_ns": 100_000_000, "ticks_per_second": 10, "mode": "MODE_LOCK_STEP", "seed": 7,
        "scene_hash": "0123456789abcdef", "max_message_bytes": 64 << 20, "server_version": "kit",
        "role": "ROLE_CONTROLLER", "robots": list(robots) or [robot("arm0"), robot("arm1")],
    }
    return Tell({"welcome": {**told, **fields}})


def observation(tick: int, robots: int = 2, **fields) -> Tell:
    """Readings of so many robots."""
    pose = [0.1, 0.2, 0.3, 1.0, 0.0, 0.0, 0.0]
    told = {"tick": tick, "time_ns": tick * 100_000_000, "joint_readings": [0.25] * robots,
            "proximity": [0.5] * robots, "positioning": pose * robots, "batteries": [1.0, 9.0] * robots}
    return Tell({"observation": {**told, **fields}})


def answered(tick: int, **pattern) -> HearFrom:
    return HearFrom("command", {"tick": tick, **pattern})


def ticks(first: int, last: int, **fields) -> list:
    return [step for tick in range(first, last + 1)
            for step in (observation(tick, **fields), answered(tick))]


def error(code: str, severity: str, tick: int = 0) -> Tell:
    return Tell({"error": {"code": code, "severity": severity, "tick": tick, "message": "for a test"}})


def end(tick: int, reason: str = "FINISHED") -> Tell:
    return Tell({"end": {"reason": reason, "tick": tick, "message": "it is over"}})


def refusal(code: str, retryable: bool = False) -> Tell:
    return Tell({"refusal": {"error": {"code": code, "severity": "FATAL", "retryable": retryable,
                                       "message": "not today"},
                             "server_version": {"major": 1}, "client_version": {"major": 1}}})


HELLO = HearFrom("hello", {"version": {"major": 1}, "role": "ROLE_CONTROLLER"})
BEGUN = [HELLO, welcome(), *ticks(0, 0)]
LEFT = HearFrom("leave", {"reason": "DONE"}, should=True)


def _no_criteria(stage) -> str:
    hello = stage.greeting
    return "" if hello.robots or hello.controller or hello.lua_only else "its Hello asks for no robots"


def _own_routing_id(stage) -> str:
    return "" if stage.routing_id[:1] == b"\0" else f"it set the routing id {stage.routing_id!r}"


# Field 1999 of any message, and a ServerMessage of a kind that 1.0 does not have.
_UNKNOWN_KIND = TellBytes(b"\xfa\x7c\x02\x08\x01", b'{"weather": {"rain": true}}')
_UNKNOWN_FIELD = TellBytes(b"\x1a\x16\x08\x01\x10\x80\xc2\xd7\x2f\x1a\x08" + b"\0" * 8 + b"\xf8\x7c\x01",
                           b'{"observation": {"tick": "1", "wind": 3}}')

CLIENT_CASES = [
    Case("H1.hello-first", "The first message is a Hello", (HELLO,)),
    Case("H2.version", "Its Hello has the version", (HearFrom("hello", {"version": {"major": 1}}),)),
    Case("H3.role", "Its Hello has the role", (HearFrom("hello", {"role": "ROLE_CONTROLLER"}),)),
    Case("H4.asks-for-robots", "It asks for robots in some way",
         (HELLO, CheckClient("criteria", _no_criteria))),
    Case("H9.named", "Its Hello has its name", (HearFrom("hello", {"client_name": Some()},
                                                           should=True),)),
    Case("T7.routing-id", "It lets ZeroMQ choose its routing id",
         (HELLO, CheckClient("routing id", _own_routing_id, should=True))),
    Case("H1.waits-for-the-answer", "It waits for the answer to its Hello", (HELLO, Quiet(1.0))),
    Case("H1.loading", "Loading is no answer yet",
         (HELLO, Tell({"loading": {"progress": 0.2, "message": "reading"}}), Quiet(0.2),
          Tell({"loading": {"progress": 0.9}}), Quiet(0.2), welcome(), *ticks(0, 1))),
    Case("H2.later-minor", "A server of a later minor version is no reason to give up",
         (HELLO, welcome(version={"major": 1, "minor": 0}, server_version="99"), *ticks(0, 2))),
    Case("H10.refused", "After a refusal that is not retryable it ends, with another exit code than 0",
         (HELLO, refusal("VERSION_MISMATCH"), Ends(good=False))),
    Case("H10.no-storm", "A refusal is no reason for a storm of Hellos",
         (HELLO, refusal("ROBOT_TAKEN", True), Wait(0.1),
          CheckClient("storm", lambda stage: _storm(stage)))),
    Case("H11.late", "It begins at whatever tick the world is at",
         (HELLO, welcome(), *ticks(41, 43))),
    Case("S1.first-tick", "It answers tick 0", (HELLO, welcome(), observation(0), answered(0))),
    Case("S1.end-at-once", "A run may end before it began",
         (HELLO, welcome(), end(0), LEFT, Ends(good=True, should=True))),
    Case("S3.answers-each", "It answers each observation with that tick", (*BEGUN, *ticks(1, 50))),
    Case("S3.answers-once", "It answers once", (*BEGUN, observation(1), answered(1), Quiet())),
    Case("S3.waits", "It waits for observations and sends nothing meanwhile",
         (*BEGUN, Quiet(1.0), *ticks(1, 2))),
    Case("S3.slow-world", "It takes a slow world as it is",
         (*BEGUN, *[s for tick in range(1, 4) for s in (Wait(0.7), *ticks(tick, tick))])),
    Case("S2.one-robot", "A session may have one robot",
         (HELLO, welcome(robot("arm0")), *ticks(0, 3, robots=1))),
    Case("S2.many-robots", "A session may have forty robots",
         (HELLO, welcome(*[robot(f"arm{i}") for i in range(40)]), *ticks(0, 3, robots=40))),
    Case("S2.other-order", "Robots stand in Welcome's order, whatever was asked for",
         (HELLO, welcome(robot("arm1"), robot("arm0")), *ticks(0, 3))),
    Case("D3.messages", "Radio messages come in any number, also empty and long ones",
         (*BEGUN, observation(1, radio_messages=[{"radio": 0, "payload": b""},
                                                 {"radio": 0, "payload": b"x" * 100_000},
                                                 {"radio": 1, "payload": bytes(range(256))}]),
          answered(1), observation(2), answered(2))),
    Case("D4.packets", "Range-and-bearing packets come in any number",
         (*BEGUN, observation(1, range_and_bearing=[
             {"robot": 0, "range": 0.5, "horizontal_bearing": 1.0, "vertical_bearing": 0.1,
              "data": b"\x01\x02"}] * 30), answered(1), *ticks(2, 2))),
    Case("D8.cameras", "Cameras see anything in any number, with pictures and without",
         (HELLO, welcome(rover("rover0"), rover("rover1")), *ticks(0, 0, **sights()),
          *ticks(1, 2, **sights(3, 2, 1)), *ticks(3, 4, **sights(0, 1, 40, bytes(24))),
          *ticks(5, 5, **sights(1000, 0, 0, b"\xff" * 24)), *ticks(6, 6, **sights()))),
    Case("T5.unknown-kind", "Messages of a kind that it does not know are ignored",
         (*BEGUN, _UNKNOWN_KIND, Quiet(0.2, should=True), *ticks(1, 2))),
    Case("M5.heartbeats-unanswered", "It does not answer heartbeats",
         (*BEGUN, *[Tell({"heartbeat": {"sequence": n}}) for n in range(1, 6)], Quiet(),
          *ticks(1, 2))),
    Case("M5.heartbeat-while-it-works", "A heartbeat behind an observation changes nothing",
         (*BEGUN, observation(1), Tell({"heartbeat": {"sequence": 1}}), answered(1), Quiet(),
          *ticks(2, 3))),
    Case("M5.heartbeat-early", "A heartbeat may come right behind Welcome",
         (HELLO, welcome(), Tell({"heartbeat": {"sequence": 1}}), *ticks(0, 2))),
    Case("S10.warning", "A warning is no reason to give up",
         (*BEGUN, error("DEADLINE_MISSED", "WARNING"), *ticks(1, 3))),
    Case("M3.fatal", "A fatal error is the end, and shows in the exit code",
         (*BEGUN, error("TOO_MANY", "FATAL"), Ends(good=False))),
    Case("L11.end", "After the end it leaves and ends well",
         (*BEGUN, *ticks(1, 3), end(3), LEFT, Ends(good=True, should=True))),
    Case("L5.end-while-it-works", "The end may come instead of the next tick, after an answer",
         (*BEGUN, observation(1), answered(1), end(1, "INTERRUPTED"), LEFT, Ends(should=True))),
    Case("L5.no-command-after-end", "After the end it answers no tick any more",
         (*BEGUN, end(0), LEFT, Quiet(0.2))),
    Case("L6.reset", "After a reset it goes on from tick 0",
         (*BEGUN, *ticks(1, 3), Tell({"reset": {"seed": 8}}), Quiet(0.2), *ticks(0, 3)),
         Level.RECONNECT),
    Case("L6.reset-twice", "It may be reset again and again",
         (*BEGUN, *[s for seed in (8, 9, 10) for s in
                    (*ticks(1, 2), Tell({"reset": {"seed": seed}}), *ticks(0, 0))]), Level.RECONNECT),
    *[Case(f"S9.reset-crosses-{code.lower().replace('_', '-')}",
           f"A command that met a reset on its way may be {code}: no reason to give up",
           (*BEGUN, *ticks(1, 3), Tell({"reset": {"seed": 8}}), *ticks(0, 0), error(code, "DISCARD"),
            Quiet(0.2, should=True), *ticks(1, 2)), Level.RECONNECT)
      for code in ("FUTURE_TICK", "STALE_TICK", "DUPLICATE_TICK")],
    Case("L6.paused", "While the world is paused it sends nothing",
         (*BEGUN, Tell({"paused": {"tick": 0}}), Tell({"heartbeat": {"sequence": 1}}), Quiet(0.5),
          *ticks(1, 3)), Level.RECONNECT),
    Case("L6.paused-again", "It may be told twice that the world is paused",
         (*BEGUN, Tell({"paused": {"tick": 0}}), Tell({"paused": {"tick": 0}}), *ticks(1, 2)),
         Level.RECONNECT),
    Case("L6.displaced", "When another takes its robots, it stops",
         (*BEGUN, Tell({"displaced": {"by": "another 1", "message": "takeover"}}),
          Ends(good=False)), Level.RECONNECT),
    Case("L6.restored", "It is told that the world was restored, and goes on at that tick",
         (*BEGUN, *ticks(1, 5), Tell({"restored": {"tick": 2, "snapshot": "two"}}), *ticks(2, 4)),
         Level.RECONNECT),
    Case("S12.many-ticks", "A thousand ticks", (HELLO, welcome(), *ticks(0, 999))),
]


def _storm(stage) -> str:
    """At most five Hellos within half a second."""
    count = 0
    for _ in range(50):
        if stage._receive(0.01) is not None:
            stage.tell(refusal("ROBOT_TAKEN", True))
            count += 1
    return f"it said Hello {count} times within half a second" if count > 5 else ""
