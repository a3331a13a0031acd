# SPDX-License-Identifier: MIT
"""Section 4: which message is taken in which state. One case for each cell of the table."""

from ..case import Case, Level
from ..messages import TWO, answer, hear_error, heartbeat, join, leave, observe, send_hello
from ..steps import Check, Hang, Hear, Interrupt, Send, Silence, Skip

# How a session "x" comes into each state. arm1, arm2 and arm3 are with "y".
_OTHERS = join("y", "arm1", "arm2", "arm3")
_STEPPING = (join("x", "arm0"), _OTHERS, *observe("x", "y"))
_STATES = {
    "NEW": (),
    "READY": (join("x", "arm0"),),
    "STEPPING, owing": _STEPPING,
    "STEPPING, answered": (*_STEPPING, answer("x")),
    "DRAINING": (*_STEPPING, Interrupt(), Skip("x", "end")),
    "CLOSED": (*_STEPPING, leave("x")),
}

_SAID = {
    "Hello": send_hello("x", "arm0"),
    "Command": answer("x"),
    "Leave": leave("x"),
    "Heartbeat": heartbeat("x", 9),
}

_DUE = {
    "NEW": ("welcome", "OUT_OF_STATE", "OUT_OF_STATE", "OUT_OF_STATE"),
    "READY": ("OUT_OF_STATE", "OUT_OF_STATE", "taken", "heartbeat"),
    "STEPPING, owing": ("OUT_OF_STATE", "taken", "taken", "heartbeat"),
    "STEPPING, answered": ("OUT_OF_STATE", "DUPLICATE_TICK", "taken", "heartbeat"),
    "DRAINING": ("OUT_OF_STATE", "taken", "taken", "heartbeat"),
    "CLOSED": ("refusal", "OUT_OF_STATE", "OUT_OF_STATE", "OUT_OF_STATE"),
}


def _heard(state: str, expected: str):
    if expected == "taken":
        return Silence("x", 0.1)
    if expected == "heartbeat":
        return Hear("x", "heartbeat", {"sequence": 9})
    if expected in ("welcome", "refusal"):
        return Hear("x", expected)
    return hear_error("x", expected, "FATAL" if state in ("NEW", "CLOSED") else "DISCARD")


def _name(state: str, message: str) -> str:
    return f"M0.{state.lower().replace(', ', '-')}-{message.lower()}"


_table = [
    Case(_name(state, message), f"{message} in {state}: {expected}",
         (join("x", "arm0"),) if expected == "welcome" else
         (*_STATES[state], _SAID[message], _heard(state, expected)),
         fresh=message == "Leave" or state in ("READY", "DRAINING", "CLOSED"))
    for state, row in _DUE.items()
    for message, expected in zip(_SAID, row)
]

def _beats(stage) -> str:
    """Something comes within the time that Welcome names, and a half."""
    peer = stage.peer("p")
    promised = peer.welcome.wall_heartbeat_ms
    if promised == 0:
        return ""
    message = peer.hear(1.5 * promised / 1000, heartbeats=True)
    return "" if message is not None else f"nothing came within {1.5 * promised:g} ms"


CASES = [
    *_table,
    Case("M1.command-on-its-way", "In DRAINING a Command is no error, and its lines count",
         (join("x", "*"), *observe("x"), Interrupt(), Skip("x", "end"),
          answer("x", log=[{"robot": 0, "text": "last"}]), Silence("x", 0.1), leave("x")), fresh=True),
    Case("M2.lost", "After a lost connection the same robots may be had again",
         (TWO, Hang("p"), join("x", "arm0", "arm1"), *observe("x"), answer("x"), answer("q"),
          *observe("x", "q"))),
    Case("M4.many-faults", "Bad messages without end are the end of the session",
         (join("p", "*"), *observe("p"),
          *[s for _ in range(100) for s in (answer("p", 2**63), hear_error("p", "FUTURE_TICK"))],
          answer("p", 2**63), hear_error("p", "TOO_MANY", "FATAL"), Hang("p"), join("x", "*"),
          *observe("x"))),
    Case("M4.in-a-row", "A good message begins their count anew",
         (join("p", "*"), *observe("p"), *[s for _ in range(2) for s in (
             *[t for _ in range(70) for t in (answer("p", 2**63), hear_error("p", "FUTURE_TICK"))],
             answer("p"), *observe("p"))])),
    Case("M5.answered", "The server answers each Heartbeat with its sequence",
         (join("p", "*"), *observe("p"), heartbeat("p", 0), Hear("p", "heartbeat", {"sequence": 0}),
          heartbeat("p", 2**64 - 1), Hear("p", "heartbeat", {"sequence": 2**64 - 1}))),
    Case("M6.heartbeats", "The server is not silent for longer than its Welcome promises",
         (join("p", "*"), *observe("p"), answer("p"), *observe("p"), Check("beat", _beats))),
    Case("M7.flood", "Who floods is thrown out, and the others are served",
         (join("p", "arm0"), join("q", "arm1", "arm2", "arm3"), *observe("p", "q"),
          heartbeat("p", 0, times=20000), Skip("p", "error", behind="heartbeat"), Hang("p"), join("x", "arm0"),
          *observe("x"), answer("x"), answer("q"), *observe("x", "q")), Level.SECURE),
    Case("M8.request", "A Request of a controller is FORBIDDEN",
         (join("p", "*"), *observe("p"), Send("p", {"request": {"id": 5, "pause": {}}}),
          Hear("p", "response", {"id": 5, "error": {"code": "FORBIDDEN"}}), answer("p"),
          *observe("p")), Level.SECURE),
    Case("M5.in-between", "Heartbeats may come between a session's other messages",
         (join("p", "*"), *observe("p"), heartbeat("p", 1), answer("p"), heartbeat("p", 2),
          Hear("p", "heartbeat", {"sequence": 1}))),
]
