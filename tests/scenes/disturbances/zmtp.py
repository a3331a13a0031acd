# SPDX-License-Identifier: MIT
"""ZeroMQ's wire protocol (ZMTP 3.0, no security) by hand, to send invalid bytes."""

import socket
import struct
import time


def free_port():
    """A port of the loopback that is free."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return listener.getsockname()[1]


class RawPeer:
    """A DEALER's connection. `drip`: wall time between two sent bytes [s]; 0 sends all at once.
    `routing_id`: that it asks for, also one that libzmq would not let a client set."""

    def __init__(self, endpoint, drip=0.0, routing_id=b""):
        host, port = endpoint.removeprefix("tcp://").rsplit(":", 1)
        self.socket = socket.create_connection((host, int(port)), timeout=60)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._drip = drip
        self._send_bytes(GREETING)
        self._receive_bytes(64)
        self._send_bytes(_frame(4, b"\x05READY" + _property(b"Socket-Type", b"DEALER")
                                + _property(b"Identity", routing_id)))
        self._receive_frame()  # the server's READY

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def _send_bytes(self, data):
        if not self._drip:
            self.socket.sendall(data)
            return
        for byte in data:
            self.socket.sendall(bytes([byte]))
            time.sleep(self._drip)  # elapsed time is the subject

    def send_message(self, message):
        self._send_bytes(_frame(0, message))

    def send_beginning(self, size, sent):
        """`sent` bytes of a frame of `size` bytes, and its header."""
        self._send_bytes(struct.pack(">BQ", 2, size) + bytes(sent))

    def send_half(self, message):
        """A frame whose header announces more bytes than follow."""
        data = _frame(0, message)
        self._send_bytes(data[:2 + len(message) // 2])

    def receive_message(self):
        """The next message other than a heartbeat."""
        while True:
            data = self._receive_frame()
            if data[:1] != b"\x22":  # ServerMessage.heartbeat
                return data

    def _receive_frame(self):
        [flags] = self._receive_bytes(1)
        [size] = struct.unpack(">Q", self._receive_bytes(8)) if flags & 2 else self._receive_bytes(1)
        return self._receive_bytes(size)

    def _receive_bytes(self, count):
        data = b""
        while len(data) < count:
            part = self.socket.recv(count - len(data))
            if not part:
                raise ConnectionError("the server closed the connection")
            data += part
        return data


GREETING = (b"\xff" + bytes(8) + b"\x7f" + b"\x03\x00" + b"NULL".ljust(20, b"\0") + bytes(32))


def _property(name, value):
    return bytes([len(name)]) + name + struct.pack(">I", len(value)) + value


def _frame(flags, body):
    if len(body) < 256:
        return struct.pack(">BB", flags, len(body)) + body
    return struct.pack(">BQ", flags | 2, len(body)) + body
