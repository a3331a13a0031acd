# SPDX-License-Identifier: MIT
"""The server that runs on this machine."""

from __future__ import annotations

import os
import pathlib
import socket
import stat
from typing import List, Mapping


def find_server(environment: Mapping[str, str] = os.environ) -> str:
    """The endpoint in ZIGGURAT_ENDPOINT of this environment, otherwise that of the only server of this user that
    `ziggurat serve` has started on this machine without --endpoint.

    Raises ValueError if there is none, or more than one.
    """
    named = environment.get("ZIGGURAT_ENDPOINT")
    if named:
        return named
    runtime = os.environ.get("XDG_RUNTIME_DIR", "")
    folders = [pathlib.Path(f"/tmp/ziggurat-{os.geteuid()}")]
    if runtime.startswith("/"):
        folders.insert(0, pathlib.Path(runtime, "ziggurat"))
    found: List[str] = []
    for folder in folders:
        if not found and _is_private(folder):
            found = sorted(f"ipc://{path}" for path in folder.iterdir() if _is_alive(path))
    if len(found) == 1:
        return found[0]
    if not found:
        raise ValueError("no server of this user runs here; start one with 'ziggurat serve SCENE', "
                         "or name the endpoint of another, which it prints")
    raise ValueError(f"{len(found)} servers run here; name the endpoint of one: {', '.join(found)}")


def _is_private(folder: pathlib.Path) -> bool:
    """Whether no other user can have put anything there."""
    try:
        status = folder.lstat()
    except OSError:
        return False
    return (stat.S_ISDIR(status.st_mode) and status.st_uid == os.geteuid()
            and status.st_mode & 0o077 == 0)


def _is_alive(path: pathlib.Path) -> bool:
    """Whether a server listens there: a socket's file may be left over."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as probe:
        probe.setblocking(False)
        try:
            probe.connect(str(path))
        except BlockingIOError:
            return True
        except OSError:
            return False
    return True
