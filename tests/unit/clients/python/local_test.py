"""Connections to a server of this machine, which go without ZeroMQ: the tests of others again, and its own."""

import os
import select
import socket
import tempfile
import threading
import time
import unittest

import ziggurat
from ziggurat.local import LocalTransport

import ending_test
import hostile_server_test
import interrupted_test
import resume_test
import session_test
import supervisor_test
from session_case import HANG, SessionCase, open_with

LOCAL = "ipc://*"


def over_ipc(module, *names):
    """Its test cases, against a server that listens at a path."""
    for name in names:
        case = getattr(module, name)
        globals()[f"Local{name}"] = type(f"Local{name}", (case,), {"endpoint": LOCAL, "__module__": __name__})


over_ipc(ending_test, "Leaving", "Losing")
over_ipc(hostile_server_test, "Lies")
over_ipc(interrupted_test, "Interrupted")
over_ipc(resume_test, "Resuming")
over_ipc(session_test, "Beginning", "Ticks")
over_ipc(supervisor_test, "Supervision")


def greeting(mechanism=b"NULL", version=3):
    return (b"\xff" + bytes(8) + b"\x7f" + bytes([version, 0]) + mechanism).ljust(64, b"\0")


READY = b"\4\x29\5READY\x0bSocket-Type\0\0\0\6ROUTER\x08Identity\0\0\0\0"


class Bytes(unittest.TestCase):
    """A server of which a test chooses each byte."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = os.path.join(self.folder.name, "socket")
        self.listener = None

    def listen(self):
        self.listener = socket.socket(socket.AF_UNIX)
        self.addCleanup(self.listener.close)
        self.listener.bind(self.path)
        self.listener.listen()

    def transport(self):
        transport = LocalTransport(f"ipc://{self.path}", 1 << 20, "no keys")
        self.addCleanup(transport.close, 0)
        return transport

    def accept(self, said=greeting() + READY):
        """The server's end, after the client's handshake."""
        end, _ = self.listener.accept()
        self.addCleanup(end.close)
        end.settimeout(HANG)
        handshake = b""
        while len(handshake) < 64 + 43:
            handshake += end.recv(64 + 43 - len(handshake))
        self.assertIn(b"DEALER", handshake)
        end.sendall(said)
        return end

    def open(self):
        self.listen()
        transport = self.transport()
        end = self.accept()
        self.assertIsNone(transport.receive(0.05))
        return transport, end

    def test_messages_are_cut_from_any_pieces(self):
        messages = [b"", b"x", b"y" * 255, b"z" * 256, b"w" * 100_000]
        stream = b"".join((bytes([0, len(each)]) if len(each) < 256 else b"\2" + len(each).to_bytes(8, "big")) + each
                          for each in messages)
        for size in (1, 7, 1000, len(stream)):
            with self.subTest(size=size):
                self.setUp()
                transport, end = self.open()
                writer = threading.Thread(
                    target=lambda: [end.sendall(stream[i:i + size]) for i in range(0, len(stream), size)])
                writer.start()
                found = []
                while len(found) < len(messages):
                    message = transport.receive(HANG)
                    if message is not None:
                        found.append(message)
                writer.join()
                self.assertEqual(found, messages)

    def test_what_is_sent_before_there_is_a_server_arrives_first(self):
        transport = self.transport()
        self.assertTrue(transport.send(b"first"))
        self.assertIsNone(transport.receive(0.01))
        self.assertFalse(transport.is_accepted)
        self.listen()
        self.assertIsNone(transport.receive(0.2))
        self.assertTrue(transport.is_accepted)
        end = self.accept()
        transport.receive(0.05)
        transport.send(b"second")
        self.assertEqual(end.recv(100), b"\0\5first\0\6second")

    def test_a_connection_that_ends_within_its_handshake_is_tried_again(self):
        self.listen()
        transport = self.transport()
        transport.send(b"hello")
        self.accept(said=greeting()[:11]).close()
        self.assertIsNone(transport.receive(0.3))
        end = self.accept()
        transport.receive(0.05)
        self.assertEqual(end.recv(100), b"\0\5hello")

    def test_a_server_that_reads_nothing_makes_send_false(self):
        transport, end = self.open()
        sent = 0
        while transport.send(bytes([sent % 256]) * 100_000):
            sent += 1
        received, wanted = b"", sent * 100_009
        while len(received) < wanted:
            transport.receive(0)  # sends what waits
            if select.select([end], [], [], 0)[0]:
                received += end.recv(1 << 20)
        self.assertEqual(received[-1], (sent - 1) % 256)
        self.assertTrue(transport.send(b"again"))

    def test_why_a_connection_is_closed(self):
        for said, why in ((greeting(b"CURVE"), "no keys"), (b"HTTP/1.1 400 Bad Request\r\n".ljust(64), "ZMTP 3"),
                          (greeting(version=1), "ZMTP 3"), (greeting() + READY + b"\x80\0", "none of ZMTP"),
                          (greeting() + READY + b"\2" + b"\0\0\0\0\x10\0\0\0", "too long")):
            with self.subTest(why=why):
                self.setUp()
                self.listen()
                transport = self.transport()
                self.accept(said)
                self.assertIsNone(transport.receive(HANG))
                self.assertRegex(transport.why_closed, why)
                self.assertFalse(transport.send(b"more"))

    def test_a_wait_without_a_message_is_as_long_as_asked(self):
        transport, _ = self.open()
        for seconds in (0.05, 0.3, 0.5):
            began = time.monotonic()
            self.assertIsNone(transport.receive(seconds))
            self.assertGreaterEqual(time.monotonic() - began, 0.99 * seconds)

    def test_a_wrong_path_is_told(self):
        for path in ("", "@", "*", "x" * 108):
            with self.assertRaisesRegex(ValueError, "1 to 107 bytes"):
                ziggurat.connect(f"ipc://{path}")


class LastWords(SessionCase):
    endpoint = LOCAL

    def test_they_arrive_though_the_client_closes_at_once(self):
        def part(server):
            open_with(server)
            self.assertEqual(server.receive().message, "the end")

        self.play(part, lambda: self.connect().close("the end"))


if __name__ == "__main__":
    unittest.main()
