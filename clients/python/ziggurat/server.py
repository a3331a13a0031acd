"""A server as a child process, for programs that start a run themselves."""

from __future__ import annotations

import json
import subprocess
from typing import Any, Optional, Sequence


class Server:
    """Runs `ziggurat serve SCENE` on a free port of this machine until it is closed.

    command    path of the program, if it is not on the PATH
    arguments  other options of `ziggurat serve`
    """

    def __init__(self, scene: str, *, command: str = "ziggurat", arguments: Sequence[str] = ()):
        self.process = subprocess.Popen(
            [command, "serve", str(scene), "--endpoint", "tcp://127.0.0.1:*", "--json", *arguments],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.endpoint = self._read_endpoint()

    def _read_endpoint(self) -> str:
        line = self.process.stdout.readline()
        try:
            return json.loads(line)["endpoint"]
        except (ValueError, KeyError):
            _, errors = self.process.communicate()
            raise RuntimeError(f"ziggurat serve did not start: {line}{errors}") from None

    def wait(self, timeout: Optional[float] = None) -> int:
        """Waits for the end of the run [s]; returns the exit code."""
        self.process.communicate(timeout=timeout)
        return self.process.returncode

    def close(self) -> None:
        if self.process.poll() is None:
            self.process.terminate()
        self.process.communicate()

    def __enter__(self) -> "Server":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()
