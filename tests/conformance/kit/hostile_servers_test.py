"""Servers that send what no server sends."""

import socket
import threading
import time
import unittest

import zmq
from ziggurat_conformance.case import Failed
from ziggurat_conformance.keys import Keys
from ziggurat_conformance.peer import Peer, Transcript
from ziggurat_conformance.wire import protocol

READY = b"\x05READY\x0bSocket-Type\0\0\0\x06ROUTER"
GREETING = b"\xff" + bytes(8) + b"\x7f\x03\x00" + b"NULL".ljust(52, b"\0") + bytes([4, len(READY)]) + READY
PATIENCE = 30.0  # [s] on a busy machine


class Ended(unittest.TestCase):
    def test_it_is_not_waited_for(self):
        with socket.create_server(("127.0.0.1", 0)) as listener:
            peer = Peer("p", f"tcp://127.0.0.1:{listener.getsockname()[1]}", "binary", Transcript(), runs=lambda: False)
            self.addCleanup(peer.release)
            start = time.monotonic()
            self.assertIsNone(peer.hear(PATIENCE))
            self.assertLess(time.monotonic() - start, PATIENCE / 2)


class Hostile(unittest.TestCase):
    def test_a_message_that_is_too_long_is_not_waited_for(self):
        for size, is_kept in (((1 << 30) + (1 << 16), True), (2 << 30, False)):
            with self.subTest(size), socket.create_server(("127.0.0.1", 0)) as listener:
                listener.settimeout(PATIENCE)
                peer = Peer("p", f"tcp://127.0.0.1:{listener.getsockname()[1]}", "binary", Transcript())
                self.addCleanup(peer.release)
                connection, _ = listener.accept()
                with connection:
                    connection.settimeout(PATIENCE)
                    connection.sendall(GREETING + b"\x02" + size.to_bytes(8, "big"))
                    connection.settimeout(2 if is_kept else PATIENCE)
                    if is_kept:
                        self.assertRaises(TimeoutError, self.wait_for_the_end, connection)
                    else:
                        self.wait_for_the_end(connection)

    def test_a_message_without_end_is_not_kept(self):
        small, large = b"\x01\x07a frame", b"\x03" + (1 << 20).to_bytes(8, "big") + bytes(1 << 20)
        for frames in (small * 7000, large):
            with self.subTest(len(frames)), socket.create_server(("127.0.0.1", 0)) as listener:
                sent = []
                sender = threading.Thread(target=self.send_without_end, args=(listener, frames, sent))
                sender.start()
                peer = Peer("p", f"tcp://127.0.0.1:{listener.getsockname()[1]}", "binary", Transcript())
                self.addCleanup(peer.release)
                with self.assertRaisesRegex(Failed, r"the server sent \d+ bytes in \d+ frames that make no whole message"):
                    peer.hear(PATIENCE)
                peer.release()
                sender.join()
                self.assertLess(sum(sent), 192 << 20)  # with the system's buffers

    def send_without_end(self, listener, frames, sent):
        """But 512 MiB."""
        with listener.accept()[0] as connection:
            try:
                connection.sendall(GREETING)
                while sum(sent) < 512 << 20:
                    sent.append(connection.send(frames))
                connection.recv(1 << 16)
            except OSError:
                pass  # the kit has closed the connection

    def test_an_encrypted_message_of_many_frames_is_not_kept(self):
        keys = Keys()
        router = zmq.Context.instance().socket(zmq.ROUTER)
        self.addCleanup(router.close, 0)
        router.curve_server, router.curve_secretkey = True, keys.server[1]
        port = router.bind_to_random_port("tcp://127.0.0.1")
        peer = Peer("controller", f"tcp://127.0.0.1:{port}", "binary", Transcript(), keys.of("controller"))
        self.addCleanup(peer.release)
        peer.send(protocol.ClientMessage())
        self.assertTrue(router.poll(1000 * PATIENCE))
        client, _ = router.recv_multipart()
        for i in range(15_000):  # whole ones come, however many
            router.send_multipart([client, protocol.ServerMessage(heartbeat=protocol.Heartbeat(sequence=i)).SerializeToString()])
            while i % 500 == 499 and len(peer.heartbeats) <= i:  # fewer than libzmq drops
                peer.hear(0.1)
        router.send_multipart([client] + [b"a frame"] * 30_000)
        with self.assertRaisesRegex(Failed, "frames that make no whole message"):
            peer.hear(PATIENCE)

    def test_a_long_message_that_comes_slowly_is_no_fault(self):
        """Longer than what may wait: the rest of a frame is waited for."""
        size, part = 130 << 20, 1 << 20
        with socket.create_server(("127.0.0.1", 0)) as listener:
            peer = Peer("p", f"tcp://127.0.0.1:{listener.getsockname()[1]}", "binary", Transcript())
            self.addCleanup(peer.release)
            connection, _ = listener.accept()
            with connection:
                connection.sendall(GREETING + b"\x02" + size.to_bytes(8, "big") + bytes(part))
                self.assertIsNone(peer.hear(2.5))
                for _ in range(size // part - 1):
                    connection.sendall(bytes(part))
                with self.assertRaises(ValueError):  # its content is none
                    peer.hear(PATIENCE)

    def wait_for_the_end(self, connection):
        try:
            while connection.recv(4096):
                pass
        except ConnectionError:
            pass


if __name__ == "__main__":
    unittest.main()
