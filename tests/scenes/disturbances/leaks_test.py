"""Thousands of peers come and go, politely and not; the server is as before."""

import os
import pathlib
import resource
import socket
import struct
import sys
import time
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from harness import INTERRUPTED, SceneTest  # noqa: E402
from zmtp import GREETING, RawPeer  # noqa: E402
from ziggurat import protocol_pb2 as v1  # noqa: E402

WARM_UP = 1000
CONNECTIONS = 5000
# [KiB] of memory over all of them, 420 bytes each: for a while it is remembered how much each said.
MOST_GROWTH = 2048


def hello(role=v1.ROLE_CONTROLLER, **fields):
    return v1.ClientMessage(hello=v1.Hello(
        version=v1.Version(major=1), role=role, client_name="passer-by" * 20, **fields)
        ).SerializeToString()


def polite(endpoint, number):
    """A supervisor that asks and leaves. (Robots of a controller that leaves would be gone.)"""
    with RawPeer(endpoint) as peer:
        peer.say(hello(role=v1.ROLE_SUPERVISOR))
        hear(peer, "welcome")
        peer.say(ask(number))
        hear(peer, "response")
        peer.say(v1.ClientMessage(leave=v1.Leave(reason=v1.Leave.DONE)).SerializeToString())


def lost(endpoint, number):
    """A controller that takes the robots of the one before; its connection breaks, and nobody takes
    up its session."""
    with RawPeer(endpoint) as peer:
        peer.say(hello(robots=[f"r{number % 3}"], takeover=True))
        hear(peer, "welcome")
        break_off(peer.socket)


def lost_in_the_tick(endpoint, number):
    """The same with all robots: the tick begins, and stands again."""
    with RawPeer(endpoint) as peer:
        peer.say(hello(robots=["*"], takeover=True))
        hear(peer, "welcome", "observation")
        peer.say(v1.ClientMessage(command=v1.Command(tick=2**40)).SerializeToString())
        hear(peer, "error")


def refused(endpoint, number):
    with RawPeer(endpoint) as peer:
        peer.say(hello(robots=[f"unknown{number}"]))
        hear(peer, "refusal")


def observer(endpoint, number):
    """Hangs up while the answer is under way."""
    with RawPeer(endpoint) as peer:
        peer.say(hello(role=v1.ROLE_OBSERVER))
        hear(peer, "welcome")
        peer.say(ask(number))


def vandal(endpoint, number):
    with RawPeer(endpoint) as peer:
        peer.say(b"\xff" + number.to_bytes(8, "big"))
        hear(peer, "error")
        peer.say_half(hello(robots=["*"]))


def nothing(endpoint, number):
    connect(endpoint).close()


def half_a_greeting(endpoint, number):
    stranger = connect(endpoint)
    stranger.sendall(GREETING[:number % len(GREETING)])
    break_off(stranger)


def connect(endpoint):
    host, port = endpoint.removeprefix("tcp://").rsplit(":", 1)
    return socket.create_connection((host, int(port)), timeout=20)


def ask(number):
    return v1.ClientMessage(
        request=v1.Request(id=number, status=v1.StatusRequest())).SerializeToString()


def hear(peer, *kinds):
    """Messages of these kinds, one after the other, and nothing else once the world is there."""
    for due in kinds:
        kind = "loading"
        while kind == "loading":
            kind = v1.ServerMessage.FromString(peer.hear()).WhichOneof("message")
        if kind != due:
            raise AssertionError(f"expected {due}, got {kind}")


def break_off(connection):
    """Resets the connection, as a machine that fails."""
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    connection.close()


PEERS = (polite, lost, lost_in_the_tick, refused, observer, vandal, nothing, half_a_greeting)


class Leaks(SceneTest):
    def measure(self, process):
        """Open files and memory [KiB]."""
        status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
        memory = next(line for line in status.splitlines() if line.startswith("VmRSS"))
        return len(os.listdir(f"/proc/{process.pid}/fd")), int(memory.split()[1])

    def come_and_go(self, endpoint, numbers):
        for number in numbers:
            PEERS[number % len(PEERS)](endpoint, number)

    def test_thousands_come_and_go(self):
        process = self.start("serve", self.scene, "--endpoint", "tcp://127.0.0.1:*", "--quiet",
                             limit=120)
        endpoint = process.stdout.readline().split()[1]
        polite(endpoint, 1)  # the world is there
        time.sleep(0.2)
        idle, _ = self.measure(process)
        self.come_and_go(endpoint, range(WARM_UP))
        _, memory = self.measure(process)
        self.come_and_go(endpoint, range(WARM_UP, WARM_UP + CONNECTIONS))
        files = self.wait_for(lambda: self.measure(process)[0], lambda files: files <= idle,
                              "end of its open files")
        growth = self.measure(process)[1] - memory
        print(f"{CONNECTIONS} connections: {files} open files, {growth} KiB more", flush=True)
        self.assertLess(growth, MOST_GROWTH)
        self.interrupt(process)
        self.assertEqual(self.finish(process).code, INTERRUPTED)

    def test_half_open_connections_do_not_block_others(self):
        """More of them than a shell usually grants open files; they are hung up on in the end."""
        soft, hard = 256, resource.getrlimit(resource.RLIMIT_NOFILE)[1]
        process = self.start("serve", self.scene, "--endpoint", "tcp://127.0.0.1:*", "--quiet", limit=120,
                             preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard)))
        endpoint = process.stdout.readline().split()[1]
        strangers = [connect(endpoint) for _ in range(2 * soft)]
        polite(endpoint, 1)
        for stranger in strangers:  # each has sent nothing
            stranger.settimeout(20)
            while stranger.recv(100):  # its greeting
                pass
            stranger.close()
        self.interrupt(process)
        self.assertEqual(self.finish(process).code, INTERRUPTED)


if __name__ == "__main__":
    unittest.main(verbosity=2)
