"""What stands between a program under test and the kit's socket: ZeroMQ gathers all frames of a message, and has no bound
for their number. A relay counts what the program sends, and reads no more than the kit may take."""

import contextlib
import math
import os
import secrets
import select
import socket
import struct
import threading
import time
from typing import Optional, Union

import zmq

from .case import Failed
from .relay_pipe import AT_ONCE, RelayPipe
from .zmtp_frames import CLIENT, SERVER, Sender

_MOST_BYTES, MOST_FRAMES = 128 << 20, 10_000  # that wait to be taken, beside what one read begins
_MOST_SIDE_BY_SIDE, _MOST_CONNECTIONS = 16, 1000  # of clients: at one time; in all
_LAST_WRITE = 0.2  # [s] for what the kit sent before it was closed
_LOOKS_EVERY = 0.01  # [s] whether that is over
_SETTLING = 2.0  # [s] until what was passed on is a message, on a busy machine too
_SLICE = 0.25  # [s] of a wait, until it is seen that nothing can come any more
_CONNECTING = 5.0  # [s] to a server
_AROUND_ENCRYPTED = 33  # [bytes] of each frame of an encrypted connection


class _Relay:
    """Listens until it is closed, on a thread of its own."""

    def __init__(self, listener: socket.socket, sender: Sender):
        self._listener, self._sender = listener, sender
        self._listener.setblocking(False)
        self._pipes: list[RelayPipe] = []
        self._bytes = self._frames = 0  # that are not taken yet
        self._lock = threading.Lock()
        self._waker, self._woken = socket.socketpair()
        self._waker.setblocking(False)
        self._end: Optional[float] = None  # of time.monotonic(), once it is being closed
        self._complaint = ""
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def wait(self, kit: zmq.Socket, seconds: float) -> bool:
        """For a whole message, within so many seconds. Raises Failed for what the program sent; nothing comes any more then."""
        deadline = time.monotonic() + seconds
        while True:
            self.check()
            left = max(0.0, deadline - time.monotonic())
            if kit.poll(math.ceil(1000 * min(left, _SLICE))):
                return True
            if self._is_stuck() and not kit.poll(int(1000 * _SETTLING)):
                self._check_room()
            if time.monotonic() >= deadline:
                self.check()
                return False

    def check(self) -> None:
        """Raises Failed for what the program sent."""
        if self._complaint:
            raise Failed(self._complaint)

    def take(self, frames: list, is_encrypted: bool) -> None:
        """The kit has taken these frames."""
        was_full = self._is_full()
        size = sum(map(len, frames)) + (_AROUND_ENCRYPTED * len(frames) if is_encrypted else 0)
        with self._lock:
            self._bytes, self._frames = max(0, self._bytes - size), max(0, self._frames - len(frames))
        if was_full:
            self._wake()

    def close(self) -> None:
        """Ends all connections, behind the kit's socket."""
        self._end = time.monotonic() + _LAST_WRITE
        self._wake()
        self._thread.join()
        self._waker.close()

    def _check_room(self) -> None:
        """Where no whole message waits. Raises Failed if there can be none any more."""
        if self._is_stuck():
            raise Failed(f"the {self._sender.name} sent {self._bytes} bytes in {self._frames} frames that make no whole message: a "
                         f"message is one frame (T2), and the kit takes at most {_MOST_BYTES} bytes and {MOST_FRAMES} frames")

    def _is_full(self) -> bool:
        """Nothing is read until something is taken, but frames that have begun."""
        with self._lock:
            return self._bytes >= _MOST_BYTES or self._frames >= MOST_FRAMES

    def _is_stuck(self) -> bool:
        """Nothing more comes until something is taken."""
        return self._is_full()

    def _has_place(self) -> bool:
        """For another connection."""
        return True

    def _connected(self, accepted: socket.socket) -> tuple:
        """The ends of the program and of the kit. Raises ConnectionError if there is no other end now, Failed if there are
        too many connections."""
        raise NotImplementedError

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
            self._complaint = f"the kit can't pass on what the {self._sender.name} sends: {error.strerror}"
        finally:
            for pipe in self._pipes:
                pipe.close()
            self._listener.close()
            self._woken.close()

    def _step(self) -> None:
        """Waits until something can be done, and does it."""
        poll = select.poll()
        poll.register(self._woken, select.POLLIN)
        if self._end is None and self._has_place():
            poll.register(self._listener, select.POLLIN)
        is_full = self._is_full()
        for pipe in self._pipes:
            pipe.register(poll, is_full)
        ready = {descriptor for descriptor, _ in poll.poll(None if self._end is None else 1000 * _LOOKS_EVERY)}
        if self._woken.fileno() in ready:
            self._woken.recv(AT_ONCE)
        for pipe in self._pipes:
            pipe.move(ready, self._is_full())
        for pipe in [pipe for pipe in self._pipes if pipe.is_over()]:
            pipe.close()
            self._pipes.remove(pipe)
        if self._listener.fileno() in ready:
            self._accept()

    def _accept(self) -> None:
        try:
            accepted, _ = self._listener.accept()
        except (BlockingIOError, ConnectionAbortedError):
            return
        try:
            self._pipes.append(RelayPipe(*self._connected(accepted), self._sender, self._count))
        except BaseException as error:
            accepted.close()
            if not isinstance(error, ConnectionError):
                raise

    def _count(self, frames: int, size: int) -> None:
        with self._lock:
            self._frames += frames
            self._bytes += size


