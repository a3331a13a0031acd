# SPDX-License-Identifier: MIT
"""The server under test, as a process that cases may restart."""

import random
import shlex
import socket
import time
from pathlib import Path
from typing import Optional

from .process_group import ProcessGroup


class ServerProcess:
    """Starts the command and waits until something listens at its endpoint."""

    def __init__(self, command: str, scene: Path, start_patience: float, extra: Optional[dict] = None):
        self.endpoint = f"tcp://127.0.0.1:{free_port()}"
        self._start_patience = start_patience  # [s] until it listens
        self._command, self._values = command, {"scene": str(scene), **(extra or {})}
        self._arguments = self._arguments_for(self.endpoint)
        try:
            self._group = ProcessGroup(self._arguments)
        except OSError as error:
            raise RuntimeError(f"{self._arguments[0]}: the server can't be started: "
                               f"{error.strerror}") from None
        try:
            self._wait_until_it_listens()
        except BaseException:
            self._group.end()
            raise

    def _arguments_for(self, endpoint: str) -> list:
        values = {**self._values, "endpoint": endpoint}
        return [_filled(word, values) for word in shlex.split(self._command)]

    def refuses_to_listen(self, endpoint: str) -> str:
        """What is wrong with another server of this command that is to listen there and must not: it has to
        end by itself, with another exit code than 0. Empty if nothing is."""
        other = ProcessGroup(self._arguments_for(endpoint))
        try:
            listens = _awaits_listener(other, endpoint, self._start_patience)
            code = other.exit_code()
        finally:
            other.end()
        return "it listens" if listens else "it runs" if code is None else "it ended with exit code 0" if code == 0 else ""

    def interrupt(self) -> None:
        self._group.interrupt()

    def stop(self) -> None:
        """Twice Ctrl-C, then by force, with all that it has started."""
        try:
            for _ in range(2):
                self._group.interrupt()
                self._group.wait(0.5)
        finally:
            self._group.end()

    def runs(self) -> bool:
        return self._group.exit_code() is None

    def exit_code(self, seconds: float) -> Optional[int]:
        """When it has ended by itself, within so many seconds; None: it has not."""
        return self._group.wait(seconds)

    def last_words(self) -> str:
        """The end of what it printed."""
        self._group.printed()
        return self._group.output.last_words()

    def _wait_until_it_listens(self) -> None:
        if _awaits_listener(self._group, self.endpoint, self._start_patience):
            return
        words = self.last_words()
        said = f"said:\n{words}" if words else "said nothing"
        if not self.runs():
            raise RuntimeError(f"the server ended at once, with exit code {self._group.exit_code()}; it {said}")
        raise RuntimeError(f"nothing listens at {self.endpoint}, which takes the place of {{endpoint}} in "
                           f"the command, after {self._start_patience:g} s; the server {said}")


def _awaits_listener(program: ProcessGroup, endpoint: str, seconds: float) -> bool:
    """Whether one listens there before the program ends, and within so many seconds."""
    host, port = endpoint.removeprefix("tcp://").rsplit(":", 1)
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline and program.exit_code() is None:
        try:
            with socket.create_connection((host, int(port)), 0.2):
                return True
        except OSError:
            time.sleep(0.01)
    return False


def check_listens(endpoint: str) -> None:
    """Raises RuntimeError with a sentence unless a server does."""
    try:
        _connect(endpoint, 5).close()
    except ValueError:
        raise RuntimeError(f"{endpoint!r} is no endpoint; tcp://127.0.0.1:5770 or ipc:///tmp/arena "
                           "would do") from None
    except OSError as error:
        raise RuntimeError(f"no server listens at {endpoint}: {error.strerror or error}") from None


def _connect(endpoint: str, seconds: float) -> socket.socket:
    """Raises OSError, and ValueError for what is no endpoint."""
    kind, _, address = endpoint.partition("://")
    if kind == "tcp":
        host, _, port = address.rpartition(":")
        return socket.create_connection((host.strip("[]"), int(port)), seconds)
    if kind != "ipc":
        raise ValueError(endpoint)
    server = socket.socket(socket.AF_UNIX)
    try:
        server.settimeout(seconds)
        server.connect("\0" + address[1:] if address.startswith("@") else address)
    except BaseException:
        server.close()
        raise
    return server


def _filled(word: str, values: dict) -> str:
    for name, value in values.items():
        word = word.replace("{" + name + "}", str(value))
    return word


def free_port() -> int:
    """Of the loopback, and below those that systems give to connections (Linux: from 32768 on): such a one could be
    taken by a client before the server listens."""
    for _ in range(1000):
        port = random.randrange(20000, 32768)
        with socket.socket() as probe:
            try:
                probe.bind(("127.0.0.1", port))
                return port
            except OSError:
                pass  # somebody has it
    raise RuntimeError("no port from 20000 to 32767 is free")
