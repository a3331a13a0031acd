# SPDX-License-Identifier: MIT
"""A controller that can be disturbed, as a process that is forked from the test.

Its commands depend only on the tick and on what its robot senses, so a restarted controller continues
where the last one stopped. Its joint target also depends on the received radio messages: one that is
lost, or sent twice, changes the robots' poses.
"""

import math
import multiprocessing
import os
import random
import struct
import time

import ziggurat
from ziggurat import protocol_pb2 as v1
from zmtp import RawPeer

ROBOTS = 16

# What a controller does to its own connection when the test orders it.
GARBAGE, RUDE, FLOOD, SLOW = range(1, 5)


class Board:
    """Memory that the test and its controllers share; one element per controller."""

    def __init__(self):
        processes = multiprocessing.get_context("fork")
        self.ticks = processes.Array("q", [-1] * ROBOTS, lock=False)  # the last tick
        self.orders = processes.Array("q", [0] * ROBOTS, lock=False)  # what to do, once
        self.noticed = processes.Array("q", [0] * ROBOTS, lock=False)  # unexpected pauses and late answers
        self.missed = processes.Array("q", [0] * ROBOTS, lock=False)  # missed deadlines
        self.first_missed = processes.Array("q", [-1] * ROBOTS, lock=False)  # tick of the first miss, or -1
        self.resumed = processes.Array("q", [0] * ROBOTS, lock=False)
        self.ended = processes.Array("q", [0] * ROBOTS, lock=False)
        self.gate = processes.Value("q", 1 << 60, lock=False)  # the first tick that none answers yet


def control(index, endpoint, folder, board, talks):
    """Controls robot `index` to the end of the run. Reconnects whenever its connection is lost."""
    token = folder / f"token{index}"
    while True:
        try:
            session = _begin(index, endpoint, token)
            if _answer_ticks(index, session, board, talks):
                board.ended[index] = 1
                session.close()
                return
        except ziggurat.ConnectionLost:
            if not token.exists():
                raise


def _begin(index, endpoint, token):
    if not token.exists():
        session = ziggurat.connect(endpoint, f"robot{index}", name=f"controller {index}",
                                   connect_timeout=60)
        _write_whole(token, session.token)
        return session
    return ziggurat.resume(endpoint, token.read_bytes(), name=f"controller {index}",
                           connect_timeout=60)


def _write_whole(path, data):
    """Atomic: a killed process leaves the whole file or no file."""
    fresh = path.with_suffix(".new")
    fresh.write_bytes(data)
    os.replace(fresh, path)


def _answer_ticks(index, session, board, talks):
    """Answers ticks. Returns False if the session must be resumed over a new connection."""
    [robot] = session.robots
    for tick in session:
        board.ticks[index] = tick.number
        board.resumed[index] += tick.event is ziggurat.Event.RESUME
        order, board.orders[index] = board.orders[index], 0
        if order and not _misbehave(order, session, tick.number):
            session.abandon()
            return False
        while tick.number >= board.gate.value:
            time.sleep(0.002)
        _command(robot, tick.number, index, talks)
        if session.missed and board.first_missed[index] < 0:
            board.first_missed[index] = tick.number - 1
        board.missed[index] = max(board.missed[index], session.missed)
        board.noticed[index] += session.paused or (session.late > 0 and session.missed == 0)
    return True


def _command(robot, tick, index, talks):
    hinge, radio = robot.joints["hinge"], robot.radios["transceiver"]
    received = sum(struct.unpack("<qq", payload)[0] for payload in radio.received)
    hinge.target = 0.8 * math.sin(0.05 * tick + index) - 0.3 * hinge.encoder + 1e-3 * (received % 7)
    if talks and (tick + index) % 8 == 0:
        radio.send(struct.pack("<qq", tick + index, index))


# ---- misbehaviour over the controller's own connection -------------------------------------------


def _misbehave(order, session, tick):
    """Returns False if the session must be resumed over a new connection."""
    stream = session._connection.transport
    draw = random.Random(tick)
    if order == GARBAGE:
        for frames in _garbage(draw, 20):
            stream._socket.send_multipart(frames)
        return all(_error(stream) in ("MALFORMED", "TOO_LARGE") for _ in range(20))
    if order == RUDE:
        for frames in _garbage(draw, 150):
            stream._socket.send_multipart(frames)
        while _error(stream) != "TOO_MANY":
            pass
        return False
    if order == FLOOD:
        beat = v1.ClientMessage(heartbeat=v1.Heartbeat(sequence=1)).SerializeToString()
        for _ in range(4000):
            stream.send(beat)
        while _error(stream) != "TOO_MANY":
            pass
        return False
    session.abandon()
    _command_slowly(session)
    return False


def _garbage(draw, count):
    """Invalid messages: noise, two frames, half a command, large noise, JSON in a binary session."""
    whole = v1.ClientMessage(command=v1.Command(tick=1, joint_targets=[1.0] * 20)).SerializeToString()
    for i in range(count):
        yield ([b"\xff" + draw.randbytes(200)], [whole, whole], [whole[:len(whole) // 2]],
               [b"\xff" + draw.randbytes(100_000)], [b'{"command": {"tick": "1"}}'])[i % 5]


def _error(stream):
    """The code of the next Error. Skips other messages."""
    while True:
        data = stream.receive(1.0)
        if data is None:
            if stream.why_closed is not None:
                raise AssertionError(f"no Error before the end: {stream.why_closed}")
            continue
        message = v1.ServerMessage.FromString(data)
        if message.WhichOneof("message") == "error":
            return v1.Error.Code.Name(message.error.code)


def _command_slowly(session):
    """Resumes the session over a new connection, byte by byte, and closes it in the middle of its
    command."""
    hello = v1.Hello(version=v1.Version(major=1), role=v1.ROLE_CONTROLLER, robots=["*"],
                     client_name="slow", session_token=session.token, takeover=True)
    command = v1.ClientMessage(command=v1.Command(tick=session.tick.number)).SerializeToString()
    with RawPeer(session.endpoint, drip=0.001) as peer:
        peer.send_message(v1.ClientMessage(hello=hello).SerializeToString())
        for expected in ("welcome", "observation"):
            kind = v1.ServerMessage.FromString(peer.receive_message()).WhichOneof("message")
            if kind != expected:
                raise AssertionError(f"expected {expected}, got {kind}")
        peer.send_half(command)
