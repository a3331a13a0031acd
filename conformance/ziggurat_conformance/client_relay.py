"""What stands between clients and the server's socket in client mode: ZeroMQ gathers all frames of a message, and has
no bound for their number. The relay counts what clients send, and reads no more than the kit may take."""

import select
import socket
import threading
import time
from typing import Optional

from .case import Failed
from .relay_pipe import AT_ONCE, RelayPipe
from .zmtp_frames import LONGEST

_MOST_BYTES, _MOST_FRAMES = LONGEST, 10_000  # that wait to be taken, beside what one read begins
_MOST_SIDE_BY_SIDE, _MOST_CONNECTIONS = 16, 1000  # at one time; in all
_LAST_WRITE = 0.2  # [s] for what the server sent before it was closed
_LOOKS_EVERY = 0.01  # [s] whether that is over


class Relay:
    """Listens until it is closed, on a thread of its own. Raises OSError if it can't."""

    def __init__(self, port: int, target: str):
        """port: of the loopback. target: the abstract name of the server's Unix socket."""
        self._listener = socket.create_server(("127.0.0.1", port), backlog=100)
        self._listener.setblocking(False)
        self._target = target
        self._pipes: list[RelayPipe] = []
        self._connected = 0  # in all
        self._bytes = self._frames = 0  # that are not taken yet
        self._lock = threading.Lock()
        self._waker, self._woken = socket.socketpair()
        self._waker.setblocking(False)
        self._end: Optional[float] = None  # of time.monotonic(), once it is being closed
        self._complaint = ""
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def check(self) -> None:
        """Raises Failed for what a client sent; nothing comes any more then."""
        if self._complaint:
            raise Failed(self._complaint)

    def is_full(self) -> bool:
        """Nothing is read until something is taken, but frames that have begun."""
        with self._lock:
            return self._bytes >= _MOST_BYTES or self._frames >= _MOST_FRAMES

    def check_room(self) -> None:
        """Where no whole message waits. Raises Failed if there can be none any more."""
        if self.is_full():
            raise Failed(f"the client sent {self._bytes} bytes in {self._frames} frames that make no whole message: a message is "
                         f"one frame (T2), and the kit takes at most {_MOST_BYTES} bytes and {_MOST_FRAMES} frames")

    def take(self, size: int, frames: int) -> None:
        """The kit has taken so many frames with so many bytes in all."""
        was_full = self.is_full()
        with self._lock:
            self._bytes, self._frames = max(0, self._bytes - size), max(0, self._frames - frames)
        if was_full:
            self._wake()

    def close(self) -> None:
        """Ends all connections, behind the server's socket."""
        self._end = time.monotonic() + _LAST_WRITE
        self._wake()
        self._thread.join()
        self._waker.close()

    def _wake(self) -> None:
        try:
            self._waker.send(b"!")
        except OSError:
            pass  # it is awake, or has ended

    def _run(self) -> None:
        try:
            while self._end is None:
                self._step()
            self._listener.close()
            while self._pipes and time.monotonic() < self._end:
                self._step()
        except Failed as failure:
            self._complaint = str(failure)
        except OSError as error:
            self._complaint = f"the kit can't serve the client: {error.strerror}"
        finally:
            for pipe in self._pipes:
                pipe.close()
            self._listener.close()
            self._woken.close()

    def _step(self) -> None:
        """Waits until something can be done, and does it."""
        poll = select.poll()
        poll.register(self._woken, select.POLLIN)
        if self._end is None and len(self._pipes) < _MOST_SIDE_BY_SIDE:
            poll.register(self._listener, select.POLLIN)
        is_full = self.is_full()
        for pipe in self._pipes:
            pipe.register(poll, is_full)
        ready = {descriptor for descriptor, _ in poll.poll(None if self._end is None else 1000 * _LOOKS_EVERY)}
        if self._woken.fileno() in ready:
            self._woken.recv(AT_ONCE)
        for pipe in self._pipes:
            pipe.move(ready, self.is_full())
        for pipe in [pipe for pipe in self._pipes if pipe.is_over()]:
            pipe.close()
            self._pipes.remove(pipe)
        if self._listener.fileno() in ready:
            self._accept()

    def _accept(self) -> None:
        try:
            client, _ = self._listener.accept()
        except (BlockingIOError, ConnectionAbortedError):
            return
        self._connected += 1
        server = socket.socket(socket.AF_UNIX)
        try:
            if self._connected > _MOST_CONNECTIONS:
                raise Failed(f"the client has connected {self._connected} times; the kit takes at most {_MOST_CONNECTIONS}")
            server.connect("\0" + self._target)
            self._pipes.append(RelayPipe(client, server, self._count))
        except BaseException as error:
            client.close()
            server.close()
            if not isinstance(error, ConnectionRefusedError):  # the server's socket is being closed
                raise

    def _count(self, frames: int, size: int) -> None:
        with self._lock:
            self._frames += frames
            self._bytes += size
