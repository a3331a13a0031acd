# SPDX-License-Identifier: MIT
"""Section 3.2: what happens when a controller does not answer in time."""

from ..case import Case, Level
from ..messages import answer, hear_error, hear_refusal, hello, join, observe, send_hello
from ..steps import Check, Hang, Hear, Join, Pause, Silence, Tick, Zeros
from ..wire import Count

MS = 150  # a deadline that no idle machine misses by itself


def policy(action: str, ms: int = MS, budget: int = 0) -> dict:
    return {"action": action, "wall_deadline_ms": ms, "miss_budget": budget}


def _late(action: str, budget: int = 0, ms: int = MS) -> list:
    """x has arm0 under a policy, y the others without one; both are at a tick."""
    return [join("x", "arm0", deadline_policy=policy(action, ms, budget)),
            join("y", "arm1", "arm2", "arm3"), *observe("x", "y")]


def _missed(peer: str) -> Hear:
    return hear_error(peer, "DEADLINE_MISSED", "WARNING", tick=Tick())


def _turned(by: float, peer: str = "y"):
    """The joint of arm0 as "watch", who holds it now, reads it: it is not in y's observation."""

    def check(stage) -> str:
        before, after = stage.memory["joint"], stage.peer(peer).observation.joint_readings[0]
        return "" if abs(after - before - by) < 0.01 else f"it turned by {after - before}; expected {by}"

    return Check("joint", check)


def _remember(peer: str):
    def note(stage) -> str:
        stage.memory["joint"] = stage.peer(peer).observation.joint_readings[0]
        return ""

    return Check("joint", note)


_TURN = Zeros("joint_actuators", 0, 1.0)


def _granted(action: str) -> Case:
    """The policy outlives the session: a short deadline would drop its robots, or stop the run."""
    wish = policy(action, 600_000)
    return Case(f"H8.{action.lower()}", f"{action} may be wished for, and is granted",
                (Join("p", hello("*", deadline_policy=wish), {"deadline_policy": wish}),), Level.HIL)


