"""How many fields a client's message may have (K5): beyond these a server does not decode it."""

import re
from typing import Iterator, Optional

from google.protobuf.descriptor import Descriptor, FieldDescriptor

from ..wire import protocol

MOST_FIELDS = 1 << 18
_BYTES_PER_FIELD = 16  # of text, and of lists of numbers without fixed size
_TEXT = re.compile(rb'"(?:[^"\\]|\\.)*"', re.DOTALL)
_SIZES = {1: 8, 5: 4}  # of wire types
_FIXED = (FieldDescriptor.TYPE_DOUBLE, FieldDescriptor.TYPE_FLOAT, FieldDescriptor.TYPE_FIXED64,
          FieldDescriptor.TYPE_FIXED32, FieldDescriptor.TYPE_SFIXED64, FieldDescriptor.TYPE_SFIXED32)
_UNPACKABLE = (FieldDescriptor.TYPE_MESSAGE, FieldDescriptor.TYPE_BYTES, *_FIXED)


def has_too_many_fields(data: bytes) -> bool:
    if len(data) <= MOST_FIELDS:
        return False  # each takes a byte at least
    if data[:1] == b"{":
        return len(re.findall(rb"[,\[{]", _TEXT.sub(b"", data))) > MOST_FIELDS
    count = 0
    for fields in _fields(data, 0, len(data), protocol.ClientMessage.DESCRIPTOR):
        count += fields
        if count > MOST_FIELDS:
            return True
    return False


def _fields(data: bytes, at: int, end: int, kind: Descriptor) -> Iterator[int]:
    """For each field how many it counts as, up to the end of what can be read."""
    while at < end:
        tag, at = _varint(data, at, end)
        wire_type = 0 if tag is None else tag & 7
        size, at = (None, at) if tag is None else _size(data, at, end, wire_type)
        if size is None or at + size > end:
            return
        yield 1
        field = kind.fields_by_number.get(tag >> 3) if wire_type == 2 else None
        if field is not None and field.type == FieldDescriptor.TYPE_MESSAGE:
            yield from _fields(data, at, at + size, field.message_type)
        elif field is not None and _counts_its_bytes(field):
            yield size // _BYTES_PER_FIELD
        at += size


def _counts_its_bytes(field: FieldDescriptor) -> bool:
    is_list = field.label == FieldDescriptor.LABEL_REPEATED
    return field.type == FieldDescriptor.TYPE_STRING or is_list and field.type not in _UNPACKABLE


def _size(data: bytes, at: int, end: int, wire_type: int) -> tuple:
    """Of the value, and where it begins; None: it can't be read."""
    if wire_type == 0:
        value, after = _varint(data, at, end)
        return (None, at) if value is None else (0, after)
    return _varint(data, at, end) if wire_type == 2 else (_SIZES.get(wire_type, 0), at)


def _varint(data: bytes, at: int, end: int) -> tuple[Optional[int], int]:
    value = 0
    for i in range(at, min(at + 10, end)):
        value |= (data[i] & 0x7F) << 7 * (i - at)
        if data[i] < 0x80:
            return value, i + 1
    return None, at
