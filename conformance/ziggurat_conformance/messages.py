# SPDX-License-Identifier: MIT
"""Messages as dicts, and steps that cases use often."""

from .steps import Hear, Join, Send, Tick

VERSION = {"major": 1, "minor": 0}


def hello(*robots: str, **fields) -> dict:
    """Fields of a Hello for these robots."""
    greeting = {
        "version": VERSION,
        "role": "ROLE_CONTROLLER",
        "robots": list(robots),
        "client_name": "conformance",
        "client_version": "1",
    }
    greeting.update(fields)
    return {name: value for name, value in greeting.items() if value is not None}


def send_hello(peer: str, *robots: str, **fields) -> Send:
    return Send(peer, {"hello": hello(*robots, **fields)})


def join(peer: str, *robots: str, **fields) -> Join:
    return Join(peer, hello(*robots, **fields))


def command(tick=Tick(), **fields) -> dict:
    return {"command": {"tick": tick, **fields}}


def answer(peer: str, tick=Tick(), **fields) -> Send:
    """The command for the peer's last observation."""
    return Send(peer, command(tick, **fields))


def leave(peer: str, *positions: int, reason: str = "DONE", **fields) -> Send:
    return Send(peer, {"leave": {"robots": list(positions), "reason": reason, **fields}})


def heartbeat(peer: str, sequence: int, times: int = 1) -> Send:
    return Send(peer, {"heartbeat": {"sequence": sequence}}, times)


def hear_error(peer: str, code: str, severity: str = "DISCARD", **pattern) -> Hear:
    return Hear(peer, "error", {"code": code, "severity": severity, **pattern})


def hear_refusal(peer: str, code: str, retryable: bool = False, **pattern) -> Hear:
    error = {"code": code, "severity": "FATAL", "retryable": retryable}
    return Hear(peer, "refusal", {"error": error, **pattern})


def observe(*peers: str) -> list:
    return [Hear(peer, "observation") for peer in peers]


# The scene has four arms; these are the sessions that most cases begin with. A session that
# joins a running world gets its tick at once, so all observations are there when the last has joined.
TWO = [join("p", "arm0", "arm1"), join("q", "arm2", "arm3"), *observe("p", "q")]
ALL = [join("p", "*"), *observe("p")]
