"""What decoding a message would cost, found out before: a hostile one of a few bytes a field would take all memory."""

from __future__ import annotations

from typing import Any, Optional, Tuple

from . import protocol_pb2 as v1

CHEAP = 1 << 20  # [bytes]; so few have few fields
LONGEST_WELCOME = 64 << 20  # and of all else that is sent once [bytes]
MOST_FIELDS = 1 << 21  # Welcomes of ten thousand robots with a hundred fields each have half of that
MOST_DECODED = (2 << 30) + (512 << 20)  # of what is sent at each tick: what a server counts at most (D5), and some [bytes]
MOST_LAID_OUT = 1 << 30  # of all WorldLayouts since one that began anew (R4) [bytes]
MOST_ROBOTS = 1 << 18
LARGEST_PACKET = 1 << 16  # of range and bearing, as in scenes [bytes]
MOST_PACKETS = 1 << 30  # of all robots of a session, which are in one message [bytes]
_OFTEN = tuple(bytes([v1.ServerMessage.DESCRIPTOR.fields_by_name[name].number << 3 | 2])
               for name in ("observation", "world_state"))  # a tag of one byte
_LAYOUT = bytes([v1.ServerMessage.DESCRIPTOR.fields_by_name["world_layout"].number << 3 | 2])
BYTES_PER_FIELD = 64  # no more than a server counts
BYTES_PER_ENTITY = 256  # likewise
TOO_MUCH_LAID_OUT = (f"entities that take more than {MOST_LAID_OUT} bytes of memory, which this client does not decode; "
                     "let the director see fewer")
_GO_ON = bytes(range(0x80, 0x100))  # bytes of a number that are not its last


def excess(data: bytes) -> str:
    """What is wrong with the cost of a ServerMessage; empty: nothing."""
    if len(data) <= CHEAP:
        return ""
    sole = _sole_content(data)
    if sole is not None:
        if _memory(data, *sole) <= MOST_DECODED:
            return ""
        return (f"a message that takes more than {MOST_DECODED} bytes of memory, which this client does not decode; "
                "control fewer robots in each session, or let them hear and see less")
    if data.startswith(_LAYOUT):
        fields = _count(data, 0, len(data), v1.ServerMessage.DESCRIPTOR, MOST_LAID_OUT // BYTES_PER_FIELD)
        return TOO_MUCH_LAID_OUT if BYTES_PER_FIELD * fields + len(data) > MOST_LAID_OUT else ""
    if len(data) > LONGEST_WELCOME:
        return f"a message of {len(data)} bytes, more than {LONGEST_WELCOME}, which this client does not decode"
    if _count(data, 0, len(data), v1.ServerMessage.DESCRIPTOR, MOST_FIELDS) > MOST_FIELDS:
        return f"a message of more than {MOST_FIELDS} fields, which this client does not decode"
    return ""


def excess_of_robots(welcome: v1.Welcome) -> str:
    """What is wrong with the memory that handles of its robots would take; empty: nothing."""
    if len(welcome.robots) > MOST_ROBOTS:
        return f"{len(welcome.robots)} robots; this client takes {MOST_ROBOTS} at most"
    packets = 0
    for robot in welcome.robots:
        if not robot.HasField("range_and_bearing"):
            continue
        size = robot.range_and_bearing.data_size
        if size > LARGEST_PACKET:
            return (f"range-and-bearing packets of {size} bytes for robot {robot.id!r}; at most {LARGEST_PACKET} "
                    "are allowed")
        packets += size
    if packets > MOST_PACKETS:
        return f"range-and-bearing packets of {packets} bytes in all; this client takes {MOST_PACKETS} at most"
    return ""


def _varint(data: bytes, at: int) -> Tuple[int, int]:
    """The number and the place behind it. Raises IndexError at the end of the data."""
    value = shift = 0
    while True:
        byte = data[at]
        value |= (byte & 0x7F) << shift
        at, shift = at + 1, shift + 7
        if byte < 0x80 or shift > 63:
            return value, at


def _sole_content(data: bytes) -> Optional[Tuple[int, Any]]:
    """Of a message that is an Observation or a WorldState alone: where its content begins, and its type."""
    if not data.startswith(_OFTEN):
        return None
    try:
        size, at = _varint(data, 1)
    except IndexError:
        return None
    field = v1.ServerMessage.DESCRIPTOR.fields_by_number[data[0] >> 3]
    return (at, field.message_type) if at + size == len(data) else None


def _memory(data: bytes, at: int, kind: Any) -> int:
    """At most so much is taken by a decoded message whose messages have no lists and no messages [bytes]. It stops
    counting beyond the bound."""
    numbers = kind.fields_by_number
    memory = 0
    try:
        while at < len(data) and memory <= MOST_DECODED:
            tag, at = _varint(data, at)
            wire = tag & 7
            if wire != 2:
                memory += 128
                at = _varint(data, at)[1] if wire == 0 else at + (8 if wire == 1 else 4)
                continue
            size, at = _varint(data, at)
            memory += _memory_of_content(data, at, size, numbers.get(tag >> 3))
            at += size
    except IndexError:
        pass
    return memory


def _memory_of_content(data: bytes, at: int, size: int, field: Any) -> int:
    """The same of one field that has a length."""
    if field is None:
        return 256 + size
    if field.type == field.TYPE_DOUBLE:
        return 3 * size  # a list that grows
    if field.cpp_type in (field.CPPTYPE_UINT32, field.CPPTYPE_INT32):
        return 24 * len(data[at:at + size].translate(None, _GO_ON))
    return (256 if field.message_type is not None else 104) + size


def _count(data: bytes, at: int, end: int, kind: Any, most: int) -> int:
    """Fields between these places, those of messages in them included. What is no message is left to the decoder."""
    numbers = kind.fields_by_number
    fields = 0
    try:
        while at < end and fields <= most:
            tag, at = _varint(data, at)
            fields += 1
            wire = tag & 7
            if wire == 0:
                _, at = _varint(data, at)
            elif wire == 2:
                size, at = _varint(data, at)
                field = numbers.get(tag >> 3)
                if field is not None and field.message_type is not None:
                    fields += _count(data, at, min(end, at + size), field.message_type, most - fields)
                at += size
            elif wire in (1, 5):
                at += 8 if wire == 1 else 4
    except IndexError:
        pass
    return fields
