#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Explains a recorded message byte by byte: explain.py FILE.bin…, with the Python client on
PYTHONPATH. explain.py --document docs/protocol.md says whether the explanations there are still
what it would print; with --update it writes them.
"""

import pathlib
import re
import struct
import sys

try:
    from google.protobuf.descriptor import FieldDescriptor as Field

    from ziggurat import protocol_pb2 as v1
except ModuleNotFoundError as error:
    sys.exit(f"explain.py: {error}. It needs Debian's python3-protobuf and the Python client: "
             "PYTHONPATH=build/release/python /usr/bin/python3 explain.py FILE.bin")

BLOCK = re.compile(r"(```hex (\S+)\n)(.*?)(```\n)", re.S)
FOLDER = pathlib.Path(__file__).resolve().parent
COLUMN = 34


def varint(data, at):
    value = shift = 0
    while True:
        value |= (data[at] & 0x7F) << shift
        at, shift = at + 1, shift + 7
        if data[at - 1] < 0x80:
            return value, at


def text_of(field, value):
    if field.type == Field.TYPE_ENUM:
        return field.enum_type.values_by_number[value].name
    return str(bool(value)).lower() if field.type == Field.TYPE_BOOL else str(value)


def quoted(field, content):
    if field.type in (Field.TYPE_STRING, Field.TYPE_BYTES) and content.isascii():
        return f'"{content.decode()}"'
    if field.type == Field.TYPE_STRING:
        return f'"{content.decode()}", in UTF-8'
    if field.type == Field.TYPE_BYTES:
        return "any bytes"
    values, at = [], 0
    while at < len(content):
        value, at = varint(content, at)
        values.append(text_of(field, value))
    return ", ".join(values) + ", packed"


def line(depth, data, text):
    """Bytes in rows of at most eight, with the text beside the first."""
    rows = [data[i:i + 8].hex(" ") for i in range(0, len(data), 8)]
    first = ("  " * depth + rows[0]).ljust(COLUMN) + text
    return "\n".join([first] + ["  " * depth + row for row in rows[1:]])


def explain(data, descriptor, depth=0):
    """Lines that account for every byte."""
    at = 0
    while at < len(data):
        begin = at
        key, at = varint(data, at)
        field = descriptor.fields_by_number[key >> 3]
        wire = key & 7
        if wire == 0:
            value, at = varint(data, at)
            yield line(depth, data[begin:at], f"{field.name}: {text_of(field, value)}")
        elif wire == 1:
            value, at = struct.unpack_from("<d", data, at)[0], at + 8
            yield line(depth, data[begin:at], f"{field.name}: {value:g}")
        else:
            size, at = varint(data, at)
            head, content, at = data[begin:at], data[at:at + size], at + size
            if field.type == Field.TYPE_MESSAGE:
                yield line(depth, head, f"{field.name}, {size} bytes")
                yield from explain(content, field.message_type, depth + 1)
            elif field.type == Field.TYPE_DOUBLE:
                values = struct.unpack(f"<{size // 8}d", content)
                numbers = ", ".join(f"{value:g}" for value in values)
                yield line(depth, data[begin:at], f"{field.name}: {numbers}, packed")
            else:
                yield line(depth, data[begin:at], f"{field.name}: {quoted(field, content)}")


def explain_file(path):
    data = path.read_bytes()
    envelope = v1.ClientMessage if "client_" in path.name else v1.ServerMessage
    return "\n".join(explain(data, envelope.DESCRIPTOR)) + "\n"


def explained(document):
    """The document with its blocks as they have to be."""
    return BLOCK.sub(lambda m: m[1] + explain_file(FOLDER / f"{m[2]}.bin") + m[4], document)


def main(arguments):
    if arguments[:1] != ["--document"]:
        for name in arguments:
            print(f"{name}\n{explain_file(pathlib.Path(name))}")
        return 0
    path = pathlib.Path(arguments[1])
    before = path.read_text()
    after = explained(before)
    if "--update" in arguments:
        path.write_text(after)
    elif after != before:
        print(f"{path}: the worked exchange is not what the recorded bytes say; "
              "explain.py --document … --update writes it", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
