#!/usr/bin/env python3
"""A whole controller that needs a ZeroMQ binding and nothing else: the protocol's JSON twin.

It turns every velocity motor at 1 rad/s (or 1 m/s) and logs what the first encoder reads.

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
    socket.linger = 1000  # [ms] for the last message to get out
    socket.connect(endpoint)

    def say(**message):
        socket.send_string(json.dumps(message))

    say(hello={"version": {"major": 1}, "role": "ROLE_CONTROLLER", "clientName": "json",
               "robots": ["*"], "controller": os.environ.get("ZIGGURAT_CONTROLLER", "")})
    targets = []
    while True:
        (kind, said), = json.loads(socket.recv()).items()
        if kind == "welcome":
            targets = [1.0 if motor["mode"] == "VELOCITY" else 0.0
                       for robot in said["robots"] for motor in robot["jointActuators"]]
        elif kind == "observation":
            command = {"tick": said["tick"]}
            if said["tick"] == "0":  # targets stay until changed
                command["jointTargets"] = targets
            elif said["jointReadings"]:
                command["log"] = [{"robot": 0, "text": f"{said['jointReadings'][0]:.2f}"}]
            say(command=command)
        elif kind == "end":
            say(leave={"reason": "DONE"})
            return 0
        elif kind == "refusal" or kind == "displaced":
            print(said, file=sys.stderr)
            return 1
        elif kind == "error" and said["severity"] != "WARNING" and "_TICK" not in said["code"]:
            say(leave={"reason": "FAILED", "message": said["message"]})
            return 1
        # "loading", "heartbeat", "paused", "reset" need no answer, nor does what comes in future;
        # STALE_TICK, DUPLICATE_TICK and FUTURE_TICK tell of an answer that met a reset on its way.


if __name__ == "__main__":
    sys.exit(main())
