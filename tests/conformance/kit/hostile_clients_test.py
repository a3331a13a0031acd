"""Clients that send without end, or what no server takes: the kit's memory is bounded, and it says what came."""

import os
import resource
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
from pathlib import Path

import zmq
from ziggurat_conformance import client_socket
from ziggurat_conformance.case import Failed
from ziggurat_conformance.client_socket import ServerSocket
from ziggurat_conformance.keys import Keys
from ziggurat_conformance.zmtp_frames import CLIENT, Frames

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1]))

from waiting import HANG, wait_until  # noqa: E402

ADDRESSES = 1 << 30  # [bytes] that the kit and the client may map, each
MEMORY = 320 << 10  # [KiB] of the kit: 128 MiB, a frame of as much, and what Python takes
LONGEST_RUN = 30.0  # [s]
GREETING = b"\xff" + bytes(8) + b"\x7f\x03\x00NULL" + bytes(48)


class Hostile(unittest.TestCase):
    def assert_fails(self, how, sentence, case="H1.hello-first"):
        with self.subTest(how), tempfile.TemporaryFile("w+") as out:
            kit = subprocess.Popen(
                [sys.executable, "-B", "-m", "ziggurat_conformance", "client", "--only", case, "--", sys.executable, "-B",
                 str(HERE / "hostile_client.py"), how], stdout=out, stderr=subprocess.STDOUT,
                preexec_fn=lambda: (resource.setrlimit(resource.RLIMIT_AS, (ADDRESSES, ADDRESSES)),
                                    resource.setrlimit(resource.RLIMIT_CPU, (int(LONGEST_RUN),) * 2)))
            _, status, usage = os.wait4(kit.pid, 0)
            kit.returncode = os.waitstatus_to_exitcode(status)
            out.seek(0)
            text = out.read()
            self.assertEqual(1, kit.returncode, text)
            self.assertRegex(text, sentence)
            self.assertLess(usage.ru_maxrss, MEMORY)

    def test_a_message_without_end(self):
        for how in ("frames", "small-frames", "bytes", "commands"):
            self.assert_fails(how, r"the client sent \d+ bytes in \d+ frames that make no whole message: a message is one frame "
                                   r"\(T2\), and the kit takes at most 134217728 bytes and 10000 frames")

    def test_an_encrypted_message_of_many_frames(self):
        self.assert_fails("many-frames", r"frames that make no whole message.* 10000 frames", "K1.session")

    def test_a_frame_of_endless_length(self):
        self.assert_fails("announced", r"sends a frame of 9223372036854775808 bytes; the kit takes at most 134217728 \(T4\)")

    def test_parts_of_frames_over_many_connections(self):
        self.assert_fails("halves", "that make no whole message")
        self.assert_fails("connections-with-a-part", "that make no whole message")

    def test_connections_without_end(self):
        self.assert_fails("connections", "has connected 1001 times; the kit takes at most 1000")

    def test_bytes_that_are_not_of_zeromq(self):
        self.assert_fails("of-another-kind", r"begins with b'G.*'; the greeting of ZMTP 3 is expected \(T1\)")

    def test_heartbeats_do_not_extend_the_wait(self):
        self.assert_fails("heartbeats", r"the client said nothing; command is expected \(S3\)", "S1.first-tick")

    def test_answers_do_not_repeat_what_is_unknown(self):
        self.assert_fails("long-heartbeats", r"the client said nothing; command is expected \(S3\)", "S1.first-tick")


