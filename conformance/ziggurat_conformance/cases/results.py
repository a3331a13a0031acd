# SPDX-License-Identifier: MIT
"""What results do not depend on: the order of answers (S12), policies (W9)."""

from ..case import Case, Level
from ..messages import answer, hello, join, observe
from ..steps import Hang, Hear, Join, Pause, Zeros
from .supervision import ask, read_hash, same_hash, told

_TICKS = 3
_IN_TIME = {"action": "HOLD", "wall_deadline_ms": 30_000, "miss_budget": 0}


def _begun_anew(id: int, *peers: str) -> list:
    return [ask("s", id, reset={}), told("s", id),
            *[step for peer in peers for step in (Hear(peer, "reset"), *observe(peer))]]


def _driven(*peers: str) -> list:
    """Some ticks, answered in this order."""
    return [step for _ in range(_TICKS) for step in (
        *[s for peer in peers for s in
          (answer(peer, joint_targets=Zeros("joint_actuators", 0, 0.0, 1.0)), Pause(0.05))],
        *observe(*peers))]


_SUPERVISOR = Join("s", hello(role="ROLE_SUPERVISOR"))

CASES = [
    Case("S12.same-results", "The state is the same, in whichever order sessions answer",
         (join("p", "arm0", "arm1"), join("q", "arm2", "arm3"), *observe("p", "q"), _SUPERVISOR,
          _begun_anew(1, "p", "q"), _driven("p", "q"), read_hash(2, "first"),
          _begun_anew(3, "p", "q"), _driven("q", "p"), read_hash(4, "second"), same_hash("first", "second")),
         Level.RECONNECT),
    Case("W9.same-results", "The state is the same with a policy and without, if all answers come in time",
         (join("x", "*", deadline_policy=_IN_TIME), *observe("x"), _SUPERVISOR,
          _begun_anew(1, "x"), _driven("x"), read_hash(2, "first"), Hang("x"),
          join("p", "*"), *observe("p"),
          _begun_anew(3, "p"), _driven("p"), read_hash(4, "second"), same_hash("first", "second")),
         Level.HIL),
]
