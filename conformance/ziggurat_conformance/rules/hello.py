# SPDX-License-Identifier: MIT
"""What a server refuses of a Hello whatever its scene is (H2 to H4, H8, V1, K5)."""

from typing import Iterator

from ..wire import protocol
from .fault import Fault

_MAJOR = 1
_MOST_PATTERNS, _LONGEST_PATTERN = 64, 256  # [1], [bytes]
_ROLES = (protocol.ROLE_CONTROLLER, protocol.ROLE_SUPERVISOR, protocol.ROLE_OBSERVER)
_Policy = protocol.DeadlinePolicy


def hello_faults(hello: protocol.Hello) -> Iterator[Fault]:
    """In the order of H15."""
    if hello.version.major != _MAJOR:
        yield Fault("H2", f"a Hello has version.major {hello.version.major}; {_MAJOR} is expected",
                    "VERSION_MISMATCH")
    is_director = hello.role == protocol.ROLE_DIRECTOR and hello.version.minor >= 4
    if hello.role not in _ROLES and not is_director:
        yield Fault("H3", f"a Hello has the role {hello.role}", "BAD_VALUE", "role")
    has_criteria = bool(hello.robots or hello.controller or hello.lua_only)
    if hello.role == protocol.ROLE_CONTROLLER and not has_criteria and not hello.session_token:
        yield Fault("H4", "a Hello asks for no robots", "BAD_VALUE", "robots")
    if is_director and (has_criteria or not (hello.director or hello.session_token)):
        yield Fault("R1", "a Hello of a director asks for robots, or names no director", "BAD_VALUE")
    if hello.role in (protocol.ROLE_SUPERVISOR, protocol.ROLE_OBSERVER) and has_criteria:
        yield Fault("V1", "a Hello without the role of a controller asks for robots", "BAD_VALUE", "robots")
    if (len(hello.robots) > _MOST_PATTERNS
            or any(len(pattern.encode()) > _LONGEST_PATTERN for pattern in hello.robots)):
        yield Fault("K5", f"a Hello has more than {_MOST_PATTERNS} patterns, or one of more than "
                    f"{_LONGEST_PATTERN} bytes", "TOO_MANY", "robots")
    yield from _policy_faults(hello)


def _policy_faults(hello: protocol.Hello) -> Iterator[Fault]:
    if not hello.HasField("deadline_policy"):
        return
    policy = hello.deadline_policy
    waits = policy.action in (_Policy.ACTION_UNSPECIFIED, _Policy.WAIT)
    if policy.action not in _Policy.Action.values():
        yield Fault("H8", f"a Hello asks for the action {policy.action}", "BAD_VALUE", "deadline_policy")
    elif not waits and not policy.wall_deadline_ms:
        yield Fault("H8", "a Hello asks for another action than WAIT without a deadline", "BAD_VALUE",
                    "deadline_policy")
