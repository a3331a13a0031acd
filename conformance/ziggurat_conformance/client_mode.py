# SPDX-License-Identifier: MIT
"""Plays cases against a controller program, and judges."""

from typing import Callable

from .case import Case, Level, Outcome, Verdict, judge
from .cases.client import CLIENT_CASES as CASES
from .client_stage import ClientStage, Options
from .client_steps import SinceMinor, TellWelcome

_TRIES_WITH_DEADLINES = 3


def play(cases: list, command: list, options: Options, on_outcome: Callable) -> list:
    """Starts the program anew for each case; `on_outcome` hears of each when it is over."""
    outcomes = []
    for case in cases:
        outcomes.append(_play_patiently(case, command, options))
        on_outcome(outcomes[-1])
    return outcomes


def _play_patiently(case: Case, command: list, options: Options) -> Outcome:
    """Cases with deadlines up to three times: a busy machine misses some by itself."""
    tries = _TRIES_WITH_DEADLINES if case.level is Level.HIL else 1
    for _ in range(tries):
        outcome = _play_one(case, command, options)
        if outcome.verdict is not Verdict.FAIL:
            break
    return outcome


def _play_one(case: Case, command: list, options: Options) -> Outcome:
    outcome = Outcome(case.id, case.title, case.level, Verdict.PASS)
    if options.scene is not None and _names_robots(case.steps):
        outcome.verdict, outcome.reason = Verdict.NOT_RUN, "plays the kit's own robots: leave --scene out"
        return outcome
    with ClientStage(command, case, options) as stage:
        judge(outcome, lambda: stage.play(case.steps))
    if outcome.verdict is not Verdict.PASS:
        outcome.transcript = stage.transcript.text()
    return outcome


def _names_robots(steps: tuple) -> bool:
    return any(_names_robots(step) if isinstance(step, (list, tuple)) else
               _names_robots(step.steps) if isinstance(step, SinceMinor) else
               isinstance(step, TellWelcome) and bool(step.robots) for step in steps)
