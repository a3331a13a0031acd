"""What can go wrong, as exceptions."""

from __future__ import annotations

from . import protocol_pb2 as v1


class ZigguratError(Exception):
    """All of the client's own exceptions are one of these."""


class ConnectionLost(ZigguratError, ConnectionError):
    """Nobody listens, or the connection is gone. `ziggurat.resume` takes up the session."""


class Timeout(ZigguratError, TimeoutError):
    """The server was silent for longer than was asked for."""


class Displaced(ZigguratError):
    """Another client took robots of this session; it is over."""


class ProtocolError(ZigguratError):
    """The server answered a message with an error, which is in the fields of the same names."""

    def __init__(self, error: v1.Error):
        self.code: str = v1.Error.Code.Name(error.code) if error.code in v1.Error.Code.values() \
            else str(error.code)
        self.retryable: bool = error.retryable
        self.tick: int = error.tick
        self.robot: str = error.robot
        self.field: str = error.field
        self.is_fatal: bool = error.severity == v1.Error.FATAL
        where = "".join(f" ({name} {value})" for name, value in
                        (("robot", error.robot), ("field", error.field)) if value)
        super().__init__(f"{self.code}: {error.message}{where}")


class Refused(ProtocolError):
    """The session did not come about. `holder` names who drives the robot, for ROBOT_TAKEN."""

    def __init__(self, refusal: v1.Refusal):
        super().__init__(refusal.error)
        self.holder: str = refusal.holder
