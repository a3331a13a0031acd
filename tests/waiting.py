# SPDX-License-Identifier: MIT
"""How tests in Python wait: for an event. The limit only bounds a hang, on a busy machine too."""

import pathlib
import time

HANG = 60.0  # [s]
_LOOKS_EVERY = 0.005  # [s]
_LOOKS_OF_AN_IDLE_PROGRAM, _MOST_TURNS = 20, 3  # of its threads meanwhile: some look around now and then


def wait_until(condition, what, hang=HANG):
    """Returns the first true value of `condition()`. Raises AssertionError with `what` if there is none."""
    end = time.monotonic() + hang
    while not (found := condition()):
        if time.monotonic() > end:
            raise AssertionError(f"not within {hang:g} s: {what}")
        time.sleep(_LOOKS_EVERY)
    return found


def wait_until_idle(pid):
    """Until all threads of a program sleep in many looks in a row. One that only waits for a processor does not sleep."""
    turns = []

    def is_idle():
        threads = _threads(pid)
        turns.append(sum(count for _, count in threads))
        if any(state != "S" for state, _ in threads):
            turns.clear()
        return len(turns) > _LOOKS_OF_AN_IDLE_PROGRAM and turns[-1] - turns[-_LOOKS_OF_AN_IDLE_PROGRAM] <= _MOST_TURNS

    wait_until(is_idle, f"process {pid} is idle")


def wait_until_stopped(pid):
    """Until SIGSTOP has stopped all threads of a program."""
    wait_until(lambda: all(state == "T" for state, _ in _threads(pid)), f"process {pid} is stopped")


def _threads(pid):
    """(state, how often it has begun to wait) of each."""
    found = []
    for thread in pathlib.Path(f"/proc/{pid}/task").iterdir():
        try:
            text = (thread / "status").read_text()
        except (FileNotFoundError, ProcessLookupError):  # the thread has ended
            continue
        lines = dict(line.split(":\t", 1) for line in text.splitlines() if ":\t" in line)
        found.append((lines["State"][0], int(lines["voluntary_ctxt_switches"])))
    return found
