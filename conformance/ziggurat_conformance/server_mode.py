# SPDX-License-Identifier: MIT
"""Plays cases against a server, and judges."""

from dataclasses import replace
from fnmatch import fnmatchcase
from typing import Callable, Iterator, Optional

from . import wire
from .case import Case, Failed, Level, NotRun, Outcome, Unimplemented, Verdict, judge
from .keys import VARIANT, Keys
from .messages import hello
from .peer import Peer, Transcript
from .server_process import ServerProcess, check_listens
from .server_scene import CROWDED, MAIN, path_of
from .steps import Hear, Join, Send, Stage
from .wire import protocol

_MOST_VAIN_STARTS = 3
_TRIES_WITH_DEADLINES = 3
_WORLD = 10.0  # [s] until a server says that its world loads, or has loaded; on a busy machine too
_MENDING = 3.0  # [s] that making a server usable again may take


class Servers:
    """Gives each case the server that it needs: one for all that leave it usable, or its own."""

    def __init__(self, command: str, variants: dict, start_patience: float):
        """start_patience: [s] until a server listens."""
        self._commands = {"": command, **variants}
        self._start_patience = start_patience
        self._shared: dict[tuple, ServerProcess] = {}  # by variant and scene
        self.own: Optional[ServerProcess] = None
        self.keys = Keys()
        self._commands_started: set[str] = set()
        self._vain_starts = 0  # in a row

    def server_for(self, case: Case) -> ServerProcess:
        command = self._commands.get(case.variant)
        if command is None:
            raise NotRun(f"give the server's command for it: --variant {case.variant}=…")
        files = self.keys.files() if case.variant == VARIANT else {}
        if case.fresh:
            self.own = self._start(command, case.scene, files)
            return self.own
        shared = self._shared.get((case.variant, case.scene))
        if shared is None or not shared.runs():
            shared = self._shared[case.variant, case.scene] = self._start(command, case.scene, files)
        return shared

    def _start(self, command: str, scene: str, files: dict) -> ServerProcess:
        """Raises RuntimeError if it never did start, or does not any more; Failed if it may again."""
        try:
            server = ServerProcess(command, path_of(scene), self._start_patience, files)
        except RuntimeError as error:
            self._vain_starts += 1
            if self._vain_starts < _MOST_VAIN_STARTS and command in self._commands_started:
                raise Failed(str(error)) from None
            raise
        self._vain_starts = 0
        self._commands_started.add(command)
        if scene != CROWDED:
            try:
                _await_world(server, self.keys.of("controller") if files else None)
            except (Failed, ValueError):
                pass  # the cases will tell
        return server

    def done(self, case: Case, usable: bool) -> None:
        if self.own is not None:
            self.own.stop()
            self.own = None
        elif not usable and (case.variant, case.scene) in self._shared:
            self._shared.pop((case.variant, case.scene)).stop()

    def stop(self) -> None:
        for server in self._shared.values():
            server.stop()
        self._shared.clear()
        self.keys.close()


def _await_world(server: ServerProcess, keys: Optional[tuple]) -> None:
    """Until a Hello, which is refused, is answered otherwise than by Loading: a server may listen
    before its world is there. One that is mute is what the cases are for."""
    probe = Peer("probe", server.endpoint, "binary", Transcript(), keys, server.runs)
    try:
        probe.send(wire.from_dict(protocol.ClientMessage, {"hello": {"version": {"major": 0}}}))
        probe.hear_behind("loading", _WORLD)
    finally:
        probe.close()


class RunningServer:
    """A server that was started elsewhere, at an endpoint."""

    def __init__(self, endpoint: str):
        check_listens(endpoint)
        self.endpoint = endpoint

    def server_for(self, case: Case) -> "RunningServer":
        if case.fresh or case.variant or case.scene != MAIN:
            raise NotRun("takes a server that the kit starts itself: server -- COMMAND")
        return self

    def runs(self) -> bool:
        return True

    def done(self, case: Case, usable: bool) -> None:
        """A case that ended in its middle may have left the world paused."""
        if usable:
            return
        with Stage(self.endpoint, wire.BINARY, _MENDING) as stage:
            try:
                stage.play((Join("mender", hello(role="ROLE_SUPERVISOR")),
                            Send("mender", {"request": {"id": 1, "resume": {}}}),
                            Hear("mender", "response")))
            except (Failed, Unimplemented):
                pass  # the next case will tell

    def stop(self) -> None:
        pass


def play(cases: list, servers, patience: float, on_outcome: Callable) -> list:
    """Plays all, one after the other; `on_outcome` hears of each when it is over."""
    outcomes = []
    try:
        for case in cases:
            for form in case.forms:
                outcomes.append(_play_patiently(case, form, servers, patience))
                on_outcome(outcomes[-1])
    finally:
        servers.stop()
    return outcomes


def _play_patiently(case: Case, form: str, servers, patience: float) -> Outcome:
    """Cases with deadlines up to three times: a busy machine misses some by itself."""
    tries = _TRIES_WITH_DEADLINES if case.level is Level.HIL else 1
    for _ in range(tries):
        outcome = _play_one(case, form, servers, patience)
        if outcome.verdict is not Verdict.FAIL:
            break
    return outcome


def _play_one(case: Case, form: str, servers, patience: float) -> Outcome:
    name = case.id if form == "binary" else f"{case.id}/{form}"
    outcome = Outcome(name, case.title, case.level, Verdict.PASS)
    server = stage = None

    def play_case() -> None:
        nonlocal server, stage
        server = servers.server_for(case)
        keys = servers.keys if case.variant == VARIANT else None
        with Stage(server.endpoint, form, patience, server, keys) as stage:
            stage.play(case.steps)
            if not case.fresh and not server.runs():
                raise Failed("nothing is wrong with its answers")

    judge(outcome, play_case)
    if outcome.verdict is Verdict.FAIL and stage is not None and not server.runs():
        outcome.reason += f"; the server had ended, and had said:\n{server.last_words()}"
    if stage is not None and outcome.verdict in (Verdict.FAIL, Verdict.NON_STRICT):
        outcome.transcript = stage.transcript.text()
    if outcome.verdict is not Verdict.NOT_RUN:
        servers.done(case, outcome.verdict is Verdict.PASS)
    return outcome


def chosen(cases: list, patterns: list, form: Optional[str] = None,
           level: Optional[str] = None) -> Iterator[Case]:
    """Those whose id fits one of the globs, all if there is none; in this form, or in all; of this level,
    or of all."""
    for case in cases:
        if level not in (None, case.level.value.lower()):
            continue
        if patterns and not any(fnmatchcase(case.id, pattern) for pattern in patterns):
            continue
        forms = tuple(f for f in case.forms if form in (None, f))
        if forms:
            yield replace(case, forms=forms)
