# SPDX-License-Identifier: MIT
"""The tables of bends by bug, and kinds of bends."""

import math

import protocol_pb2 as protocol

E = protocol.Error
POLICY = protocol.DeadlinePolicy
# Of what clients say and of what the server says: functions of a connection and a message; of the bytes that
# the server says, and of those that clients say; of the options that the server is started with.
SAID, TOLD, RAW, RAW_SAID, OPTIONS = {}, {}, {}, {}, {}


def said(*bugs):
    """A bend of what clients say."""
    def keep(function):
        SAID.update({bug: function for bug in bugs})
        return function
    return keep


def told(*bugs):
    """A bend of what the server says."""
    def keep(function):
        TOLD.update({bug: function for bug in bugs})
        return function
    return keep


def in_kind(kind, change):
    """Changes messages of a kind: change(connection, content), whose list, if any, takes their place."""
    def bend(connection, message):
        return change(connection, getattr(message, kind)) if message.HasField(kind) else None
    return bend


def set_fields(kind, **fields):
    def change(_, content):
        for name, value in fields.items():
            setattr(content, name, value)
    return in_kind(kind, change)


def clear_fields(kind, *fields):
    def change(_, content):
        for name in fields:
            content.ClearField(name)
    return in_kind(kind, change)


def drop(kind, *codes):
    """Swallows messages of a kind; of errors, those with these codes."""
    return in_kind(kind, lambda _, content: [] if not codes or content.code in codes else None)


def swap(kind):
    """Each two messages of a kind in the other order."""
    def bend(connection, message):
        if not message.HasField(kind):
            return None
        held = connection.notes.pop("held", None)
        if held is None:
            connection.notes["held"] = message
            return []
        return [message, held]
    return bend


def recode(kind, code, other):
    """Another code in errors."""
    def change(_, content):
        error = content if kind == "error" else content.error
        if error.code == code:
            error.code = other
    return in_kind(kind, change)


def shorter(field):
    def change(_, content):
        if getattr(content, field):
            del getattr(content, field)[-1]
    return in_kind("observation", change)


def refill(content, field, values):
    values = list(values)
    content.ClearField(field)
    getattr(content, field).extend(values)


def each_value(field, change):
    return in_kind("command", lambda _, command: refill(command, field, map(change, getattr(command, field))))


def per_device(field, devices, value):
    """Pads and cuts a field of Command to its right length."""
    def change(connection, command):
        if getattr(command, field) and connection.welcome:
            count = sum(len(getattr(robot, devices)) for robot in connection.welcome.robots)
            refill(command, field, (list(getattr(command, field)) + [value] * count)[:count])
    return in_kind("command", change)


finite = lambda value: value if math.isfinite(value) else 0.0  # noqa: E731
