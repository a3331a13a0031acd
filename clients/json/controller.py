#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A complete controller with only a ZeroMQ binding: it uses the JSON form of the protocol.

It sets every velocity motor to 1 rad/s (or 1 m/s) and logs the first encoder. If its connection is lost, it
resumes its session; with ZIGGURAT_SERVER_KEY and ZIGGURAT_CURVE_SECRET it is encrypted.

    ziggurat serve scenes/dynamics3d_multi_body_test.argos
    controller.py ENDPOINT        in a second terminal; as the server prints it
"""

import base64
import json
import os
import pathlib
import sys
import time

import zmq
import zmq.utils.monitor

REFUSED_KEYS = (zmq.EVENT_HANDSHAKE_FAILED_AUTH | zmq.EVENT_HANDSHAKE_FAILED_NO_DETAIL
                | zmq.EVENT_HANDSHAKE_FAILED_PROTOCOL)
PATIENCE = 10.0  # [s] of wall time for a server that is not there


class Lost(Exception):
    """The connection was closed, or is silent for longer than the server promised."""


def tell(text):
    """A text of the server, without characters that a terminal would obey."""
    print("".join(c if c.isprintable() else f"\\u{ord(c):04x}" for c in text[:1000]), file=sys.stderr)


class Connection:
    def __init__(self, endpoint):
        self.socket = zmq.Context.instance().socket(zmq.DEALER)
        self.socket.linger = 1000  # [ms] to send the last message
        self.socket.maxmsgsize = (1 << 30) + (1 << 20)  # [bytes]; a longer one closes the connection
        if server_key := os.environ.get("ZIGGURAT_SERVER_KEY"):
            secret = pathlib.Path(os.environ["ZIGGURAT_CURVE_SECRET"]).read_text().strip().encode()
            self.socket.curve_serverkey, self.socket.curve_secretkey = server_key.encode(), secret
            self.socket.curve_publickey = zmq.curve_public(secret)
        self.monitor = self.socket.get_monitor_socket(zmq.EVENT_DISCONNECTED | REFUSED_KEYS)
        self.socket.connect(endpoint)

    def close(self):
        self.socket.disable_monitor()
        self.monitor.close(linger=0)
        self.socket.close()

    def send(self, **message):
        self.socket.send_string(json.dumps(message))

    def receive(self, seconds):
        """The next message, as kind and content: one of the names is the kind; a later version of the protocol
        may have more names. Raises Lost after so many seconds without any."""
        waited = 0.0  # in pieces: a program that was stopped has not waited
        while not self.socket.poll(100):
            waited += 0.1
            while self.monitor.poll(0):
                event = zmq.utils.monitor.recv_monitor_message(self.monitor)["event"]
                if event & REFUSED_KEYS and os.environ.get("ZIGGURAT_SERVER_KEY"):
                    sys.exit("refused key? Compare ZIGGURAT_SERVER_KEY and ZIGGURAT_CURVE_SECRET with the server's")
                if event == zmq.EVENT_DISCONNECTED and not self.socket.poll(0):
                    raise Lost
            if waited > seconds:
                raise Lost
        return next(iter(json.loads(self.socket.recv()).items()))


class Controller:
    def __init__(self, endpoint):
        self.endpoint = endpoint
        self.connection = Connection(endpoint)
        self.token = base64.b64encode(bytes.fromhex(os.environ.get("ZIGGURAT_SESSION_TOKEN", ""))).decode()
        self.silence = PATIENCE  # [s] after which a connection is lost
        self.targets, self.are_told = [], False  # targets stay until changed: they are told once
        self.command, self.is_resumed = {"tick": ""}, False  # the last one, which may have been lost
        self.is_over_at = None  # wall time at which a session that is not resumed is given up

    def hello(self):
        self.connection.send(hello={
            "version": {"major": 1, "minor": 3}, "role": "ROLE_CONTROLLER", "clientName": "json", "robots": ["*"],
            "canRestore": True,  # it has no state but what it was told
            "controller": os.environ.get("ZIGGURAT_CONTROLLER", ""), "sessionToken": self.token})

    def resume(self):
        """Over another connection; the first observation may be one that was answered before."""
        now = time.monotonic()
        if not self.token or now > (self.is_over_at or now):
            return 1
        if self.is_over_at:
            time.sleep(1)
        self.is_over_at, self.silence = self.is_over_at or now + PATIENCE, PATIENCE
        self.connection.close()
        self.connection, self.are_told, self.is_resumed = Connection(self.endpoint), False, True
        self.hello()
        return None

    def run(self):
        """Returns the exit code."""
        self.hello()
        code = None
        while code is None:
            try:
                kind, data = self.connection.receive(self.silence)
            except Lost:
                code = self.resume()
                continue
            # "loading", "heartbeat", "paused" and messages of later versions need no answer.
            code = getattr(self, f"take_{kind}", lambda _: None)(data)
        return code

    def take_welcome(self, welcome):
        if welcome["version"]["major"] != 1:
            tell(f"the server speaks version {welcome['version']['major']} of the protocol, this client 1")
            return 1
        self.token = welcome["sessionToken"]
        beat = welcome["wallHeartbeatMs"] / 1000
        # The end of a local connection is always told: a server that is silent there is slow.
        is_watched = beat and not self.endpoint.startswith("ipc://")
        self.silence = max(3.0, 3 * beat) if is_watched else float("inf")
        self.targets = [1.0 if motor["mode"] == "VELOCITY" else 0.0
                        for robot in welcome["robots"] for motor in robot["jointActuators"]]
        return None

    def take_observation(self, observation):
        is_same = all(self.command.get(name) == observation.get(name) for name in ("tick", "epoch"))
        is_again, self.is_resumed = self.is_resumed and is_same, False
        if not is_again:
            self.command = self.answer_to(observation)
            self.is_over_at = None
        self.connection.send(command=self.command)

    def answer_to(self, observation):
        command = {name: observation[name] for name in ("tick", "epoch") if name in observation}
        if not self.are_told:
            command["jointTargets"] = self.targets
        elif observation["jointReadings"]:
            command["log"] = [{"robot": 0, "text": f"{observation['jointReadings'][0]:.2f}"}]
        self.are_told = True
        return command

    def take_reset(self, _):
        self.are_told = self.is_resumed = False

    take_restored = take_reset

    def take_end(self, _):
        self.connection.send(leave={"reason": "DONE"})
        return 0

    def take_refusal(self, refusal):
        if refusal["error"]["retryable"] and self.is_over_at:
            return self.resume()
        tell(refusal["error"]["message"])
        return 1

    def take_displaced(self, displaced):
        tell(displaced["message"])
        return 1

    def take_error(self, error):
        if error["severity"] == "FATAL" and error["code"] == "OUT_OF_STATE":
            return self.resume()
        if error["severity"] == "WARNING" or "_TICK" in error["code"]:
            self.are_told = False  # the answer was late, or crossed a reset: its values may be lost
            return None
        if error["severity"] != "FATAL":
            self.connection.send(leave={"reason": "FAILED", "message": error["message"]})
        tell(error["message"])
        return 1


def main():
    endpoint = sys.argv[1] if len(sys.argv) > 1 else os.environ.get("ZIGGURAT_ENDPOINT")
    if not endpoint:
        sys.exit("write controller.py ENDPOINT, as the server prints it, or set ZIGGURAT_ENDPOINT")
    controller = Controller(endpoint)
    try:
        return controller.run()
    except (ValueError, LookupError, TypeError, AttributeError, StopIteration, RecursionError) as error:
        tell(f"{endpoint} sent what is no message of the protocol: {error!r:.200}")
        return 1
    finally:
        controller.connection.close()
        zmq.Context.instance().term()  # waits for the last message, as long as the linger says


if __name__ == "__main__":
    sys.exit(main())
