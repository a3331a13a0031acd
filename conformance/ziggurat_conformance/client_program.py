# SPDX-License-Identifier: MIT
"""The controller program under test, as a process."""

import os
import time
from typing import Callable, Optional

from .process_group import ProcessGroup

_LOOKS_EVERY = 0.005  # [s]


class ClientProgram:
    """Raises RuntimeError if it can't be started."""

    def __init__(self, command: list, environment: dict):
        """environment: names and values beside those of this process, without its own of Ziggurat."""
        others = {name: value for name, value in os.environ.items() if not name.startswith("ZIGGURAT_")}
        self._command, self._environment = command, {**others, **environment}
        self.start_took = 0.0  # [s] until it connected
        self._start()

    def _start(self) -> None:
        try:
            self._group = ProcessGroup(self._command, self._environment)
        except OSError as error:
            raise RuntimeError(f"{self._command[0]}: the controller can't be started: {error.strerror}") from None
        self._started_at = time.monotonic()

    def await_start(self, is_reached: Callable[[], bool], longest: float) -> None:
        """Until it has connected or ended, at most so many seconds."""
        while not is_reached() and self.exit_code() is None and self._age() < longest:
            time.sleep(_LOOKS_EVERY)
        self.start_took = self._age()

    def _age(self) -> float:
        return time.monotonic() - self._started_at

    def restart(self) -> None:
        """Gives it twice the time that it needed before."""
        self._group.end()
        self._start()
        time.sleep(2 * self.start_took)

    def exit_code(self) -> Optional[int]:
        """None while it runs."""
        return self._group.exit_code()

    def printed(self) -> bytes:
        """The beginning and the end of it."""
        return self._group.printed()

    def end(self) -> str:
        """Ends it, with all that it has started. Returns the last words that it printed."""
        self._group.end()
        return self._group.output.last_words()
