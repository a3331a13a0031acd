# SPDX-License-Identifier: MIT
"""Section 1: transport."""

import json

from ..case import Case
from ..messages import ALL, answer, hear_error, heartbeat, hello, join, observe
from ..steps import Check, Frames, Hear, Join, RefusesToListen, Send, Silence
from ..wire import AtLeast

_STRANGE = {
    "text": b"hello",
    "nothing": b"",
    "ones": b"\xff" * 1000,
    "cut-short": b"\x12\x7f",
    "bad-varint": b"\x12\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff",
    "bad-wire-type": b"\x0f\x01",
    "http": b"GET / HTTP/1.1\r\nHost: x\r\n\r\n",
    "nul": b"\x00" * 64,
}



def _too_long(stage) -> str:
    """An observer's limit is the smallest."""
    limit = stage.peer("o").welcome.max_message_bytes
    stage.play((Frames("o", (b"x" * (limit + limit // 2),)),))
    return ""


# Garbage of a peer without a session is answered, and the session beside it goes on.
_garbage = [
    Case(
        f"T2.garbage-{name}",
        f"Garbage ({name}) of a peer without a session is MALFORMED and disturbs no session",
        (ALL, Frames("other", (data,)), hear_error("other", "MALFORMED", "FATAL"), answer("p"),
         observe("p")),
        forms=("binary",),
    )
    for name, data in _STRANGE.items()
]

_garbage_in_session = [
    Case(
        f"T2.session-garbage-{name}",
        f"Garbage ({name}) in a session is MALFORMED and has no effect",
        (ALL, Frames("p", (data,)), hear_error("p", "MALFORMED"), answer("p"), observe("p")),
        forms=("binary",),
    )
    for name, data in _STRANGE.items()
]

_NOT_JSON = {
    "single-quotes": b"{'heartbeat': {'sequence': 5}}",
    "bare-names": b"{heartbeat: {sequence: 5}}",
    "trailing-comma": b'{"heartbeat": {"sequence": 5},}',
    "comma-in-a-list": b'{"command": {"tick": "0", "jointTargets": [0, 0, 0, 0,]}}',
    "nan": b'{"command": {"tick": "0", "jointTargets": [NaN, 0, 0, 0]}}',
    "comment": b'{"heartbeat": {"sequence": 5}} // five',
    "text-for-a-list": b'{"leave": {"robots": "0", "reason": "DONE"}}',
    "number-for-a-text": b'{"command": {"log": [{"text": 7}]}}',
    "space-in-a-number": b'{"heartbeat": {"sequence": " 5"}}',
    "plus-before-a-number": b'{"heartbeat": {"sequence": "+5"}}',
    "point-in-an-integer": b'{"command": {"tick": "0.0"}}',
    "nothing-for-a-number": b'{"command": {"tick": "0", "jointTargets": ["", 0, 0, 0]}}',
    "two-kinds": b'{"heartbeat": {"sequence": 5}, "command": {"tick": "0"}}',
    "name-twice": b'{"heartbeat": {"sequence": 5, "sequence": 6}}',
    "nul": b'{"heartbeat": {"sequence": 5}}\0{"leave": {}}',
    "latin-1": b'{"command": {"log": [{"text": "\xe9"}]}}',
}


def _texts_for_numbers(stage) -> str:
    tick = stage.peer("p").tick
    command = {"tick": tick, "robots": ["0"], "jointTargets": ["0.5"], "log": [{"robot": "0", "text": "12"}]}
    stage.play((Frames("p", (json.dumps({"command": command}).encode(),)), Hear("p", "observation", {"tick": tick + 1})))
    return ""


# Fields that protocol 1.0 does not have: 2000 of Command and of ClientMessage.
_UNKNOWN_FIELD = b"\x80\x7d\x07"

CASES = [
    Case("T8.any-address", "Without keys it does not listen at an address that others can reach",
         (RefusesToListen("tcp://0.0.0.0:{port}"),), fresh=True, forms=("binary",)),
    *_garbage,
    *_garbage_in_session,
    Case("T2.two-frames", "A message of two frames is MALFORMED",
         (ALL, Frames("p", (b"", b"x")), hear_error("p", "MALFORMED"), answer("p"), observe("p"))),
    Case("T2.many-frames", "A message of a thousand frames is MALFORMED",
         (ALL, Frames("p", (b"x",) * 1000), hear_error("p", "MALFORMED"), answer("p"), observe("p"))),
    Case("T2.empty-envelope", "An envelope without a message is MALFORMED",
         (ALL, Frames("p", (_UNKNOWN_FIELD,)), hear_error("p", "MALFORMED"), answer("p"),
          observe("p")),
         forms=("binary",)),
    Case("T3.order", "What is said in one go is answered in that order",
         (ALL, *[heartbeat("p", n) for n in range(1, 30)],
          *[Hear("p", "heartbeat", {"sequence": n}) for n in range(1, 30)])),
    Case("T4.limit-is-told", "Welcome has the longest size of a message",
         (Join("p", hello("*"), {"max_message_bytes": AtLeast(2**16)}),)),
    Case("T4.too-long", "A message longer than Welcome allows is TOO_LARGE and has no effect",
         (Join("o", hello(role="ROLE_OBSERVER"), {"max_message_bytes": AtLeast(1)}), Check("long", _too_long),
          hear_error("o", "TOO_LARGE"), Send("o", {"request": {"id": 1, "status": {}}}),
          Hear("o", "response", {"id": 1}))),
    Case("T4.too-long-hello", "A peer without a session that says more than 64 KiB is cut off; others go on",
         (ALL, Frames("other", (b"x" * 100_000,)), Silence("other"), answer("p"), observe("p"))),
    Case("T5.unknown-field", "Unknown fields are ignored",
         (ALL, Frames("p", (b"\x22\x05\x08\x05" + _UNKNOWN_FIELD,)),
          Hear("p", "heartbeat", {"sequence": 5}), answer("p"), observe("p")),
         forms=("binary",)),
    Case("T5.unknown-json-field", "Unknown fields are ignored in JSON too",
         (ALL, Frames("p", (b'{"heartbeat": {"sequence": 5, "colour": "red"}, "later": 1}',)),
          Hear("p", "heartbeat", {"sequence": 5})),
         forms=("json",)),
    Case("T5.not-utf8", "Text that is not UTF-8 is MALFORMED",
         (ALL, Frames("other", (b"\x0a\x05\x1a\x03a\xff\xfe",)),
          hear_error("other", "MALFORMED", "FATAL")),
         forms=("binary",)),
    Case("T6.json-session", "A session that begins with { goes on in JSON",
         (ALL, answer("p"), observe("p")), forms=("json",)),
    Case("T6.json-garbage", "Bad JSON of a peer without a session is MALFORMED",
         (ALL, Frames("other", (b'{"hello": {"robots": [',)),
          hear_error("other", "MALFORMED", "FATAL"), answer("p"), observe("p")),
         forms=("json",)),
    Case("T6.json-bad-type", "JSON with a value of the wrong type is MALFORMED",
         (ALL, Frames("p", (b'{"command": {"tick": "soon"}}',)), hear_error("p", "MALFORMED"),
          answer("p"), observe("p")), forms=("json",)),
    Case("T6.json-deep", "JSON nested a thousand deep is MALFORMED",
         (ALL, Frames("p", (b'{"a":' * 1000 + b"1" + b"}" * 1000,)), hear_error("p", "MALFORMED"),
          answer("p"), observe("p")), forms=("json",)),
    *[Case(f"T6.not-json-{name}", f"What is not JSON, or not of the message's types, is MALFORMED: {name}",
           (ALL, Frames("p", (text,)), hear_error("p", "MALFORMED"), answer("p"), observe("p")), forms=("json",))
      for name, text in _NOT_JSON.items()],
    Case("T6.json-texts-for-numbers", "A text that is a number is taken for it",
         (ALL, Check("texts", _texts_for_numbers)), forms=("json",)),
    Case("T6.binary-in-json", "A binary message in a JSON session is MALFORMED",
         (ALL, Frames("p", (b"\x22\x02\x08\x05",)), hear_error("p", "MALFORMED"), answer("p"),
          observe("p")), forms=("json",)),
    Case("T6.json-in-binary", "A JSON message in a binary session is MALFORMED",
         (ALL, Frames("p", (b'{"heartbeat": {"sequence": 5}}',)), hear_error("p", "MALFORMED"),
          answer("p"), observe("p")), forms=("binary",)),
    Case("T6.both-forms", "A JSON and a binary session drive one world together",
         (join("binary", "arm0", "arm1"), join("json", "arm2", "arm3"), observe("binary", "json"),
          answer("json"), answer("binary"), observe("binary", "json")), forms=("json",)),
]
