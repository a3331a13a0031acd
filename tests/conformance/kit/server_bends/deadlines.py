# SPDX-License-Identifier: MIT
"""Bends of section 3.2: deadlines."""

import protocol_pb2 as protocol

from .kinds import E, POLICY, SAID, TOLD, drop, in_kind


def policy(bug, change):
    """Another policy holds than the one that is told."""
    def hello(connection, message):
        if message.HasField("hello") and message.hello.HasField("deadline_policy"):
            connection.notes["asked"] = protocol.DeadlinePolicy.FromString(
                message.hello.deadline_policy.SerializeToString())
            change(message.hello.deadline_policy)

    def welcome(connection, message):
        if message.HasField("welcome") and "asked" in connection.notes:
            message.welcome.deadline_policy.CopyFrom(connection.notes["asked"])

    SAID[bug], TOLD[bug] = hello, welcome


policy("waits-always", lambda policy: (policy.Clear(), setattr(policy, "action", POLICY.WAIT)))
policy("hold-is-zero", lambda policy: setattr(policy, "action", POLICY.ZERO))
policy("zero-is-hold", lambda policy: setattr(policy, "action", POLICY.HOLD))
policy("drop-is-hold", lambda policy: setattr(policy, "action", POLICY.HOLD))
policy("stop-is-hold", lambda policy: setattr(policy, "action", POLICY.HOLD))
policy("misses-early", lambda policy: setattr(policy, "wall_deadline_ms", policy.wall_deadline_ms // 5))
policy("no-budget", lambda policy: setattr(policy, "miss_budget", 0))
TOLD["miss-not-told"] = drop("error", E.DEADLINE_MISSED)
TOLD["miss-is-fatal"] = in_kind("error", lambda _, error: setattr(error, "severity", E.DISCARD)
                            if error.code == E.DEADLINE_MISSED else None)
TOLD["late-is-silent"] = drop("error", E.STALE_TICK)
