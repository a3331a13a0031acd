#!/usr/bin/env python3
"""A complete controller with only a ZeroMQ binding: it uses the JSON form of the protocol.

It sets every velocity motor to 1 rad/s (or 1 m/s) and logs the first encoder.

    ziggurat serve scenes/dynamics3d_multi_body_test.argos &
    controller.py tcp://127.0.0.1:5770
"""

import json
import os
import sys

import zmq


def main():
    endpoint = sys.argv[1] if len(sys.argv) > 1 else os.environ["ZIGGURAT_ENDPOINT"]
    socket = zmq.Context.instance().socket(zmq.DEALER)
    socket.linger = 1000  # [ms] to send the last message
    socket.connect(endpoint)

    def send(**message):
        socket.send_string(json.dumps(message))

    send(hello={"version": {"major": 1}, "role": "ROLE_CONTROLLER", "clientName": "json",
                "robots": ["*"], "controller": os.environ.get("ZIGGURAT_CONTROLLER", "")})
    targets = []
    while True:
        (kind, data), = json.loads(socket.recv()).items()
        if kind == "welcome":
            targets = [1.0 if motor["mode"] == "VELOCITY" else 0.0
                       for robot in data["robots"] for motor in robot["jointActuators"]]
        elif kind == "observation":
            command = {"tick": data["tick"]}
            if data["tick"] == "0":  # targets stay until changed
                command["jointTargets"] = targets
            elif data["jointReadings"]:
                command["log"] = [{"robot": 0, "text": f"{data['jointReadings'][0]:.2f}"}]
            send(command=command)
        elif kind == "end":
            send(leave={"reason": "DONE"})
            return 0
        elif kind == "refusal" or kind == "displaced":
            print(data, file=sys.stderr)
            return 1
        elif kind == "error" and data["severity"] != "WARNING" and "_TICK" not in data["code"]:
            send(leave={"reason": "FAILED", "message": data["message"]})
            return 1
        # "loading", "heartbeat", "paused", "reset" and messages of later versions need no answer.
        # STALE_TICK, DUPLICATE_TICK and FUTURE_TICK mean that the answer crossed a reset.


if __name__ == "__main__":
    sys.exit(main())