class WholeMessages(unittest.TestCase):
    """They wait until the kit reads them, however many there are."""

    def dealer(self, server, keys=None, most_read=0):
        client = zmq.Context.instance().socket(zmq.DEALER)
        self.addCleanup(client.close, 0)
        client.setsockopt(zmq.SNDHWM, 0)
        client.setsockopt(zmq.RCVHWM, most_read)
        client.setsockopt(zmq.RCVBUF, 64 << 10)  # bounded: some systems let it grow to 32 MiB
        if keys is not None:
            client.curve_serverkey, client.curve_publickey, client.curve_secretkey = keys.of("controller")
        client.connect(server.endpoint)
        return client

    def test_all_come_in_order(self):
        keys = Keys()
        for secret, of_client in ((None, None), (keys.server[1], keys)):
            server = ServerSocket(secret)
            self.addCleanup(server.destroy)
            client = self.dealer(server, of_client)
            messages = [b"%d" % i + bytes(i % 300) for i in range(25_000)] + [bytes(40 << 20)] * 6
            for message in messages:
                client.send(message)
            for message in messages:
                arrival = server.receive(HANG)
                self.assertEqual([len(message)], [len(frame) for frame in arrival.frames])
                self.assertTrue(arrival.frames[0].bytes == message)
            server.send(arrival.routing_id, bytes(1 << 20))
            self.assertEqual(1 << 20, len(client.recv()))
            self.assertLess(server._relay._bytes, 2000)  # of the handshake
            self.assertLess(server._relay._frames, 10)

    def test_few_bytes_wait_for_a_client_that_reads_nothing(self):
        keys = Keys()
        for secret, of_client in ((None, None), (keys.server[1], keys)):
            with unittest.mock.patch.object(client_socket, "LONGEST_SEND", 0.5):
                server = ServerSocket(secret)
                self.addCleanup(server.destroy)
                client = self.dealer(server, of_client, most_read=1)
                client.send(b"question")
                routing_id = server.receive(HANG).routing_id
                sent = 0
                with self.assertRaisesRegex(Failed, "the client has read nothing for 0.5 s"):
                    for _ in range(100):
                        server.send(routing_id, bytes(8 << 20))
                        sent += 1
                self.assertLess(sent, 8)  # libzmq reads two in the client
                for _ in range(sent):
                    self.assertEqual(8 << 20, len(client.recv()))
                for i in range(2000):  # short ones wait for nothing, and none is lost
                    server.send(routing_id, b"%d" % i)
                for i in range(2000):
                    self.assertEqual(b"%d" % i, client.recv())
                client.close(0)
                wait_until(lambda: not server.connections(), "the end of the connection is seen")
                server.send(routing_id, b"to no client")

    def test_a_server_may_be_closed_and_opened_again(self):
        server = ServerSocket()
        self.addCleanup(server.destroy)
        client = self.dealer(server)
        for _ in range(20):
            client.send(b"question")
            arrival = server.receive(HANG)
            server.send(arrival.routing_id, b"answer")
            self.assertEqual(b"answer", client.recv())
            server.close()
            server.open()

    def test_only_the_relay_reaches_the_server(self):
        server = ServerSocket()
        self.addCleanup(server.destroy)
        name = server._socket.getsockopt(zmq.LAST_ENDPOINT).rstrip(b"\0").decode().removeprefix("ipc://@")
        code = ("import socket, sys; s = socket.socket(socket.AF_UNIX); s.connect(chr(0) + sys.argv[1]);"
                "s.settimeout(60); sys.exit(len(s.recv(1)))")
        self.assertEqual(0, subprocess.run([sys.executable, "-c", code, name], timeout=HANG).returncode)


class Sizes(unittest.TestCase):
    def test_of_frames_that_come_in_any_pieces(self):
        data = GREETING + b"\x04\x03abc" + b"\x01\x00" + b"\x00\x02xy" + b"\x02" + (300).to_bytes(8, "big") + bytes(300)
        for piece in (1, 2, 7, 64, 65, 1000):
            frames, count, size = Frames(CLIENT), 0, 0
            for i in range(0, len(data), piece):
                more = frames.read(data[i:i + piece])
                count, size = count + more[0], size + more[1]
            self.assertEqual((4, 305, 0), (count, size, frames.left))

    def test_what_is_refused(self):
        for data in (b"\x01", b"\xff" + bytes(9), GREETING[:10] + b"\x02", GREETING + b"\x02" + (CLIENT.longest + 1).to_bytes(8, "big")):
            with self.assertRaises(Failed):
                Frames(CLIENT).read(data)
        Frames(CLIENT).read(GREETING + b"\x02" + CLIENT.longest.to_bytes(8, "big"))


if __name__ == "__main__":
    unittest.main()
