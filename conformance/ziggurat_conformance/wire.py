# SPDX-License-Identifier: MIT
"""Messages as bytes, in both forms, and patterns that messages are held against."""

import json
from dataclasses import dataclass
from typing import Any, Iterator

from google.protobuf import json_format
from google.protobuf.message import DecodeError, Message

import protocol_pb2 as protocol

from .rules.binary_form import is_whole

BINARY = "binary"
JSON = "json"
FORMS = (BINARY, JSON)


def encode(message: Message, form: str) -> bytes:
    """A message as it travels; `form` is BINARY or JSON."""
    if form == JSON:
        # T6: a server leaves no numbers, texts and arrays out; a client may.
        whole = isinstance(message, protocol.ServerMessage)
        return json_format.MessageToJson(message, indent=0,
                                         including_default_value_fields=whole).encode()
    return message.SerializeToString()


_LATER = b"\x80\x7d\x07"  # field 2000 of any message: 7


def encode_as_later_version(message: Message, form: str) -> bytes:
    """With fields that protocol 1.0 does not have, in the envelope and in what it holds."""
    kind = kind_of(message)
    if form == JSON:
        fields = json.loads(encode(message, form))
        fields[kind]["later"] = [1]
        return json.dumps({**fields, "alsoLater": 7}).encode()
    content = getattr(message, kind).SerializeToString() + _LATER
    size, length = len(content), b""
    while size > 127:
        length, size = length + bytes([size & 127 | 128]), size >> 7
    number = message.DESCRIPTOR.fields_by_name[kind].number
    return bytes([number << 3 | 2]) + length + bytes([size]) + content + _LATER


def decode(kind: type, data: bytes, form: str) -> Message:
    """The message of a type that bytes hold. Raises ValueError, saying what is wrong."""
    try:
        return _of_text(kind, data) if form == JSON else _of_bytes(kind, data)
    except (DecodeError, json_format.ParseError, RecursionError, ValueError) as error:
        raise ValueError(f"not a {kind.__name__} in {form} form: {error}") from None


def _of_text(kind: type, data: bytes) -> Message:
    """Of names that stand twice the last counts: the rules judge those that the protocol knows."""
    tree = json.loads(data.decode())
    if not isinstance(tree, dict):
        raise ValueError("it is not an object")
    return json_format.ParseDict(tree, kind(), ignore_unknown_fields=True)


def _of_bytes(kind: type, data: bytes) -> Message:
    if not is_whole(data):
        raise ValueError("something else than a field stands in it or behind it")
    return kind.FromString(data)


def from_dict(kind: type, fields: dict) -> Message:
    """A message from field names as in the .proto; bytes stay bytes, enums may be names."""
    message = kind()
    _fill(message, fields)
    return message


def _fill(message: Message, fields: dict) -> None:
    for name, value in fields.items():
        field = message.DESCRIPTOR.fields_by_name[name]
        repeated = field.label == field.LABEL_REPEATED
        if field.type == field.TYPE_MESSAGE:
            if repeated:
                for element in value:
                    _fill(getattr(message, name).add(), element)
            else:
                getattr(message, name).SetInParent()
                _fill(getattr(message, name), value)
            continue
        if field.type == field.TYPE_ENUM:
            value = [_number(field, v) for v in value] if repeated else _number(field, value)
        if repeated:
            getattr(message, name).extend(value)
        else:
            setattr(message, name, value)


def _number(field: Any, value: Any) -> int:
    return field.enum_type.values_by_name[value].number if isinstance(value, str) else value


# ---- patterns ------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Some:
    """Matches any value but the default one."""


@dataclass(frozen=True)
class Count:
    """Matches a list of this length."""

    length: int


@dataclass(frozen=True)
class AtLeast:
    """Matches a number from this one on."""

    least: float


@dataclass(frozen=True)
class OneOf:
    """Matches any of these."""

    values: tuple


def mismatches(pattern: Any, value: Any, path: str = "") -> Iterator[str]:
    """Sentences on where a value does not match the pattern. A dict is about the fields it names."""
    if isinstance(pattern, dict):
        for name, inner in pattern.items():
            field = value.DESCRIPTOR.fields_by_name[name]
            found = getattr(value, name)
            if field.type == field.TYPE_ENUM and field.label != field.LABEL_REPEATED:
                found = _name(field, found)
            yield from mismatches(inner, found, f"{path}.{name}" if path else name)
    elif isinstance(pattern, Some):
        if not value:
            yield f"{path} is empty; expected a value"
    elif isinstance(pattern, Count):
        if len(value) != pattern.length:
            yield f"{path} has {len(value)} elements; expected {pattern.length}"
    elif isinstance(pattern, AtLeast):
        if not value >= pattern.least:
            yield f"{path} is {value!r}; expected at least {pattern.least}"
    elif isinstance(pattern, OneOf):
        if value not in pattern.values:
            yield f"{path} is {value!r}; expected one of {', '.join(map(repr, pattern.values))}"
    elif isinstance(pattern, (list, tuple)):
        if len(pattern) != len(value):
            yield f"{path} has {len(value)} elements; expected {len(pattern)}"
        else:
            for i, (inner, found) in enumerate(zip(pattern, value)):
                yield from mismatches(inner, found, f"{path}[{i}]")
    elif pattern != value:
        yield f"{path} is {value!r}; expected {pattern!r}"


def _name(field: Any, number: int) -> Any:
    known = field.enum_type.values_by_number.get(number)
    return known.name if known else number


def kind_of(message: Message) -> str:
    """Which message an envelope holds: "welcome", "observation", … or "" for none known."""
    return message.WhichOneof("message") or ""


_MOST_SHOWN = 40  # elements of a list, and characters or bytes of 8 times as many


def text_of(message: Message, limit: int = 2000) -> str:
    """For people, on one line, cut where it is long. Takes bounded time whatever the message holds."""
    if message.ByteSize() > limit:
        message = _shortened(message)
    text = json_format.MessageToJson(message, indent=None, preserving_proto_field_name=True)
    return text if len(text) <= limit else f"{text[:limit]} … ({len(text)} characters)"


def _shortened(message: Message) -> Message:
    """A copy with the first elements and characters of everything."""
    short = type(message)()
    for field, value in message.ListFields():
        if field.label == field.LABEL_REPEATED:
            values = [_shortened_value(v) for v in value[:_MOST_SHOWN]]
            getattr(short, field.name).extend(values)
        elif field.type == field.TYPE_MESSAGE:
            getattr(short, field.name).CopyFrom(_shortened(value))
        else:
            setattr(short, field.name, _shortened_value(value))
    return short


def _shortened_value(value: Any) -> Any:
    if isinstance(value, Message):
        return _shortened(value)
    return value[:8 * _MOST_SHOWN] if isinstance(value, (str, bytes)) else value
