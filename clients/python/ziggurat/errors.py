# SPDX-License-Identifier: MIT
"""The exceptions of the client."""

from __future__ import annotations

from typing import Any

from . import protocol_pb2 as v1


LONGEST_TEXT = 4096  # of a server, in exceptions and endings [characters]


def name_of(enum: Any, number: int) -> str:
    """A later version of the protocol may have more values: their number."""
    return str(enum.Name(number) if number in enum.values() else number)


def printable(text: str) -> str:
    """A server's text, of which no character has an effect on a terminal; of a longer one the beginning, and "…"."""
    shown = "".join(c if c.isprintable() or c in "\n\t" else f"\\u{ord(c):04x}" for c in text[:LONGEST_TEXT + 1])
    return shown if len(shown) <= LONGEST_TEXT else shown[:LONGEST_TEXT - 1] + "…"


class ZigguratError(Exception):
    """The base of the client's own exceptions."""

    def __str__(self) -> str:
        return printable(super().__str__())


class ConnectionLost(ZigguratError, ConnectionError):
    """No server answered, or the connection was closed. `ziggurat.resume` resumes the session."""


class Timeout(ZigguratError, TimeoutError):
    """What was waited for did not arrive within the time-out. The session goes on; the next call waits again."""


class Displaced(ZigguratError):
    """Another client took robots of this session, which has ended."""


class ProtocolError(ZigguratError):
    """The server answered a message with an error, whose fields have the same names here; or it sent what is no
    message of the protocol (MALFORMED, is_fatal)."""

    def __init__(self, error: v1.Error):
        self.code: str = name_of(v1.Error.Code, error.code)
        self.retryable: bool = error.retryable
        self.tick: int = error.tick
        self.robot: str = printable(error.robot)
        self.field: str = printable(error.field)
        self.is_fatal: bool = error.severity == v1.Error.FATAL
        where = "".join(f" ({name} {value})" for name, value in
                        (("robot", error.robot), ("field", error.field)) if value)
        super().__init__(f"{self.code}: {error.message}{where}")


class Malformed(ProtocolError):
    """The server sent what is no message of the protocol."""


class Refused(ProtocolError):
    """The server refused the session. For ROBOT_TAKEN, `holder` is the robot's owner."""

    def __init__(self, refusal: v1.Refusal):
        super().__init__(refusal.error)
        self.holder: str = printable(refusal.holder)
