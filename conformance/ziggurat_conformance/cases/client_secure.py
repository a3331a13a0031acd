# SPDX-License-Identifier: MIT
"""Secure: a client that is told keys uses them, and nothing else (K1, L12, T10)."""

from ..case import Case, Level
from ..client_messages import BEGUN, LEFT, end, ticks, welcome
from ..client_steps import CheckClient, Cut, Ends, HearFrom, HearResume, Listen, Mechanisms, Quiet, Restart
from ..keys import MISLED, PLAIN_SERVER, SPACED_FILE, UNLISTED, VARIANT, WRONG_FILE


def _case(id: str, title: str, variant: str, *steps) -> Case:
    return Case(id, title, steps, Level.SECURE, variant=variant)


def _own_key(stage) -> str:
    expected = stage.keys.of("controller")[1].decode()
    return "" if stage.key == expected else f"it connects with the key {stage.key!r}; {expected!r} is its own"


CASES = [
    _case("K1.session", "A session over an encrypted connection is like any",
          VARIANT, *BEGUN, *ticks(1, 5), end(5), LEFT, Ends(good=True, should=True)),
    _case("K2.own-key", "It connects with the key in the file of ZIGGURAT_CURVE_SECRET",
          VARIANT, *BEGUN, CheckClient("key", _own_key)),
    _case("K1.another-server", "A server with another key than ZIGGURAT_SERVER_KEY is told nothing",
          MISLED, Quiet(2.0)),
    _case("K1.no-fallback", "A server without keys is told nothing, in no way", PLAIN_SERVER, Mechanisms()),
    *[_case(f"K9.{name}", f"It ends, with another exit code than 0, when {title}", variant,
            Quiet(0.5), Ends(good=False, should=True, within=20.0))
      for name, title, variant in (("refused-key", "its key is refused", UNLISTED),
                                   ("another-server", "the server has another key", MISLED))],
    _case("K6.white-space", "White space around the key in its file is skipped", SPACED_FILE,
          HearFrom("hello", should=True), CheckClient("key", _own_key)),
    _case("K6.other-file", "A file that has more than one key is refused", WRONG_FILE,
          Quiet(1.0, should=True), Ends(good=False, should=True, within=20.0)),
    _case("K7.one-file", "Its public key follows from the secret one: it needs no other file", VARIANT,
          *BEGUN, CheckClient("key", _own_key)),
    _case("K8.late-server", "It waits while no server listens yet: its keys are not refused", VARIANT,
          Restart(), Quiet(4.0), Listen(), HearFrom("hello", should=True), CheckClient("key", _own_key)),
    _case("L12.same-key", "It resumes its session with the key that it began it with",
          VARIANT, *BEGUN, *ticks(1, 2), Cut(), HearResume(), welcome(), *ticks(2, 4)),
]
