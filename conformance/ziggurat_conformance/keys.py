# SPDX-License-Identifier: MIT
"""Keys of a server under test and of peers that it knows, or does not: the variant "curve"."""

import os
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Optional

import zmq

VARIANT = "curve"
# Variants of cases for clients: what the file with their key is like.
SPACED_FILE = "spaced-file"
WRONG_FILE = "wrong-file"
RESTARTED = "restarted"  # the program finds the token of its session in its environment
PLAIN_SERVER = "plain-server"  # of cases for clients: a server without keys is where one with keys should be

# Peers of a case by name. A peer that is not here has the key of "controller".
ROLES = {
    "controller": "controller",
    "supervisor": "supervisor",
    "observer": "observer",
    "both": "controller,observer",
}
UNLISTED = "unknown"  # its key is not on the list
PLAIN = "plain"  # it has none
MISLED = "misled"  # it has a listed one, and expects another server


@dataclass
class Keys:
    """Drawn anew for each run of the kit."""

    server: tuple = field(default_factory=zmq.curve_keypair)  # public, secret
    _peers: dict = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._peers = {name: zmq.curve_keypair() for name in (*ROLES, UNLISTED)}
        self._folder: Optional[tempfile.TemporaryDirectory] = None

    def of(self, peer: str) -> Optional[tuple]:
        """What a connection needs: the server's public key, its own, its secret one; None: plain."""
        if peer == PLAIN:
            return None
        if peer == MISLED:
            return (zmq.curve_keypair()[0], *self._peers["controller"])
        return (self.server[0], *self._peers.get(peer, self._peers["controller"]))

    def files(self) -> dict:
        """Paths that take the place of {curve_secret} and {curve_clients} in a server's command."""
        fresh = self._folder is None
        if fresh:
            self._folder = tempfile.TemporaryDirectory(prefix="ziggurat-keys-")
        secret = Path(self._folder.name, "server.secret")
        clients = Path(self._folder.name, "clients")
        if fresh:
            with os.fdopen(os.open(secret, os.O_WRONLY | os.O_CREAT, 0o600), "w") as file:
                file.write(self.server[1].decode() + "\n")
            clients.write_text("".join(f"{self._peers[name][0].decode()} {roles} {name}\n"
                                       for name, roles in ROLES.items()))
        return {"curve_secret": str(secret), "curve_clients": str(clients)}

    def client_file(self, variant: str = "") -> str:
        """Path of a file with the secret key of "controller", as a client program gets it."""
        path = Path(self.files()["curve_secret"]).with_name("controller.secret")
        if not path.exists():
            key = self._peers["controller"][1].decode()
            text = {SPACED_FILE: f"\n \t{key} \n\n", WRONG_FILE: f"{key}\n{key}\n"}.get(variant, f"{key}\n")
            with os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT, 0o600), "w") as file:
                file.write(text)
        return str(path)

    def close(self) -> None:
        """Removes the files."""
        if self._folder is not None:
            self._folder.cleanup()
            self._folder = None
