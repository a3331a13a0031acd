# SPDX-License-Identifier: MIT
"""Section 9.1: directors. The variant is a server that lets them in from outside, such as
`ziggurat serve {scene} --endpoint {endpoint} --allow-director`."""

from ..case import Case, Level
from ..messages import answer, hear_error, hear_refusal, hello, join, leave, observe
from ..steps import Check, Hang, Hear, Join, Pause, Send, Silence, Tick, Token
from ..wire import AtLeast, Count, Some
from .deadlines import MS, policy
from .supervision import ask, failed, told

VARIANT = "director"
_V14 = {"major": 1, "minor": 4}
_BOX = '<box id="{id}" size="0.02,0.02,0.02" movable="true" mass="0.1"><body position="{position}"/></box>'


def _hello(director: str = "judge", **fields) -> dict:
    fields.setdefault("version", _V14)
    fields.setdefault("subscription", {"groups": ["POSES"]})
    return hello(role="ROLE_DIRECTOR", director=director, **fields)


def _directs(peer: str, director: str = "judge", pattern=None, **fields) -> list:
    return [Join(peer, _hello(director, **fields), {"role": "ROLE_DIRECTOR", "director": {"id": director}}),
            Hear(peer, "world_layout", {"first": 0, **(pattern or {})}), Hear(peer, "world_state")]


def _says(peer: str, tick=Tick(), **fields) -> Send:
    return Send(peer, {"direction": {"tick": tick, **fields}})


def _sees(*peers: str) -> list:
    return [Hear(peer, "world_state") for peer in peers]


def _spawn(id: str, position: str) -> dict:
    return {"spawn": {"xml": _BOX.format(id=id, position=position)}}


def _move(entity: str, *position: float) -> dict:
    return {"move": {"entity": entity, "position": list(position)}}


# "p" has all robots, "d" directs; both owe the same tick.
_BOTH = [join("p", "*"), *observe("p"), *_directs("d")]
_NEXT = [answer("p"), _says("d"), *observe("p"), *_sees("d")]


def _refused(title: str, name: str, code: str, *acts, **fields) -> Case:
    """A Direction that has no effect: the tick still waits, for one that is right."""
    wrong = {"acts": list(acts), **fields} if acts else fields
    return Case(f"{name}", title, (_BOTH, answer("p"), _says("d", **wrong), hear_error("d", code), Silence("p"),
                                   _says("d"), *observe("p"), *_sees("d")),
                fresh=True, variant=VARIANT)


def _lay(image: bytes, **others: object) -> dict:
    return {"paint_floor": {"image": image, **others}}


def _paint(*center: float, size: tuple = (1.0,), color: int = 0) -> dict:
    return {"paint_floor": {"center": list(center), "size": list(size), "color": color}}


def _ground(*expected: float) -> Check:
    """Brightness under rover1's ground sensors, which it reads behind its 24 light sensors."""

    def check(stage) -> str:
        found = list(stage.peer("p").observation.device_readings)[24:]
        return "" if found == list(expected) else f"the ground sensors read {found}; {list(expected)} is expected"

    return Check("ground", check)


def _remember(peer: str):
    """The next WorldState, for later."""
    def check(stage) -> str:
        message = stage.peer(peer).hear_behind("world_layout", stage.patience)
        if message is None or not message.HasField("world_state"):
            return "no WorldState came"
        stage.memory["state"] = message.world_state
        return ""
    return Check(f"{peer} is told the world", check)


