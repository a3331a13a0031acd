# SPDX-License-Identifier: MIT
"""What version 1.1 brought: dropped robots (W10), what a resumed session had commanded (L13), spawned robots
(V15); and 1.2: epochs (S13), snapshots (V11, V16, V17). Sessions of lower versions see none of it: the rules of
every session say so. And 1.3: metrics (S14)."""

from ..case import Case, Level
from ..messages import answer, hear_error, hello, join, leave, observe, send_hello
from ..steps import Check, Hang, Hear, Join, Send, Silence, Skip, Tick, Token
from ..wire import AtLeast, Count
from .deadlines import MS, policy
from .supervision import arm, ask, failed, told

_V11 = {"major": 1, "minor": 1}


def _joins(peer: str, *robots: str, **fields) -> Join:
    return Join(peer, hello(*robots, version=_V11, **fields), {"version": _V11})


def _resumes(peer: str, of: str, **pattern) -> list:
    return [send_hello(peer, version=_V11, session_token=Token(of)), Hear(peer, "welcome", {"resumed": pattern})]


def _same_command(stage) -> str:
    """What the Welcome says was commanded is a Command that changes nothing."""
    commanded = stage.peer("x").welcome.resumed.commanded
    fields = {field.name: list(value) if field.label == field.LABEL_REPEATED else value
              for field, value in commanded.ListFields()}
    stage.play((answer("x", **fields),))
    return ""


_DROPPED = [_joins("x", "arm0", "arm1", deadline_policy=policy("DROP")),
            join("y", "arm2", "arm3"), *observe("x", "y")]
_SPAWNING = [ask("s", 1, pause={}), Silence("s", 0.1)]
_SUPERVISOR = Join("s", hello(role="ROLE_SUPERVISOR"), {"robots": Count(0)})

_KEPT = [0.1, 0.2, 0.3, 0.4]  # joint targets
_V12 = {"major": 1, "minor": 2}


def _joins_12(peer: str, *robots: str, **fields) -> Join:
    return Join(peer, hello(*robots, version=_V12, **fields), {"version": _V12})


def _sees(peer: str, epoch: int) -> Hear:
    return Hear(peer, "observation", {"epoch": epoch})


def _answers(peer: str, epoch: int, **fields) -> Send:
    return answer(peer, epoch=epoch, **fields)


def _paused_12(**fields) -> list:
    """"p" has all robots of a world that is paused at tick 0, or the tick that it is at."""
    return [_joins_12("p", "*", **fields), Hear("p", "observation"), _SUPERVISOR, *_SPAWNING, answer("p"),
            told("s", 1), Hear("p", "paused")]


_V13 = {"major": 1, "minor": 3}


def _joins_13(peer: str, *robots: str, **fields) -> Join:
    return Join(peer, hello(*robots, version=_V13, **fields), {"version": _V13})


def _metric(**fields) -> list:
    return [{"robot": 0, "name": "x", "value": 1.0, **fields}]