CASES = [
    *[_granted(action) for action in ("HOLD", "ZERO", "DROP", "STOP")],
    Case("H8.no-deadline", "Another action than WAIT needs a deadline",
         (send_hello("p", "*", deadline_policy={"action": "HOLD"}), hear_refusal("p", "BAD_VALUE")),
         Level.HIL),
    Case("H8.unknown-action", "An action that is not there is BAD_VALUE",
         (send_hello("p", "*", deadline_policy={"action": 77, "wall_deadline_ms": 5}),
          hear_refusal("p", "BAD_VALUE")), Level.HIL),
    Case("H8.negative-action", "Nor is there one below 0",
         (send_hello("p", "*", deadline_policy={"action": -1, "wall_deadline_ms": 5}),
          hear_refusal("p", "BAD_VALUE")), Level.HIL),
    Case("H14.waits", "Without a wish the scene's policy is told: WAIT here",
         (Join("p", hello("*"), {"deadline_policy": {"action": "WAIT"}, "role": "ROLE_CONTROLLER"}),)),
    Case("W1.in-time", "A client that answers in time is told nothing of deadlines",
         (_late("HOLD"), *[s for _ in range(5) for s in
                           (answer("x"), answer("y"), *observe("x", "y"))]), Level.HIL),
    Case("W1.hold", "Under HOLD the world goes on without the late one",
         (_late("HOLD"), answer("y"), Hear("y", "observation", {"tick": Tick(1)}), _missed("x"),
          Hear("x", "observation")), Level.HIL),
    Case("W1.zero", "Under ZERO the world goes on without the late one",
         (_late("ZERO"), answer("y"), Hear("y", "observation", {"tick": Tick(1)}), _missed("x"),
          Hear("x", "observation")), Level.HIL),
    Case("W1.not-before", "Not before the deadline",
         (_late("HOLD", ms=2000), answer("y"), Silence("y", 1.0), *observe("y")), Level.HIL),
    Case("W1.hold-keeps", "What was commanded before stays, under HOLD",
         (_late("HOLD"), answer("x", joint_targets=_TURN), answer("y"), *observe("x", "y"),
          _remember("x"), answer("y"), *observe("y"), _missed("x"), *observe("x"),
          _turned(0.1, "x")), Level.HIL),
    Case("W7.zero-zeroes", "What was commanded before is zero, under ZERO, until others come",
         (_late("ZERO"), answer("x", joint_targets=_TURN), answer("y"), *observe("x", "y"),
          _remember("x"), answer("y"), *observe("y"), _missed("x"), *observe("x"), _turned(0.0, "x"),
          answer("x"), answer("y"), *observe("x", "y"), _turned(0.0, "x")), Level.HIL),
    Case("W1.drop", "Under DROP the late one's robots leave for good",
         (_late("DROP"), answer("y"), *observe("y"), _missed("x"), answer("y"), *observe("y"),
          send_hello("z", "arm0"), hear_refusal("z", "NOT_YOURS")), Level.HIL, fresh=True),
    Case("W1.stop", "Under STOP the run ends",
         (_late("STOP"), answer("y"), Hear("y", "end", {"reason": "FAILED"})), Level.HIL, fresh=True),
    Case("W1.others-wait", "Who has no deadline is waited for",
         (_late("HOLD"), answer("x"), Silence("x", MS / 1000 * 3), answer("y"), *observe("x", "y")),
         Level.HIL),
    Case("W2.hangs-up", "A dead one is a late one",
         (_late("HOLD"), answer("y"), Hang("x"), *observe("y"), answer("y"), *observe("y")), Level.HIL),
    Case("W2.comes-back", "A dead one that comes back goes on where the world is",
         (_late("HOLD"), answer("y"), Hang("x"), *observe("y"), join("z", "arm0"),
          Hear("z", "observation", {"tick": Tick(of="y")}), answer("y"), answer("z"),
          *observe("y", "z")), Level.HIL),
    Case("W11.crashes", "Who comes and goes again and again holds a tick for three deadlines, not without end",
         (_late("HOLD"), answer("y"), Hang("x"),
          *[s for i in range(8) for s in (join(f"z{i}", "arm0", deadline_policy=policy("HOLD")),
                                          Pause(MS / 1000 * 0.6), Hang(f"z{i}"))],
          join("z", "arm0", deadline_policy=policy("HOLD")),
          Hear("y", "observation", {"tick": Tick(1)}, within=MS / 1000 * 0.5)), Level.HIL),
    Case("W3.beginning", "The beginning waits forever",
         (join("x", "arm0", deadline_policy=policy("DROP", 20)), Silence("x", 0.2),
          join("y", "arm1", "arm2", "arm3"), *observe("x", "y")), Level.HIL, fresh=True),
    Case("W4.budget", "Beyond the budget HOLD drops the robots",
         (_late("HOLD", 2), *[s for _ in range(3) for s in (answer("y"), *observe("y"))], answer("y"),
          *observe("y"), send_hello("z", "arm0"),
          hear_refusal("z", "NOT_YOURS")), Level.HIL, fresh=True),
    Case("W4.in-a-row", "The budget counts misses in a row",
         (_late("HOLD", 1), *[s for _ in range(4) for s in
                              (answer("y"), *observe("y"), _missed("x"), *observe("x"), answer("x"),
                               answer("y"), *observe("x", "y"))]), Level.HIL, fresh=True),
    Case("W5.told", "The late one is told, and goes on to get observations",
         (_late("HOLD"), *[s for _ in range(3) for s in
                           (answer("y"), *observe("y"), _missed("x"), *observe("x"))]), Level.HIL),
    Case("W6.late-answer", "An answer that comes late is STALE_TICK",
         (_late("HOLD"), answer("y"), *observe("y"), answer("x"), _missed("x"), *observe("x"),
          hear_error("x", "STALE_TICK"), answer("x"), answer("y"), *observe("x", "y")), Level.HIL),
    Case("W6.in-hand", "… also while the world still waits for others at that tick",
         (_late("HOLD"), _missed("x"), answer("x"), hear_error("x", "STALE_TICK"), answer("y"), *observe("x", "y")),
         Level.HIL),
    Case("W8.does-not-read", "A client that does not read delays no other",
         (_late("HOLD"), *[s for _ in range(10) for s in (answer("y"), *observe("y"))]), Level.HIL),
    Case("W9.radio-of-the-late", "The late one's messages are not sent",
         (_late("HOLD"), answer("y"), Hear("y", "observation", {"radio_messages": Count(0)})),
         Level.HIL),
]
