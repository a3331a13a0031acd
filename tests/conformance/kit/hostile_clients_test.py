# SPDX-License-Identifier: MIT
"""Clients that do not answer, or do not read."""

import subprocess
import sys
import unittest
import unittest.mock
from pathlib import Path

import zmq
from ziggurat_conformance import client_socket
from ziggurat_conformance.case import Failed
from ziggurat_conformance.client_socket import ServerSocket

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1]))

from waiting import HANG, wait_until  # noqa: E402


class Heartbeats(unittest.TestCase):
    def test_they_do_not_extend_the_wait(self):
        kit = subprocess.run(
            [sys.executable, "-B", "-m", "ziggurat_conformance", "client", "--only", "S1.first-tick", "--", sys.executable, "-B",
             str(HERE / "heartbeat_client.py")], text=True, capture_output=True, timeout=HANG)
        self.assertEqual(1, kit.returncode, kit.stdout)
        self.assertRegex(kit.stdout, r"the client said nothing; command is expected \(S3\)")


class Connections(unittest.TestCase):
    def dealer(self, server):
        client = zmq.Context.instance().socket(zmq.DEALER)
        self.addCleanup(client.close, 0)
        client.setsockopt(zmq.RCVHWM, 1)
        client.connect(server.endpoint)
        return client

    def test_a_client_that_reads_nothing_is_told(self):
        with unittest.mock.patch.object(client_socket, "LONGEST_SEND", 0.5):
            server = ServerSocket()
            self.addCleanup(server.destroy)
            client = self.dealer(server)
            client.send(b"question")
            routing_id = server.receive(HANG).routing_id
            with self.assertRaisesRegex(Failed, "the client has read nothing for 0.5 s"):
                for _ in range(100):
                    server.send(routing_id, bytes(8 << 20))

    def test_what_is_sent_to_a_client_that_has_gone_has_no_effect(self):
        server = ServerSocket()
        self.addCleanup(server.destroy)
        client = self.dealer(server)
        client.send(b"question")
        routing_id = server.receive(HANG).routing_id
        client.close(0)
        wait_until(lambda: not server.connections(), "the end of the connection is seen")
        server.send(routing_id, b"answer")

    def test_a_server_may_be_closed_and_opened_again(self):
        server = ServerSocket()
        self.addCleanup(server.destroy)
        client = self.dealer(server)
        for _ in range(20):
            arrival = None
            while arrival is None:  # what goes into a connection that is being closed is lost
                client.send(b"question")
                arrival = server.receive(0.5)
            server.send(arrival.routing_id, b"answer")
            self.assertEqual(b"answer", client.recv())
            server.close()
            server.open()


if __name__ == "__main__":
    unittest.main()
