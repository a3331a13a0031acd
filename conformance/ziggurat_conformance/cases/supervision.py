# SPDX-License-Identifier: MIT
"""Section 9: supervision."""

import math
import re

from ..case import Case, Level
from ..messages import ALL, answer, hear_refusal, hello, join, leave, observe, send_hello
from ..server_scene import SCENE
from ..steps import Check, Hear, Join, Send, ServerEnds, Silence, Skip, Tick
from ..wire import Count, OneOf, Some


def _comes(peer: str = "s", role: str = "ROLE_SUPERVISOR", **more) -> Join:
    return Join(peer, hello(**{"role": role, "client_name": "supervisor", **more}), {"robots": Count(0)})


def ask(peer: str, id: int, **request) -> Send:
    return Send(peer, {"request": {"id": id, **request}})


def told(peer: str, id: int, **pattern) -> Hear:
    """The request was done."""
    return Hear(peer, "response", {"id": id, "error": {"code": "CODE_UNSPECIFIED"}, **pattern})


def failed(peer: str, id: int, code: str) -> Hear:
    return Hear(peer, "response", {"id": id, "error": {"code": code, "message": Some()}})


def _pausing(id: int = 1) -> list:
    """The request has arrived before any session answers: it is not answered while the tick is owed."""
    return [ask("s", id, pause={}), Silence("s", 0.1)]


def _paused(**more) -> list:
    """s has paused the world, of which p has all robots and has answered."""
    return [*ALL, _comes(**more), *_pausing(), answer("p"), told("s", 1, tick=Tick(of="p")), Hear("p", "paused")]


def _resumed(first: int = 90) -> list:
    return [ask("s", first, resume={}), told("s", first), *observe("p")]


def _stepping() -> list:
    """s steps the world, far; p owes the first of its ticks; t is a supervisor, too."""
    return [*_paused(), _comes("t"), ask("s", 2, step={"ticks": 1000}), *observe("p")]


def _holds_up(stage) -> str:
    """The status names p as the one that owes its answer."""
    status = stage.memory["status"]
    owing = [s for s in status.sessions if s.state == 2]
    if len(owing) != 1:
        return f"{len(owing)} sessions are OWING; expected one"
    return "" if list(owing[0].robots) == [f"arm{i}" for i in range(4)] else "it names other robots"


def _ask_status(stage) -> str:
    stage.play((ask("s", 5, status={}),))
    message = stage.peer("s").hear(stage.patience)
    if message is None or not message.response.HasField("status"):
        return "no status came"
    stage.memory["status"] = message.response.status
    return ""


def read_hash(id: int, name: str):
    def read(stage) -> str:
        stage.play((ask("s", id, read={"entities": ["arm0"]}),))
        message = stage.peer("s").hear(stage.patience)
        if message is None or not message.response.HasField("states"):
            return "no states came"
        stage.memory[name] = message.response.states.hash
        return ""

    return Check("read", read)


def same_hash(first: str, second: str) -> Check:
    return Check("hash", lambda stage: "" if stage.memory[first] == stage.memory[second]
                 else "the two states are not the same")


def _moved(stage) -> str:
    stage.play((ask("s", 8, read={"entities": ["arm0"]}),))
    entity = stage.peer("s").hear(stage.patience).response.states.entities[0]
    found = [round(v, 9) for v in entity.position]
    return "" if found == [1.0, 1.0, 0.0] else f"arm0 is at {found}; expected 1, 1, 0"


def _still_turned(stage) -> str:
    """arm0 was turned by a move, and then moved without an orientation."""
    stage.play((ask("s", 8, read={"entities": ["arm0"]}),))
    entity = stage.peer("s").hear(stage.patience).response.states.entities[0]
    found = [round(v, 9) for v in (*entity.position, *entity.orientation)]
    expected = [0.9, 1.0, 0.0, *_TURNED]
    return "" if found == expected else f"arm0 is at {found}; expected {expected}"


