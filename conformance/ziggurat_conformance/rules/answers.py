# SPDX-License-Identifier: MIT
"""Which answer a client's faulty message must have (S10, H15, section 6)."""

from typing import Iterator

from ..wire import protocol
from .fault import Fault, musts
from .session import Session, State

_TICKS = {"STALE_TICK", "FUTURE_TICK", "DUPLICATE_TICK"}
# What a server may answer a Hello that is faulty in other ways, too: by its keys, limits and phase.
_ALWAYS = {"FORBIDDEN", "TOO_MANY", "OUT_OF_STATE"}


class Answers:
    """The server's answers to one client, held against what the client said."""

    def __init__(self) -> None:
        self._refused: list = []  # faults of each Command or Leave that was not answered yet
        self._hello: list = []  # faults of the last Hello

    def said(self, state: State, message: protocol.ClientMessage, faults: list) -> None:
        """A message was sent in this state."""
        kind = message.WhichOneof("message")
        broken = musts(faults)
        if kind == "hello":
            self._hello = broken
        elif kind in ("command", "direction", "leave") and state in (State.STEPPING, State.PAUSED):
            if any(fault.code for fault in broken):
                self._refused.append(broken)

    def told(self, session: Session, message: protocol.ServerMessage) -> Iterator[Fault]:
        """A message came. `session` is as it was before."""
        kind = message.WhichOneof("message")
        if kind == "error" and message.error.severity == protocol.Error.DISCARD and self._refused:
            yield from self._refusal_faults(message.error, self._refused.pop(0))
        elif kind in ("welcome", "refusal"):
            yield from self._hello_faults(message)
        elif kind in ("observation", "world_state") and self._refused and session.owes and session.is_waited_for():
            fault = self._refused.pop(0)[0]
            yield Fault(fault.rule, f"the tick went on with a message that must be refused: {fault.text}")
        elif kind in ("reset", "end", "displaced"):
            self._refused.clear()

    def _refusal_faults(self, error: protocol.Error, broken: list) -> Iterator[Fault]:
        codes = {fault.code for fault in broken}
        code = _name(error.code)
        if code not in codes | (_TICKS if codes & _TICKS else set()):
            expected = " or ".join(sorted(codes))
            yield Fault(broken[0].rule, f"the answer is {code}; {expected} is expected: {broken[0].text}")
        fields = {fault.field for fault in broken if fault.code == code} - {""}
        if error.field and fields and error.field not in fields and code not in _TICKS:
            yield Fault("M0", f"field is {error.field!r}; {' or '.join(sorted(fields))} is expected")

    def _hello_faults(self, message: protocol.ServerMessage) -> Iterator[Fault]:
        broken, self._hello = self._hello, []
        if not broken:
            return
        if message.HasField("welcome"):
            yield Fault(broken[0].rule, f"Welcome answers a Hello that must be refused: {broken[0].text}")
            return
        code = _name(message.refusal.error.code)
        if code not in {broken[0].code, *_ALWAYS}:
            yield Fault("H15", f"the Refusal is {code}; {broken[0].code} is expected: {broken[0].text}")


def _name(code: int) -> str:
    return protocol.Error.Code.Name(code) if code in protocol.Error.Code.values() else str(code)
