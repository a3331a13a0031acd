# SPDX-License-Identifier: MIT
"""Section 8: keys. The name of a peer chooses its key: keys.py."""

from ..case import Case, Level
from ..keys import MISLED, PLAIN, UNLISTED, VARIANT
from ..messages import answer, hear_refusal, hello, join, observe, send_hello
from ..steps import Frames, Hang, Hear, Join, Send, Silence, Token

_UNANSWERED = 0.5  # [s] in which a server that answers at all would


def _secure(id: str, title: str, *steps) -> Case:
    return Case(id, title, steps, Level.SECURE, variant=VARIANT)


def _comes(peer: str, role: str) -> Join:
    return Join(peer, hello(role=role), {"role": role})


def _says_hello(peer: str, role: str) -> Send:
    return send_hello(peer, role=role)


# A listed controller goes on with all robots, whatever others try.
_GOES_ON = [answer("controller"), observe("controller")]


def _unanswered(id: str, title: str, peer: str) -> Case:
    """Neither its Hello nor anything else is answered, and other sessions go on."""
    return _secure(id, title, join("controller", "*"), *observe("controller"),
                   send_hello(peer, "*", takeover=True), Frames(peer, (b"\xff\xff",)),
                   Silence(peer, _UNANSWERED), _GOES_ON)


CASES = [
    Case("K4.any-role", "Without keys any peer may have any role",
         (_comes("s", "ROLE_SUPERVISOR"), _comes("o", "ROLE_OBSERVER"), Join("p", hello("*"),
          {"role": "ROLE_CONTROLLER"}), *observe("p"), answer("p"), *observe("p")), Level.SECURE),
    _secure("K1.listed", "A session over an encrypted connection goes as any",
            join("controller", "*"), *observe("controller"), _GOES_ON, _GOES_ON),
    _unanswered("K1.plain", "A connection without encryption gets no answer", PLAIN),
    _unanswered("K1.another-server", "A client that expects another server's key gets no answer",
                MISLED),
    _unanswered("K2.unlisted", "A key that is not on the list gets no answer", UNLISTED),
    _secure("K2.roles", "Each role of a key is granted: supervisor, observer",
            _comes("supervisor", "ROLE_SUPERVISOR"), _comes("observer", "ROLE_OBSERVER")),
    _secure("K2.several-roles", "A key with several roles may have each, on a connection of its own",
            _comes("both", "ROLE_OBSERVER"), Hang("both"),
            Join("both", hello("*"), {"role": "ROLE_CONTROLLER"}), *observe("both")),
    *[_secure(f"K3.{key}-as-{wish}", f"A key for {key}s may not be a {wish}",
              _says_hello(key, f"ROLE_{wish.upper()}"), hear_refusal(key, "FORBIDDEN"),
              _comes(key, f"ROLE_{key.upper()}"))
      for key, wish in (("supervisor", "observer"), ("observer", "supervisor"))],
    *[_secure(f"K3.controller-as-{wish}", f"A key for controllers may not be a {wish}",
              _says_hello("controller", f"ROLE_{wish.upper()}"), hear_refusal("controller", "FORBIDDEN"),
              join("controller", "*"), *observe("controller"))
      for wish in ("supervisor", "observer")],
    *[_secure(f"K3.{key}-drives", f"A key for {key}s drives no robots, and takes none over",
              join("controller", "*"), *observe("controller"),
              send_hello(key, "*", takeover=True), hear_refusal(key, "FORBIDDEN"), _GOES_ON)
      for key in ("supervisor", "observer")],
    _secure("K11.stop", "A key for controllers may not end the run by its deadline policy",
            send_hello("controller", "*", deadline_policy={"action": "STOP", "wall_deadline_ms": 60_000}),
            hear_refusal("controller", "FORBIDDEN"), join("controller", "*"), *observe("controller")),
    *[_secure(case, title,
              join("controller", "*"), *observe("controller"), Hang("controller"),
              send_hello(key, "*", session_token=Token("controller")), hear_refusal(key, "FORBIDDEN"),
              Join("controller", hello("*", session_token=Token("controller"))),
              Hear("controller", "observation"))
      for case, key, title in (
          ("K3.token", "observer", "A key for observers does not take up a session whose token it has learnt"),
          ("L12.another-key", "both", "A session goes on only with the key that it was begun with"))],
]
