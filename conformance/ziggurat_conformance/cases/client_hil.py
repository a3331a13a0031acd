# SPDX-License-Identifier: MIT
"""HIL: deadlines of hardware in the loop."""

from ..case import Case, Level
from ..client_messages import HELLO, answered, end, error, heartbeat, observation, ticks, welcome
from ..client_robots import robot
from ..client_steps import Ends, HearLate, Quiet, SinceMinor, Tell, Wait

MS = 150  # a deadline that no idle machine misses by itself
_PERIOD = 0.02  # [s] of the paced ticks


def _held(action: str = "HOLD") -> list:
    return [HELLO, welcome(mode="MODE_HARDWARE_IN_THE_LOOP",
                           deadline_policy={"action": action, "wall_deadline_ms": MS}), *ticks(0, 0)]


def _case(id: str, title: str, *steps) -> Case:
    return Case(id, title, steps, Level.HIL)


def _missed(tick: int) -> list:
    """The world did not wait for this tick."""
    return [observation(tick), error("DEADLINE_MISSED", "WARNING", tick), observation(tick + 1),
            HearLate(tick, tick + 1)]


CASES = [
    _case("W1.in-time", f"It answers every tick within the deadline of {MS} ms",
          *_held(), *[s for tick in range(1, 101)
                      for s in (observation(tick), answered(tick, MS / 1000), Wait(_PERIOD))]),
    _case("W1.with-heartbeats", "… also when heartbeats come between",
          *_held(), *[s for tick in range(1, 21)
                      for s in (heartbeat(tick), observation(tick), answered(tick, MS / 1000), Wait(_PERIOD))]),
    _case("W5.missed", "A missed deadline is no reason to give up: it answers the next tick",
          *_held(), *ticks(1, 3), *_missed(4), *ticks(6, 8)),
    _case("W5.missed-often", "… nor are twenty",
          *_held(), *[s for tick in range(1, 40, 2) for s in _missed(tick)], *ticks(41, 43)),
    _case("W6.stale", "Nor is STALE_TICK, the answer to a Command that came late",
          *_held(), *ticks(1, 3), observation(4), error("DEADLINE_MISSED", "WARNING", 4), HearLate(4),
          *ticks(5, 7)),
    _case("W6.all-values", "After a missed deadline the next Command has all values",
          *_held(), *ticks(1, 5), *_missed(6), *ticks(8, 9), *_missed(10), *ticks(12, 13)),
    _case("W7.zero", "So it is under ZERO, where the lost values are 0 until then",
          *_held("ZERO"), *ticks(1, 5), *_missed(6), *ticks(8, 9)),
    _case("W8.skipped", "Observations that it was too slow to read never come",
          *_held(), *ticks(1, 3), *ticks(9, 9), *ticks(20, 22)),
    _case("P3.paused", "No deadline runs while the world is paused: it waits",
          *_held(), Tell({"paused": {"tick": 0}}), Quiet(1.0), *ticks(1, 3)),
    _case("W10.dropped", "When one of its robots was dropped, it goes on with the other",
          HELLO, SinceMinor(1, (
              welcome(robot("arm0"), robot("arm1"), version={"major": 1, "minor": 1},
                      deadline_policy={"action": "DROP", "wall_deadline_ms": MS, "miss_budget": 1}),
              *ticks(0, 2), observation(3), error("DEADLINE_MISSED", "WARNING", 3),
              Tell({"error": {"code": "ROBOTS_DROPPED", "severity": "WARNING", "tick": 3, "message": "too late",
                              "dropped": {"robots": [1]}}}), HearLate(3), *ticks(4, 9)))),
    _case("W1.stopped", "Under STOP the run may end because of it",
          *_held("STOP"), observation(1), error("DEADLINE_MISSED", "WARNING", 1), end(1, "FAILED"),
          Ends(should=True)),
]
