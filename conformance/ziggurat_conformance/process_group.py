# SPDX-License-Identifier: MIT
"""A program under test with all that it starts: a session of processes of its own, which ends as a whole."""

import contextlib
import os
import signal
import subprocess
import time
from typing import Optional

from .interruption import postponed
from .program_output import ProgramOutput

_LOOKS_EVERY = 0.005  # [s]


class ProcessGroup:
    """Raises OSError if the program can't be started. What starts a session of its own is not ended with it."""

    def __init__(self, command: list, environment: Optional[dict] = None):
        self.output = ProgramOutput()
        with postponed():
            try:
                self._process = subprocess.Popen(command, env=environment, stdin=subprocess.DEVNULL, stdout=self.output.writer,
                                                 stderr=subprocess.STDOUT, start_new_session=True)
            except BaseException:
                self.output.close()
                raise
            _running.add(self)
            self.output.begin()

    def exit_code(self) -> Optional[int]:
        """Of the program itself; None while it runs. It stays a zombie, so that its number names no other group."""
        if self._process.returncode is not None:
            return self._process.returncode
        ended = os.waitid(os.P_PID, self._process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT)
        if ended is None:
            return None
        return ended.si_status if ended.si_code == os.CLD_EXITED else -ended.si_status

    def wait(self, seconds: float) -> Optional[int]:
        """Its exit code, once it has ended by itself; None: it has not, within so many seconds."""
        deadline = time.monotonic() + seconds
        while self.exit_code() is None and time.monotonic() < deadline:
            time.sleep(_LOOKS_EVERY)
        return self.exit_code()

    def interrupt(self) -> None:
        """As Ctrl-C: SIGINT to the program itself."""
        if self.exit_code() is None:
            self._process.send_signal(signal.SIGINT)

    def printed(self) -> bytes:
        """The beginning and the end of it."""
        if self.exit_code() is not None:
            self.output.settle()
        return self.output.text()

    def end(self) -> None:
        """By force, with all that it has started."""
        with postponed():
            if self._process.returncode is None:
                with contextlib.suppress(ProcessLookupError, PermissionError):
                    os.killpg(self._process.pid, signal.SIGKILL)
                self._process.wait()
            self.output.settle()
            self.output.close()
            _running.discard(self)


_running: set = set()


def end_all() -> None:
    """Those that are left when the kit ends, for whatever reason."""
    for group in list(_running):
        group.end()
