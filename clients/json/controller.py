#!/usr/bin/env python3
"""A complete controller with only a ZeroMQ binding: it uses the JSON form of the protocol.

It sets every velocity motor to 1 rad/s (or 1 m/s) and logs the first encoder.

    ziggurat serve scenes/dynamics3d_multi_body_test.argos &
    controller.py ENDPOINT        as the server prints it
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

    send(hello={"version": {"major": 1, "minor": 1}, "role": "ROLE_CONTROLLER", "clientName": "json",
                "robots": ["*"], "controller": os.environ.get("ZIGGURAT_CONTROLLER", "")})
    targets, are_told = [], False  # targets stay until changed: they are told once
    while True:
        # One of the names is the kind; a later version of the protocol may have more names.
        for kind, data in json.loads(socket.recv()).items():
            if kind == "welcome":
                targets = [1.0 if motor["mode"] == "VELOCITY" else 0.0
                           for robot in data["robots"] for motor in robot["jointActuators"]]
            elif kind == "observation":
                command = {"tick": data["tick"]}
                if not are_told:
                    command["jointTargets"] = targets
                elif data["jointReadings"]:
                    command["log"] = [{"robot": 0, "text": f"{data['jointReadings'][0]:.2f}"}]
                send(command=command)
                are_told = True
            elif kind == "reset":
                are_told = False
            elif kind == "end":
                send(leave={"reason": "DONE"})
                return 0
            elif kind == "refusal" or kind == "displaced":
                print(data, file=sys.stderr)
                return 1
            elif kind == "error" and (data["severity"] == "WARNING" or "_TICK" in data["code"]):
                are_told = False  # the answer was late, or crossed a reset: its values may be lost
            elif kind == "error":
                send(leave={"reason": "FAILED", "message": data["message"]})
                return 1
            # "loading", "heartbeat", "paused" and messages of later versions need no answer.


if __name__ == "__main__":
    sys.exit(main())
