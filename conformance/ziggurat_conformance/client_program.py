"""The controller program under test, as a process."""

import os
from typing import Optional

from .process_group import ProcessGroup


class ClientProgram:
    """Raises RuntimeError if it can't be started."""

    def __init__(self, command: list, environment: dict):
        """environment: names and values beside those of this process, without its own of Ziggurat."""
        others = {name: value for name, value in os.environ.items() if not name.startswith("ZIGGURAT_")}
        try:
            self._group = ProcessGroup(command, {**others, **environment})
        except OSError as error:
            raise RuntimeError(f"{command[0]}: the controller can't be started: {error.strerror}") from None

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