def _bent(stage) -> str:
    """The hinge of arm0 is at an angle about z: its lamp's link has turned by it."""
    stage.play((ask("s", 8, read={"entities": ["arm0"]}),))
    entity = stage.peer("s").hear(stage.patience).response.states.entities[0]
    hand = next(link for link in entity.links if link.id == "hand")
    found = [round(v, 9) for v in (*entity.position, *hand.orientation, *hand.angular_velocity)]
    expected = [0.3, 0.3, 0.0, *_TURNED, 0.0, 0.0, 2.5]
    return "" if found == expected else f"arm0 and its hand are at {found}; expected {expected}"


def _v(name: str, title: str, *steps, level: Level = Level.RECONNECT, **more) -> Case:
    return Case(name, title, tuple(steps), level, **more)


def arm(id: str) -> str:
    """An arm like arm0, in a place of its own."""
    arm = re.search(r'<prototype id="arm0".*?</prototype>', SCENE.read_text(), re.DOTALL)[0]
    return arm.replace('"arm0"', f'"{id}"').replace("0.3, 0.3, 0", "1, 1, 0")


def _spawned(id: int, xml: str) -> list:
    return [ask("s", id, spawn={"xml": xml}), told("s", id)]


def _removed(id: int, entity: str) -> list:
    return [ask("s", id, remove={"entity": entity}), told("s", id)]


_V14 = {"major": 1, "minor": 4}
_TURNED = [0.8, 0.0, 0.0, 0.6]  # a unit quaternion
_BOX = '<box id="crate" size="0.1,0.1,0.1" movable="false"><body position="1.5,1.5,0"/></box>'

