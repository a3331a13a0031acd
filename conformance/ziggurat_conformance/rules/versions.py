# SPDX-License-Identifier: MIT
"""What sessions of earlier versions are not told (H2)."""

from typing import Iterator, Optional

from ..wire import protocol
from .fault import Fault


def version_faults(message: protocol.ServerMessage, welcome: Optional[protocol.Welcome]) -> Iterator[Fault]:
    """welcome: of the session; None: it has not begun, and section 4 says what may come."""
    for minor, has_news in _NEWS.items():
        if has_news(message) and welcome is not None and welcome.version.minor < minor:
            yield Fault("H2", f"{message.WhichOneof('message')} has what version 1.{minor} brought, in a session of "
                        f"1.{welcome.version.minor}")


def _is_since_1_1(message: protocol.ServerMessage) -> bool:
    return (message.HasField("robot_spawned") or message.welcome.HasField("resumed")
            or message.error.code == protocol.Error.ROBOTS_DROPPED)


def _is_since_1_2(message: protocol.ServerMessage) -> bool:
    return (message.HasField("restored") or message.observation.HasField("epoch")
            or message.reset.HasField("epoch"))


def _is_since_1_4(message: protocol.ServerMessage) -> bool:
    return (message.HasField("world_layout") or message.HasField("world_state")
            or message.welcome.HasField("director"))


_NEWS = {1: _is_since_1_1, 2: _is_since_1_2, 4: _is_since_1_4}
