# SPDX-License-Identifier: MIT
"""A server as a child process, for programs that start a run themselves."""

from __future__ import annotations

import json
import os
import subprocess
from typing import Any, Optional, Sequence

from .errors import ConnectionLost
from .joining import connect
from .session import Session


def _readable(messages: str) -> str:
    """What a server with --json printed on stderr, as sentences with their places: its faults, if there are any."""
    texts, faults = [], []
    for line in messages.splitlines():
        try:
            message = json.loads(line)
            place = f"{message['file']}:{message['line']}:{message['column']}: " if message.get("line") else (
                f"{message['file']}: " if message.get("file") else "")
            texts.append(place + message["text"])
            if message.get("severity") == "fault":
                faults.append(texts[-1])
        except (ValueError, KeyError, TypeError, AttributeError):
            texts.append(line)
    return "\n".join(text for text in faults or texts if text)


class Server:
    """Runs `ziggurat serve SCENE` at a local socket of its own until it is closed, or this program ends, however
    that happens.

    command    path of the program, if it is not on the PATH
    arguments  other options of `ziggurat serve`
    """

    def __init__(self, scene: str, *, command: str = "ziggurat", arguments: Sequence[str] = ()):
        # Nothing is written: the server ends when the other end is closed, as by the end of this program.
        self._end_for_program: Optional[int]
        end_for_server, self._end_for_program = os.pipe()
        try:
            self.process = subprocess.Popen(
                [command, "serve", str(scene), "--endpoint", "ipc://*", "--json", "--end-with-input",
                 *arguments],
                stdin=end_for_server, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        except FileNotFoundError:
            self._release()
            raise FileNotFoundError(f"there is no program '{command}'; put the folder of 'ziggurat' on the PATH, or "
                                    "pass command=PATH") from None
        except BaseException:
            self._release()
            raise
        finally:
            os.close(end_for_server)
        self.endpoint = self._read_endpoint()

    def _release(self) -> None:
        if self._end_for_program is not None:
            os.close(self._end_for_program)
            self._end_for_program = None

    def _read_endpoint(self) -> str:
        assert self.process.stdout is not None  # a pipe
        line = self.process.stdout.readline()
        try:
            return str(json.loads(line)["endpoint"])
        except (ValueError, KeyError):
            _, errors = self.process.communicate()
            self._release()
            raise RuntimeError(f"ziggurat serve did not start: {line}{_readable(errors)}") from None

    def session(self, **options: Any) -> Session:
        """As connect(), but with nothing from the environment: that may be of another server. Without one this server is
        ended; if it has ended itself, because of a fault in the scene for example, RuntimeError has what it printed."""
        try:
            return connect(self.endpoint, environment={}, has_ended=self._has_ended, **options)
        except BaseException as error:
            is_explained = isinstance(error, ConnectionLost) or getattr(error, "code", "") == "OUT_OF_STATE"
            explanation = self._last_words() if is_explained else ""
            self.close()
            if not explanation:
                raise
        raise RuntimeError(explanation)  # without the errors of the connection, which explain nothing

    def _has_ended(self) -> bool:
        return self.process.poll() is not None

    def _last_words(self) -> str:
        """What the server printed, if it has ended, or does now."""
        try:
            _, errors = self.process.communicate(timeout=1)
        except subprocess.TimeoutExpired:
            return ""
        return f"ziggurat serve has ended: {_readable(errors)}"

    def wait(self, timeout: Optional[float] = None) -> int:
        """Waits for the end of the run [s]; returns the exit code."""
        self.process.communicate(timeout=timeout)
        return self.process.returncode

    def close(self) -> None:
        if self.process.poll() is None:
            self.process.terminate()
        self.process.communicate()
        self._release()

    def __enter__(self) -> "Server":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()
