# SPDX-License-Identifier: MIT
"""Section 2: beginning a session."""

from ..case import Case, Level
from ..messages import ALL, TWO, answer, hear_error, hear_refusal, hello, join, leave, observe, send_hello
from ..server_scene import CROWDED
from ..steps import Check, Hang, Hear, Join, Silence, Skip
from ..wire import Count, OneOf, Some


def _positions_are_in_scene_order(stage) -> str:
    ids = [robot.id for robot in stage.peer("p").welcome.robots]
    return "" if ids == sorted(ids) else f"robots come as {ids}; they stand in scene order"


def _devices_are_described(stage) -> str:
    robot = stage.peer("p").welcome.robots[0]
    missing = [
        name
        for name in ("joint_sensors", "joint_actuators", "radios", "leds", "directional_leds", "tags",
                     "magnets", "proximity_sensors", "params")
        if not getattr(robot, name)
    ]
    missing += [name for name in ("positioning", "battery") if not getattr(robot, name)]
    missing += [] if robot.HasField("range_and_bearing") else ["range_and_bearing"]
    return f"{robot.id} has no {', '.join(missing)}" if missing else ""


def _holder_is_short(stage) -> str:
    holder = stage.peer("q").refusal.holder
    is_printable = all(" " <= letter != "\x7f" for letter in holder)
    return "" if is_printable and holder.count("x") <= 64 and holder.count("1") <= 64 else f"it is {holder!r}"


def _one_run(stage) -> str:
    first, second = (stage.peer(name).welcome for name in "pq")
    others = [name for name in ("tick_ns", "ticks_per_second", "mode", "seed", "scene_hash")
              if getattr(first, name) != getattr(second, name)]
    return f"two sessions of one run are told another {', '.join(others)}" if others else ""


def _robots_are(*ids: str) -> dict:
    return {"robots": [{"id": id} for id in ids]}


def _refused(name: str, code: str, title: str, retryable: bool = False, robots=("*",), **fields):
    return Case(f"{name}", title, (send_hello("p", *robots, **fields), hear_refusal("p", code, retryable)))


