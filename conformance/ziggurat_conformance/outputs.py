# SPDX-License-Identifier: MIT
"""What is written to: reports, checked before the first case is played, so that no run is lost; stdout and stderr."""

import errno
import os
import signal
import time
from pathlib import Path
from typing import Callable, Optional, TextIO

_READER_STARTS = 10.0  # [s] that a reader which was started beside this program may take
_READER_TAKES = 0.3  # [s] for the last words


class WrongOutput(Exception):
    """A sentence that names the option and what to write instead."""


def _check_one(option: str, path: Path, ending: str) -> None:
    if path.is_dir():
        raise WrongOutput(f"{option} is '{path}', a folder; name a file in it")
    if not path.exists() and not path.parent.is_dir():
        raise WrongOutput(f"{option} is '{path}', whose folder is not there; make it first")
    if path.suffix != ending and not (path.exists() and not path.is_file()):  # pipes and devices need none
        raise WrongOutput(f"{option} is '{path}'; its name must end with {ending}, because that is the format "
                          "of its content")


def _opened_pipe(option: str, path: Path) -> int:
    """Its reader waits until it is closed."""
    deadline = time.monotonic() + _READER_STARTS
    while True:
        try:
            pipe = os.open(path, os.O_WRONLY | os.O_NONBLOCK)
            os.set_blocking(pipe, True)
            return pipe
        except OSError as error:
            if error.errno != errno.ENXIO:
                raise
        if time.monotonic() > deadline:
            raise WrongOutput(f"{option} is '{path}', a pipe without reader; start its reader first")
        time.sleep(0.02)


class Reports:
    """The files of those that are asked for. All functions raise WrongOutput."""

    def __init__(self, named: list):
        """named: (option, path, ending) of each."""
        self._paths = {option: path for option, path, _ in named}
        self._pipes: dict[str, int] = {}  # option → descriptor
        for option, path, ending in named:
            try:
                _check_one(option, path, ending)
                if path.is_fifo():
                    self._pipes[option] = _opened_pipe(option, path)
            except OSError as error:
                raise WrongOutput(f"{option} is '{path}': {error.strerror}") from None

    def write(self, contents: dict) -> None:
        """contents: option → function that makes the bytes. What can't be written keeps no other from its file."""
        faults = []
        for option, path in self._paths.items():
            try:
                with open(self._pipes.get(option, path), "wb") as file:
                    file.write(contents[option]())
            except OSError as error:
                faults.append(f"{option} {path} can't be written: {error.strerror}")
        if faults:
            raise WrongOutput("; ".join(faults))


def keep_descriptors() -> None:
    """Nothing that is opened later takes the place of stdin, stdout or stderr where these are closed: libraries print there."""
    while (descriptor := os.open(os.devnull, os.O_RDWR)) < 3:
        pass
    os.close(descriptor)


class Output:
    """Takes the place of sys.stdout or sys.stderr. What can't be written is let go, so that the run goes on to its reports;
    `fault` says why."""

    def __init__(self, name: str, stream: Optional[TextIO]):
        """stream: None if it is closed, which is no fault."""
        self._name = name
        self._stream = stream or open(os.devnull, "w")
        self.fault = ""
        if hasattr(self._stream, "reconfigure"):
            self._stream.reconfigure(errors="replace")  # what its encoding does not have

    def write(self, text: str) -> int:
        self._attempt(lambda: self._stream.write(text))
        return len(text)

    def flush(self) -> None:
        self._attempt(self._stream.flush)

    def isatty(self) -> bool:
        return self._stream.isatty()

    def end(self, text: str = "") -> None:
        """Writes the text and what waits, or lets them go if its reader does not take them soon. For the main thread."""
        before = signal.signal(signal.SIGALRM, _raise_timeout)
        try:
            self._attempt(lambda: self._write_soon(text))
        finally:
            signal.signal(signal.SIGALRM, before)

    def _write_soon(self, text: str) -> None:
        signal.setitimer(signal.ITIMER_REAL, _READER_TAKES)
        try:
            self._stream.write(text)
            self._stream.flush()
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)

    def _attempt(self, act: Callable) -> None:
        try:
            act()
        except OSError as error:
            nothing = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nothing, self._stream.fileno())  # what is left in its buffer, too
            os.close(nothing)
            if not isinstance(error, BrokenPipeError):  # of a reader such as head
                self.fault = f"{self._name} can't be written: {error.strerror}"


def _raise_timeout(*_) -> None:
    raise TimeoutError(errno.ETIMEDOUT, "it is not read")
