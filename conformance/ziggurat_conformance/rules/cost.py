# SPDX-License-Identifier: MIT
"""How many fields a client's message may have (K5): beyond these a server does not decode it."""

import re
from typing import Iterator

from google.protobuf.descriptor import Descriptor, FieldDescriptor

from ..wire import protocol
from .binary_form import fields_of

MOST_FIELDS = 1 << 18
_BYTES_PER_FIELD = 16  # of text, and of lists of numbers without fixed size
_TEXT = re.compile(rb'"(?:[^"\\]|\\.)*"', re.DOTALL)
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
    """For each field how many it counts as."""
    for tag, inner, size in fields_of(data, at, end):
        yield 1
        field = kind.fields_by_number.get(tag >> 3) if tag & 7 == 2 else None
        if field is not None and field.type == FieldDescriptor.TYPE_MESSAGE:
            yield from _fields(data, inner, inner + size, field.message_type)
        elif field is not None and _counts_its_bytes(field):
            yield size // _BYTES_PER_FIELD


def _counts_its_bytes(field: FieldDescriptor) -> bool:
    is_list = field.label == FieldDescriptor.LABEL_REPEATED
    return field.type == FieldDescriptor.TYPE_STRING or is_list and field.type not in _UNPACKABLE
