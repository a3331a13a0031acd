# SPDX-License-Identifier: MIT
"""The binary form: the fields of a message, without their meaning."""

from typing import Iterator, Optional

_SIZES = {1: 8, 5: 4}  # of wire types
_GROUP, _END_OF_GROUP = 3, 4


def fields_of(data: bytes, at: int, end: int) -> Iterator[tuple[int, int, int]]:
    """Tag, place and size of the value of each field, up to the end of what can be read. Those of groups, too."""
    while at < end:
        tag, at = _varint(data, at, end)
        size, at = (None, at) if tag is None else _size(data, at, end, tag & 7)
        if size is None or at + size > end:
            return
        yield tag, at, size
        at += size


def is_whole(data: bytes) -> bool:
    """Whether there are fields to the end. Some readers end at a NUL byte, or at the end of a group that has not begun."""
    end = depth = 0
    for tag, at, size in fields_of(data, 0, len(data)):
        end = at + size
        depth += (tag & 7 == _GROUP) - (tag & 7 == _END_OF_GROUP)
        if tag >> 3 == 0 or depth < 0:
            return False
    return end == len(data)


def _size(data: bytes, at: int, end: int, wire_type: int) -> tuple[Optional[int], int]:
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
