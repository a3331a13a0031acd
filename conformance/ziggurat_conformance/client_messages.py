# SPDX-License-Identifier: MIT
"""Steps that cases for clients use often."""

from .client_steps import HearFrom, Tell, TellObservation, TellWelcome

HELLO = HearFrom("hello", {"version": {"major": 1}, "role": "ROLE_CONTROLLER"})
LEFT = HearFrom("leave", {"reason": "DONE"}, should=True)


def welcome(*robots: dict, **fields) -> TellWelcome:
    return TellWelcome(robots, fields)


def observation(tick: int, **fields) -> TellObservation:
    return TellObservation(tick, fields)


def answered(tick: int, within: float = 0.0, **pattern) -> HearFrom:
    return HearFrom("command", {"tick": tick, **pattern}, within=within)


def ticks(first: int, last: int, **fields) -> list:
    return [step for tick in range(first, last + 1)
            for step in (observation(tick, **fields), answered(tick))]


def error(code: str, severity: str, tick: int = 0) -> Tell:
    return Tell({"error": {"code": code, "severity": severity, "tick": tick, "message": "for a test"}})


def end(tick: int, reason: str = "FINISHED") -> Tell:
    return Tell({"end": {"reason": reason, "tick": tick, "message": "it is over"}})


def heartbeat(sequence: int) -> Tell:
    return Tell({"heartbeat": {"sequence": 1_000_000 + sequence}})


def refusal(code: str, retryable: bool = False) -> Tell:
    return Tell({"refusal": {"error": {"code": code, "severity": "FATAL", "retryable": retryable,
                                       "message": "not today"},
                             "server_version": {"major": 1}, "client_version": {"major": 1}}})


BEGUN = [HELLO, welcome(), *ticks(0, 0)]
