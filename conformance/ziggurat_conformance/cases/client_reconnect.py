# SPDX-License-Identifier: MIT
"""Reconnect: resets, pauses, and connections that are really lost."""

from ..case import Case, Level
from ..client_messages import (BEGUN, HELLO, end, error, heartbeat, observation, refusal, ticks, welcome)
from ..keys import RESTARTED
from ..client_robots import robot
from ..client_steps import CheckClient, Cut, Ends, HearFrom, HearResume, Quiet, SinceMinor, Tell
from ..wire import text_of
from .client_core import storm

_WATCHED = {"wall_heartbeat_ms": 100}


def _case(id: str, title: str, *steps) -> Case:
    return Case(id, title, steps, Level.RECONNECT)


def _resumed(tick: int) -> list:
    """Back in the session at this tick; L9: it may have been answered before."""
    return [HearResume(), welcome(), *ticks(tick, tick + 2)]


def _same_answer(stage) -> str:
    first, second = stage.last_commands
    return "" if first == second else f"first {text_of(first, 200)}; then {text_of(second, 200)}"


_WELCOME_BACK = welcome(version={"major": 1, "minor": 2}, resumed={"gone_robots": []})
_RESET = Tell({"reset": {"seed": 8}})
_PAUSED = Tell({"paused": {"tick": 0}})

