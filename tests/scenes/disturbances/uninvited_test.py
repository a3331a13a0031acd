# SPDX-License-Identifier: MIT
"""What peers without a session, and observers, can do to a server: nothing that others notice.

uninvited_test.py         seconds per attack
uninvited_test.py --full  the same, with more of each
"""

import ctypes
import os
import pathlib
import re
import resource
import select
import socket
import struct
import subprocess
import sys
import threading
import time
import unittest

import zmq

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from harness import INTERRUPTED, LIMIT, LUA, SceneTest  # noqa: E402
from waiting import wait_until, wait_until_idle  # noqa: E402
from zmtp import RawPeer  # noqa: E402
from ziggurat import protocol_pb2 as v1  # noqa: E402

IS_FULL = "--full" in sys.argv
MEBIBYTE = 1 << 20
MANY_FILES = lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (4096, resource.getrlimit(resource.RLIMIT_NOFILE)[1]))
SLOW = 20  # [s] in which a connection that must be closed is closed, on a busy machine


def hello(role=v1.ROLE_CONTROLLER, **fields):
    return v1.ClientMessage(hello=v1.Hello(version=v1.Version(major=1), role=role, **fields)
                            ).SerializeToString()


def read_request(number, *entities):
    return v1.ClientMessage(request=v1.Request(id=number, read=v1.ReadRequest(entities=entities))
                            ).SerializeToString()


def observer(endpoint):
    peer = RawPeer(endpoint)
    peer.send_message(hello(v1.ROLE_OBSERVER))
    answer(peer)
    return peer


def answer(peer):
    """The next message other than Loading and heartbeats."""
    while True:
        message = v1.ServerMessage.FromString(peer.receive_message())
        if message.WhichOneof("message") not in ("loading", "heartbeat"):
            return message


def is_closed(peer, seconds=SLOW):
    """Whether the server closes the connection in that time. Messages before that are dropped."""
    peer.socket.settimeout(seconds)
    try:
        while peer.socket.recv(65536):
            pass
    except TimeoutError:
        return False
    except OSError:
        pass
    return True


