"""The server under test, as a process that cases may restart."""

import shlex
import signal
import socket
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Optional


class ServerProcess:
    """Starts the command and waits until something listens at its endpoint."""

    def __init__(self, command: str, scene: Path, patience: float, extra: Optional[dict] = None):
        self.endpoint = f"tcp://127.0.0.1:{_free_port()}"
        values = {"scene": str(scene), "endpoint": self.endpoint, **(extra or {})}
        self._arguments = [_filled(word, values) for word in shlex.split(command)]
        self._output = tempfile.TemporaryFile()
        try:
            self._process = subprocess.Popen(
                self._arguments, stdin=subprocess.DEVNULL, stdout=self._output,
                stderr=subprocess.STDOUT)
        except OSError as error:
            raise RuntimeError(f"the server could not be started: {error}") from None
        self._wait_until_it_listens(patience)

    def interrupt(self) -> None:
        self._process.send_signal(signal.SIGINT)

    def stop(self) -> None:
        """Twice Ctrl-C, then by force."""
        for _ in range(2):
            if self._process.poll() is None:
                self._process.send_signal(signal.SIGINT)
                try:
                    self._process.wait(0.5)
                except subprocess.TimeoutExpired:
                    pass
        if self._process.poll() is None:
            self._process.kill()
            self._process.wait()
        self._output.close()

    def runs(self) -> bool:
        return self._process.poll() is None

    def last_words(self) -> str:
        """The end of what it printed."""
        self._output.seek(0)
        return self._output.read()[-2000:].decode(errors="replace")

    def _wait_until_it_listens(self, patience: float) -> None:
        host, port = self.endpoint.removeprefix("tcp://").rsplit(":", 1)
        deadline = time.monotonic() + max(patience, 10)
        while time.monotonic() < deadline:
            if not self.runs():
                raise RuntimeError(
                    f"the server ended at once (exit code {self._process.returncode}):\n"
                    f"{self.last_words()}")
            try:
                with socket.create_connection((host, int(port)), 0.2):
                    return
            except OSError:
                time.sleep(0.01)
        words = self.last_words()
        self.stop()
        raise RuntimeError(f"nothing listens at {self.endpoint}; the server said:\n{words}")


def _filled(word: str, values: dict) -> str:
    for name, value in values.items():
        word = word.replace("{" + name + "}", str(value))
    return word


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]

