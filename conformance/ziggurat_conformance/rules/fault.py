# SPDX-License-Identifier: MIT
"""A rule that a message breaks."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Fault:
    rule: str  # its number in docs/protocol.md
    text: str  # what is wrong
    code: str = ""  # the Error.Code that a server answers with; empty: none
    field: str = ""  # of the Error
    should: bool = False  # a SHOULD is not kept; otherwise a MUST

    def __str__(self) -> str:
        return f"{self.text} ({self.rule})"


def musts(faults: list) -> list:
    return [fault for fault in faults if not fault.should]
