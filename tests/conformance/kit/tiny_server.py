"""A server of the protocol's core in little space, and broken ones:
tiny_server.py ENDPOINT SCENE [BUG [SECRET CLIENTS]], the last two as of `ziggurat serve --curve-…`. The
scene is not read.

It has four robots of one joint, one radio and nothing else of interest, and no physics. It is there to
show that the kit catches what is broken; nothing else should use it.
"""

import math
import pathlib
import signal
import sys
from fnmatch import fnmatchcase

import zmq
import zmq.auth.thread
from google.protobuf.message import DecodeError

import protocol_pb2 as protocol

E = protocol.Error
ROBOTS = [f"arm{i}" for i in range(4)]


class Fault(Exception):
    def __init__(self, code, severity=E.DISCARD, **fields):
        self.error = protocol.Error(code=code, severity=severity, message="no", **fields)


class Session:
    def __init__(self, robots, token):
        self.robots, self.token, self.owes, self.lost = robots, token, False, False


class Server:
    def __init__(self, endpoint, bug, keys=()):
        self.roles = {}  # by public key
        self.allowed = None  # roles of the peer that is being answered
        self.bug, self.tick, self.begun = bug, 0, False
        self.angle, self.speed = [0.0] * 4, [0.0] * 4
        self.sent, self.heard = [], []  # (robot, payload)
        self.sessions, self.tokens = {}, 0  # by routing id
        self.lost = []
        self.socket = zmq.Context.instance().socket(zmq.ROUTER)
        self.socket.setsockopt(zmq.ROUTER_MANDATORY, 1)
        self.socket.setsockopt(zmq.LINGER, 0)
        if keys and bug != "plain-text":
            self.protect(*keys)
        self.socket.bind(endpoint)

    def protect(self, secret, clients):
        for line in pathlib.Path(clients).read_text().splitlines():
            key, roles, _ = line.split()
            self.roles[key] = roles.split(",")
        allows_any = self.bug == "any-key"
        self.authenticator = zmq.auth.thread.ThreadAuthenticator(self.socket.context)
        self.authenticator.start()
        self.authenticator.configure_curve_callback(credentials_provider=self)
        self.callback = lambda domain, key: allows_any or key.decode() in self.roles
        self.socket.curve_secretkey = pathlib.Path(secret).read_bytes().strip()
        self.socket.curve_server = True

    def serve(self):
        while True:
            frames = self.socket.recv_multipart(copy=False)
            user = frames[-1].get("User-Id") if self.roles else None
            peer, *frames = [frame.bytes for frame in frames]
            session = self.sessions.get(peer)
            try:
                try:
                    message = protocol.ClientMessage.FromString(frames[0])
                except DecodeError:
                    raise Fault(E.MALFORMED) from None
                kind = message.WhichOneof("message")
                if len(frames) != 1 or kind is None:
                    raise Fault(E.MALFORMED)
                self.allowed = self.roles.get(user)
                self.take(peer, session, kind, getattr(message, kind))
            except Fault as fault:
                if self.bug == "silent-on-garbage" and fault.error.code == E.MALFORMED:
                    continue
                fault.error.tick = self.tick
                if session is None:
                    fault.error.severity = E.FATAL
                self.tell(peer, error=fault.error)

    def tell(self, peer, **fields):
        try:
            self.socket.send_multipart([peer, protocol.ServerMessage(**fields).SerializeToString()])
            return True
        except zmq.ZMQError:
            session = self.sessions.pop(peer, None)
            if session:
                session.lost = True
                self.lost.append(session)
            return False

    def take(self, peer, session, kind, message):
        if session is None and kind != "hello":
            raise Fault(E.OUT_OF_STATE)
        if kind == "hello":
            if session is not None:
                raise Fault(E.OUT_OF_STATE)
            try:
                self.hello(peer, message)
            except Fault as fault:
                fault.error.severity = E.FATAL
                fault.error.retryable = fault.error.code == E.ROBOT_TAKEN
                self.tell(peer, refusal=protocol.Refusal(error=fault.error, holder="another client"))
        elif kind == "heartbeat":
            self.tell(peer, heartbeat=message)
            if self.bug == "heartbeat-releases" and session.owes:
                self.release(session)
        elif kind == "command":
            self.command(session, message)

    def wanted(self, hello):
        robots = []
        for pattern in hello.robots:
            found = [i for i, name in enumerate(ROBOTS) if fnmatchcase(name, pattern)]
            if not found:
                raise Fault(E.UNKNOWN_ROBOT)
            robots += [i for i in found if i not in robots]
        return robots if self.bug == "asked-order" else sorted(robots)

    def hello(self, peer, hello):
        if hello.version.major != 1 and self.bug != "any-version":
            raise Fault(E.VERSION_MISMATCH)
        role = protocol.Role.Name(hello.role).removeprefix("ROLE_").lower()
        if self.allowed is not None and role not in self.allowed and self.bug != "any-role":
            raise Fault(E.FORBIDDEN)
        if hello.role != protocol.ROLE_CONTROLLER:
            raise Fault(E.BAD_VALUE)
        ends_runs = self.allowed is None or "supervisor" in self.allowed or self.bug == "grants-stop"
        if hello.deadline_policy.action == protocol.DeadlinePolicy.STOP and not ends_runs:
            raise Fault(E.FORBIDDEN)
        if hello.session_token and self.bug != "any-token":
            session = self.resumed(hello.session_token)
        else:
            robots = self.wanted(hello) if hello.robots else []
            if not robots and not hello.session_token:
                raise Fault(E.BAD_VALUE)
            for other in list(self.sessions):
                if set(self.sessions[other].robots) & set(robots) and self.bug != "shares-robots":
                    if self.tell(other, heartbeat=protocol.Heartbeat()):
                        raise Fault(E.ROBOT_TAKEN, robot=ROBOTS[robots[0]])
            self.tokens += 1
            session = Session(robots, f"token{self.tokens}".encode())
        session.lost = False
        self.sessions[peer] = session
        self.tell(peer, welcome=self.welcome(session))
        held = {robot for s in self.sessions.values() for robot in s.robots}
        if self.begun and self.bug != "late-waits":
            self.observe(peer, session)
        elif len(held) == 4 and not self.begun:
            self.begun = True
            for other, s in list(self.sessions.items()):
                self.observe(other, s)

    def resumed(self, token):
        """The session with this token, taken from its connection if it has one."""
        for peer in [p for p, s in self.sessions.items() if s.token == token]:
            if self.bug == "token-waits":
                raise Fault(E.ROBOT_TAKEN)
            if self.tell(peer, displaced=protocol.Displaced(by="its token", message="resumed")):
                return self.sessions.pop(peer)
        for session in [s for s in self.lost if s.token == token]:
            self.lost.remove(session)
            return session
        raise Fault(E.NO_SUCH_SESSION)

    def welcome(self, session):
        welcome = protocol.Welcome(version={"major": 1}, session_token=session.token, seed=7,
                                   tick_ns=100_000_000, ticks_per_second=10, scene_hash="0" * 16,
                                   mode=protocol.MODE_LOCK_STEP, max_message_bytes=1 << 26,
                                   role=protocol.ROLE_CONTROLLER)
        for robot in session.robots:
            description = welcome.robots.add(id=ROBOTS[robot], controller="steady")
            description.joint_sensors.add(id="hinge", mode=protocol.JointDescription.POSITION)
            description.joint_actuators.add(id="hinge", mode=protocol.JointDescription.VELOCITY)
            description.radios.add(id="mouth", range=3, sends=True, receives=True)
        return welcome

    def observe(self, peer, session):
        time_ns = self.tick * (99_999_999 if self.bug == "time-drifts" else 100_000_000)
        observation = protocol.Observation(tick=self.tick, time_ns=time_ns)
        readings = [self.angle[robot] for robot in session.robots]
        observation.joint_readings.extend(readings[:-1] if self.bug == "short-readings" else readings)
        for position, robot in enumerate(session.robots):
            for sender, payload in self.heard:
                if sender != robot and robot not in {s for s, _ in self.heard}:
                    observation.radio_messages.add(radio=position, payload=payload)
        session.owes = True
        self.tell(peer, observation=observation)
        if self.bug == "tells-twice":
            self.tell(peer, observation=observation)

    def command(self, session, command):
        if command.tick > self.tick and self.bug != "future-counts":
            raise Fault(E.FUTURE_TICK)
        if command.tick < self.tick and self.bug == "dies":
            sys.exit("goodbye")
        if command.tick < self.tick and self.bug != "stale-counts":
            raise Fault(E.STALE_TICK)
        if not session.owes:
            if self.bug == "duplicate-silent":
                return
            raise Fault(E.DUPLICATE_TICK)
        if self.bug == "half-a-command":
            self.send_radio(session, command)
        if any(p >= len(session.robots) for p in command.robots):
            raise Fault(E.UNKNOWN_ROBOT, field="robots")
        if len(set(command.robots)) != len(command.robots):
            raise Fault(E.BAD_VALUE, field="robots")
        robots = [session.robots[p] for p in command.robots] or session.robots
        if len(command.joint_targets) not in (0, len(robots)) and self.bug != "any-length":
            raise Fault(E.BAD_VALUE, field="joint_targets")
        if any(not math.isfinite(t) for t in command.joint_targets) and self.bug != "nan-counts":
            raise Fault(E.BAD_VALUE, field="joint_targets")
        if any(m.radio >= len(session.robots) for m in command.radio_messages):
            raise Fault(E.UNKNOWN_DEVICE)
        if command.led_colors:
            raise Fault(E.BAD_VALUE, field="led_colors")
        for robot, target in zip(robots, command.joint_targets):
            self.speed[robot] = target if math.isfinite(target) else 0.0
        if self.bug != "half-a-command":
            self.send_radio(session, command)
        self.release(session)

    def send_radio(self, session, command):
        self.sent += [(session.robots[m.radio], m.payload) for m in command.radio_messages]

    def release(self, session):
        session.owes = False
        living = [s for s in self.sessions.values()]
        held = {robot for s in living for robot in s.robots}
        if any(s.owes for s in living) or len(held) < 4:
            return
        for peer in list(self.sessions):  # a peer that is gone is waited for
            if not self.tell(peer, heartbeat=protocol.Heartbeat()):
                return
        self.tick += 2 if self.bug == "skips-ticks" else 1
        step = 0.1 if self.bug != "two-steps" else 0.2
        self.angle = [a + s * step for a, s in zip(self.angle, self.speed)]
        self.heard = sorted(self.sent, key=lambda m: m[0])
        if self.bug == "radio-reversed":
            self.heard.reverse()
        self.sent = []
        for peer, s in list(self.sessions.items()):
            self.observe(peer, s)


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    Server(sys.argv[1], sys.argv[3] if len(sys.argv) > 3 else "", sys.argv[4:]).serve()
