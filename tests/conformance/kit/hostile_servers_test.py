# SPDX-License-Identifier: MIT
"""Servers that send what no server sends."""

import socket
import time
import unittest

from ziggurat_conformance.peer import Peer, Transcript

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

    def wait_for_the_end(self, connection):
        try:
            while connection.recv(4096):
                pass
        except ConnectionError:
            pass


if __name__ == "__main__":
    unittest.main()
