"""A controller that does nothing, rightly, and broken ones: tiny_client.py [BUG]."""

import os
import sys
import time

import zmq

import protocol_pb2 as protocol


def main(bug):
    socket = zmq.Context.instance().socket(zmq.DEALER)
    socket.setsockopt(zmq.LINGER, 500)
    socket.connect(os.environ["ZIGGURAT_ENDPOINT"])

    def say(**fields):
        socket.send(protocol.ClientMessage(**fields).SerializeToString())

    def hello():
        version = protocol.Version(major=0 if bug == "version-zero" else 1)
        say(hello=protocol.Hello(version=version, role=protocol.ROLE_CONTROLLER, robots=[] if bug == "asks-for-nothing" else ["*"],
                                 client_name="tiny"))

    if bug == "command-first":
        say(command=protocol.Command(tick=0))
    hello()
    robots, last = 0, 0
    while True:
        if bug == "impatient" and not socket.poll(300):
            hello()
            continue
        message = protocol.ServerMessage.FromString(socket.recv())
        kind = message.WhichOneof("message")
        if kind == "welcome":
            robots = len(message.welcome.robots)
        elif kind == "observation":
            last = message.observation.tick + (1 if bug == "tick-ahead" else 0)
            if bug == "skips-zero" and last == 0:
                continue
            command = protocol.Command(tick=last)
            if bug == "short-targets":
                command.joint_targets.extend([0.0] * (robots - 1))
            if bug == "nan-targets":
                command.joint_targets.extend([float("nan")] * robots)
            say(command=command)
            if bug == "answers-twice":
                say(command=command)
        elif kind == "heartbeat" and bug == "answers-heartbeats":
            say(heartbeat=message.heartbeat)
        elif kind == "paused" and bug == "answers-paused":
            say(command=protocol.Command(tick=last))
        elif kind == "reset" and bug == "answers-reset":
            say(command=protocol.Command(tick=0))
        elif kind == "displaced":
            if bug == "comes-back":
                hello()
                continue
            return 1
        elif kind == "refusal":
            if bug == "storm":
                hello()
                continue
            return 0 if bug == "refusal-is-fine" else 1
        elif kind == "error" and message.error.severity == protocol.Error.FATAL:
            return 0 if bug == "fatal-is-fine" else 1
        elif kind == "end":
            if bug == "answers-end":
                say(command=protocol.Command(tick=last))
            if bug != "ignores-end":
                say(leave=protocol.Leave(reason=protocol.Leave.DONE))
                time.sleep(0.05)
                return 0
        elif kind is None and bug == "dies-of-news":
            return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1] if len(sys.argv) > 1 else ""))
