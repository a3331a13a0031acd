#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Records messages of the protocol: record.py FOLDER, with the Python client on PYTHONPATH.

Files that exist stay as they are: a message that was released never changes. A message that is the same
in the folder of an earlier version, beside this one, is not written again.
"""

import pathlib
import sys

from google.protobuf import json_format
from google.protobuf.descriptor import FieldDescriptor as Field

from ziggurat import protocol_pb2 as v1


def value_of(field, number):
    """A value that no other field of the message has."""
    if field.type == Field.TYPE_ENUM:
        return field.enum_type.values[1].number
    if field.type == Field.TYPE_BOOL:
        return True
    if field.type == Field.TYPE_STRING:
        return f"{field.name} é"
    if field.type == Field.TYPE_BYTES:
        return bytes([number, 0, 0xFF])
    if field.type == Field.TYPE_DOUBLE:
        return number + 0.25
    return number


def fill(message, only=None):
    """Sets every field; of the members of a oneof just `only`, or none."""
    for field in message.DESCRIPTOR.fields:
        if field.containing_oneof is not None and field.has_presence \
                and len(field.containing_oneof.fields) > 1 and field.name != only:
            continue
        repeated = field.label == Field.LABEL_REPEATED
        if field.type == Field.TYPE_MESSAGE:
            target = getattr(message, field.name)
            for part in [target.add(), target.add()] if repeated else [target]:
                part.SetInParent()
                fill(part)
        elif repeated:
            first = value_of(field, field.number)
            getattr(message, field.name).extend([first, first])
        else:
            setattr(message, field.name, value_of(field, field.number))
    return message


def all_kinds():
    """(name, message) of everything that either side may say, every field of it set."""
    for kind, envelope in (("client", v1.ClientMessage), ("server", v1.ServerMessage)):
        for field in envelope.DESCRIPTOR.fields:
            inner = [one for one in field.message_type.oneofs if len(one.fields) > 1]
            for only in [member.name for one in inner for member in one.fields] or [None]:
                message = envelope()
                getattr(message, field.name).SetInParent()
                fill(getattr(message, field.name), only)
                yield "_".join(filter(None, (kind, field.name, only))), message


def exchange():
    """A run of one robot with one hinge, over two ticks."""
    client, server = v1.ClientMessage, v1.ServerMessage
    version = v1.Version(major=1)
    joint = v1.JointDescription
    robot = v1.RobotDescription(
        id="robot0", controller="lua",
        joint_sensors=[joint(id="hinge", mode=joint.POSITION)],
        joint_actuators=[joint(id="hinge", mode=joint.VELOCITY, max_impulse=0.005)])
    yield "client", client(hello=v1.Hello(version=version, role=v1.ROLE_CONTROLLER, robots=["*"],
                                          client_name="me"))
    yield "server", server(welcome=v1.Welcome(
        version=version, session_token=b"0123456789abcdef", tick_ns=100_000_000,
        ticks_per_second=10, mode=v1.MODE_LOCK_STEP, seed=42, scene_hash="0123456789abcdef",
        max_message_bytes=64 << 20, robots=[robot], server_version="0.1.0",
        role=v1.ROLE_CONTROLLER))
    yield "server", server(observation=v1.Observation(tick=0, joint_readings=[0]))
    yield "client", client(command=v1.Command(tick=0, joint_targets=[1.5]))
    yield "server", server(observation=v1.Observation(tick=1, time_ns=100_000_000,
                                                      joint_readings=[100]))
    yield "client", client(command=v1.Command(tick=1, log=[v1.LogLine(robot=0, text="hello")]))
    yield "server", server(end=v1.End(reason=v1.End.FINISHED, tick=1))
    yield "client", client(leave=v1.Leave(reason=v1.Leave.DONE))


def write(path, data):
    if not path.exists():
        path.write_bytes(data)


def is_known(folder, name, data):
    """Whether an earlier version has the same message."""
    earlier = (one / f"{name}.bin" for one in folder.parent.iterdir()
               if one.is_dir() and one.name < folder.name)
    return any(path.exists() and path.read_bytes() == data for path in earlier)


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    messages = list(all_kinds())
    for number, (side, message) in enumerate(exchange(), 1):
        name = f"exchange_{number}_{side}_{message.WhichOneof('message')}"
        messages.append((name, message))
    for name, message in messages:
        data = message.SerializeToString(deterministic=True)
        if is_known(folder.resolve(), name, data):
            continue
        write(folder / f"{name}.bin", data)
        # As the server writes JSON: nothing left out.
        text = json_format.MessageToJson(message, including_default_value_fields=True, indent=1,
                                         ensure_ascii=False)
        write(folder / f"{name}.json", (text + "\n").encode())


if __name__ == "__main__":
    main()