CASES = [
    Case("R1.forbidden", "A director that neither scene nor server allows is FORBIDDEN",
         (Send("d", {"hello": _hello()}), hear_refusal("d", "FORBIDDEN"))),
    Case("R1.not-for-1.3", "A Hello of version 1.3 has no such role",
         (Send("d", {"hello": _hello(version={"major": 1, "minor": 3})}), hear_refusal("d", "BAD_VALUE"))),
    Case("R1.robots", "A director asks for no robots",
         (Send("d", {"hello": {**_hello(), "robots": ["*"]}}), hear_refusal("d", "BAD_VALUE")), variant=VARIANT),
    Case("R1.nameless", "A director says which it is",
         (Send("d", {"hello": _hello("")}), hear_refusal("d", "BAD_VALUE")), variant=VARIANT),
    Case("R1.id", "The id of one from outside is a plain one",
         (Send("d", {"hello": _hello("two words")}), hear_refusal("d", "BAD_VALUE")), variant=VARIANT),
    Case("R1.taken", "A director has one session; takeover displaces it",
         (_BOTH, Send("e", {"hello": _hello()}), hear_refusal("e", "ROBOT_TAKEN", retryable=True),
          Send("e", {"hello": _hello(takeover=True)}), Hear("d", "displaced"), Hear("e", "welcome"),
          Hear("e", "world_layout"), *_sees("e"), answer("p"), _says("e"), *observe("p"), *_sees("e")),
         fresh=True, variant=VARIANT),
    Case("R1.five", "A world has four directors",
         ([step for id in "abcd" for step in (Join(id, _hello(id)),)], Send("e", {"hello": _hello("e")}),
          hear_refusal("e", "TOO_MANY", retryable=True)), fresh=True, variant=VARIANT),
    Case("R2.waits", "The world waits for a director that has come",
         (_BOTH, answer("p"), Silence("p", 0.5), _says("d"), *observe("p"), *_sees("d")), fresh=True, variant=VARIANT),
    Case("R2.together", "WorldState has the tick of the Observation, and an epoch",
         (_BOTH, _NEXT, answer("p"), _says("d"), *observe("p"),
          Hear("d", "world_state", {"tick": Tick(of="p"), "epoch": 0})), fresh=True, variant=VARIANT),
    Case("R2.before", "A Direction before the first WorldState is OUT_OF_STATE",
         (Join("d", _hello()), _says("d", 0), hear_error("d", "OUT_OF_STATE")), fresh=True, variant=VARIANT),
    Case("R2.future", "A Direction for a later tick is FUTURE_TICK",
         (_BOTH, _says("d", Tick(1)), hear_error("d", "FUTURE_TICK"), _NEXT), fresh=True, variant=VARIANT),
    Case("R2.stale", "… for an earlier one STALE_TICK",
         (_BOTH, _NEXT, _says("d", Tick(-1)), hear_error("d", "STALE_TICK"), _NEXT), fresh=True, variant=VARIANT),
    Case("R2.duplicate", "… and the second for one DUPLICATE_TICK",
         (_BOTH, _says("d"), _says("d"), hear_error("d", "DUPLICATE_TICK"), answer("p"), *observe("p"), *_sees("d")),
         fresh=True, variant=VARIANT),
    _refused("… and one of a later epoch is FUTURE_TICK, too", "R2.epoch", "FUTURE_TICK", epoch=99),
    Case("R2.command", "A director sends no Command, and a controller no Direction",
         (_BOTH, answer("d"), hear_error("d", "OUT_OF_STATE"), _says("p"), hear_error("p", "OUT_OF_STATE"), _NEXT),
         fresh=True, variant=VARIANT),
    Case("R2.request", "A director makes no Request",
         (_BOTH, ask("d", 1, status={}), failed("d", 1, "FORBIDDEN"), _NEXT), fresh=True, variant=VARIANT),
    Case("R2.deadline", "A tick goes on without a director whose deadline passes",
         (join("p", "*"), *observe("p"), *_directs("d", deadline_policy=policy("HOLD")), answer("p"), *observe("p"),
          hear_error("d", "DEADLINE_MISSED", "WARNING"), *_sees("d"), _says("d", Tick(-1)), hear_error("d", "STALE_TICK"),
          answer("p"), _says("d"), *observe("p")),
         Level.HIL, fresh=True, variant=VARIANT),
    Case("R2.dropped", "… and for good, if its policy is DROP",
         (join("p", "*"), *observe("p"), *_directs("d", deadline_policy=policy("DROP")), answer("p"), *observe("p"),
          hear_error("d", "DEADLINE_MISSED", "WARNING"), answer("p"), *observe("p"), Silence("d", MS / 1000)),
         Level.HIL, fresh=True, variant=VARIANT),
    Case("R2.resume", "A director whose connection is gone is waited for, and resumes with its token",
         (_BOTH, answer("p"), Hang("d"), Silence("p", 0.5),
          Join("e", _hello(session_token=Token("d")), {"resumed": {}}), Hear("e", "world_layout", {"first": 0}),
          Hear("e", "world_state", {"tick": Tick(of="p")}), _says("e"), *observe("p"), *_sees("e")),
         Level.RECONNECT, fresh=True, variant=VARIANT),
    Case("R2.leaves", "One that has left is not waited for, and does not come back",
         (_BOTH, answer("p"), leave("d"), *observe("p"), answer("p"), *observe("p"),
          Send("e", {"hello": _hello()}), hear_refusal("e", "NOT_YOURS")), fresh=True, variant=VARIANT),
    Case("R2.reset", "A reset is told, then the layout and state of tick 0",
         (_BOTH, Join("s", hello(role="ROLE_SUPERVISOR"), {"robots": Count(0)}), ask("s", 1, reset={}),
          Hear("d", "reset", {"epoch": AtLeast(1)}), Hear("d", "world_layout", {"first": 0}),
          Hear("d", "world_state", {"tick": 0}), told("s", 1)), Level.RECONNECT, fresh=True, variant=VARIANT),
    Case("R2.paused", "A pause is told",
         (_BOTH, Join("s", hello(role="ROLE_SUPERVISOR"), {"robots": Count(0)}), ask("s", 1, pause={}),
          Silence("s", 0.1), answer("p"), _says("d"), told("s", 1), Hear("d", "paused", {"tick": Tick()})),
         Level.RECONNECT, fresh=True, variant=VARIANT),
    Case("R3.patterns", "A director is told of what its patterns fit",
         (join("p", "*"), *observe("p"), *_directs("d", pattern={"entities": Count(2)},
                                                   subscription={"entities": ["arm[01]"], "groups": ["POSES"]}),
          _NEXT), fresh=True, variant=VARIANT),
    Case("R3.nothing", "… without subscription of nothing",
         (join("p", "*"), *observe("p"), *_directs("d", pattern={"entities": Count(0)}, subscription=None), _NEXT),
         fresh=True, variant=VARIANT),
    Case("R3.groups", "All groups may be asked for; one that is unknown is ignored",
         (join("p", "*"), *observe("p"),
          *_directs("d", subscription={"groups": ["POSES", "LINKS", "JOINTS", "LEDS", "TAGS", "MAGNETS",
                                                  "RADIO_MESSAGES", "CONTACTS", 77]}), _NEXT),
         fresh=True, variant=VARIANT),
    Case("R3.many", "65 patterns are TOO_MANY",
         (Send("d", {"hello": _hello(subscription={"entities": ["a*"] * 65})}), hear_refusal("d", "TOO_MANY")),
         variant=VARIANT),
    Case("R3.long", "… and so is one of 257 bytes",
         (Send("d", {"hello": _hello(subscription={"entities": ["a" * 257]})}), hear_refusal("d", "TOO_MANY")),
         variant=VARIANT),
    Case("R4.comes-and-goes", "Entities that come and go are told before the state of the next tick",
         (_BOTH, answer("p"), _says("d", acts=[_spawn("crate", "30,0,0")]), *observe("p"),
          Hear("d", "world_layout", {"first": AtLeast(1), "entities": Count(1), "removed": Count(0)}), *_sees("d"),
          answer("p"), _says("d", acts=[{"remove": {"entity": "crate"}}]), *observe("p"),
          Hear("d", "world_layout", {"entities": Count(0), "removed": Count(1)}), *_sees("d"), _NEXT),
         fresh=True, variant=VARIANT),
    Case("R5.no-contacts-at-0", "There are no contacts before the first tick",
         (Join("d", _hello(subscription={"groups": ["CONTACTS"]})), join("p", "*"), *observe("p"),
          Hear("d", "world_layout"), Hear("d", "world_state", {"tick": 0, "contacts": Count(0)}), _NEXT),
         fresh=True, variant=VARIANT),
    Case("R6.order", "Acts of several directors are done in the order of their ids, whichever answers first",
         (join("p", "*"), *observe("p"), *_directs("d", "b"),
          *_directs("e", "a"), answer("p"), _says("d", acts=[_spawn("crate", "30,0,0")]), Pause(0.05), _says("e"),
          *observe("p"), Hear("d", "world_layout"), *_sees("d"), Hear("e", "world_layout"), *_sees("e"), answer("p"),
          _says("d", acts=[_move("crate", 40, 0, 0)]), Pause(0.05), _says("e", acts=[_move("crate", 50, 0, 0)]),
          *observe("p"), _remember("d"),
          Check("the last one counts", lambda stage: "" if abs(stage.memory["state"].poses[-7] - 40) < 1e-3
                else f"x is {stage.memory['state'].poses[-7]}; 40 is expected")), fresh=True, variant=VARIANT),
    _refused("An act on what is not there is UNKNOWN_ENTITY", "R7.unknown", "UNKNOWN_ENTITY",
             _move("nobody", 0.0, 0.0, 0.0)),
    _refused("One wrong act leaves out the others", "R7.whole", "UNKNOWN_ENTITY",
             _spawn("crate", "30,0,0"), {"remove": {"entity": "nobody"}}),
    _refused("What an act has removed is gone for later ones", "R7.removed", "UNKNOWN_ENTITY",
             {"remove": {"entity": "arm0"}}, _move("arm0", 0.0, 0.0, 3.0)),
    _refused("A spawned entity is there from the next tick on", "R7.spawned", "UNKNOWN_ENTITY",
             _spawn("crate", "30,0,0"), {"remove": {"entity": "crate"}}),
    Case("R7.left-out", "What can't be done when its turn comes is left out, with a warning",
         (_BOTH, answer("p"), _says("d", acts=[_spawn("one", "30,0,0"), _spawn("two", "30.01,0,0"),
                                               _spawn("three", "40,0,0")]),
          hear_error("d", "BAD_VALUE", "WARNING", field=Some()), *observe("p"),
          Hear("d", "world_layout", {"entities": Count(2)}), *_sees("d"), _NEXT), fresh=True, variant=VARIANT),
    _refused("An act has a kind", "R8.none", "BAD_VALUE", {}),
    _refused("A position has three values", "R8.position", "BAD_VALUE", _move("arm0", 0.0, 0.0)),
    _refused("… that are finite", "R8.finite", "BAD_VALUE", _move("arm0", 0.0, 0.0, float("nan"))),
    _refused("An element with a fault is BAD_VALUE", "R8.element", "BAD_VALUE", {"spawn": {"xml": "<box/>"}}),
    _refused("A force is bounded", "R8.force", "BAD_VALUE", {"push": {"entity": "arm0", "force": [0.0, 0.0, 2e6]}}),
    _refused("… and has three values", "R8.torque", "BAD_VALUE", {"push": {"entity": "arm0", "torque": [1.0]}}),
    _refused("A link that the entity does not have is UNKNOWN_ENTITY", "R8.link", "UNKNOWN_ENTITY",
             {"push": {"entity": "arm0", "link": "no such link"}}),
    _refused("LEDs that the controller sets are NOT_YOURS", "R8.leds", "NOT_YOURS",
             {"show": {"entity": "arm0", "led_colors": [1]}}),
    Case("R8.acts", "An entity is moved, pushed and shown before the next tick",
         (_BOTH, answer("p"), _says("d", acts=[_spawn("crate", "30,0,0")]), *observe("p"), Hear("d", "world_layout"),
          *_sees("d"), answer("p"), _says("d", acts=[_move("crate", 35.0, 0.0, 1.0),
                                                     {"push": {"entity": "crate", "torque": [0.0, 0.0, 0.001]}},
                                                     {"show": {"entity": "crate"}}]), *observe("p"), _remember("d"),
          Check("it is there", lambda stage: "" if abs(stage.memory["state"].poses[-7] - 35) < 1e-3
                else f"x is {stage.memory['state'].poses[-7]}; 35 is expected")), fresh=True, variant=VARIANT),
    _refused("The name of a metric is a plain one", "R9.metric", "BAD_VALUE",
             metrics=[{"name": "two words", "value": 1.0}]),
    Case("R9.taken", "A Direction may have metrics and lines",
         (_BOTH, answer("p"), _says("d", metrics=[{"name": "food", "value": 3.0}], log=[{"text": "hello"}]),
          *observe("p"), *_sees("d")), fresh=True, variant=VARIANT),
    Case("R9.leave", "A Leave of a director has its last ones, and no robots",
         (_BOTH, leave("d", 0), hear_error("d", "UNKNOWN_ROBOT"), answer("p"),
          leave("d", metrics=[{"name": "food", "value": 3.0}]), *observe("p")), fresh=True, variant=VARIANT),
    Case("R10.finish", "A director ends the run",
         (_BOTH, answer("p"), _says("d", finish={"result": "it stands"}),
          Hear("p", "end", {"reason": "FINISHED", "message": "it stands"}), Hear("d", "end", {"reason": "FINISHED"})),
         fresh=True, variant=VARIANT),
    _refused("A result has 1 KiB at most", "R10.long", "TOO_LARGE", finish={"result": "x" * 1025}),
    Case("R12.seen", "What is painted on the floor is seen from the next tick on, and stays; a reset forgets it",
         (_BOTH, answer("p"), _says("d"), *observe("p"), *_sees("d"), _ground(1, 1, 1, 1), answer("p"),
          _says("d", acts=[_paint(0.0, 0.0, size=(20.0, 20.0)), _paint(0.0, 9.0, color=0xFFFFFF)]), *observe("p"),
          *_sees("d"), _ground(0, 0, 0, 0), answer("p"), _says("d"), *observe("p"), *_sees("d"), _ground(0, 0, 0, 0),
          Join("s", hello(role="ROLE_SUPERVISOR"), {"robots": Count(0)}), ask("s", 1, reset={}), told("s", 1),
          Hear("p", "reset"), *observe("p"), Hear("d", "reset"), Hear("d", "world_layout"), *_sees("d"), answer("p"),
          _says("d"), *observe("p"), *_sees("d"), _ground(1, 1, 1, 1)),
         Level.RECONNECT, fresh=True, variant=VARIANT, scene="rovers"),
    *[_refused(title, f"R12.{name}", "BAD_VALUE", act) for name, title, act in (
        ("center", "A painted region has a centre", _paint(1.0)),
        ("size", "… and a size", _paint(0.0, 0.0, size=())),
        ("three", "… of no more than two numbers", _paint(0.0, 0.0, size=(1.0, 1.0, 1.0))),
        ("nothing", "… above 0", _paint(0.0, 0.0, size=(1.0, 0.0))),
        ("far", "… not too far away", _paint(2e6, 0.0)),
        ("nan", "… at numbers", _paint(float("nan"), 0.0)),
        ("color", "… and a colour", _paint(0.0, 0.0, color=0x1000000)),
        ("both", "… or an image alone", _lay(b"P5 1 1 255\nx", color=1)))],
    _refused("An image of the floor has 2 MiB at most", "R12.large", "TOO_LARGE", _lay(bytes((2 << 20) + 1))),
    _refused("… and is alone", "R12.several", "TOO_MANY", _lay(b"P5 1 1 255\nx"), _lay(b"P5 1 1 255\ny")),
    Case("R12.image", "An image covers the floor of the arena from the next tick on; what is no image is left out",
         (_BOTH, answer("p"), _says("d"), *observe("p"), *_sees("d"), _ground(1, 1, 1, 1), answer("p"),
          _says("d", acts=[_lay(b"P5 1 1 255\n\0")]), *observe("p"), *_sees("d"), _ground(0, 0, 0, 0), answer("p"),
          _says("d", acts=[_lay(b"GIF89a")]), hear_error("d", "BAD_VALUE", "WARNING", field=Some()), *observe("p"),
          *_sees("d"),
          _ground(0, 0, 0, 0)), Level.RECONNECT, fresh=True, variant=VARIANT, scene="rovers"),
]
