"""Connections that belong to nobody and mean no good, each function a process until the server is
gone."""

import random
import select
import socket
import struct
import time

from ziggurat import protocol_pb2 as v1
from zmtp import GREETING, RawPeer


def _open(endpoint):
    host, port = endpoint.removeprefix("tcp://").rsplit(":", 1)
    stranger = socket.create_connection((host, int(port)), timeout=20)
    stranger.setblocking(False)
    return stranger


def slowloris(endpoint, count=300):
    """So many half-open connections, each of which sends a byte of its greeting a second."""
    connections = [_open(endpoint) for _ in range(count)]
    for byte in GREETING:
        for connection in connections:
            try:
                connection.send(bytes([byte]))
            except OSError:
                pass  # hung up: as it should be in the end
        time.sleep(1)


def noise(endpoint):
    """Other protocols, and none; a frame that claims to be of 2^62 bytes; half a handshake."""
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
    """An observer that asks for the whole state as fast as it may, and reads none of it."""
    hello = v1.Hello(version=v1.Version(major=1), role=v1.ROLE_OBSERVER, client_name="deaf")
    while True:
        with RawPeer(endpoint) as peer:
            peer.say(v1.ClientMessage(hello=hello).SerializeToString())
            try:
                for i in range(1, 20_000):
                    ask = v1.Request(id=i, read=v1.ReadRequest())
                    peer.say(v1.ClientMessage(request=ask).SerializeToString())
                    time.sleep(0.0012)
            except OSError:
                pass  # it was hung up on


def annoy(function, endpoint):
    try:
        function(endpoint)
    except OSError:
        pass  # there is no server any more
