# SPDX-License-Identifier: MIT
"""Keys of encrypted connections."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from typing import Mapping, Optional

import zmq


_Z85 = re.compile(r"[0-9a-zA-Z.\-:+=^!/*?&<>()\[\]{}@%$#]{40}")


def _check(key: str, what: str) -> None:
    """A secret key is not printed, but the path of a file is."""
    if isinstance(key, str) and _Z85.fullmatch(key):
        return
    if isinstance(key, (str, os.PathLike)) and os.path.exists(key):
        raise ValueError(f"{what} is the path of a file, {str(key)!r}; write the key that is in it, 40 characters")
    raise ValueError(f"{what} is no key of 40 characters of Z85, as 'ziggurat keygen' writes it into a file")


@dataclass(frozen=True)
class Curve:
    """Keys of an encrypted connection, each 40 characters of Z85. Raises ValueError for what is none."""

    server_key: str
    public_key: str
    secret_key: str

    def __post_init__(self) -> None:
        _check(self.server_key, "server_key")
        _check(self.public_key, "public_key")
        _check(self.secret_key, "secret_key")

    @staticmethod
    def from_environment(environment: Mapping[str, str] = os.environ) -> Optional["Curve"]:
        """The keys in ZIGGURAT_SERVER_KEY and in the file that ZIGGURAT_CURVE_SECRET names; None if neither
        is there. Raises ValueError if only one is, or the file has no secret key."""
        server_key = environment.get("ZIGGURAT_SERVER_KEY", "")
        path = environment.get("ZIGGURAT_CURVE_SECRET", "")
        if not server_key and not path:
            return None
        if not server_key or not path:
            raise ValueError("only one of ZIGGURAT_SERVER_KEY and ZIGGURAT_CURVE_SECRET is set; "
                             "an encrypted connection needs both")
        _check(server_key, "ZIGGURAT_SERVER_KEY")
        if _Z85.fullmatch(path) and not os.path.exists(path):
            raise ValueError("ZIGGURAT_CURVE_SECRET is a key; it must be the path of the file with the secret key")
        try:
            with open(path, encoding="ascii") as file:
                secret_key = file.read().strip()
            public_key = zmq.curve_public(secret_key.encode()).decode()
        except (OSError, ValueError, zmq.ZMQError):
            raise ValueError(f"{path!r}: not a file with one secret key and nothing else; create one with "
                             "'ziggurat keygen'") from None
        return Curve(server_key, public_key, secret_key)