CASES = [
    _v("V1.supervisor", "A supervisor is welcome and has no robots", _comes()),
    _v("V1.observer", "An observer is welcome and has no robots", _comes("o", "ROLE_OBSERVER")),
    _v("V1.robots", "A supervisor may not ask for robots",
       send_hello("s", "arm0", role="ROLE_SUPERVISOR"), hear_refusal("s", "BAD_VALUE")),
    _v("V1.not-in-the-barrier", "The world does not wait for supervisors",
       *ALL, _comes(), answer("p"), *observe("p"), Silence("s")),
    _v("V1.many", "Several supervisors and observers may be there",
       _comes("s"), _comes("t"), _comes("o", "ROLE_OBSERVER"), _comes("u", "ROLE_OBSERVER"), *ALL,
       answer("p"), *observe("p")),
    _v("V2.id", "A response has its request's id", *ALL, _comes(), ask("s", 2**63, status={}),
       told("s", 2**63, status={"tick": Tick(of="p")})),
    _v("V2.order", "Responses come in the order of requests", *ALL, _comes(),
       *[ask("s", n, status={}) for n in range(1, 11)], *[told("s", n) for n in range(1, 11)]),
    _v("V2.tick", "A response has the tick that it is true of", *ALL, answer("p"), *observe("p"), answer("p"), *observe("p"),
       _comes(), ask("s", 1, status={}), told("s", 1, tick=Tick(of="p")), ask("s", 2, read={}), told("s", 2, tick=Tick(of="p"))),
    _v("V2.empty", "A Request without a request is BAD_VALUE", *ALL, _comes(), ask("s", 3),
       failed("s", 3, "BAD_VALUE")),
    _v("V3.status", "An observer may ask for the status", *ALL, _comes("o", "ROLE_OBSERVER"),
       ask("o", 1, status={}), told("o", 1)),
    _v("V3.read", "An observer may read", *ALL, _comes("o", "ROLE_OBSERVER"), ask("o", 1, read={}),
       told("o", 1, states={"entities": Count(4), "hash": Some()})),
    *[_v(f"V3.{name}", f"An observer may not {name}", *ALL, _comes("o", "ROLE_OBSERVER"),
         ask("o", 1, **{name: {}}), failed("o", 1, "FORBIDDEN"), answer("p"), *observe("p"),
         level=Level.SECURE)
      for name in ("pause", "resume", "step", "reset", "spawn", "remove", "move", "shutdown")],
    _v("V4.pause", "Paused, no tick comes; resumed, it goes on", *_paused(), Silence("p", 0.3),
       *_resumed(), answer("p"), *observe("p")),
    _v("V4.twice", "Pausing a paused world is answered at once", *_paused(), ask("s", 2, pause={}),
       told("s", 2), *_resumed()),
    _v("V4.resume-running", "Resuming a world that runs changes nothing", *ALL, _comes(),
       ask("s", 1, resume={}), told("s", 1), answer("p"), *observe("p")),
    _v("V4.not-before", "Pause is answered when the tick is complete", *ALL, _comes(),
       ask("s", 1, pause={}), Silence("s"), answer("p"), told("s", 1), Hear("p", "paused"),
       *_resumed()),
    _v("P1.told", "Sessions are told that the world is paused", *ALL, _comes(), *_pausing(),
       answer("p"), Hear("p", "paused", {"tick": Tick()}), Skip("s", "response"), *_resumed()),
    _v("P1.command", "A Command in PAUSED is DUPLICATE_TICK", *_paused(), answer("p"),
       Hear("p", "error", {"code": "DUPLICATE_TICK"}), *_resumed()),
    _v("P2.late", "Who comes while it is paused gets its tick, and after its answer is told",
       join("p", "arm0", "arm1", "arm2"), join("q", "arm3"), *observe("p", "q"), _comes(),
       *_pausing(), answer("p"), answer("q"), told("s", 1), Hear("p", "paused"),
       Hear("q", "paused"), ask("s", 2, resume={}), told("s", 2), *observe("p", "q")),
    _v("V5.step", "A step moves a paused world by its ticks", *_paused(), ask("s", 2, step={"ticks": 2}),
       *observe("p"), answer("p"), *observe("p"), answer("p"), told("s", 2, tick=Tick(of="p")), Hear("p", "paused"),
       Silence("p"), *_resumed()),
    _v("V5.running", "A step of a world that runs is OUT_OF_STATE", *ALL, _comes(),
       ask("s", 1, step={"ticks": 1}), failed("s", 1, "OUT_OF_STATE"), answer("p"), *observe("p")),
    _v("V5.none", "A step of 0 ticks is BAD_VALUE", *_paused(), ask("s", 2, step={"ticks": 0}),
       failed("s", 2, "BAD_VALUE"), *_resumed()),
    _v("V5.left", "Steps end with the session that asked for them", *_stepping(), leave("s"), Silence("p", 0.1), answer("p"),
       Hear("p", "paused"), Silence("p"), ask("t", 1, step={"ticks": 1}), *observe("p"), answer("p"), told("t", 1),
       Hear("p", "paused"), ask("t", 2, resume={}), told("t", 2), *observe("p"), fresh=True),
    _v("V5.reset", "Another's reset ends steps, and those that wait; the world is paused", *_stepping(), _comes("u"),
       ask("u", 1, step={"ticks": 1}), Silence("u", 0.1), ask("t", 1, reset={}), failed("s", 2, "OUT_OF_STATE"),
       failed("u", 1, "OUT_OF_STATE"), told("t", 1), Hear("p", "reset"), Hear("p", "observation", {"tick": 0}),
       answer("p"), Hear("p", "paused", {"tick": 0}), Silence("p"), ask("t", 2, resume={}), told("t", 2),
       Hear("p", "observation", {"tick": 1}), fresh=True),
    _v("V19.pause", "A pause that waits for its own program's answer is OUT_OF_STATE, and has no effect", *ALL, _comes(version=_V14),
       ask("s", 1, pause={}, held_up=["arm1"]), failed("s", 1, "OUT_OF_STATE"), answer("p"), *observe("p")),
    _v("V19.others", "A pause that waits for others is answered as ever", *ALL, _comes(version=_V14),
       ask("s", 1, pause={}, held_up=["nobody"]), Silence("s", 0.1), answer("p"), told("s", 1, tick=Tick(of="p")),
       Hear("p", "paused"), ask("s", 2, pause={}, held_up=["arm1"]), told("s", 2), *_resumed()),
    _v("V19.step", "So is a step, which would wait for its own program", *_paused(version=_V14),
       ask("s", 2, step={"ticks": 1}, held_up=["arm0"]), failed("s", 2, "OUT_OF_STATE"), Silence("p", 0.2), *_resumed()),
    _v("V19.many", "It names 64 at most", *ALL, _comes(version=_V14), ask("s", 1, pause={}, held_up=["x"] * 65),
       failed("s", 1, "TOO_MANY"), answer("p"), *observe("p")),
    _v("V6.reset", "After a reset the world is at tick 0", *ALL, _comes(), ask("s", 1, reset={}),
       Skip("p", "reset"), Hear("p", "observation", {"tick": 0}), told("s", 1, tick=0), answer("p"),
       Hear("p", "observation", {"tick": 1}), fresh=True),
    _v("V6.seed", "A reset may set the seed", *ALL, _comes(), ask("s", 1, reset={"seed": 99}),
       Hear("p", "reset", {"seed": 99}), Hear("p", "observation", {"tick": 0}), told("s", 1),
       fresh=True),
    _v("V6.same", "States after a reset are those of before, bit for bit",
       *ALL, answer("p"), *observe("p"), answer("p"), *observe("p"), _comes(), read_hash(1, "before"),
       ask("s", 2, reset={}), Skip("p", "reset"), *observe("p"), Skip("s", "response"), answer("p"),
       *observe("p"), answer("p"), *observe("p"), read_hash(3, "after"), same_hash("before", "after"),
       fresh=True),
    _v("V6.void", "What was owed before a reset is void", *ALL, _comes(), ask("s", 1, reset={}),
       Skip("p", "reset"), *observe("p"), answer("p", 5), Hear("p", "error", {"code": "FUTURE_TICK"}),
       answer("p"), *observe("p"), fresh=True),
    _v("V6.seed-0", "A seed of 0 is BAD_VALUE", *ALL, _comes(), ask("s", 1, reset={"seed": 0}),
       answer("p"), failed("s", 1, "BAD_VALUE"), *observe("p")),
    _v("V7.all", "Read without a name gives all entities", *ALL, _comes(), ask("s", 1, read={}),
       told("s", 1, states={"entities": Count(4)})),
    _v("V7.some", "Read by glob, in scene order", *ALL, _comes(),
       ask("s", 1, read={"entities": ["arm[23]", "arm0"]}),
       told("s", 1, states={"entities": [{"id": "arm0"}, {"id": "arm2"}, {"id": "arm3"}]})),
    _v("V7.unknown", "An entity that is not there is UNKNOWN_ENTITY", *ALL, _comes(),
       ask("s", 1, read={"entities": ["nobody"]}), failed("s", 1, "UNKNOWN_ENTITY")),
    _v("V8.move", "An entity may be moved", *_paused(),
       ask("s", 2, move={"entity": "arm0", "position": [1.0, 1.0, 0.0]}), told("s", 2),
       Check("moved", _moved), *_resumed(), fresh=True),
    _v("V8.still-turned", "A move without an orientation leaves it as it is", *_paused(),
       ask("s", 2, move={"entity": "arm0", "position": [1.0, 1.0, 0.0], "orientation": _TURNED}), told("s", 2),
       ask("s", 3, move={"entity": "arm0", "position": [0.9, 1.0, 0.0]}), told("s", 3),
       Check("turned", _still_turned), *_resumed(), fresh=True),
    _v("V8.overlap", "A move onto another entity is BAD_VALUE", *_paused(), *_spawned(2, _BOX),
       ask("s", 3, move={"entity": "arm0", "position": [1.5, 1.5, 0.0]}), failed("s", 3, "BAD_VALUE"), *_resumed(), fresh=True),
    _v("V8.may-overlap", "A move that may overlap is done", *_paused(), *_spawned(2, _BOX),
       ask("s", 3, move={"entity": "arm0", "position": [1.5, 1.5, 0.0], "may_overlap": True}), told("s", 3), *_resumed(),
       fresh=True),
    _v("V20.set", "A joint may be set to a position and a speed; the rest stays", *_paused(version=_V14),
       ask("s", 2, set_joint={"entity": "arm0", "joint": "hinge", "position": 2 * math.atan2(0.6, 0.8), "velocity": 2.5}),
       told("s", 2), Check("bent", _bent), *_resumed(), fresh=True),
    _v("V20.unknown", "An entity or a joint that is not there is UNKNOWN_ENTITY", *_paused(version=_V14),
       ask("s", 2, set_joint={"entity": "nobody", "joint": "hinge"}), failed("s", 2, "UNKNOWN_ENTITY"),
       ask("s", 3, set_joint={"entity": "arm0", "joint": "knee"}), failed("s", 3, "UNKNOWN_ENTITY"), *_resumed()),
    *[_v(f"V20.{name}", f"A {what} is BAD_VALUE", *_paused(version=_V14),
         ask("s", 2, set_joint={"entity": "arm0", "joint": "hinge", **motion}), failed("s", 2, "BAD_VALUE"), *_resumed())
      for name, what, motion in (("nan", "position that is no number", {"position": math.nan}),
                                 ("fast", "velocity beyond 10^6", {"velocity": 1.1e6}))],
    _v("V18.free", "A place with nothing in it is free", *_paused(),
       ask("s", 2, is_free={"entity": "arm0", "position": [1.5, 1.5, 0.0]}), told("s", 2, place={"overlapped": ""}),
       *_resumed()),
    _v("V18.taken", "A place that is taken is told with what is there, also of an element", *_paused(), *_spawned(2, _BOX),
       ask("s", 3, is_free={"entity": "arm0", "position": [1.5, 1.5, 0.0]}), told("s", 3, place={"overlapped": "crate"}),
       ask("s", 4, is_free={"xml": '<sphere radius="0.05"/>', "position": [1.5, 1.5, 0.0]}),
       told("s", 4, place={"overlapped": "crate"}), *_resumed(), fresh=True),
    _v("V18.wrong", "What is not there is UNKNOWN_ENTITY, and no element BAD_VALUE", *_paused(),
       ask("s", 2, is_free={"entity": "nobody", "position": [0.0, 0.0, 0.0]}), failed("s", 2, "UNKNOWN_ENTITY"),
       ask("s", 3, is_free={"xml": "<sphere/>", "position": [0.0, 0.0, 0.0]}), failed("s", 3, "BAD_VALUE"), *_resumed()),
    _v("V8.unknown", "Moving what is not there is UNKNOWN_ENTITY", *ALL, _comes(),
       ask("s", 1, move={"entity": "nobody", "position": [0.0, 0.0, 0.0]}), answer("p"),
       failed("s", 1, "UNKNOWN_ENTITY"), *observe("p")),
    *[_v(f"V8.{name}", f"A pose that is {name} is BAD_VALUE", *_paused(),
         ask("s", 2, move={"entity": "arm0", **pose}), failed("s", 2, "BAD_VALUE"), *_resumed())
      for name, pose in (("short", {"position": [1.0]}), ("nan", {"position": [math.nan, 0.0, 0.0]}),
                         ("absent", {}), ("far", {"position": [1.1e6, 0.0, 0.0]}),
                         ("of-three-angles", {"position": [0.0] * 3, "orientation": [1.0, 0.0, 0.0]}),
                         ("turned-by-nothing", {"position": [0.0] * 3, "orientation": [0.0] * 4}))],
    _v("V9.spawn", "An entity may be spawned and read", *_paused(), *_spawned(2, _BOX),
       ask("s", 3, read={"entities": ["crate"]}),
       told("s", 3, states={"entities": [{"position": [1.5, 1.5, 0.0]}]}), *_resumed(), fresh=True),
    _v("V9.waited", "A robot that was spawned is waited for from the next tick on", *_paused(),
       *_spawned(2, arm("arm9")), *_resumed(), answer("p"), Silence("p"),
       join("q", "arm9"), *observe("q"), Silence("p"), answer("q"), *observe("p", "q"), answer("p"),
       answer("q"), *observe("p", "q"), fresh=True),
    _v("V9.taken", "It may be taken at once, and gets the current tick", *_paused(),
       *_spawned(2, arm("arm9")), join("q", "arm9"), Hear("q", "observation", {"tick": Tick(of="p")}),
       answer("q"), Hear("q", "paused"), ask("s", 3, resume={}), told("s", 3), *observe("p", "q"),
       fresh=True),
    _v("V9.overlap", "A place that is taken is BAD_VALUE", *_paused(),
       ask("s", 2, spawn={"xml": _BOX.replace("1.5,1.5,0", "0.35,0.3,0")}),
       failed("s", 2, "BAD_VALUE"), *_resumed()),
    _v("V9.not-in-the-arena", "What has no body is BAD_VALUE", *_paused(),
       ask("s", 2, spawn={"xml": '<distribute/>'}), failed("s", 2, "BAD_VALUE"), *_resumed()),
    _v("V9.no-effect", "What is BAD_VALUE had no effect", *_paused(),
       ask("s", 2, spawn={"xml": _BOX.replace("false", "perhaps")}), failed("s", 2, "BAD_VALUE"),
       ask("s", 3, read={"entities": ["crate"]}), failed("s", 3, "UNKNOWN_ENTITY"), *_resumed()),
    _v("V9.bad-xml", "What is no entity is BAD_VALUE", *_paused(),
       ask("s", 2, spawn={"xml": "<box id="}), failed("s", 2, "BAD_VALUE"), *_resumed()),
    _v("V9.bad-entity", "Nor is a faulty one", *_paused(),
       ask("s", 2, spawn={"xml": '<box id="x" movable="maybe"/>'}), failed("s", 2, "BAD_VALUE"),
       *_resumed()),
    _v("V9.taken-id", "Nor one whose id is taken", *_paused(),
       ask("s", 2, spawn={"xml": _BOX.replace("crate", "arm0")}), failed("s", 2, "BAD_VALUE"),
       *_resumed()),
    _v("V13.remove", "An entity may be removed, and its id used again", *_paused(),
       *_spawned(2, _BOX), *_removed(3, "crate"), ask("s", 4, read={"entities": ["crate"]}),
       failed("s", 4, "UNKNOWN_ENTITY"), *_spawned(5, _BOX), ask("s", 6, read={"entities": ["crate"]}),
       told("s", 6, states={"entities": Count(1)}), *_resumed(), fresh=True),
    _v("V13.robot", "The session of a robot that is removed is told, and goes on", *_paused(),
       *_removed(2, "arm1"), Hear("p", "error", {"code": "NOT_YOURS", "severity": "WARNING",
                                                 "robot": "arm1"}),
       *_resumed(), answer("p"), Hear("p", "observation", {"joint_readings": Count(4)}), fresh=True),
    _v("V13.last", "A session whose last robot is removed is over; no tick waits for it",
       join("p", "arm0"), join("q", "arm1", "arm2", "arm3"), *observe("p", "q"), _comes(),
       *_removed(1, "arm0"), Hear("p", "end", {"reason": "FINISHED"}), answer("q"), *observe("q"),
       fresh=True),
    _v("V13.gone", "A robot that was removed has left", *_paused(), *_removed(2, "arm1"),
       send_hello("q", "arm1"), hear_refusal("q", "NOT_YOURS"), Skip("p", "error"), *_resumed(),
       fresh=True),
    _v("V14.gone", "After a reset, what was spawned is gone", *_paused(), *_spawned(2, _BOX),
       ask("s", 3, reset={}), Skip("p", "reset"), *observe("p"), told("s", 3),
       ask("s", 4, read={"entities": ["crate"]}), failed("s", 4, "UNKNOWN_ENTITY"), fresh=True),
    _v("V14.back", "After a reset, what was removed is back", *_paused(), *_removed(2, "arm1"),
       ask("s", 3, reset={}), Skip("p", "reset"), *observe("p"), told("s", 3),
       ask("s", 4, read={}), told("s", 4, states={"entities": Count(4)}), fresh=True),
    _v("V14.session", "A session with a robot that was spawned ends with a reset", *_paused(),
       *_spawned(2, arm("arm9")), join("q", "arm9"), *observe("q"), ask("s", 3, reset={}),
       Hear("q", "end", {"reason": "FINISHED"}), Hear("p", "reset"), *observe("p"), told("s", 3),
       send_hello("r", "arm9"), hear_refusal("r", "UNKNOWN_ROBOT"), fresh=True),
    _v("V13.unknown", "Removing what is not there is UNKNOWN_ENTITY", *_paused(),
       ask("s", 2, remove={"entity": "nobody"}), failed("s", 2, "UNKNOWN_ENTITY"), *_resumed()),
    _v("V10.shutdown", "Shutdown is answered, and the run ends", *ALL, _comes(),
       ask("s", 1, shutdown={}), told("s", 1), Skip("p", "end"), Skip("s", "end"), fresh=True),
    _v("V10.reason", "Shutdown with a reason of up to 1 KiB is a planned end: FINISHED, and exit code 0", *ALL, _comes(),
       ask("s", 1, shutdown={"reason": "x" * 1024}), told("s", 1),
       Hear("p", "end", {"reason": "FINISHED", "message": Some()}), Hear("s", "end", {"reason": "FINISHED"}), leave("p"),
       leave("s"), ServerEnds(0), fresh=True),
    _v("V10.long-reason", "A longer reason is refused, and the run goes on", *ALL, _comes(),
       ask("s", 1, shutdown={"reason": "x" * 1025}),
       Hear("s", "response", {"id": 1, "error": {"code": OneOf(("TOO_LARGE", "BAD_VALUE"))}}), answer("p"), *observe("p"),
       fresh=True),
    _v("L1.exit-code", "A run in which a controller has failed ends with exit code 3", *ALL, _comes(),
       leave("p", 0, reason="FAILED", message="x.lua:3: oh"), answer("p"), *observe("p"),
       ask("s", 1, shutdown={"reason": "enough"}), told("s", 1), Skip("p", "end"), leave("p"), leave("s"), ServerEnds(3), fresh=True),
    _v("V12.who", "The status names the session that the world waits for", *ALL, _comes(),
       Check("status", _ask_status), Check("owing", _holds_up), answer("p"), *observe("p")),
    _v("V12.phase", "The status tells whether the world runs or is paused", *ALL, _comes(),
       ask("s", 1, status={}), told("s", 1, status={"phase": "RUNNING", "seed": 7}), answer("p"),
       *observe("p"), *_pausing(2), answer("p"), told("s", 2), ask("s", 3, status={}),
       told("s", 3, status={"phase": "PAUSED"}), ask("s", 4, resume={}), told("s", 4)),
    _v("V12.free", "The status names free robots", join("p", "arm1"), _comes(),
       ask("s", 1, status={}), told("s", 1, status={"phase": OneOf(("GATHERING", "RUNNING")),
                                                    "free_robots": ["arm0", "arm2", "arm3"]}),
       fresh=True),
]
