# SPDX-License-Identifier: MIT
"""A controller that uses every device, rightly, and broken ones: tiny_client.py [BUG [json]].

It resumes its session after a lost connection, repeats its values after a missed deadline, and uses keys.
One BUG of client_bugs.py makes it break one rule; "without-monitor" is none: it notices losses by silence alone.
"""

import os
import signal
import sys
import time

import zmq
import zmq.utils.monitor
from google.protobuf import json_format

import client_bugs as bugs
import protocol_pb2 as protocol

LATE = (protocol.Error.STALE_TICK, protocol.Error.DUPLICATE_TICK, protocol.Error.FUTURE_TICK)
PER_ROBOT = {
    "joint_targets": lambda robot: [0.5] * len(robot.joint_actuators),
    "led_colors": lambda robot: [0x00FF00] * len(robot.leds),
    "directional_led_colors": lambda robot: [0xFFFFFF] * len(robot.directional_leds),
    "tag_payloads": lambda robot: [b"tag"] * len(robot.tags),
    "magnet_currents": lambda robot: [0.1] * len(robot.magnets),
    "wheel_velocities": lambda robot: [0.1, 0.2] * robot.wheels.drives,
    "turret_modes": lambda robot: [protocol.TURRET_SPEED] * robot.turret.drives,
    "turret_rotations": lambda robot: [0.0] * robot.turret.drives,
    "turret_speeds": lambda robot: [0.5] * robot.turret.drives,
    "range_and_bearing_data": lambda robot: bytes(robot.range_and_bearing.data_size
                                                  if robot.range_and_bearing.sends else 0),
}


