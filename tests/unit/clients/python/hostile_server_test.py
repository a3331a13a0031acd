# SPDX-License-Identifier: MIT
"""What a server that lies can do to a Python program: against a fake server."""

import pathlib
import socket
import subprocess
import sys
import unittest

import ziggurat
from ziggurat import protocol_pb2 as v1

from fake_server import equipped, welcome
from session_case import HANG, SessionCase, open_with


class Lies(SessionCase):
    """A server that sends anything."""

    def test_what_is_no_message_is_an_error_of_the_protocol(self):
        def part(server):
            server.receive()
            server.socket.send_multipart([server.peer, b"\xff no message"])

        def client():
            with self.assertRaisesRegex(ziggurat.ProtocolError, "MALFORMED: .* no message of the protocol") as caught:
                self.connect()
            self.assertTrue(caught.exception.is_fatal)

        self.play(part, client)

    def test_texts_of_a_server_are_printable(self):
        error = v1.Error(message="\x1b]52;c;eA==\x07\u202eé")
        self.assertEqual(str(ziggurat.ProtocolError(error)).split(": ", 1)[1], "\\u001b]52;c;eA==\\u0007\\u202eé")
        self.assertEqual(str(ziggurat.Displaced("\x9b")), "\\u009b")

    def test_texts_of_a_server_are_bounded(self):
        long = v1.Error(message="\x1b" * 1_000_000, robot="r" * 1_000_000)
        refused = ziggurat.Refused(v1.Refusal(error=long, holder="\x1b" + "h" * 1_000_000))
        for text in (str(refused), refused.robot, refused.holder):
            self.assertEqual(len(text), 4096)
            self.assertTrue(text.endswith("…"))
            self.assertTrue(text.isprintable())

    def refused(self, data):
        """The exception of a client that is answered so."""
        def part(server):
            while not isinstance(server.receive(), v1.Hello):
                pass  # the Leave of the client before
            server.socket.send_multipart([server.peer, data])

        caught = []

        def client():
            with self.assertRaises(ziggurat.ProtocolError) as error:
                self.connect()
            caught.append(str(error.exception))

        self.play(part, client)
        return caught[0]

    def left(self, data, client):
        """The Leave of a client that is told this behind its Welcome."""
        leaves = []

        def part(server):
            open_with(server)
            server.socket.send_multipart([server.peer, data])
            leaves.append(server.receive())
            while not isinstance(leaves[-1], v1.Leave):  # a supervisor's request
                leaves.append(server.receive())

        self.play(part, client)
        self.assertEqual(leaves[-1].reason, v1.Leave.FAILED)
        return leaves[-1].message

    def test_who_refuses_a_message_leaves_with_the_cause(self):
        def in_a_block():
            with self.assertRaises(ziggurat.ProtocolError):
                with self.connect() as session:
                    next(session)

        def without_block():
            session = self.connect()
            with self.assertRaises(ziggurat.ProtocolError):
                next(session)
            with self.assertRaises(ziggurat.ConnectionLost):
                next(session)

        def supervisor():
            with self.assertRaises(ziggurat.ProtocolError):
                ziggurat.Supervisor(self.server.endpoint).status()

        for client in (in_a_block, without_block, supervisor):
            with self.subTest(client.__name__):
                self.assertRegex(self.left(b"\xff no message", client), "^MALFORMED: .* what is no message of the protocol")

    def listener(self):
        """A server whose bytes a test chooses."""
        listener = socket.create_server(("127.0.0.1", 0))
        self.addCleanup(listener.close)
        return listener

    def accepted(self, listener):
        """A connection that is open."""
        greeting = b"\xff" + bytes(8) + b"\x7f\x03\x01NULL" + bytes(48)
        ready = b"\x05READY\x0bSocket-Type\x00\x00\x00\x06ROUTER"
        connection = listener.accept()[0]
        self.addCleanup(connection.close)
        connection.sendall(greeting + bytes([4, len(ready)]) + ready)
        heard = b""
        while b"READY" not in heard:  # the client's, behind its greeting
            heard += connection.recv(1024)
        return connection

    def test_a_message_of_2_gib_is_not_waited_for(self):
        listener = self.listener()

        def part(_):
            connection = self.accepted(listener)
            connection.sendall(b"\x02" + (1 << 31).to_bytes(8, "big"))

        def client():
            with self.assertRaisesRegex(ziggurat.ConnectionLost, "the connection was closed"):
                ziggurat.connect(f"tcp://127.0.0.1:{listener.getsockname()[1]}", connect_timeout=HANG)

        self.play(part, client)

    def test_a_welcome_of_another_major_version_is_refused(self):
        other = welcome(equipped("a"))
        other.version.CopyFrom(v1.Version(major=9, minor=4))
        self.assertRegex(self.refused(v1.ServerMessage(welcome=other).SerializeToString()),
                         "VERSION_MISMATCH: .*the server speaks version 9.4 of the protocol, this client 1.5")

    def test_the_json_client_ends_with_a_sentence(self):
        controller = pathlib.Path(__file__).parents[4] / "clients" / "json" / "controller.py"
        for lie in (b"\xff", b"{", b"[]", b"{}", b"[" * 100_000, b'{"welcome":{}}', b'{"welcome":null}',
                    b'{"refusal":{"error":{"retryable":false,"message":"\\u001b[2J"}}}'):
            with self.subTest(lie[:60]):
                process = subprocess.Popen([sys.executable, controller, self.server.endpoint], stderr=subprocess.PIPE, text=True)
                self.assertTrue(self.server.socket.poll(1000 * HANG))
                peer, _ = self.server.socket.recv_multipart()
                self.server.socket.send_multipart([peer, lie])
                _, err = process.communicate(timeout=HANG)
                self.assertEqual(process.returncode, 1)
                self.assertRegex(err, r"no message of the protocol|^\\u001b\[2J\n$")
                self.assertEqual(len(err.splitlines()), 1, err)


if __name__ == "__main__":
    unittest.main()
