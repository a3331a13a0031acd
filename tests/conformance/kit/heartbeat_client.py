# SPDX-License-Identifier: MIT
"""A client that sends heartbeats instead of Commands; fewer than are too many (M7). It does not read what the server says."""

import os
import time

import zmq
from ziggurat_conformance.wire import protocol

client = zmq.Context.instance().socket(zmq.DEALER)
client.connect(os.environ["ZIGGURAT_ENDPOINT"])
client.send(protocol.ClientMessage(hello={
    "version": {"major": 1}, "role": protocol.ROLE_CONTROLLER, "robots": ["*"]}).SerializeToString())
client.recv()
for sequence in range(1_000_000):
    client.send(protocol.ClientMessage(heartbeat={"sequence": sequence}).SerializeToString())
    time.sleep(0.005)
