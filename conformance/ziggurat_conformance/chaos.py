# SPDX-License-Identifier: MIT
"""Legal but unpleasant behaviour, drawn from a seed: resend, hang up and resume, share robots anew,
answer in any order. The world must tick on, and well-behaved sessions must not notice."""

import random
import time
from typing import Callable

from . import wire
from .case import Case, Failed, Level, Outcome, Verdict, judge
from . import client_messages as words
from .client_stage import ClientStage, Options
from .cases.client_core import UNKNOWN_KIND
from .client_steps import Tell
from .messages import answer, hear_error, heartbeat, join
from .steps import Hang, Hear, Stage, Token

ROBOTS = ("arm0", "arm1", "arm2", "arm3")


def play_server(servers, seed: int, ticks: int, patience: float, forms: tuple,
                on_outcome: Callable) -> list:
    """So many ticks of unpleasant sessions, in each form."""
    outcomes = []
    try:
        for form in forms:
            case = Case("S12.chaos", f"{ticks} ticks of chaos, seed {seed}", (), Level.RECONNECT)
            outcome = Outcome(f"{case.id}/{form}", case.title, case.level, Verdict.PASS)
            server = servers.server_for(case)
            with Stage(server.endpoint, form, patience, server) as stage:
                judge(outcome, lambda: _Crowd(stage, random.Random(seed)).live(ticks))
            outcome.transcript = _end_of(stage, outcome)
            servers.done(case, outcome.verdict is Verdict.PASS)
            outcomes.append(outcome)
            on_outcome(outcome)
    finally:
        servers.stop()
    return outcomes


class _Crowd:
    """Sessions that share the robots among them. One of them, "good", only ever answers."""

    def __init__(self, stage: Stage, draw: random.Random):
        self._stage = stage
        self._draw = draw
        self._count = 0
        self._bad: dict[str, tuple] = {}  # name → its robots
        self._tick = None

    def live(self, ticks: int) -> None:
        self._stage.play((join("good", "arm0"),))
        self._share_anew()
        for _ in range(ticks):
            self._one_tick()

    def _one_tick(self) -> None:
        names = ["good", *self._bad]
        self._stage.play(tuple(Hear(name, "observation") for name in names))
        found = {self._stage.peer(name).tick for name in names}
        expected = {self._tick + 1} if self._tick is not None else found
        if found != expected or len(found) != 1:
            raise Failed(f"sessions are at ticks {sorted(found)}; all should be at {sorted(expected)}")
        self._tick = found.pop()
        self._draw.shuffle(names)
        act = self._draw.choice((self._resend, self._resume, self._move, self._beat, self._err, None,
                                 None))
        if act is not None:
            names = act(names)
        self._stage.play(tuple(answer(name) for name in names))

    def _share_anew(self) -> None:
        """All robots but arm0, among one, two or three sessions."""
        robots = list(ROBOTS[1:])
        self._draw.shuffle(robots)
        cut = self._draw.randint(1, len(robots))
        for group in (robots[:cut], robots[cut:]):
            if group:
                self._count += 1
                name = f"bad{self._count}"
                self._stage.play((join(name, *group),))
                self._bad[name] = tuple(group)

    def _resend(self, names: list) -> list:
        """A session answers three times. Others still owe, so that the tick is not complete."""
        name = next(n for n in names if n != names[-1])
        self._stage.play((answer(name), answer(name), hear_error(name, "DUPLICATE_TICK"),
                          answer(name), hear_error(name, "DUPLICATE_TICK")))
        return [n for n in names if n != name]

    def _resume(self, names: list) -> list:
        """A session closes its connection and resumes with its token, at the same tick."""
        name = self._draw.choice([n for n in names if n != "good"])
        self._count += 1
        fresh = f"bad{self._count}"
        self._stage.play((Hang(name), join(fresh, session_token=Token(name)),
                          Hear(fresh, "observation", {"tick": self._tick})))
        self._bad[fresh] = self._bad.pop(name)
        return [fresh if n == name else n for n in names]

    def _move(self, names: list) -> list:
        """All but the good one close; others take their robots."""
        for name in list(self._bad):
            self._stage.play((Hang(name),))
        self._bad.clear()
        self._share_anew()
        self._stage.play(tuple(Hear(n, "observation", {"tick": self._tick}) for n in self._bad))
        return ["good", *self._bad]

    def _beat(self, names: list) -> list:
        for name in names:
            sequence = self._draw.randrange(2**32)
            self._stage.play((heartbeat(name, sequence), Hear(name, "heartbeat",
                                                              {"sequence": sequence})))
        return names

    def _err(self, names: list) -> list:
        """A session answers for a later tick first."""
        name = self._draw.choice([n for n in names if n != "good"])
        self._stage.play((answer(name, self._tick + 5), hear_error(name, "FUTURE_TICK")))
        return names


def play_client(command: list, seed: int, ticks: int, options: Options, on_outcome: Callable) -> list:
    """A server that pauses, resets, sends heartbeats and unknown messages, and takes its time."""
    draw = random.Random(seed)
    outcome = Outcome("S3.chaos", f"{ticks} ticks of chaos, seed {seed}", Level.RECONNECT, Verdict.PASS)
    with ClientStage(command, Case(outcome.id, outcome.title, ()), options) as stage:
        judge(outcome, lambda: _unrest(stage, draw, ticks))
    outcome.transcript = _end_of(stage, outcome)
    on_outcome(outcome)
    return [outcome]


def _unrest(stage: ClientStage, draw: random.Random, ticks: int) -> None:
    stage.play((words.HELLO, words.welcome()))
    tick = 0
    for _ in range(ticks):
        stage.play((words.observation(tick),))
        if draw.random() < 0.2:
            stage.tell(Tell({"heartbeat": {"sequence": draw.randrange(2**32)}}))
        stage.play((words.answered(tick),))
        tick = _disturb(stage, draw, tick) + 1
    stage.play((words.end(tick - 1), words.LEFT))


def _end_of(stage, outcome: Outcome) -> str:
    """Of the exchange, if something is wrong with it."""
    lines = [] if outcome.verdict is Verdict.PASS else stage.transcript.text().splitlines()
    return "\n".join(lines[-100:])


def _disturb(stage: ClientStage, draw: random.Random, tick: int) -> int:
    """Something between two ticks. Returns the tick that the world is at afterwards."""
    what = draw.randrange(12)
    if what == 0:
        stage.tell(Tell({"paused": {"tick": tick}}))
        time.sleep(draw.random() * 0.05)
    elif what == 1:
        stage.tell(Tell({"reset": {"seed": draw.randrange(1, 100)}}))
        return -1
    elif what == 2:
        stage.tell(Tell({"error": {"code": "DEADLINE_MISSED", "severity": "WARNING", "tick": tick}}))
    elif what == 3:
        time.sleep(draw.random() * 0.1)
    elif what == 4:
        stage.play((UNKNOWN_KIND,))
    return tick
