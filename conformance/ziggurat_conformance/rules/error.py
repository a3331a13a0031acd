# SPDX-License-Identifier: MIT
"""What an Error of the server must hold (section 6)."""

from typing import Iterator

from ..wire import protocol
from .fault import Fault

_Error = protocol.Error


def error_faults(error: protocol.Error) -> Iterator[Fault]:
    if error.code not in _Error.Code.values() or not error.code:
        yield Fault("M0", f"an Error has the code {error.code} (section 6)")
    if error.severity not in (_Error.WARNING, _Error.DISCARD, _Error.FATAL):
        yield Fault("M0", f"an Error has the severity {error.severity} (section 6)")
    if not error.message:
        yield Fault("M0", "an Error has no sentence (section 6)", should=True)
