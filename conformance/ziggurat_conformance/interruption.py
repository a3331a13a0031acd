# SPDX-License-Identifier: MIT
"""Ctrl-C, SIGTERM and SIGHUP end the kit as exceptions, but not while a program is started or ended."""

import contextlib
import signal
import time
from typing import Iterator

_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
_ONE = 1.0  # [s] in which several are one: a second exception may break off what ends by the first


class Interrupted(KeyboardInterrupt):
    """By the signal of this number."""

    def __init__(self, number: int):
        super().__init__()
        self.number = number


class _State:
    depth = 0  # of postponed()
    pending = 0  # the signal that came meanwhile
    ignores = False  # for good
    last = 0  # the signal that was raised last
    raised = 0.0  # when [s]


def _raise(number: int) -> None:
    if _State.last and time.monotonic() - _State.raised < _ONE:
        return
    _State.last, _State.raised = number, time.monotonic()
    raise Interrupted(number)


def _handle(number: int, _frame) -> None:
    if _State.depth:
        _State.pending = number
    else:
        _raise(number)


def repeat() -> None:
    """Where something ended with another error: a signal may have broken it off, in a lock for example."""
    if _State.last:
        raise Interrupted(_State.last)


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
            _raise(number)


def ignore() -> None:
    """Behind an Interrupted: further signals have no effect, also while the interpreter ends."""
    for number in _SIGNALS:
        signal.signal(number, signal.SIG_IGN)
    _State.ignores = True


@contextlib.contextmanager
def handled() -> Iterator[None]:
    """Signals that were ignored at the start stay so."""
    _State.ignores, _State.last = False, 0
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
