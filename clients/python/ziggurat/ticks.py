# SPDX-License-Identifier: MIT
"""What a session tells: ticks, spawned robots, the end of the run."""

from __future__ import annotations

import enum
from dataclasses import dataclass


class Event(enum.Enum):
    """The kind of a tick."""

    INIT = "init"  # the first observation of a session
    STEP = "step"
    RESET = "reset"  # the world was reset, and all commands with it
    RESTORED = "restored"  # the world went back to a snapshot: Session.snapshot
    RESUME = "resume"  # the first observation of a resumed session


@dataclass(frozen=True)
class Tick:
    number: int
    time_ns: int  # simulated
    event: Event

    @property
    def time(self) -> float:
        """Simulated [s]."""
        return self.time_ns * 1e-9


@dataclass(frozen=True)
class Ending:
    reason: str  # "finished", "interrupted" or "failed"
    message: str  # printable, at most 4096 characters
    tick: int  # the last one


@dataclass(frozen=True)
class SpawnedRobot:
    """A robot that a supervisor spawned. Another session takes it: connect(endpoint, robots=id)."""

    id: str
    controller: str  # its id in the scene
    tick: int  # from which on it stands there
