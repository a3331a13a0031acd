# SPDX-License-Identifier: MIT
"""What a case is, and its outcome."""

import enum
import time
from dataclasses import dataclass
from typing import Callable

from .printable import printable
from .server_scene import MAIN


class Level(enum.Enum):
    """Badges: a server or client has one if it passes all of its cases."""

    CORE = "Core"
    RECONNECT = "Reconnect"
    HIL = "HIL"
    SECURE = "Secure"


class Verdict(enum.Enum):
    PASS = "pass"
    FAIL = "fail"
    NON_STRICT = "non-strict"  # a SHOULD is not kept
    UNIMPLEMENTED = "unimplemented"  # the peer answers so
    KNOWN_FAILING = "known-failing"  # listed as such, and it does fail
    NOT_RUN = "not run"


@dataclass(frozen=True)
class Case:
    """One thing that a rule asks for, as steps that are played one after the other."""

    id: str  # the rule's number, a dot, a name: "S9.stale"
    title: str
    steps: tuple
    level: Level = Level.CORE
    fresh: bool = False  # needs a server of its own: it ends the run, or takes robots out of it
    variant: str = ""  # of the server's command; empty = the plain one
    scene: str = MAIN
    forms: tuple = ("binary", "json")

    @property
    def rule(self) -> str:
        return self.id.split(".")[0]


@dataclass
class Outcome:
    """How a case went."""

    id: str
    title: str
    level: Level
    verdict: Verdict
    seconds: float = 0.0
    reason: str = ""
    transcript: str = ""


class Failed(Exception):
    """The peer broke a MUST."""


class NonStrict(Exception):
    """The peer broke a SHOULD."""


class Unimplemented(Exception):
    """The peer answers that it does not serve this."""


class NotRun(Exception):
    """The case can't be played here; the text names what is needed."""


def judge(outcome: Outcome, play: Callable[[], None]) -> None:
    """Plays, and notes what came out and why."""
    verdicts = {NotRun: Verdict.NOT_RUN, Unimplemented: Verdict.UNIMPLEMENTED, NonStrict: Verdict.NON_STRICT,
                Failed: Verdict.FAIL}
    start = time.monotonic()
    try:
        play()
    except tuple(verdicts) as reason:
        outcome.verdict, outcome.reason = verdicts[type(reason)], printable(str(reason))
    except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
        outcome.verdict, outcome.reason = Verdict.FAIL, printable(f"what it said made the case stumble: {error!r}")
    outcome.seconds = time.monotonic() - start
