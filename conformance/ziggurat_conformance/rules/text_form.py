# SPDX-License-Identifier: MIT
"""The JSON form (T6)."""

import json
from typing import Any, Callable, Iterator

from google.protobuf import json_format
from google.protobuf.message import Message

from .fault import Fault


def _no_constant(name: str) -> None:
    raise ValueError(f"{name} is not JSON; \"{name}\" is")


def parsed(data: bytes, object_of: Callable) -> Any:
    """RFC 8259 in UTF-8; an object is what object_of makes of its names and values. Raises ValueError, saying
    what is wrong."""
    try:
        return json.loads(data.decode(), parse_constant=_no_constant, object_pairs_hook=object_of)
    except UnicodeDecodeError as error:
        raise ValueError(str(error)) from None
    except RecursionError:
        raise ValueError("it is nested too deep") from None


def _once(pairs: list) -> dict:
    found = dict(pairs)
    if len(found) != len(pairs):
        raise ValueError("a name stands twice in one object")
    return found


def server_text_faults(data: bytes, message: Message) -> Iterator[Fault]:
    """Of a ServerMessage in the JSON form: it must be canonical, with every value that is not absent."""
    try:
        told = parsed(data, _once)
    except ValueError as error:
        yield Fault("T6", f"text that is not JSON: {error}")
        return
    expected = json_format.MessageToDict(message, including_default_value_fields=True)
    for path in _differences(expected, told, ""):
        yield Fault("T6", path)


def _differences(expected: Any, told: Any, path: str) -> Iterator[str]:
    """Unknown names are allowed, and numbers may be written in any way that JSON has."""
    if isinstance(expected, dict):
        if not isinstance(told, dict):
            yield f"{path} is {told!r}; an object is expected"
            return
        for name, inner in expected.items():
            if name in told:
                yield from _differences(inner, told[name], f"{path}.{name}" if path else name)
            elif inner is not None:
                yield f"{path or 'a message'} has no {name}"
    elif isinstance(expected, list):
        if not isinstance(told, list) or len(told) != len(expected):
            yield f"{path} is {told!r:.80}; an array of {len(expected)} values is expected"
            return
        for inner, found in zip(expected, told):
            yield from _differences(inner, found, f"{path}[]")
    elif isinstance(expected, str) or isinstance(expected, bool):
        if type(told) is not type(expected) or told != expected:
            yield f"{path} is {told!r:.80}; {expected!r:.80} is expected"
    elif isinstance(told, bool) or not isinstance(told, (int, float)):
        yield f"{path} is {told!r:.80}; a number is expected"
