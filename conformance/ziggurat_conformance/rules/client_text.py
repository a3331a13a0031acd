# SPDX-License-Identifier: MIT
"""The JSON form of a ClientMessage: what a server answers with MALFORMED (T6, K5)."""

import math
import re
from typing import Any, Iterator, Optional

from google.protobuf.descriptor import Descriptor, FieldDescriptor

from ..wire import protocol
from .text_form import parsed

_DEEPEST = 64  # objects and arrays
_INTEGER = re.compile("-?[0-9]+")
_REAL = re.compile(r"-?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")
_CONSTANTS = ("NaN", "Infinity", "-Infinity")
_BASE64 = re.compile("[A-Za-z0-9+/_-]*")
_DIGITS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"
_REALS = (FieldDescriptor.CPPTYPE_DOUBLE, FieldDescriptor.CPPTYPE_FLOAT)


class _Object(list):
    """Names and values in order, also of names that stand twice."""


def client_text_faults(data: bytes) -> Iterator[str]:
    """Sentences. Beyond these, whether values fit into their fields is left to protobuf's reader."""
    try:
        tree = parsed(data, _Object)
    except ValueError as error:
        yield str(error)
        return
    if isinstance(tree, _Object):
        yield from _object_faults(protocol.ClientMessage.DESCRIPTOR, tree, 1)
    else:
        yield "a message is not an object"


def _object_faults(kind: Optional[Descriptor], value: _Object, depth: int) -> Iterator[str]:
    """kind: None for one in a field that the protocol does not have."""
    if depth > _DEEPEST:
        yield f"a message is nested more than {_DEEPEST} deep (K5)"
        return
    seen = set()
    for name, inner in value:
        yield from _character_faults(name)
        field = _field(kind, name)
        if field is None:
            yield from _unknown_faults(inner, depth)
        elif field.name in seen:
            yield f"{field.name} stands twice in one object"
        else:
            seen.add(field.name)
            yield from _field_faults(field, inner, depth)


def _field(kind: Optional[Descriptor], name: str) -> Optional[FieldDescriptor]:
    if kind is None:
        return None
    return kind.fields_by_camelcase_name.get(name) or kind.fields_by_name.get(name)


def _unknown_faults(value: Any, depth: int) -> Iterator[str]:
    """It must be JSON, and nothing else."""
    if isinstance(value, _Object):
        yield from _object_faults(None, value, depth + 1)
    elif isinstance(value, list):
        if depth + 1 > _DEEPEST:
            yield f"a message is nested more than {_DEEPEST} deep (K5)"
            return
        for each in value:
            yield from _unknown_faults(each, depth + 1)
    elif isinstance(value, str):
        yield from _character_faults(value)
    elif isinstance(value, float) and math.isinf(value):
        yield "a number is beyond what a double holds"


def _field_faults(field: FieldDescriptor, value: Any, depth: int) -> Iterator[str]:
    is_list = isinstance(value, list) and not isinstance(value, _Object)
    if value is None:
        return
    if field.label != FieldDescriptor.LABEL_REPEATED:
        yield from _element_faults(field, value, depth)
    elif not is_list:
        yield f"{field.name} is {value!r:.80}; an array is expected"
    else:
        for each in value:
            yield from _element_faults(field, each, depth + 1)


def _element_faults(field: FieldDescriptor, value: Any, depth: int) -> Iterator[str]:
    if field.type == FieldDescriptor.TYPE_MESSAGE and isinstance(value, _Object):
        yield from _object_faults(field.message_type, value, depth + 1)
    elif not _fits(field, value):
        yield f"{field.name} can't be {value!r:.80}"
    elif isinstance(value, str):
        yield from _character_faults(value)


def _fits(field: FieldDescriptor, value: Any) -> bool:
    if value is None or isinstance(value, list) or field.type == FieldDescriptor.TYPE_MESSAGE:
        return False
    if isinstance(value, bool) or field.type == FieldDescriptor.TYPE_BOOL:
        return isinstance(value, bool) and field.type == FieldDescriptor.TYPE_BOOL
    if field.type == FieldDescriptor.TYPE_STRING:
        return isinstance(value, str)
    if field.type == FieldDescriptor.TYPE_BYTES:
        return isinstance(value, str) and _is_base64(value)
    if field.cpp_type in _REALS:
        return _is_real(value)
    if field.type == FieldDescriptor.TYPE_ENUM and value in field.enum_type.values_by_name:
        return True
    is_integer = bool(_INTEGER.fullmatch(value)) if isinstance(value, str) else float(value).is_integer()
    return is_integer and (field.type != FieldDescriptor.TYPE_ENUM or -2**31 <= int(value) < 2**31)


def _is_real(value: Any) -> bool:
    if not isinstance(value, str):
        return math.isfinite(value)
    if value in _CONSTANTS:
        return True
    return bool(_REAL.fullmatch(value)) and math.isfinite(float(value)) and not _vanishes(value)


def _vanishes(text: str) -> bool:
    """A number that is nearer to 0 than a double can be."""
    return not float(text) and bool(re.search("[1-9]", re.split("[eE]", text)[0]))


def _is_base64(text: str) -> bool:
    """Of both alphabets, with padding or without; bits that are left over are 0."""
    if len(text) % 4 == 0:
        text = text[:-2] + text[-2:].rstrip("=")
    if len(text) % 4 == 1 or not _BASE64.fullmatch(text):
        return False
    left_over = {0: 0, 2: 0xF, 3: 0x3}[len(text) % 4]
    last = text[-1:].replace("-", "+").replace("_", "/")
    return not left_over or _DIGITS.index(last) & left_over == 0


def _character_faults(text: str) -> Iterator[str]:
    if any("\ud800" <= each <= "\udfff" for each in text):
        yield "a text has half of a pair of surrogates"