class ClientRelay(_Relay):
    """Where clients connect."""

    def __init__(self, address: Union[tuple, str], target: str):
        """address: host and port, or the path of a Unix socket. target: the abstract name of the kit's Unix socket. Raises
        OSError."""
        self._target = target
        self._connections = 0  # in all
        self._is_held = False
        super().__init__(_listener(address), CLIENT)

    def hold(self, is_held: bool) -> None:
        """is_held: nothing more is read of clients."""
        self._is_held = is_held
        self._wake()

    def unread(self) -> int:
        """[bytes] that clients have sent and that wait; of TCP, those that have left their machine's buffers."""
        return sum(pipe.unread() for pipe in list(self._pipes))

    def _is_full(self) -> bool:
        return self._is_held or super()._is_full()

    def has_client(self) -> bool:
        """One has connected, if only for a moment."""
        return self._connections > 0

    def _has_place(self) -> bool:
        return len(self._pipes) < _MOST_SIDE_BY_SIDE

    def _connected(self, accepted: socket.socket) -> tuple:
        self._connections += 1
        if self._connections > _MOST_CONNECTIONS:
            raise Failed(f"the client has connected {self._connections} times; the kit takes at most {_MOST_CONNECTIONS}")
        kit = socket.socket(socket.AF_UNIX)
        try:
            kit.connect("\0" + self._target)  # refused while the kit's socket is being closed
        except BaseException:
            kit.close()
            raise
        return accepted, kit


class ServerRelay(_Relay):
    """Where a socket of the kit connects that is meant for a server."""

    def __init__(self, server: str):
        """server: its endpoint."""
        self._server = server
        name = f"ziggurat-kit-{secrets.token_hex(16)}"
        self.endpoint = f"ipc://@{name}"
        listener = socket.socket(socket.AF_UNIX)
        listener.bind("\0" + name)
        listener.listen()
        super().__init__(listener, SERVER)

    def _is_stuck(self) -> bool:
        """Not while a long frame comes, which takes its time."""
        return self._is_full() and not any(pipe.is_within_a_frame() for pipe in list(self._pipes))

    def _connected(self, accepted: socket.socket) -> tuple:
        credentials = accepted.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, struct.calcsize("3i"))
        if struct.unpack("3i", credentials)[0] != os.getpid():
            raise ConnectionRefusedError  # another program
        try:
            return connect(self._server, _CONNECTING), accepted
        except OSError:
            raise ConnectionRefusedError from None  # the kit's socket tries it again


def _listener(address: Union[tuple, str]) -> socket.socket:
    if isinstance(address, tuple):
        return socket.create_server(address, backlog=100)
    with contextlib.suppress(FileNotFoundError):
        os.unlink(address)
    listener = socket.socket(socket.AF_UNIX)
    listener.bind(address)
    listener.listen(100)
    return listener


def connect(endpoint: str, seconds: float) -> socket.socket:
    """To a server. Raises OSError, and ValueError for what is no endpoint."""
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
