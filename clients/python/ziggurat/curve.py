"""Keys of encrypted connections."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Optional

import zmq


@dataclass(frozen=True)
class Curve:
    """Keys of an encrypted connection, each 40 characters of Z85."""

    server_key: str
    public_key: str
    secret_key: str

    @staticmethod
    def from_environment() -> Optional["Curve"]:
        """The keys in ZIGGURAT_SERVER_KEY and in the file that ZIGGURAT_CURVE_SECRET names; None if neither
        is there. Raises ValueError if only one is, or the file has no secret key."""
        server_key = os.environ.get("ZIGGURAT_SERVER_KEY", "")
        path = os.environ.get("ZIGGURAT_CURVE_SECRET", "")
        if not server_key and not path:
            return None
        if not server_key or not path:
            raise ValueError("only one of ZIGGURAT_SERVER_KEY and ZIGGURAT_CURVE_SECRET is set; "
                             "an encrypted connection needs both")
        try:
            with open(path, encoding="ascii") as file:
                secret_key = file.read().strip()
            return Curve(server_key, zmq.curve_public(secret_key.encode()).decode(), secret_key)
        except (OSError, ValueError, zmq.ZMQError):
            raise ValueError(f"{path!r}: not a file with one secret key and nothing else; create one with "
                             "'ziggurat keygen'") from None
