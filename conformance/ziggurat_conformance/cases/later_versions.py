"""What version 1.1 brought: dropped robots (W10), what a resumed session had commanded (L13), spawned robots
(V15). A session of 1.0 sees none of it: the rules of every session say so."""

from ..case import Case, Level
from ..messages import answer, hear_error, hello, join, leave, observe, send_hello
from ..steps import Check, Hang, Hear, Join, Silence, Tick, Token
from ..wire import Count
from .deadlines import MS, policy
from .supervision import arm, ask, told

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

CASES = [
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
          Hear("p", "robot_spawned", {"robot": "arm9", "controller": "steady"}), told("s", 2)),
         Level.RECONNECT, fresh=True),
    Case("V15.not-others", "Sessions of other controllers are not told, nor is one of 1.0",
         (_joins("p", "arm3"), join("q", "arm0", "arm1", "arm2"), *observe("p", "q"), _SUPERVISOR, _SPAWNING,
          answer("p"), answer("q"), told("s", 1), Hear("p", "paused"), Hear("q", "paused"),
          ask("s", 2, spawn={"xml": arm("arm9")}), told("s", 2), Silence("p"), Silence("q")),
         Level.RECONNECT, fresh=True),
]
