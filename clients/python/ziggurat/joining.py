# SPDX-License-Identifier: MIT
"""How a controller begins or resumes a session."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any, Callable, MutableMapping, Optional, Sequence, Union

import zmq

from . import protocol_pb2 as v1
from .curve import Curve
from .find_server import find_server
from .session import Session

_TOKEN = "ZIGGURAT_SESSION_TOKEN"


@dataclass(frozen=True)
class Deadline:
    """The action if this controller does not answer in time: "wait", "hold", "zero", "drop" or
    "stop". A wish, which the server may refuse."""

    action: str
    wall_ms: int = 0
    miss_budget: int = 0

    def _message(self) -> v1.DeadlinePolicy:
        return v1.DeadlinePolicy(action=v1.DeadlinePolicy.Action.Value(self.action.upper()),
                                 wall_deadline_ms=self.wall_ms, miss_budget=self.miss_budget)


def connect(endpoint: str = "", robots: Union[str, Sequence[str]] = (), *, controller: str = "",
            name: str = "", version: str = "", deadline: Optional[Deadline] = None,
            takeover: bool = False, can_restore: bool = False, curve: Optional[Curve] = None,
            connect_timeout: float = 10.0, wait_timeout: Optional[float] = None,
            resume_timeout: Optional[float] = None,
            environment: MutableMapping[str, str] = os.environ,
            has_ended: Callable[[], bool] = lambda: False,
            context: Optional[zmq.Context[Any]] = None) -> Session:
    """A session with all robots that match both `robots` (ids, or globs with * ? [a-z]) and
    `controller` (its id in the scene); with neither, all robots.

    What is not given is taken from the environment, where `ziggurat run` writes it: the endpoint is that of
    find_server(), the controller is ZIGGURAT_CONTROLLER, the keys are those of Curve.from_environment(). At the endpoint
    of ZIGGURAT_ENDPOINT, or without one, a token in ZIGGURAT_SESSION_TOKEN (in hexadecimal) resumes its session; that is
    removed from the environment.

    can_restore      this controller can go back: at Event.RESTORED it takes the state that it had at
                     the tick of the snapshot. Without, the server refuses to restore the world
    connect_timeout  wall time to wait for the server's welcome [s]
    wait_timeout     wall time to wait for each observation [s]; None: forever
    resume_timeout   wall time for which a session whose connection was lost is tried to resume [s]; None: as
                     long as the server reserves the robots, at least 10 s; 0: never
    environment      {}: nothing is taken from there; without endpoint it is then that of the only server
    has_ended        whether the server is known to have ended: then it is not waited for
    context          of libzmq, which several sessions share: one thread then sends and receives for all of them. End it
                     after them; None: one of its own

    Raises ConnectionLost if no server answers, and Refused if the server refuses the session.
    """
    curve = curve or Curve.from_environment(environment)
    token = take_token(endpoint, environment)
    endpoint = endpoint or find_server(environment)
    controller = controller or environment.get("ZIGGURAT_CONTROLLER", "")
    wanted = [robots] if isinstance(robots, str) else list(robots)
    if not wanted and not controller:
        wanted = ["*"]
    hello = v1.Hello(role=v1.ROLE_CONTROLLER, robots=wanted, controller=controller,
                     client_name=name or controller or "python", client_version=version, takeover=takeover,
                     session_token=token, can_restore=can_restore)
    if deadline is not None:
        hello.deadline_policy.CopyFrom(deadline._message())
    return Session(endpoint, hello, curve, connect_timeout, wait_timeout, resume_timeout, has_ended, context)


def take_token(endpoint: str, environment: MutableMapping[str, str] = os.environ) -> bytes:
    """Of the session that this program is started to resume. A secret, for one session at ZIGGURAT_ENDPOINT only."""
    if endpoint not in ("", environment.get("ZIGGURAT_ENDPOINT", "")):
        return b""
    text = environment.get(_TOKEN, "")
    try:
        token = bytes.fromhex(text)
    except ValueError:
        raise ValueError(f"{_TOKEN} is not hexadecimal; it has two digits for each byte of the "
                         "token") from None
    environment.pop(_TOKEN, None)
    return token


def resume(endpoint: str, token: bytes, *, name: str = "python", version: str = "",
           takeover: bool = False, curve: Optional[Curve] = None, connect_timeout: float = 10.0,
           wait_timeout: Optional[float] = None, resume_timeout: Optional[float] = None) -> Session:
    """Resumes the session with this token after its connection was lost: same robots, same tick.
    The last commands hold, and the robots have their values; the first tick's event is RESUME. Without curve the keys
    are those of Curve.from_environment()."""
    hello = v1.Hello(role=v1.ROLE_CONTROLLER, robots=["*"], client_name=name,
                     client_version=version, session_token=token, takeover=takeover)
    return Session(endpoint, hello, curve or Curve.from_environment(), connect_timeout, wait_timeout, resume_timeout)
