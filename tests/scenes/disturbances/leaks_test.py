# SPDX-License-Identifier: MIT
"""Thousands of peers connect and disconnect, correctly and not; the server leaks no file and no memory."""

import ctypes
import os
import pathlib
import resource
import socket
import struct
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from harness import INTERRUPTED, SceneTest  # noqa: E402
from waiting import wait_until_idle  # noqa: E402
from zmtp import GREETING, RawPeer  # noqa: E402
from ziggurat import protocol_pb2 as v1  # noqa: E402

WARM_UP = 2000  # the server keeps what a connection sent for some seconds
CONNECTIONS = 10000
# [KiB] of memory over all connections, 210 bytes each: less than a record of each takes.
MOST_GROWTH = 2048


PR_SET_THP_DISABLE = 41  # <linux/prctl.h>


def disable_huge_pages():
    """In the child process. A huge page of 2 MiB would hide what is measured."""
    ctypes.CDLL(None).prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0)


def hello(role=v1.ROLE_CONTROLLER, **fields):
    return v1.ClientMessage(hello=v1.Hello(
        version=v1.Version(major=1), role=role, client_name="short-lived" * 20, **fields)
        ).SerializeToString()


def polite(endpoint, number):
    """A supervisor that sends a request and leaves. (A controller that leaves takes its robots along.)"""
    with RawPeer(endpoint) as peer:
        peer.send_message(hello(role=v1.ROLE_SUPERVISOR))
        expect(peer, "welcome")
        peer.send_message(status_request(number))
        expect(peer, "response")
        peer.send_message(v1.ClientMessage(leave=v1.Leave(reason=v1.Leave.DONE)).SerializeToString())


def lost(endpoint, number):
    """A controller that takes over the robots of the one before. Its connection breaks, and no client
    resumes its session."""
    with RawPeer(endpoint) as peer:
        peer.send_message(hello(robots=[f"r{number % 3}"], takeover=True))
        expect(peer, "welcome")
        reset(peer.socket)


def lost_in_the_tick(endpoint, number):
    """The same with all robots: the tick begins, and then waits again."""
    with RawPeer(endpoint) as peer:
        peer.send_message(hello(robots=["*"], takeover=True))
        expect(peer, "welcome", "observation")
        peer.send_message(v1.ClientMessage(command=v1.Command(tick=2**40)).SerializeToString())
        expect(peer, "error")


def refused(endpoint, number):
    with RawPeer(endpoint) as peer:
        peer.send_message(hello(robots=[f"unknown{number}"]))
        expect(peer, "refusal")


def observer(endpoint, number):
    """Disconnects before the answer arrives."""
    with RawPeer(endpoint) as peer:
        peer.send_message(hello(role=v1.ROLE_OBSERVER))
        expect(peer, "welcome")
        peer.send_message(status_request(number))


def malformed(endpoint, number):
    with RawPeer(endpoint) as peer:
        peer.send_message(b"\xff" + number.to_bytes(8, "big"))
        expect(peer, "error")
        peer.send_half(hello(robots=["*"]))


def no_bytes(endpoint, number):
    connect(endpoint).close()


def half_a_greeting(endpoint, number):
    connection = connect(endpoint)
    connection.sendall(GREETING[:number % len(GREETING)])
    reset(connection)


def connect(endpoint):
    host, port = endpoint.removeprefix("tcp://").rsplit(":", 1)
    return socket.create_connection((host, int(port)), timeout=60)


def status_request(number):
    return v1.ClientMessage(
        request=v1.Request(id=number, status=v1.StatusRequest())).SerializeToString()


def expect(peer, *kinds):
    """Receives messages of exactly these kinds, in this order; skips Loading."""
    for expected in kinds:
        kind = "loading"
        while kind == "loading":
            kind = v1.ServerMessage.FromString(peer.receive_message()).WhichOneof("message")
        if kind != expected:
            raise AssertionError(f"expected {expected}, got {kind}")


def reset(connection):
    """Resets the TCP connection, as after a crash of the peer's machine."""
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    connection.close()


PEERS = (polite, lost, lost_in_the_tick, refused, observer, malformed, no_bytes, half_a_greeting)


class Leaks(SceneTest):
    def measure(self, process):
        """Open files and memory [KiB]."""
        status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
        memory = next(line for line in status.splitlines() if line.startswith("VmRSS"))
        return len(os.listdir(f"/proc/{process.pid}/fd")), int(memory.split()[1])

    def connect_and_leave(self, endpoint, numbers):
        for number in numbers:
            PEERS[number % len(PEERS)](endpoint, number)

    def test_thousands_of_connections_leak_nothing(self):
        process = self.start("serve", self.scene, "--endpoint", "tcp://127.0.0.1:*", "--quiet",
                             limit=120, preexec_fn=disable_huge_pages)
        endpoint = process.stdout.readline().split()[1]
        polite(endpoint, 1)  # the scene is loaded
        wait_until_idle(process.pid)
        idle, _ = self.measure(process)
        self.connect_and_leave(endpoint, range(WARM_UP))
        _, memory = self.measure(process)
        self.connect_and_leave(endpoint, range(WARM_UP, WARM_UP + CONNECTIONS))
        files = self.wait_for(lambda: self.measure(process)[0], lambda files: files <= idle,
                              "return to the idle number of open files")
        growth = self.measure(process)[1] - memory
        print(f"{CONNECTIONS} connections: {files} open files, {growth} KiB more", flush=True)
        self.assertLess(growth, MOST_GROWTH)
        self.interrupt(process)
        self.assertEqual(self.finish(process).code, INTERRUPTED)

    def test_half_open_connections_do_not_block_others(self):
        """More connections than the limit on open files. The server closes them after its time limit."""
        soft, hard = 256, resource.getrlimit(resource.RLIMIT_NOFILE)[1]
        process = self.start("serve", self.scene, "--endpoint", "tcp://127.0.0.1:*", "--quiet", limit=120,
                             preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard)))
        endpoint = process.stdout.readline().split()[1]
        half_open = [connect(endpoint) for _ in range(2 * soft)]
        polite(endpoint, 1)
        for connection in half_open:  # each has sent nothing
            connection.settimeout(60)
            while connection.recv(100):  # the server's greeting, then the end
                pass
            connection.close()
        self.interrupt(process)
        self.assertEqual(self.finish(process).code, INTERRUPTED)


if __name__ == "__main__":
    unittest.main(verbosity=2)
