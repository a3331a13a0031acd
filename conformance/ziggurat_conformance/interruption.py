"""Ctrl-C, SIGTERM and SIGHUP end the kit as exceptions, but not while a program is started or ended."""

import contextlib
import signal
from typing import Iterator

_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Interrupted(KeyboardInterrupt):
    """By the signal of this number."""

    def __init__(self, number: int):
        super().__init__()
        self.number = number


class _State:
    depth = 0  # of postponed()
    pending = 0  # the signal that came meanwhile
    ignores = False  # for good


def _handle(number: int, _frame) -> None:
    if _State.depth:
        _State.pending = number
    else:
        raise Interrupted(number)


@contextlib.contextmanager
def postponed() -> Iterator[None]:
    """Signals that come meanwhile have their effect behind it."""
    _State.depth += 1
    try:
        yield
    finally:
        _State.depth -= 1
        if not _State.depth and (number := _State.pending):
            _State.pending = 0
            raise Interrupted(number)


def ignore() -> None:
    """Behind an Interrupted: further signals have no effect, also while the interpreter ends."""
    for number in _SIGNALS:
        signal.signal(number, signal.SIG_IGN)
    _State.ignores = True


@contextlib.contextmanager
def handled() -> Iterator[None]:
    """Signals that were ignored at the start stay so."""
    _State.ignores = False
    before = {number: signal.getsignal(number) for number in _SIGNALS}
    for number, handler in before.items():
        if handler not in (signal.SIG_IGN, None):  # None: not one of Python
            signal.signal(number, _handle)
    try:
        yield
    finally:
        for number, handler in before.items():
            if handler is not None and not _State.ignores:
                signal.signal(number, handler)
