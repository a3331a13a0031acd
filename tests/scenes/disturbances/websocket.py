# SPDX-License-Identifier: MIT
"""A viewer's end of WebSocket (RFC 6455) by hand, to send invalid bytes too."""

import base64
import json
import os
import socket
import struct

TEXT, BINARY, CLOSE, PING, PONG = 1, 2, 8, 9, 10
PAUSE, RESUME, STEP, RESET, SPEED, MOVE, SPAWN, REMOVE = range(1, 9)  # services


def frame(opcode, content=b"", first=0x80, is_masked=True, length=None):
    """`first`: bits beside the opcode, 0x80 ends the message; `length`: another than that of the content."""
    length = len(content) if length is None else length
    mask_bit = 0x80 if is_masked else 0
    if length < 126:
        header = bytes([first | opcode, mask_bit | length])
    elif length < 65536:
        header = struct.pack(">BBH", first | opcode, mask_bit | 126, length)
    else:
        header = struct.pack(">BBQ", first | opcode, mask_bit | 127, length)
    return header + (bytes(4) if is_masked else b"") + content  # masked with zeros


def handshake(target="/", host="localhost", *more):
    key = base64.b64encode(os.urandom(16)).decode()
    return "\r\n".join([f"GET {target} HTTP/1.1", f"Host: {host}", "Upgrade: websocket", "Connection: Upgrade",
                        "Sec-WebSocket-Version: 13", f"Sec-WebSocket-Key: {key}",
                        "Sec-WebSocket-Protocol: foxglove.websocket.v1", *more, "", ""]).encode()


class RawViewer:
    """A connection behind its handshake. `status` is that of the answer; 101: it is open."""

    def __init__(self, port, token="", request=None):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=60)
        self.buffer = b""
        self.status = None
        self.socket.sendall(request or handshake(f"/?token={token}" if token else "/"))
        self.answer = self._until(b"\r\n\r\n").decode(errors="replace")
        self.status = int(self.answer.split()[1]) if self.answer else None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def _until(self, end):
        while end not in self.buffer:
            part = self._receive()
            if not part:
                return b""
            self.buffer += part
        at = self.buffer.index(end) + len(end)
        head, self.buffer = self.buffer[:at], self.buffer[at:]
        return head

    def _receive(self):
        try:
            return self.socket.recv(65536)
        except ConnectionError:
            return b""

    def _exactly(self, size):
        while len(self.buffer) < size:
            part = self._receive()
            if not part:
                raise ConnectionError("closed")
            self.buffer += part
        head, self.buffer = self.buffer[:size], self.buffer[size:]
        return head

    def send(self, data):
        """False if the server has closed."""
        try:
            self.socket.sendall(data)
            return True
        except ConnectionError:
            return False

    def say(self, **operation):
        return self.send(frame(TEXT, json.dumps(operation).encode()))

    def call(self, service, number, payload, encoding=b"json"):
        """Calls a service, by its number in the list of services."""
        return self.send(frame(BINARY, struct.pack("<BIII", 2, service, number, len(encoding)) + encoding + payload))

    def hear(self):
        """The next frame: opcode, content. Raises ConnectionError at the end."""
        first, length = self._exactly(2)
        if length == 126:
            [length] = struct.unpack(">H", self._exactly(2))
        elif length == 127:
            [length] = struct.unpack(">Q", self._exactly(8))
        return first & 15, self._exactly(length)

    def hear_operation(self, *names):
        """The next text message with one of these operations."""
        while True:
            opcode, content = self.hear()
            if opcode == TEXT and json.loads(content)["op"] in names:
                return json.loads(content)

    def hear_answer(self, number):
        """Of a call: True and its content, or False and why it was refused."""
        while True:
            opcode, content = self.hear()
            if opcode == BINARY and content[0] == 3 and struct.unpack_from("<I", content, 5) == (number,):
                return True, json.loads(content[17:])
            if opcode == TEXT:
                told = json.loads(content)
                if told["op"] == "serviceCallFailure" and told["callId"] == number:
                    return False, told["message"]

    def is_closed(self):
        """Reads until the server closes; fails by a timeout of 20 s if it does not."""
        try:
            while self.hear()[0] != CLOSE:
                pass
        except ConnectionError:
            pass
        return True
