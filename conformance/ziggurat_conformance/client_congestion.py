"""A connection on which nothing more fits, as over a slow network: what was sent last is lost with a client that closes
without waiting."""

import time

from .client_messages import end, error
from .client_steps import TellObservation

_MOST_TICKS = 900  # fewer than the messages that ZeroMQ keeps for a connection
_SETTLED = 1.0  # [s] without more of a client: nothing fits
_HELD = 0.5  # [s] until it is read again
_LOOKS_EVERY = 0.001  # [s]


def last_message_is_lost(stage) -> str:
    """For checks, at a local socket and after tick 0. Ticks miss their deadlines until the connection is full, and the run ends."""
    stage.socket.hold(True)
    tick, is_full = 0, False
    while not is_full and tick < _MOST_TICKS:
        tick += 1
        is_full = not _answers(stage, tick)
    code = stage.program.exit_code()
    if code is not None:
        return f"the program ended with exit code {code} when it missed a deadline (W5)"
    stage.tell(end(tick))
    time.sleep(_HELD)
    stage.socket.hold(False)
    commands = 0
    while (message := stage.receive(stage.patience)) is not None and message.HasField("command"):
        commands += 1
    if message is not None and message.HasField("leave"):
        return ""
    return f"after {commands} Commands that waited in the connection its Leave did not arrive: its linger leaves no time (T1, L5)"


def _answers(stage, tick: int) -> bool:
    """Whether more of the client has come after this tick, which it misses."""
    before = stage.socket.unread()
    stage.tell_observation(TellObservation(tick))
    stage.tell(error("DEADLINE_MISSED", "WARNING", tick))
    deadline = time.monotonic() + _SETTLED
    while stage.socket.unread() <= before and stage.program.exit_code() is None:
        if time.monotonic() > deadline:
            return False
        time.sleep(_LOOKS_EVERY)
    return stage.program.exit_code() is None
