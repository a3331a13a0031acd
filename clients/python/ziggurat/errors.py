"""The exceptions of the client."""

from __future__ import annotations

from typing import Any

from . import protocol_pb2 as v1


def name_of(enum: Any, number: int) -> str:
    """A later version of the protocol may have more values: their number."""
    return enum.Name(number) if number in enum.values() else str(number)


class ZigguratError(Exception):
    """The base of the client's own exceptions."""

    def __str__(self) -> str:
        """Printable: texts of a server must not reach a terminal as escape sequences."""
        return "".join(c if c.isprintable() or c in "\n\t" else f"\\u{ord(c):04x}" for c in super().__str__())


class ConnectionLost(ZigguratError, ConnectionError):
    """No server answered, or the connection was closed. `ziggurat.resume` resumes the session."""


class Timeout(ZigguratError, TimeoutError):
    """No message arrived within the time-out."""


class Displaced(ZigguratError):
    """Another client took robots of this session, which has ended."""


class ProtocolError(ZigguratError):
    """The server answered a message with an error, whose fields have the same names here; or it sent what is no
    message of the protocol (MALFORMED, is_fatal)."""

    def __init__(self, error: v1.Error):
        self.code: str = name_of(v1.Error.Code, error.code)
        self.retryable: bool = error.retryable
        self.tick: int = error.tick
        self.robot: str = error.robot
        self.field: str = error.field
        self.is_fatal: bool = error.severity == v1.Error.FATAL
        where = "".join(f" ({name} {value})" for name, value in
                        (("robot", error.robot), ("field", error.field)) if value)
        super().__init__(f"{self.code}: {error.message}{where}")


class Refused(ProtocolError):
    """The server refused the session. For ROBOT_TAKEN, `holder` is the robot's owner."""

    def __init__(self, refusal: v1.Refusal):
        super().__init__(refusal.error)
        self.holder: str = refusal.holder
