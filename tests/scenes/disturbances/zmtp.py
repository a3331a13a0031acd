"""ZeroMQ's wire protocol (ZMTP 3.0, no security) by hand, to speak it badly."""

import socket
import struct
import time


class RawPeer:
    """A DEALER's connection. `drip`: wall time between two bytes that it sends [s]; 0 sends at once."""

    def __init__(self, endpoint, drip=0.0):
        host, port = endpoint.removeprefix("tcp://").rsplit(":", 1)
        self.socket = socket.create_connection((host, int(port)), timeout=20)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._drip = drip
        self.send(GREETING)
        self._receive(64)
        self.send(_frame(4, b"\x05READY\x0bSocket-Type" + struct.pack(">I", 6) + b"DEALER"))
        self._hear_frame()  # its READY

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def send(self, data):
        if not self._drip:
            self.socket.sendall(data)
            return
        for byte in data:
            self.socket.sendall(bytes([byte]))
            time.sleep(self._drip)

    def say(self, message):
        self.send(_frame(0, message))

    def say_half(self, message):
        """A frame that announces more than comes."""
        data = _frame(0, message)
        self.send(data[:2 + len(message) // 2])

    def hear(self):
        """The next message that is no heartbeat."""
        while True:
            data = self._hear_frame()
            if data[:1] != b"\x22":  # ServerMessage.heartbeat
                return data

    def _hear_frame(self):
        [flags] = self._receive(1)
        [size] = struct.unpack(">Q", self._receive(8)) if flags & 2 else self._receive(1)
        return self._receive(size)

    def _receive(self, count):
        data = b""
        while len(data) < count:
            part = self.socket.recv(count - len(data))
            if not part:
                raise ConnectionError("the server hung up")
            data += part
        return data


GREETING = (b"\xff" + bytes(8) + b"\x7f" + b"\x03\x00" + b"NULL".ljust(20, b"\0") + bytes(32))


def _frame(flags, body):
    if len(body) < 256:
        return struct.pack(">BB", flags, len(body)) + body
    return struct.pack(">BQ", flags | 2, len(body)) + body
