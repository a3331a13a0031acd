"""usage: hostile_client.py HOW    A client that sends without end, or what no server takes, to ZIGGURAT_ENDPOINT."""

import os
import signal
import socket
import sys
import time

import zmq
from ziggurat_conformance.wire import protocol

GREETING = b"\xff" + bytes(8) + b"\x7f\x03\x00NULL" + bytes(48)
READY = b"\x05READY\x0bSocket-Type\x00\x00\x00\x06DEALER"
ANSWER = len(GREETING) + 2 + len(b"\x05READY\x0bSocket-Type\x00\x00\x00\x06ROUTER\x08Identity\x00\x00\x00\x00")  # [bytes]
HALF = 100 << 20  # [bytes] of a frame that does not end


def opened():
    """A connection behind its handshake."""
    host, port = os.environ["ZIGGURAT_ENDPOINT"].removeprefix("tcp://").split(":")
    connection = socket.create_connection((host, int(port)))
    connection.sendall(GREETING + b"\x04" + bytes([len(READY)]) + READY)
    heard = 0
    while heard < ANSWER and (data := connection.recv(ANSWER - heard)):
        heard += len(data)
    return connection


def without_end(data):
    connection = opened()
    while True:
        connection.sendall(data)


def once(data):
    connection = opened()
    connection.sendall(data)
    signal.pause()


def halves():
    """Each of many connections begins a long frame."""
    there = []
    while True:
        there.append(opened())
        there[-1].sendall(b"\x02" + HALF.to_bytes(8, "big"))
        there[-1].sendall(bytes(1 << 20))


def connections():
    while True:
        opened().close()


def connections_with_a_part():
    while True:
        connection = opened()
        connection.sendall(b"\x03" + (8 << 20).to_bytes(8, "big") + bytes(8 << 20))
        connection.close()


def of_another_kind():
    host, port = os.environ["ZIGGURAT_ENDPOINT"].removeprefix("tcp://").split(":")
    socket.create_connection((host, int(port))).sendall(b"GET / HTTP/1.1\r\n\r\n")
    signal.pause()


def dealer(most_waiting=1000):
    client = zmq.Context.instance().socket(zmq.DEALER)
    client.set_hwm(most_waiting)
    if "ZIGGURAT_SERVER_KEY" in os.environ:
        client.curve_serverkey = os.environ["ZIGGURAT_SERVER_KEY"].encode()
        with open(os.environ["ZIGGURAT_CURVE_SECRET"], encoding="ascii") as file:
            secret_key = file.read().strip().encode()
        client.curve_secretkey, client.curve_publickey = secret_key, zmq.curve_public(secret_key)
    client.connect(os.environ["ZIGGURAT_ENDPOINT"])
    return client


def many_frames():
    """One message, which ends: encrypted, the server alone sees where."""
    dealer().send_multipart([b""] * 300_000)
    signal.pause()


def long_heartbeats():
    """Each has 4 MiB of fields that no version knows. What the server says is not read."""
    client = dealer(most_waiting=1)
    client.send(protocol.ClientMessage(hello={
        "version": {"major": 1}, "role": protocol.ROLE_CONTROLLER, "robots": ["*"]}).SerializeToString())
    client.recv()
    unknown = b"\xfa\x7f" + b"\x80\x80\x80\x02" + bytes(1 << 22)
    for sequence in range(1, 100):
        content = protocol.Heartbeat.FromString(b"\x08" + bytes([sequence]) + unknown)
        client.send(protocol.ClientMessage(heartbeat=content).SerializeToString())
    signal.pause()


def heartbeats():
    """Instead of Commands; fewer than are too many (M7). What the server says is not read."""
    client = dealer()
    client.send(protocol.ClientMessage(hello={
        "version": {"major": 1}, "role": protocol.ROLE_CONTROLLER, "robots": ["*"]}).SerializeToString())
    client.recv()
    for sequence in range(1_000_000):
        client.send(protocol.ClientMessage(heartbeat={"sequence": sequence}).SerializeToString())
        time.sleep(0.005)  # fewer than are too many


HOWS = {
    "frames": lambda: without_end(b"\x01\x00" * 500_000),
    "small-frames": lambda: without_end((b"\x01\x28" + bytes(40)) * 25_000),
    "bytes": lambda: without_end(b"\x03" + (1 << 20).to_bytes(8, "big") + bytes(1 << 20)),
    "commands": lambda: without_end((b"\x05\x0a\x09SUBSCRIBE") * 50_000),
    "announced": lambda: once(b"\x02" + (1 << 63).to_bytes(8, "big")),
    "halves": halves,
    "connections": connections,
    "connections-with-a-part": connections_with_a_part,
    "of-another-kind": of_another_kind,
    "many-frames": many_frames,
    "heartbeats": heartbeats,
    "long-heartbeats": long_heartbeats,
}

if __name__ == "__main__":
    HOWS[sys.argv[1]]()
