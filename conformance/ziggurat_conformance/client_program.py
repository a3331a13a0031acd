"""The controller program under test, as a process."""

import os
import subprocess
import tempfile
from typing import Optional

_MOST_READ = 4 << 20  # [bytes]


class ClientProgram:
    """Raises RuntimeError if it can't be started."""

    def __init__(self, command: list, environment: dict):
        """environment: names and values beside those of this process, without its own of Ziggurat."""
        others = {name: value for name, value in os.environ.items() if not name.startswith("ZIGGURAT_")}
        self._output = tempfile.TemporaryFile()
        try:
            self._process = subprocess.Popen(command, env={**others, **environment}, stdin=subprocess.DEVNULL,
                                             stdout=self._output, stderr=subprocess.STDOUT)
        except OSError as error:
            self._output.close()
            raise RuntimeError(f"{command[0]}: the controller can't be started: {error.strerror}") from None

    def exit_code(self) -> Optional[int]:
        """None while it runs."""
        return self._process.poll()

    def printed(self) -> bytes:
        self._output.seek(0)
        return self._output.read(_MOST_READ)

    def end(self) -> str:
        """Ends it. Returns the last words that it printed."""
        if self._process.poll() is None:
            self._process.kill()
        self._process.wait()
        size = self._output.seek(0, os.SEEK_END)
        self._output.seek(max(0, size - 2000))
        words = self._output.read().decode(errors="replace").strip()
        self._output.close()
        return words