CASES = [
    _case("L6.reset", "After a reset it goes on from tick 0",
          *BEGUN, *ticks(1, 3), _RESET, Quiet(0.2), *ticks(0, 3)),
    _case("L6.reset-twice", "It may be reset again and again",
          *BEGUN, *[s for seed in (8, 9, 10) for s in
                    (*ticks(1, 2), Tell({"reset": {"seed": seed}}), *ticks(0, 0))]),
    *[_case(f"S9.reset-crosses-{code.lower().replace('_', '-')}",
            f"A command that met a reset on its way may be {code}: no reason to give up",
            *BEGUN, *ticks(1, 3), _RESET, *ticks(0, 0), error(code, "DISCARD"), Quiet(0.2, should=True),
            observation(1), HearFrom("command", {"tick": 1}, should=True), *ticks(2, 3))
      for code in ("FUTURE_TICK", "STALE_TICK", "DUPLICATE_TICK")],
    _case("L6.paused", "While the world is paused it sends nothing",
          *BEGUN, _PAUSED, heartbeat(1), Quiet(0.5), *ticks(1, 3)),
    _case("L6.paused-again", "It may be told twice that the world is paused",
          *BEGUN, _PAUSED, _PAUSED, *ticks(1, 2)),
    _case("L6.displaced", "When another client takes its robots, it ends, with another exit code than 0",
          *BEGUN, Tell({"displaced": {"by": "another 1", "message": "takeover"}}), Ends(good=False, should=True)),
    _case("L10.displaced", "It does not take them back",
          *BEGUN, *ticks(1, 2), Tell({"displaced": {"by": "another 1", "message": "takeover"}}), Quiet(2.0)),
    _case("L6.restored", "It is told that the world was restored, and goes on at that tick",
          HELLO, SinceMinor(2, (
              welcome(version={"major": 1, "minor": 2}), *ticks(0, 5, epoch=0),
              Tell({"restored": {"tick": 2, "snapshot": "two", "epoch": 1}}), *ticks(2, 4, epoch=1)))),
    _case("L4.lost", "A connection that is lost between ticks is made anew, and the session resumed",
          *BEGUN, *ticks(1, 3), Cut(), _resumed(3)),
    _case("L4.lost-in-a-tick", "… and one that is lost before the answer",
          *BEGUN, *ticks(1, 3), observation(4), Cut(), _resumed(4)),
    _case("L4.lost-before-tick-0", "… and one that is lost before the first tick",
          HELLO, welcome(), Cut(), _resumed(0)),
    _case("L4.lost-again", "… again and again",
          *BEGUN, *[s for tick in (0, 2, 4) for s in (Cut(), *_resumed(tick))]),
    _case("L9.same-answer", "To a tick that it had answered it gives the same answer: nothing is done twice",
          *BEGUN, *ticks(1, 3), Cut(), HearResume(), welcome(), *ticks(3, 3),
          CheckClient("answer", _same_answer, should=True), *ticks(4, 5)),
    _case("L4.other-tick", "The world may have gone on meanwhile", *BEGUN, *ticks(1, 3), Cut(), _resumed(70)),
    _case("M3.silence", "When nothing comes for much longer than M6 says, it resumes its session",
          HELLO, welcome(**_WATCHED), *ticks(0, 2), heartbeat(1), HearResume(), welcome(), *ticks(2, 4)),
    *[_case(f"M3.{name}", f"{title} is no loss",
            HELLO, welcome(wall_heartbeat_ms=beat), *ticks(0, 2), Quiet(silence), *ticks(3, 4))
      for name, title, beat, silence in (("short-silence", "Silence of less than 3 s", 100, 2.3),
                                         ("slow-beats", "Silence of less than three heartbeats", 2000, 4.5))],
    _case("M3.beats", "As long as heartbeats come, the connection is alive",
          HELLO, welcome(**_WATCHED), *ticks(0, 2), *[s for n in range(20) for s in (heartbeat(n), Quiet(0.1))],
          *ticks(3, 4)),
    _case("M3.out-of-state", "Told OUT_OF_STATE, it resumes its session",
          *BEGUN, *ticks(1, 3), error("OUT_OF_STATE", "FATAL"), _resumed(3)),
    Case("T10.token", "A program that finds the token of a session in its environment resumes that session",
         (HearResume(), welcome(), *ticks(5, 7)), Level.RECONNECT, variant=RESTARTED),
    Case("T10.secret", "It does not print that token, and sends it in no other place",
         (HearResume(), welcome(), *ticks(5, 6), end(6), Ends()), Level.RECONNECT, variant=RESTARTED),
    _case("L4.no-such-session", "A session that can't be resumed is no reason for a storm of Hellos",
          *BEGUN, Cut(), HearResume(), refusal("NO_SUCH_SESSION"), CheckClient("storm", storm, should=True)),
    _case("L13.resumed", "A Welcome of 1.1 with what was commanded is a Welcome",
          *BEGUN, *ticks(1, 2), Cut(), HearResume(),
          SinceMinor(1, (welcome(version={"major": 1, "minor": 1}, resumed={"gone_robots": []}), *ticks(2, 4)))),
    _case("L13.gone", "Robots that left while its session was lost are neither named nor left again",
          *BEGUN, *ticks(1, 2), Cut(), HearResume(),
          SinceMinor(1, (welcome(version={"major": 1, "minor": 1}, resumed={"gone_robots": [0]}), *ticks(70, 77)))),
    _case("L4.taken", "When another client took a robot of its lost session, it resumes that and goes on with the others",
          HELLO, welcome(robot("arm0"), robot("arm1")), *ticks(0, 2), Cut(), HearResume(),
          welcome(robot("arm0"), robot("arm1")),
          Tell({"error": {"code": "NOT_YOURS", "severity": "WARNING", "robot": "arm0", "message": "another client took it"}}),
          *ticks(70, 77)),
    _case("S13.epoch", "Its Command has the epoch of the Observation that it answers",
          HELLO, SinceMinor(2, (welcome(version={"major": 1, "minor": 2}), *ticks(0, 2, epoch=0),
                                Tell({"reset": {"seed": 8, "epoch": 1}}), *ticks(0, 2, epoch=1)))),
    _case("S13.resumed", "So has the one that is sent again after a loss, and the first of another epoch",
          HELLO, SinceMinor(2, (
              welcome(version={"major": 1, "minor": 2}), *ticks(0, 2, epoch=4),
              Cut(), HearResume(), _WELCOME_BACK, *ticks(2, 3, epoch=4),
              Cut(), HearResume(), _WELCOME_BACK, *ticks(3, 4, epoch=5)))),
    _case("V15.spawned", "That a robot was spawned needs no answer",
          HELLO, SinceMinor(1, (welcome(version={"major": 1, "minor": 1}), *ticks(0, 2), Tell(
              {"robot_spawned": {"robot": "arm9", "controller": "steady", "tick": 2}}), Quiet(0.3), *ticks(3, 4)))),
    _case("L5.end-after-resume", "A resumed session ends as any",
          *BEGUN, Cut(), *_resumed(0), end(2), Ends(good=True, should=True)),
]