CASES = [
    Case("H2.minor-3", "The version 1.3 is agreed upon with a client of 1.3", (_joins_13("p", "arm0"),)),
    Case("S14.taken", "A Command may have metrics",
         (_joins_13("p", "*"), Hear("p", "observation"), answer("p", metrics=_metric(name="a.b-c_9")),
          Hear("p", "observation"))),
    Case("S14.name", "The name of a metric is BAD_VALUE if it is no plain one",
         (_joins_13("p", "*"), Hear("p", "observation"),
          *[step for name in ("", "two words", "a/b", "é", "a\n", "x" * 65)
            for step in (answer("p", metrics=_metric(name=name)), hear_error("p", "BAD_VALUE"))],
          answer("p"), Hear("p", "observation"))),
    Case("S14.finite", "A metric that is not finite is BAD_VALUE",
         (_joins_13("p", "*"), Hear("p", "observation"),
          *[step for value in ("nan", "inf", "-inf")
            for step in (answer("p", metrics=_metric(value=float(value))), hear_error("p", "BAD_VALUE"))],
          answer("p"), Hear("p", "observation"))),
    Case("S14.robot", "A metric of a robot that the session does not have is UNKNOWN_ROBOT",
         (_joins_13("p", "*"), Hear("p", "observation"), answer("p", metrics=_metric(robot=4)),
          hear_error("p", "UNKNOWN_ROBOT"), answer("p"), Hear("p", "observation"))),
    Case("S14.too-many", "A robot has 100 names of metrics in a run; one more is TOO_MANY",
         (_joins_13("p", "*"), Hear("p", "observation"),
          answer("p", metrics=[{"robot": robot, "name": f"m{i}", "value": 1.0} for robot in (0, 1) for i in range(100)]),
          Hear("p", "observation"), answer("p", metrics=_metric(name="one.more")), hear_error("p", "TOO_MANY"),
          answer("p", metrics=_metric(name="m7")), Hear("p", "observation")), fresh=True),
    Case("S14.not-for-1.2", "A session of 1.2 has no metrics: the field is unknown and ignored",
         (_joins_12("p", "*"), Hear("p", "observation"), answer("p", metrics=_metric(name="two words")),
          Hear("p", "observation"))),
    Case("H2.minor-1", "The version 1.1 is agreed upon with a client of 1.1, and 1.0 with one of 1.0",
         (_joins("p", "arm0"), Join("q", hello("arm1"), {"version": {"major": 1, "minor": 0}}))),
    Case("W10.told", "A session whose robots are dropped is told which",
         (_DROPPED, answer("y"), *observe("y"), hear_error("x", "DEADLINE_MISSED", "WARNING"),
          hear_error("x", "ROBOTS_DROPPED", "WARNING", dropped={"robots": [0, 1]}, tick=Tick())),
         Level.HIL, fresh=True),
    Case("W10.others-stay", "Those that are dropped have left; a session of 1.0 is not told",
         (join("x", "arm0", deadline_policy=policy("DROP")), join("y", "arm1", "arm2", "arm3"),
          *observe("x", "y"), answer("y"), *observe("y"), hear_error("x", "DEADLINE_MISSED", "WARNING"),
          Silence("x", MS / 1000), send_hello("z", "arm0"),
          Hear("z", "refusal", {"error": {"code": "NOT_YOURS"}})), Level.HIL, fresh=True),
    Case("L13.commanded", "A resumed session is told what it had commanded, and the same again is legal",
         (_joins("p", "*"), *observe("p"),
          answer("p", joint_targets=[0.1, 0.2, 0.3, 0.4], led_colors=[1, 2, 3, 0xFFFFFF],
                 range_and_bearing_data=bytes(range(8))), *observe("p"), Hang("p"),
          _resumes("x", "p", commanded={"joint_targets": [0.1, 0.2, 0.3, 0.4],
                                        "led_colors": [1, 2, 3, 0xFFFFFF],
                                        "range_and_bearing_data": bytes(range(8))}, gone_robots=[]),
          *observe("x"), Check("the same again", _same_command), *observe("x"),
          answer("x", joint_targets=[0.0] * 4), *observe("x")), Level.RECONNECT),
    Case("L13.not-the-last-only", "Values of earlier Commands are there, too",
         (_joins("p", "*"), *observe("p"), answer("p", joint_targets=[0.5] * 4), *observe("p"),
          answer("p", robots=[2], joint_targets=[0.0]), *observe("p"), answer("p"), *observe("p"), Hang("p"),
          _resumes("x", "p", commanded={"joint_targets": [0.5, 0.5, 0.0, 0.5]}), *observe("x"),
          answer("x", joint_targets=[0.0] * 4), *observe("x")), Level.RECONNECT),
    Case("L13.gone", "… and which of its robots have left",
         (_joins("p", "*"), *observe("p"), leave("p", 1), answer("p"), *observe("p"), Hang("p"),
          _resumes("x", "p", gone_robots=[1]), *observe("x"), answer("x"), *observe("x")),
         Level.RECONNECT, fresh=True),
    Case("L13.not-for-1.0", "A session of 1.0 that is resumed is told nothing of it",
         (join("p", "*"), *observe("p"), answer("p"), *observe("p"), Hang("p"),
          send_hello("x", session_token=Token("p")), Hear("x", "welcome"), *observe("x")), Level.RECONNECT),
    Case("V15.told", "A session is told of a robot that was spawned with its controller, before the response",
         (_joins("p", "*"), *observe("p"), _SUPERVISOR, _SPAWNING, answer("p"), told("s", 1), Hear("p", "paused"),
          ask("s", 2, spawn={"xml": arm("arm9")}),
          Hear("p", "robot_spawned", {"robot": "arm9", "controller": "steady", "tick": Tick()}), told("s", 2), Silence("p")),
         Level.RECONNECT, fresh=True),
    Case("V15.not-others", "Sessions of other controllers are not told, nor is one of 1.0",
         (_joins("p", "arm3"), join("q", "arm0", "arm1", "arm2"), *observe("p", "q"), _SUPERVISOR, _SPAWNING,
          answer("p"), answer("q"), told("s", 1), Hear("p", "paused"), Hear("q", "paused"),
          ask("s", 2, spawn={"xml": arm("arm9")}), told("s", 2), Silence("p"), Silence("q")),
         Level.RECONNECT, fresh=True),
    Case("H2.minor-2", "The version 1.2 is agreed upon with a client of 1.2", (_joins_12("p", "arm0"),)),
    Case("S13.epoch", "Observations of a session of 1.2 have an epoch, and a reset begins another",
         (*_paused_12(), ask("s", 2, reset={}), Hear("p", "reset", {"epoch": AtLeast(1)}),
          Hear("p", "observation", {"epoch": AtLeast(1)}), told("s", 2), ask("s", 3, resume={}), told("s", 3)), fresh=True),
    Case("S13.stale", "A Command of an earlier epoch is STALE_TICK, also for the same tick",
         (_joins_12("p", "*"), _sees("p", 0), _SUPERVISOR, ask("s", 1, reset={}), Hear("p", "reset", {"epoch": 1}),
          _sees("p", 1), told("s", 1), _answers("p", 0), hear_error("p", "STALE_TICK"), _answers("p", 1),
          _sees("p", 1)), Level.RECONNECT, fresh=True),
    Case("S13.future", "One of a later epoch is FUTURE_TICK",
         (_joins_12("p", "*"), Hear("p", "observation"), _answers("p", 99), hear_error("p", "FUTURE_TICK"),
          answer("p"), Hear("p", "observation")), fresh=True),
    Case("S13.not-for-1.1", "A session of 1.1 has no epochs: the field is unknown and ignored",
         (_joins("p", "*"), *observe("p"), answer("p", epoch=5), *observe("p"))),
    Case("S13.absent", "A Command without epoch answers the last Observation",
         (_joins_12("p", "*"), Hear("p", "observation"), answer("p"), Hear("p", "observation"))),
    Case("V11.snapshot", "The world can be kept, and restored: Restored, then the Observation of its tick",
         (*_paused_12(can_restore=True), ask("s", 2, step={"ticks": 2}),
          Hear("p", "observation"), answer("p", joint_targets=_KEPT), Hear("p", "observation"), answer("p"),
          told("s", 2), Skip("p", "paused"), ask("s", 3, snapshot={"name": "here"}), told("s", 3, tick=2),
          ask("s", 4, step={"ticks": 3}),
          *[step for _ in range(3) for step in (Hear("p", "observation"), answer("p", joint_targets=[0.0] * 4))],
          told("s", 4, tick=5), Skip("p", "paused"), ask("s", 5, restore={"name": "here"}),
          Hear("p", "restored", {"snapshot": "here", "tick": 2, "epoch": 1, "commanded": {"joint_targets": _KEPT}}),
          Hear("p", "observation", {"tick": 2, "epoch": 1}), told("s", 5, tick=2), answer("p"), Hear("p", "paused"),
          ask("s", 6, resume={}), told("s", 6)), Level.RECONNECT, fresh=True),
    Case("V11.name", "The name of a snapshot is BAD_VALUE if it is no plain one",
         (*_paused_12(), *[step for number, name in enumerate(("", ".x", "a/b", "../a", "x" * 65), 2)
                           for step in (ask("s", number, snapshot={"name": name}), failed("s", number, "BAD_VALUE"))],
          ask("s", 9, resume={}), told("s", 9)), Level.RECONNECT, fresh=True),
    Case("V16.unknown", "To restore what was not kept is BAD_VALUE",
         (*_paused_12(can_restore=True), ask("s", 2, restore={"name": "nothing"}), failed("s", 2, "BAD_VALUE"),
          ask("s", 3, resume={}), told("s", 3)), Level.RECONNECT, fresh=True),
    Case("V17.refused", "The world is not restored while a session has not said that it can go back",
         (*_paused_12(), ask("s", 2, snapshot={"name": "here"}), told("s", 2), ask("s", 3, restore={"name": "here"}),
          failed("s", 3, "OUT_OF_STATE"), ask("s", 4, resume={}), told("s", 4)), Level.RECONNECT, fresh=True),
]
