"""Plays cases against a controller program, and judges."""

import time
from typing import Callable

from .case import Case, Failed, NonStrict, Outcome, Verdict
from .cases.client import CLIENT_CASES as CASES
from .client_steps import ClientStage


def play(cases: list, command: list, patience: float, on_outcome: Callable) -> list:
    """Starts the program anew for each case; `on_outcome` hears of each when it is over."""
    outcomes = []
    for case in cases:
        outcomes.append(_play_one(case, command, patience))
        on_outcome(outcomes[-1])
    return outcomes


def _play_one(case: Case, command: list, patience: float) -> Outcome:
    outcome = Outcome(case.id, case.title, case.level, Verdict.PASS)
    start = time.monotonic()
    with ClientStage(command, patience) as stage:
        try:
            stage.play(case.steps)
        except NonStrict as reason:
            outcome.verdict, outcome.reason = Verdict.NON_STRICT, str(reason)
        except Failed as reason:
            outcome.verdict, outcome.reason = Verdict.FAIL, str(reason)
        except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
            reason = f"what it said made the case stumble: {error!r}"
            outcome.verdict, outcome.reason = Verdict.FAIL, reason
    outcome.seconds = time.monotonic() - start
    if outcome.verdict is not Verdict.PASS:
        outcome.transcript = stage.transcript.text()
    return outcome
