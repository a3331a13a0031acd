"""What a server that lies can do to a Python program: against a fake server."""

import pathlib
import socket
import subprocess
import sys
import threading
import unittest
from unittest import mock

import ziggurat
from ziggurat import cost, protocol_pb2 as v1
from ziggurat.cost import excess

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

    def left(self, data, client, welcomed=True):
        """The Leave of a client that is told this, behind its Welcome or instead of it."""
        leaves = []

        def part(server):
            if welcomed:
                open_with(server)
            else:
                server.receive()
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
        self.assertRegex(self.left(b"\x0a\x00" * (1 << 22), in_a_block), "more than 2097152 fields")

    def test_who_refuses_a_welcome_leaves_with_the_cause(self):
        def client():
            with self.assertRaises(ziggurat.ProtocolError):
                self.connect()

        robot = v1.RobotDescription(id="a", range_and_bearing=v1.RangeAndBearingDescription(range=1, data_size=65_537, sends=True))
        data = v1.ServerMessage(welcome=welcome(robot)).SerializeToString()
        self.assertRegex(self.left(data, client, welcomed=False), "^MALFORMED: .*range-and-bearing packets of 65537 bytes")

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

    def test_a_message_without_end_of_frames_is_not_kept(self):
        listener = self.listener()
        sent = []

        def part(_):
            connection = self.accepted(listener)
            connection.settimeout(5)
            frames = b"\x01\x07a frame" * 100_000
            try:
                while sum(sent) < 1 << 29:
                    sent.append(connection.send(frames))
            except OSError:
                pass  # the client has left

        def client():
            with self.assertRaisesRegex(ziggurat.ProtocolError, "no message of the protocol"):
                ziggurat.connect(f"tcp://127.0.0.1:{listener.getsockname()[1]}", connect_timeout=HANG)

        self.play(part, client)
        self.assertLess(sum(sent), 1 << 29, "and the client reads it for a second until it ends")

    def test_messages_that_are_not_taken_stay_with_the_server(self):
        listener = self.listener()
        sent, is_full = [], threading.Event()

        def part(_):
            connection = self.accepted(listener)
            data = v1.ServerMessage(welcome=welcome(equipped("one"))).SerializeToString()
            connection.sendall(b"\x02" + len(data).to_bytes(8, "big") + data)
            connection.settimeout(1)
            try:
                while sum(sent) < 1 << 28:
                    sent.append(connection.send(b"\x02" + (1 << 20).to_bytes(8, "big") + bytes(1 << 20)))
            except TimeoutError:
                pass
            is_full.set()
            connection.close()

        def client():
            session = ziggurat.connect(f"tcp://127.0.0.1:{listener.getsockname()[1]}", connect_timeout=HANG)
            self.assertTrue(is_full.wait(HANG))
            session.abandon()

        self.play(part, client)
        self.assertLess(sum(sent), 1 << 26)  # the kernel keeps some

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
                         "VERSION_MISMATCH: .*the server speaks version 9.4 of the protocol, this client 1.4")

    def test_a_welcome_that_could_take_all_memory_is_not_decoded(self):
        other = welcome(equipped("a")).SerializeToString()

        def with_robots(count):
            robots = other + b"\x52\x00" * count
            length = len(robots)
            return b"\x0a" + bytes(length >> shift & 0x7F | (0x80 if length >> shift + 7 else 0)
                                   for shift in (0, 7, 14, 21) if length >> shift) + robots

        self.assertIn("this client takes 262144 at most", self.refused(with_robots(1 << 18)))
        self.assertIn("more than 2097152 fields", self.refused(with_robots(1 << 21)))
        self.assertIn("bytes, more than 67108864", self.refused(b"\x0a" * (65 << 20)))

    def test_an_observation_that_could_take_all_memory_is_not_decoded(self):
        field = v1.ServerMessage.DESCRIPTOR.fields_by_name["observation"].number

        def observation(content):
            return bytes([field << 3 | 2]) + bytes(len(content) >> shift & 0x7F | (0x80 if len(content) >> shift + 7 else 0)
                                                for shift in (0, 7, 14, 21) if len(content) >> shift) + content

        of = {name: bytes([number.number << 3 | 2] if number.number < 16 else
                          [number.number << 3 & 0x7F | 0x82, number.number >> 4])
              for name, number in v1.Observation.DESCRIPTOR.fields_by_name.items()}
        self.assertEqual(cost.MOST_DECODED, 2684354560)  # of which eleven million fields take ten seconds to count
        with mock.patch("ziggurat.cost.MOST_DECODED", 1 << 28):
            self.assertRegex(excess(observation((of["radio_messages"] + b"\x00") * (11 << 17))),
                             "more than 268435456 bytes of memory.* fewer robots in each session")
        self.assertEqual(excess(observation((of["tag_payloads"] + b"\x017") * (5 << 19))), "")
        self.assertIn("more than 2097152 fields", excess(observation(b"") + b"\x0a\x00" * (1 << 22)))

    def test_a_layout_of_600_000_boxes_is_decoded_and_one_that_could_take_all_memory_is_not(self):
        box = v1.WorldLayout(entities=[v1.EntityDescription(id="b123456", kind="box", links=[""])]).SerializeToString()

        def layout(content):
            return v1.ServerMessage(world_layout=v1.WorldLayout.FromString(content)).SerializeToString()

        self.assertEqual("", excess(layout(box * 600_000)))
        size = 1 << 22
        bomb = b"\x72" + bytes([size >> shift & 0x7F | 0x80 for shift in (0, 7, 14)]) + bytes([size >> 21]) + b"\x12\x00" * (size // 2)
        with mock.patch("ziggurat.cost.MOST_LAID_OUT", 1 << 26):
            self.assertIn("entities that take more than 1073741824 bytes of memory", excess(bomb))

    def test_packets_that_could_take_all_memory_are_refused(self):
        def with_packets(size, count):
            robots = [v1.RobotDescription(id=f"r{i}", range_and_bearing=v1.RangeAndBearingDescription(
                range=1, data_size=size, sends=True)) for i in range(count)]
            return v1.ServerMessage(welcome=welcome(*robots)).SerializeToString()

        self.assertIn("range-and-bearing packets of 4294967295 bytes for robot 'r0'; at most 65536 are allowed",
                      self.refused(with_packets(2**32 - 1, 2)))
        self.assertIn("at most 65536 are allowed", self.refused(with_packets(65_537, 1)))
        self.assertIn("range-and-bearing packets of 1073807360 bytes in all; this client takes 1073741824 at most",
                      self.refused(with_packets(65_536, (1 << 14) + 1)))

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
