# SPDX-License-Identifier: MIT
"""Which thread drives which session of this program: a thread that waits for a supervisor's request can't answer for its
sessions meanwhile."""

from __future__ import annotations

import atexit
import os
import sys
import threading
import time
import weakref
from typing import Any, List

_STARTING = 1.0  # [s] for a thread that is about to begin with a session

_process = os.getpid()
_lock = threading.Lock()
_sessions: "weakref.WeakSet[Any]" = weakref.WeakSet()


def note(session: Any) -> None:
    with _lock:
        _sessions.add(session)


@atexit.register
def _leave() -> None:
    """The program ends by itself: its sessions leave, as done. After an exception they are lost, and may be resumed. In a
    process that was forked they are the parent's."""
    if getattr(sys, "last_type", None) is None and os.getpid() == _process:
        for session in list(_sessions):
            session.close()


def driven_here(endpoint: str) -> List[str]:
    """Of the sessions with this server that the calling thread drives: the id of a robot of each, or of its director. One
    that no thread has begun yet is the caller's, unless another thread begins with it at once."""
    end = time.monotonic() + _STARTING
    while True:
        with _lock:
            sessions = [each for each in _sessions if each.endpoint == endpoint and not each.is_over]
        mine = [each for each in sessions if each.thread in (None, threading.get_ident())]
        may_begin = threading.active_count() > 1 and any(each.thread is None for each in mine)
        if not may_begin or time.monotonic() >= end:
            return [each.id_of_one for each in mine]
        time.sleep(0.005)
