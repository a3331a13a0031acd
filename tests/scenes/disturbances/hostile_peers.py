# SPDX-License-Identifier: MIT
"""Hostile peers without a session. Each function runs in a process of its own until the server has
ended."""

import random
import select
import socket
import struct
import time

from ziggurat import protocol_pb2 as v1
from zmtp import GREETING, RawPeer


def _open(endpoint):
    host, port = endpoint.removeprefix("tcp://").rsplit(":", 1)
    connection = socket.create_connection((host, int(port)), timeout=60)
    connection.setblocking(False)
    return connection


def slowloris(endpoint, count=300):
    """Opens `count` connections. Each sends one byte of its greeting per second."""
    connections = [_open(endpoint) for _ in range(count)]
    for byte in GREETING:
        for connection in connections:
            try:
                connection.send(bytes([byte]))
            except OSError:
                pass  # the server closed the connection, as it should
        time.sleep(1)  # elapsed time is the subject


def noise(endpoint):
    """Sends other protocols, random bytes, a frame that claims 2^62 bytes, half a handshake."""
    draw = random.Random(2)
    huge = GREETING + b"\x06" + struct.pack(">Q", 2**62)
    while True:
        for data in (b"GET / HTTP/1.1\r\n\r\n", draw.randbytes(50_000), GREETING[:11], huge,
                     GREETING + draw.randbytes(500)):
            connection = _open(endpoint)
            try:
                connection.send(data)
                select.select([connection], [], [], 0.01)
            except OSError:
                pass
            connection.close()


def never_reads(endpoint):
    """An observer that requests the whole state as fast as it is allowed to and reads no answer."""
    hello = v1.Hello(version=v1.Version(major=1), role=v1.ROLE_OBSERVER, client_name="never reads")
    while True:
        with RawPeer(endpoint) as peer:
            peer.send_message(v1.ClientMessage(hello=hello).SerializeToString())
            try:
                for i in range(1, 20_000):
                    request = v1.Request(id=i, read=v1.ReadRequest())
                    peer.send_message(v1.ClientMessage(request=request).SerializeToString())
                    time.sleep(0.0012)  # as fast as it may
            except OSError:
                pass  # the server closed the connection


def run_until_server_ends(function, endpoint):
    try:
        function(endpoint)
    except OSError:
        pass  # the server has ended