class Client:
    def __init__(self, bug, form):
        self.bug, self.form = bug, form
        self.welcome = None
        self.token = bytes.fromhex(os.environ.get("ZIGGURAT_SESSION_TOKEN", "") if bug != "forgets-its-past" else "")
        self.answered, self.is_resumed = None, False  # the last Command
        self.started_at = time.monotonic()
        self.epoch = None
        self.tick, self.is_fresh = -1, True  # the next Command has all values
        self.left, self.retries, self.takes_over = set(), 3, False
        self.curve = None
        self.context = zmq.Context.instance()
        self.connect()

    # ---- the connection ----

    def connect(self):
        self.socket = self.context.socket(zmq.REQ if self.bug == "uses-req" else zmq.DEALER)
        self.socket.setsockopt(zmq.LINGER, 500)
        if self.bug == "sets-routing-id":
            self.socket.setsockopt(zmq.IDENTITY, b"me")
        self.set_keys()
        self.monitor = self.socket.get_monitor_socket(zmq.EVENT_DISCONNECTED | zmq.EVENT_HANDSHAKE_FAILED_NO_DETAIL
                                                      | zmq.EVENT_HANDSHAKE_FAILED_AUTH)
        self.socket.connect(os.environ["ZIGGURAT_ENDPOINT"])
        if self.bug == "idle-connection":
            self.idle = self.context.socket(zmq.DEALER)
            self.idle.connect(os.environ["ZIGGURAT_ENDPOINT"])

    def set_keys(self):
        server, path = os.environ.get("ZIGGURAT_SERVER_KEY"), os.environ.get("ZIGGURAT_CURVE_SECRET")
        if not server or self.bug == "ignores-keys":
            return
        text = open(path).read()
        secret = (text.split()[0] if self.bug == "reads-the-first-word" else
                  text if self.bug == "reads-spaces" else text.strip()).encode()
        if len(secret.rstrip(b"\n")) != 40:
            sys.exit(f"{path}: not one secret key")
        if self.bug == "wants-the-public-file":
            open(path.replace("secret", "public"))
        secret = secret.rstrip(b"\n")
        if self.bug == "any-key" or (self.bug == "new-key" and self.token):
            secret = zmq.curve_keypair()[1]
        self.socket.curve_serverkey = server.encode()
        self.socket.curve_secretkey = secret
        self.socket.curve_publickey = zmq.curve_public(secret)

    def close(self):
        self.socket.disable_monitor()
        self.monitor.close(linger=0)
        self.socket.close()

    def say(self, **fields):
        self.send(self.encoded(protocol.ClientMessage(**fields)))

    def send(self, *frames):
        self.socket.send_multipart(frames)

    def encoded(self, message):
        if self.form != "json":
            return bugs.BYTES.get(self.bug, bytes)(message.SerializeToString())
        text = json_format.MessageToJson(message, indent=None)
        return bugs.TEXTS.get(self.bug, str.encode)(text)

    def hear(self):
        """The next message; None if the connection was lost, or nothing came for much too long."""
        promised = self.welcome.wall_heartbeat_ms if self.welcome else 0
        silence = bugs.SILENCES.get(self.bug, max(3.0, 3 * promised / 1000))
        deadline = time.monotonic() + silence if promised else None
        while not self.socket.poll(20):
            if deadline and time.monotonic() > deadline and self.bug not in ("no-watchdog", "no-resume"):
                return None
            if self.bug != "without-monitor" and self.monitor.poll(0):
                event = zmq.utils.monitor.recv_monitor_message(self.monitor)["event"]
                if event != zmq.EVENT_DISCONNECTED and self.bug not in ("waits-for-ever", "falls-back"):
                    sys.exit("the keys are refused")
                if self.token and self.bug != "no-resume":
                    return None
            if self.bug == "impatient-with-keys" and not self.welcome and time.monotonic() - self.started_at > 0.2:
                sys.exit("no server has accepted the keys")
            if self.bug == "impatient" and self.welcome is None:
                self.hello()
            if self.bug == "falls-back" and self.welcome is None:
                time.sleep(0.3)  # it gives the keys that long
                self.close()
                os.environ.pop("ZIGGURAT_SERVER_KEY", None)
                self.connect()
                self.hello()
        data = self.socket.recv()
        if self.form == "json":
            return json_format.Parse(data, protocol.ServerMessage(), ignore_unknown_fields=True)
        if self.bug == "dies-of-unknown-fields" and b"\x80\x7d\x07" in data:
            sys.exit(1)
        return protocol.ServerMessage.FromString(data)

    # ---- what it says ----

    def hello(self, token=b""):
        hello = protocol.Hello(version={"major": 1, "minor": 3}, role=protocol.ROLE_CONTROLLER, robots=["*"],
                               client_name="tiny", session_token=token, takeover=self.takes_over)
        bugs.HELLOS.get(self.bug, lambda *_: None)(hello)
        self.say(hello=hello)

    def resume(self):
        self.close()
        self.connect()
        self.welcome, self.is_fresh, self.is_resumed = None, True, self.answered is not None
        self.takes_over = self.bug == "takes-over-when-lost"
        self.hello({"begins-anew": b"", "takes-over-when-lost": b"", "wrong-token": b"guess"}.get(self.bug, self.token))

    def command(self):
        """The right one for the last Observation."""
        epoch = None if self.bug == "forgets-epochs" else self.epoch
        command = protocol.Command(tick=self.tick, epoch=epoch if epoch is None or self.bug != "guesses-epochs" else epoch + 1)
        robots = self.welcome.robots
        if self.is_fresh:
            for field, values in PER_ROBOT.items():
                for robot in robots:
                    self.add(command, field, values(robot))
        elif self.tick % 5 == 1 and 0 not in self.left:
            command.robots.append(0)
            command.joint_targets.extend(PER_ROBOT["joint_targets"](robots[0]))
        elif self.tick % 5 == 2:
            radios = [radio for robot in robots for radio in robot.radios]
            command.radio_messages.extend(protocol.RadioMessage(radio=i, payload=b"hi")
                                          for i, radio in enumerate(radios) if radio.sends)
            command.log.add(robot=len(robots) - 1, text="a line")
        self.is_fresh = False
        self.answered = command
        return command

    @staticmethod
    def add(command, field, values):
        if field == "range_and_bearing_data":
            command.range_and_bearing_data += values
        else:
            getattr(command, field).extend(values)

    def answer(self):
        command = self.command()
        if self.bug in bugs.COMMANDS:
            bugs.COMMANDS[self.bug](self, command)
        if self.bug in bugs.ANSWERS:
            bugs.ANSWERS[self.bug](self, command)
        else:
            self.say(command=command)

    # ---- what it is told ----

    def run(self):
        if self.bug == "command-first":
            self.say(command=protocol.Command(tick=0))
        if self.bug == "heartbeat-first":
            self.say(heartbeat=protocol.Heartbeat(sequence=1))
        self.hello(self.token or (b"of another run" if self.bug in ("guesses-a-token", "tries-an-old-token") else b""))
        while True:
            message = self.hear()
            if message is None:
                self.resume()
                continue
            kind = message.WhichOneof("message")
            if kind is None and self.bug == "dies-of-news":
                return 1
            if self.bug == f"gives-up-on-{kind}":
                return 1
            code = getattr(self, f"take_{kind}", lambda _: None)(getattr(message, kind) if kind else None)
            if code is not None:
                return code

    def take_loading(self, _):
        if self.bug == "hello-on-loading":
            self.hello()

    def take_welcome(self, welcome):
        self.welcome, self.token = welcome, welcome.session_token
        gone = set(welcome.resumed.gone_robots)
        self.left |= set() if self.bug == "names-the-gone" else gone
        if gone and self.bug == "leaves-the-gone":
            self.say(leave=protocol.Leave(robots=gone, reason=protocol.Leave.DONE))
        if self.bug == "prints-its-token":
            print(f"resumed {self.token.hex()}", flush=True)
        if self.bug == "hello-twice":
            self.hello()
        if self.bug == "command-early":
            self.say(command=protocol.Command(tick=0))

    def take_observation(self, observation):
        if self.bug == "only-consecutive" and self.tick >= 0 and observation.tick not in (0, self.tick + 1):
            return
        moment = (observation.tick, observation.epoch if observation.HasField("epoch") else None)
        if self.is_resumed and moment == (self.tick, self.epoch) and self.bug != "sees-ticks-twice":
            self.say(command=self.answered)
        else:
            self.tick, self.epoch = moment
            self.answer()
        self.is_resumed = False

    def take_heartbeat(self, heartbeat):
        if self.bug == "answers-heartbeats":
            self.say(heartbeat=heartbeat)

    def take_paused(self, _):
        if self.bug == "answers-paused":
            self.say(command=protocol.Command(tick=self.tick))

    def take_reset(self, _):
        self.tick, self.is_fresh, self.is_resumed = -1, True, False
        if self.bug == "answers-reset":
            self.say(command=protocol.Command(tick=0))

    take_restored = take_reset

    def take_displaced(self, _):
        if self.bug.startswith("comes-back"):
            self.takes_over = self.bug == "comes-back-by-takeover"
            if self.bug == "comes-back-elsewhere":
                self.close()
                self.connect()
            self.hello(self.token if self.bug == "comes-back-by-token" else b"")
            return None
        return 0 if self.bug == "displaced-is-fine" else 1

    def take_refusal(self, refusal):
        self.takes_over = bugs.TAKEOVERS.get(self.bug) == refusal.error.code
        if self.takes_over or self.bug == "tries-an-old-token":
            return self.hello()
        if self.bug in ("storm", "storms-with-token"):
            self.hello(self.token)
            return None
        if refusal.error.retryable and self.retries:
            self.retries -= 1
            time.sleep(1)  # as H10 asks
            self.hello()
            return None
        return 0 if self.bug == "refusal-is-fine" else 1

    def take_error(self, error):
        if error.severity == protocol.Error.FATAL:
            if error.code == protocol.Error.OUT_OF_STATE and self.token and self.bug != "no-resume":
                return self.resume()
            return 0 if self.bug == "fatal-is-fine" else 1
        if error.code == protocol.Error.NOT_YOURS and (
                self.bug == "gives-up-on-taken" or (self.bug == "gives-up-when-resumed-with-less" and self.is_resumed)):
            return 1
        if self.bug == "gives-up-on-warning" or (self.bug == "gives-up-on-late" and error.code in LATE):
            return 1
        if error.severity == protocol.Error.WARNING or error.code in LATE:
            self.left |= set(error.dropped.robots) if self.bug != "names-dropped" else set()
            if error.robot:
                gone = {i for i, robot in enumerate(self.welcome.robots) if robot.id == error.robot}
                self.left |= gone
                if self.bug == "leaves-the-removed":
                    self.say(leave=protocol.Leave(robots=gone, reason=protocol.Leave.DONE))
            self.is_fresh = self.bug != "forgets-values"
            if self.bug == "stops-after-miss":
                signal.pause()
            return None
        if self.bug != "keeps-quiet":  # a Command that was refused: an empty one can't be
            self.say(command=protocol.Command(tick=self.tick))
        return None

    def take_end(self, _):
        if self.bug == "answers-end":
            self.say(command=protocol.Command(tick=self.tick))
        if self.bug == "ignores-end":
            return None
        leave = protocol.Leave(reason=protocol.Leave.DONE)
        bugs.LEAVES.get(self.bug, lambda *_: None)(leave)
        self.socket.setsockopt(zmq.LINGER, -1)  # it ends once that is sent
        self.say(leave=leave)
        self.close()
        self.context.term()
        return 1 if self.bug == "end-is-bad" else 0


if __name__ == "__main__":
    sys.exit(Client(*(sys.argv[1:] + ["", "binary"][len(sys.argv[1:]):])).run())