CASES = [
    Case("H1.at-once", "A Hello is answered at once",
         (join("p", "arm0"),)),
    Case("H1.first", "A Command before Hello is OUT_OF_STATE",
         (answer("p"), hear_error("p", "OUT_OF_STATE", "FATAL"))),
    _refused("H2.major-above", "VERSION_MISMATCH", "A later major version is refused",
             version={"major": 2, "minor": 0}),
    _refused("H2.major-below", "VERSION_MISMATCH", "Major version 0 is refused",
             version={"major": 0, "minor": 9}),
    _refused("H2.no-version", "VERSION_MISMATCH", "A Hello without version is refused", version=None),
    Case("H2.both-versions", "The refusal names both versions",
         (send_hello("p", "*", version={"major": 7, "minor": 3}),
          Hear("p", "refusal", {"server_version": {"major": 1},
                                "client_version": {"major": 7, "minor": 3}}))),
    Case("H2.minor-above", "A later minor version is welcome",
         (join("p", "*", version={"major": 1, "minor": 99}),)),
    Case("H2.minor-agreed", "The lower minor version counts",
         (Join("p", hello("*", version={"major": 1, "minor": 0}), {"version": {"major": 1, "minor": 0}}),)),
    _refused("H3.no-role", "BAD_VALUE", "A Hello without role is refused", role="ROLE_UNSPECIFIED"),
    _refused("H3.unknown-role", "BAD_VALUE", "A role of the future is refused", role=77),
    _refused("H3.negative-role", "BAD_VALUE", "A role below 0 is refused", role=-7),
    _refused("H4.nothing-asked", "BAD_VALUE", "A Hello that asks for no robot is refused", robots=()),
    Case("H4.one", "A robot by id", (Join("p", hello("arm1"), _robots_are("arm1")),)),
    Case("H4.some", "Robots by id come in scene order",
         (Join("p", hello("arm2", "arm0"), _robots_are("arm0", "arm2")),)),
    Case("H4.star", "A glob with *", (Join("p", hello("arm*"), {"robots": Count(4)}),)),
    Case("H4.question", "A glob with ?", (Join("p", hello("ar?3"), _robots_are("arm3")),)),
    Case("H4.set", "A glob with [a-z]", (Join("p", hello("arm[1-2]"), _robots_are("arm1", "arm2")),)),
    Case("H4.not-in-set", "A glob with [!a-z]", (Join("p", hello("arm[!1-3]"), _robots_are("arm0")),)),
    Case("H4.twice", "A robot that two patterns mean is given once",
         (Join("p", hello("arm0", "arm[0]"), _robots_are("arm0")),)),
    Case("H4.controller", "Robots by controller",
         (Join("p", hello(controller="steady"), _robots_are("arm0", "arm1")),)),
    Case("H4.both", "Criteria are joined by and",
         (Join("p", hello("arm[1-3]", controller="steady"), _robots_are("arm1")),)),
    Case("H4.lua-only", "lua_only passes other controllers over",
         (Join("p", hello("*", lua_only=True), _robots_are("arm3")),)),
    Case("H4.all-or-nothing", "A session has all robots that it asks for, or there is none",
         (join("p", "arm1"), send_hello("q", "*"), hear_refusal("q", "ROBOT_TAKEN", True),
          join("q", "arm0"))),
    _refused("H5.unknown-id", "UNKNOWN_ROBOT", "An id that the scene does not have", robots=("nobody",)),
    _refused("H5.unknown-among", "UNKNOWN_ROBOT", "One of several ids is not there",
             robots=("arm0", "nobody")),
    _refused("H5.no-match", "UNKNOWN_ROBOT", "A glob that nothing fits", robots=("leg*",)),
    _refused("H5.no-common", "UNKNOWN_ROBOT", "Criteria that no robot fits together",
             robots=("arm3",), controller="steady"),
    _refused("H5.controller", "UNKNOWN_CONTROLLER", "A controller that is not there",
             robots=(), controller="nobody"),
    _refused("H5.bad-glob", "UNKNOWN_ROBOT", "A glob that is not closed", robots=("arm[0",)),
    Case("H6.taken-twice", "Two sessions never hold one robot; the holder is named",
         (join("p", "arm0", client_name="first"), send_hello("q", "arm0"),
          Hear("q", "refusal", {"error": {"code": "ROBOT_TAKEN", "robot": "arm0", "retryable": True},
                                "holder": Some()}))),
    Case("H6.holder-undisturbed", "The holder hears nothing of it",
         (ALL, send_hello("q", "arm0"), hear_refusal("q", "ROBOT_TAKEN", True), Silence("p"),
          answer("p"), observe("p"))),
    Case("H7.left-by-id", "A robot that left can't be had by id",
         (TWO, leave("p", 0), send_hello("x", "arm0"), hear_refusal("x", "NOT_YOURS")), fresh=True),
    Case("H7.left-by-glob", "A glob passes over robots that left",
         (join("p", "arm0"), join("q", "arm1", "arm2", "arm3"), observe("p", "q"), leave("p"),
          Hang("q"), Join("x", hello("*"), _robots_are("arm1", "arm2", "arm3"))), fresh=True),
    Case("H8.wait", "To wait forever is always granted",
         (Join("p", hello("*", deadline_policy={"action": "WAIT"}), {"robots": Count(4)}),)),
    Case("H9.run", "Welcome describes the run",
         (Join("p", hello("*"), {"tick_ns": 100000000, "ticks_per_second": 10, "seed": 7,
                                 "mode": "MODE_LOCK_STEP", "session_token": Some(),
                                 "scene_hash": Some(), "max_message_bytes": Some()}),)),
    Case("H9.one-run", "All sessions are told of the same run",
         (join("p", "arm0"), join("q", "arm1"), Check("run", _one_run))),
    Case("H9.devices", "Welcome describes the robots' devices",
         (join("p", "arm0"), Check("devices", _devices_are_described))),
    Case("H9.params", "Welcome carries the controller's parameters in order",
         (Join("p", hello("arm0"), {"robots": [{"controller": "steady", "params": [
             {"name": "speed", "value": "0.5"}, {"name": "name", "value": "Ada"}]}]}),)),
    Case("H9.script", "Welcome names the Lua script",
         (Join("p", hello("arm3"), {"robots": [{"controller": "scripted", "script": Some()}]}),)),
    Case("H9.order", "Welcome.robots is in scene order",
         (join("p", "arm3", "arm1", "arm0"), Check("order", _positions_are_in_scene_order))),
    Case("H9.tokens-differ", "Each session has a token of its own",
         (join("p", "arm0"), join("q", "arm1"),
          Check("tokens", lambda stage: "" if stage.peer("p").welcome.session_token
                != stage.peer("q").welcome.session_token else "two sessions have one token"))),
    Case("H10.again", "After a Refusal another Hello may come over the same connection",
         (send_hello("p", "nobody"), hear_refusal("p", "UNKNOWN_ROBOT"), join("p", "*"), observe("p"))),
    Case("H10.many", "Ten refusals, then a welcome",
         (*[step for _ in range(10) for step in
            (send_hello("p", "nobody"), hear_refusal("p", "UNKNOWN_ROBOT"))], join("p", "arm0"))),
    Case("T9.early", "Who comes while the world is loading is told so at once",
         (send_hello("p", "*"), Hear("p", "loading", should=True)), fresh=True, scene=CROWDED),
    Case("H12.welcome", "When the world is there, the Hello is handled without another one",
         (send_hello("p", "*"), Skip("p", "welcome"), observe("p"), answer("p"), observe("p")),
         fresh=True, scene=CROWDED),
    Case("H12.leave", "A Leave takes the Hello back",
         (send_hello("p", "*"), Hear("p", "loading", should=True), leave("p"),
          send_hello("q", "*"), Skip("q", "welcome"), observe("q")), fresh=True, scene=CROWDED),
    Case("H11.late", "Who comes late gets the tick that the others are at",
         (TWO, answer("q"), Hang("p"), join("x", "arm0", "arm1"), Hear("x", "observation"),
          Check("tick", lambda stage: "" if stage.peer("x").tick == stage.peer("q").tick
                else f"it got tick {stage.peer('x').tick}, the others are at {stage.peer('q').tick}"),
          answer("x"), observe("x", "q"))),
    Case("H4.too-many-patterns", "A Hello with five thousand patterns is refused",
         (send_hello("p", *[f"*{n}" for n in range(5000)]),
          Hear("p", "refusal", {"error": {"code": OneOf(("TOO_MANY", "UNKNOWN_ROBOT")),
                                          "severity": "FATAL"}}))),
    Case("K5.most-patterns", "A Hello may have 64 patterns of 256 bytes each",
         (join("p", "*", *[f"x{n:02}{'x' * 252}*" for n in range(63)]), observe("p")), Level.SECURE),
    Case("H4.slow-glob", "A glob made to be slow is answered in time",
         (send_hello("p", "*a" * 15 + "b"), Hear("p", "refusal", {"error": {"severity": "FATAL"}},
                                                within=1.0))),
    Case("H1.long-names", "A client with a name of 30 000 bytes is treated as any other",
         (join("p", "arm0", client_name="x" * 30000, client_version="y" * 30000),)),
    Case("H16.shown", "Names are shown cut to 64 bytes each, and without control characters",
         (join("p", "arm0", client_name="\x1b]" + "x" * 100, client_version="1" * 100), send_hello("q", "arm0"),
          Hear("q", "refusal", {"error": {"code": "ROBOT_TAKEN"}, "holder": Some()}),
          Check("holder", _holder_is_short))),
    Case("H16.unnamed", "A client without a name has one for people",
         (join("p", "arm0", client_name="", client_version=""), send_hello("q", "arm0"),
          Hear("q", "refusal", {"holder": "unnamed client"}))),
    Case("H1.control-characters", "A name with control characters is treated as any other",
         (join("p", "arm0", client_name="\x1b[31m\nred\x00"),)),
]