class Uninvited(SceneTest):
    def serve(self, *options, scene=None, **process_options):
        process = self.start("serve", scene or self.scene, "--endpoint", "tcp://127.0.0.1:*", "--quiet",
                             "--ticks", 0, *options, limit=240, **process_options)
        self.endpoint = process.stdout.readline().split()[1]
        with RawPeer(self.endpoint) as peer:  # until the world is loaded
            peer.send_message(hello(v1.ROLE_OBSERVER))
            self.assertTrue(answer(peer).HasField("welcome"))
        return process

    def end(self, process):
        self.assertIsNone(process.poll(), "the server has ended")
        self.interrupt(process)
        outcome = self.finish(process)
        self.assertEqual(outcome.code, INTERRUPTED, outcome.err)
        return outcome

    def most_memory(self, process):
        """That the process ever had [bytes]."""
        status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
        return int(re.search(r"VmHWM:\s*(\d+)", status)[1]) * 1024

    def memory(self, process):
        status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s*(\d+)", status)[1]) * 1024

    # ---- routing ids ----

    def test_routing_ids_of_peers_have_no_effect(self):
        """Peers ask for the ids that libzmq's ROUTER draws next; thousands of clients connect meanwhile."""
        process = self.serve()
        rand = ctypes.CDLL(None)
        rand.srand(1)  # what a process has that never calls srand()
        drawn = [rand.rand() for _ in range(8)]
        starts = [(low | high << 31) & 0xFFFFFFFF for low, high in zip(drawn, drawn[1:])]
        for turn in range(20 if IS_FULL else 4):
            claims = [RawPeer(self.endpoint, routing_id=b"\0" + (start + 60 * turn + i
                                                                 ).to_bytes(5, "big")[1:])
                      for start in starts for i in range(40)]
            for _ in range(60):
                observer(self.endpoint).socket.close()
            for peer in claims:
                peer.socket.close()
        self.end(process)

    def test_a_session_belongs_to_its_connection(self):
        """A peer with the routing id of a crashed controller has no session."""
        process = self.serve()
        for _ in range(200 if IS_FULL else 20):
            first = RawPeer(self.endpoint, routing_id=b"the same")
            first.send_message(hello(robots=["*"], takeover=True))
            self.assertTrue(answer(first).HasField("welcome"))
            second = RawPeer(self.endpoint, routing_id=b"the same")
            first.socket.close()
            second.send_message(v1.ClientMessage(command=v1.Command()).SerializeToString())
            error = answer(second).error
            self.assertEqual(v1.Error.Code.Name(error.code), "OUT_OF_STATE")
            self.assertEqual(v1.Error.Severity.Name(error.severity), "FATAL")
            second.socket.close()
        self.end(process)

    # ---- encryption ----

    def test_altered_bytes_of_an_encrypted_connection(self):
        """A program between client and server alters one byte of each connection. It gets nowhere, and the
        server serves on."""
        for name in ("server", "friend"):
            self.assertEqual(self.ziggurat("keygen", "--out", self.folder / name).code, 0)
        friend = (self.folder / "friend.public").read_text().strip()
        self.write("clients", f"{friend} controller,observer\n")
        process = self.start("serve", self.scene, "--endpoint", "tcp://127.0.0.1:*", "--quiet", "--ticks", 0,
                             "--curve-secret", self.folder / "server.secret",
                             "--curve-clients", self.folder / "clients", limit=240)
        self.endpoint = process.stdout.readline().split()[1]
        self.passed = 0
        self.assertTrue(self.is_welcome(self.altering(10**6)))
        answered = [at for at in range(0, self.passed, 3 if IS_FULL else 9)
                    if self.is_welcome(self.altering(at), 0.2)]
        # Bytes without a meaning: the greeting's filler, the version's minor, the signature's length, and the
        # padding of the first command, up to byte 145.
        self.assertLess(max(answered, default=0), 146, answered)
        self.assertTrue(self.is_welcome(self.endpoint))
        self.end(process)

    def is_welcome(self, endpoint, seconds=SLOW):
        """Whether a client with a listed key gets a session."""
        keys = [(self.folder / name).read_text().strip().encode()
                for name in ("friend.secret", "friend.public", "server.public")]
        with zmq.Context() as context, context.socket(zmq.DEALER) as dealer:
            dealer.curve_secretkey, dealer.curve_publickey, dealer.curve_serverkey = keys
            dealer.linger, dealer.rcvtimeo = 0, int(1000 * seconds)
            dealer.connect(endpoint)
            dealer.send(hello(v1.ROLE_OBSERVER))
            try:
                while True:
                    kind = v1.ServerMessage.FromString(dealer.recv()).WhichOneof("message")
                    if kind != "loading":
                        return kind == "welcome"
            except zmq.Again:
                return False

    def altering(self, position):
        """An endpoint that leads to the server, but for one bit of what clients send, for one connection."""
        listener = socket.create_server(("127.0.0.1", 0))

        def carry():
            listener.settimeout(SLOW)
            client, _ = listener.accept()
            listener.close()
            server = socket.create_connection(("127.0.0.1", int(self.endpoint.rsplit(":", 1)[1])))
            passed = 0
            try:
                while True:
                    for source in select.select([client, server], [], [])[0]:
                        data = bytearray(source.recv(65536))
                        if not data:
                            return
                        if source is client:
                            if 0 <= position - passed < len(data):
                                data[position - passed] ^= 0x10
                            passed += len(data)
                            self.passed = passed  # by the last connection
                        (server if source is client else client).sendall(data)
            except OSError:
                pass
            finally:
                client.close()
                server.close()

        threading.Thread(target=carry, daemon=True).start()
        return f"tcp://127.0.0.1:{listener.getsockname()[1]}"

    # ---- memory ----

    def test_long_messages_without_session(self):
        process = self.serve()
        before = self.most_memory(process)
        for size in (64 * 1024 + 1, 64 * MEBIBYTE, 1 << 62):
            with RawPeer(self.endpoint) as peer:
                peer.send_beginning(size, 100)
                self.assertTrue(is_closed(peer), size)
        with RawPeer(self.endpoint) as peer:  # the longest: it is answered
            peer.send_message(b"\xff" * 64 * 1024)
            self.assertEqual(answer(peer).error.code, v1.Error.MALFORMED)
        self.assertLess(self.most_memory(process) - before, 4 * MEBIBYTE)
        self.end(process)

    def test_unfinished_messages_of_many(self):
        """Each connection sends nearly all of the longest message, then nothing."""
        process = self.serve(preexec_fn=MANY_FILES)
        before = self.most_memory(process)
        peers = [RawPeer(self.endpoint) for _ in range(512)]
        for peer in peers:
            peer.send_beginning(64 * 1024, 64 * 1024 - 1)
        wait_until_idle(process.pid)
        growth = self.most_memory(process) - before
        print(f"  512 unfinished messages: {growth / MEBIBYTE:.0f} MiB", flush=True)
        self.assertLess(growth, 48 * MEBIBYTE)
        observer(self.endpoint).socket.close()
        for peer in peers:
            peer.socket.close()
        self.end(process)

    def test_there_are_512_without_session(self):
        process = self.serve(preexec_fn=MANY_FILES)
        address = ("127.0.0.1", int(self.endpoint.rsplit(":", 1)[1]))
        idle = [socket.create_connection(address) for _ in range(700)]
        connections = lambda: sum(os.readlink(f"/proc/{process.pid}/fd/{file}").startswith("socket:")
                                  for file in os.listdir(f"/proc/{process.pid}/fd"))
        self.wait_for(connections, lambda count: count > 512, "connections")
        wait_until_idle(process.pid)
        self.assertLessEqual(connections(), 512 + 3)  # and what listens
        for connection in idle:
            connection.close()
        self.end(process)

    def test_observers_that_never_read(self):
        """The world has 3000 boxes, so that an answer has hundreds of kilobytes."""
        boxes = "".join(f'<box id="b{i}" size="0.1,0.1,0.1" movable="false">'
                        f'<body position="{i % 60},{i // 60},2" orientation="0,0,0"/></box>'
                        for i in range(3000))
        scene = self.write("many.argos", self.text.replace("</arena>", boxes + "</arena>"))
        process = self.serve(scene=scene)
        before = self.memory(process)
        peers = [observer(self.endpoint) for _ in range(100)]
        end = time.monotonic() + (60 if IS_FULL else 10)
        number = 0
        while time.monotonic() < end:
            number += 1
            for peer in peers:
                try:
                    peer.socket.setblocking(False)
                    peer.socket.send(b"\x00" + bytes([len(read_request(number))]) + read_request(number))
                except OSError:
                    pass  # full, or closed by the server
            time.sleep(0.02)  # so often each asks
        most = self.most_memory(process)
        for peer in peers:
            peer.socket.close()
        observer(self.endpoint).socket.close()
        after = self.wait_for(lambda: self.memory(process), lambda now: now < before + 64 * MEBIBYTE,
                              "return of the memory")
        print(f"  100 observers: {before / MEBIBYTE:.0f} MiB, {most / MEBIBYTE:.0f} MiB at most, "
              f"{after / MEBIBYTE:.0f} MiB after", flush=True)
        self.assertLess(most - before, 300 * MEBIBYTE)
        self.end(process)

    def test_reads_with_many_patterns(self):
        process = self.serve()
        with RawPeer(self.endpoint) as peer:
            peer.send_message(hello(v1.ROLE_SUPERVISOR))
            self.assertTrue(answer(peer).HasField("welcome"))
            for entities, expected in ((["*"] * 64, None), (["*"] * 65, "TOO_MANY"),
                                       (["*" * 257], "TOO_MANY"), (["*"] * 2_000_000, "TOO_LARGE"),
                                       ([""] * 300_000, "MALFORMED")):
                peer.send_message(read_request(1, *entities))
                told = answer(peer)
                code = told.response.error.code or told.error.code
                self.assertEqual(v1.Error.Code.Name(code) if code else None, expected)
        self.assertLess(self.most_memory(process), 300 * MEBIBYTE)
        self.end(process)

    # ---- descriptors ----

    def test_idle_connections_leave_descriptors_for_files(self):
        """A run that writes pictures goes on, however many connect and send nothing."""
        process = self.serve(preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (256, 256)))
        address = ("127.0.0.1", int(self.endpoint.rsplit(":", 1)[1]))
        idle = [socket.create_connection(address) for _ in range(1000)]
        for _ in range(5):
            observer(self.endpoint).socket.close()
            files = len(os.listdir(f"/proc/{process.pid}/fd"))
            self.assertLess(files, 220)
        for connection in idle:
            connection.close()
        self.end(process)

    def test_few_files_leave_places_for_controllers(self):
        """Of 80 connections: 20 are for observers, 10 for supervisors."""
        process = self.serve(preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (128, 128)))
        for role, most in ((v1.ROLE_OBSERVER, 20), (v1.ROLE_SUPERVISOR, 10)):
            peers = [RawPeer(self.endpoint) for _ in range(most + 1)]
            for peer in peers:
                peer.send_message(hello(role))
            kinds = [answer(peer).WhichOneof("message") for peer in peers]
            self.assertEqual(sorted(kinds), ["refusal"] + ["welcome"] * most)
            self.addCleanup(lambda peers=peers: [peer.socket.close() for peer in peers])
        with RawPeer(self.endpoint) as peer:
            peer.send_message(hello(robots=["*"]))
            self.assertTrue(answer(peer).HasField("welcome"))
        self.end(process)

    # ---- the tick ----

    def test_controllers_tick_on(self):
        """Observers ask for all that they may, and peers without a session send garbage; controllers notice little."""
        self.write("swing.lua", "function init() end\nfunction step() end\n"
                                "function reset() end\nfunction destroy() end\n")
        process = self.start("serve", self.scene, "--endpoint", "tcp://127.0.0.1:*", "--quiet",
                             "--duration", 0, limit=240)
        self.endpoint = process.stdout.readline().split()[1]
        client = self.start_lua()
        watcher = observer(self.endpoint)
        self.wait_for(lambda: self.tick(watcher), lambda tick: tick > 100, "ticks")
        alone = self.ticks_in(watcher, 3)
        self.turns = 0  # of peers that flood
        for attack in (self.ask, self.send_garbage):
            over, before = threading.Event(), self.turns
            flood = [threading.Thread(target=attack, args=(over,)) for _ in range(4)]
            for thread in flood:
                thread.start()
            wait_until(lambda: self.turns > before, "the flood comes")
            together = self.ticks_in(watcher, 3)
            over.set()
            for thread in flood:
                thread.join()
            print(f"  {alone:.0f} ticks in 3 s alone, {together:.0f} with {attack.__name__}", flush=True)
            self.assertGreater(together, 0.1 * alone)  # they also take the processors; it was 0.007
        self.end(process)
        client.wait(timeout=LIMIT)

    def start_lua(self):
        client = subprocess.Popen([str(LUA), "--connect", self.endpoint, "--quiet"], cwd=self.folder,
                                  stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL)
        self.started.append(client)
        return client

    def tick(self, watcher):
        watcher.send_message(v1.ClientMessage(request=v1.Request(id=1, status=v1.StatusRequest())
                                              ).SerializeToString())
        return answer(watcher).response.tick

    def ticks_in(self, watcher, seconds):
        first, begun = self.tick(watcher), time.monotonic()
        time.sleep(seconds)  # elapsed time is the subject
        last, ended = self.tick(watcher), time.monotonic()
        return (last - first) * seconds / (ended - begun)

    def send_garbage(self, over):
        """Peers without a session: each connects, sends as much garbage as it may, and goes."""
        garbage = (b"\x02" + struct.pack(">Q", 30_000) + bytes(30_000)) * 10
        while not over.is_set():
            try:
                with RawPeer(self.endpoint) as peer:
                    peer.socket.settimeout(0.2)
                    self.turns += 1
                    peer.socket.sendall(garbage)
            except OSError:
                pass  # disconnected, or its turn has not come

    def ask(self, over):
        """Five observers: each asks and reads as fast as both ends can."""
        peers = [observer(self.endpoint) for _ in range(5)]
        request = read_request(1)
        frame = (b"\x00" + bytes([len(request)]) + request) * 20
        while not over.is_set():
            for peer in peers:
                try:
                    peer.socket.setblocking(False)
                    peer.socket.send(frame)
                    while peer.socket.recv(1 << 20):
                        pass
                except OSError:
                    pass
            self.turns += 1
            time.sleep(0.02)  # so often they ask
        for peer in peers:
            peer.socket.close()


if __name__ == "__main__":
    sys.argv = [each for each in sys.argv if each != "--full"]
    unittest.main(verbosity=2, warnings="ignore")
