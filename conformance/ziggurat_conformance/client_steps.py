# SPDX-License-Identifier: MIT
"""Steps of cases that play a server against a controller program: plain data. client_stage.py plays them."""

from dataclasses import dataclass, field
from typing import Callable, Optional


@dataclass(frozen=True)
class Tell:
    message: dict  # of ServerMessage


@dataclass(frozen=True)
class TellWelcome:
    """To the robots that are named, or to those that the client is to drive."""

    robots: tuple = ()  # dicts of RobotDescription
    fields: dict = field(default_factory=dict)  # of Welcome


@dataclass(frozen=True)
class TellObservation:
    """With a reading for every device of the session's robots; `fields` are others than these."""

    tick: int
    fields: dict = field(default_factory=dict)
    is_of_later_version: bool = False  # it has fields that protocol 1.0 does not have


@dataclass(frozen=True)
class TellBytes:
    """Bytes instead of a message, in the form that the client uses."""

    binary: bytes
    json: bytes


@dataclass(frozen=True)
class HearFrom:
    """The client's next message."""

    kind: str
    pattern: dict = field(default_factory=dict)
    should: bool = False
    within: float = 0.0  # [s] after the last Observation; 0: the usual patience


@dataclass(frozen=True)
class HearLate:
    """The Command for a tick that the world did not wait for: it may still come, and is STALE_TICK. If
    `tick` is given, its Command must come then."""

    late: int
    tick: Optional[int] = None


@dataclass(frozen=True)
class Remove:
    """A supervisor takes the robot at this position out of the world, and the session is told."""

    position: int


@dataclass(frozen=True)
class Refuse:
    """The Command for the last tick had no effect."""

    code: str


@dataclass(frozen=True)
class HearCorrection:
    """After a Command that was refused: another one, a Leave, or the end of the program."""

    tick: int


@dataclass(frozen=True)
class SinceMinor:
    """Steps of a later version, played with clients whose Hello has it."""

    minor: int
    steps: tuple


@dataclass(frozen=True)
class Cut:
    """The server's end of the connection is gone, and a server that knows no session listens there."""


@dataclass(frozen=True)
class Restart:
    """The program is started anew, and no server listens. It gets the time that it took to connect before, and as long again."""


@dataclass(frozen=True)
class Listen:
    """The server listens from now on."""


@dataclass(frozen=True)
class HearResume:
    """A Hello with the session's token; until it comes, the client may send over the restored connection. It has the time
    that M3 gives a client to notice by silence that its connection is lost, and then the usual patience."""


@dataclass(frozen=True)
class Quiet:
    """Nothing comes from the client but heartbeats of its own."""

    seconds: float = 0.3
    should: bool = False


@dataclass(frozen=True)
class Ends:
    """The program ends; `good`: with exit code 0, or not."""

    good: Optional[bool] = None
    should: bool = False
    within: float = 0.0  # [s]; 0: the usual patience


@dataclass(frozen=True)
class Wait:
    seconds: float


@dataclass(frozen=True)
class CheckClient:
    title: str
    check: Callable
    should: bool = False


@dataclass(frozen=True)
class Mechanisms:
    """A server without keys answers in place of the protected one: no connection may be plain."""

    seconds: float = 3.0
