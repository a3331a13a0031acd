# SPDX-License-Identifier: MIT
"""The robots of a scene that the user names, as a server describes them, to be played to a client."""

from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path

from . import wire
from .messages import hello
from .peer import Peer, Transcript
from .server_process import ServerProcess
from .wire import protocol

_LOADING = 60.0  # [s] that the scene may take


@dataclass(frozen=True)
class SceneRobots:
    path: Path
    robots: tuple  # RobotDescription, in scene order

    def controller(self, wanted: str) -> str:
        """The one of this id; otherwise that of the first robot without a Lua script, or of the first.
        Raises RuntimeError if the scene does not have it."""
        ids = list(dict.fromkeys(robot.controller for robot in self.robots))
        if wanted and wanted not in ids:
            raise RuntimeError(f"--controller {wanted}: {self.path} has robots of {', '.join(ids)}")
        external = [robot.controller for robot in self.robots if not robot.script]
        return wanted or (external or ids)[0]

    def of(self, controller: str) -> list:
        """All robots of a controller."""
        return [robot for robot in self.robots if robot.controller == controller]

    def chosen_by(self, hello: protocol.Hello) -> list:
        """Robots that fit the criteria of a Hello (H4). Raises LookupError for what is not there."""
        chosen = [robot for robot in self.robots
                  if hello.controller in ("", robot.controller) and (robot.script or not hello.lua_only)]
        ids = {robot.id for robot in self.robots}
        if hello.robots:
            literal = {pattern for pattern in hello.robots if pattern in ids}
            globs = [pattern for pattern in hello.robots if pattern not in ids]
            for pattern in globs:
                if not any(letter in pattern for letter in "*?["):
                    raise LookupError(f"robot {pattern!r}, which {self.path} does not have; its robots are "
                                      f"{', '.join(sorted(ids)[:10])}")
            chosen = [robot for robot in chosen if robot.id in literal
                      or any(fnmatchcase(robot.id, pattern) for pattern in globs)]
        if not chosen:
            raise LookupError(f"robots that {self.path} does not have")
        return chosen


def robots_of(path: Path, command: str, start_patience: float) -> SceneRobots:
    """Starts a server with the scene, as `command` says, and asks it. Raises RuntimeError."""
    if not path.is_file():
        raise RuntimeError(f"--scene {path}: there is no such file")
    server = ServerProcess(command, path.resolve(), start_patience)
    peer = Peer("kit", server.endpoint, wire.BINARY, Transcript())
    try:
        peer.send(wire.from_dict(protocol.ClientMessage, {"hello": hello("*")}))
        message = peer.hear_behind("loading", _LOADING)
        if message is None or not message.HasField("welcome"):
            said = "nothing" if message is None else wire.text_of(message, 300)
            raise RuntimeError(f"--scene {path}: the server said {said} to a Hello for all robots; it had "
                               f"printed:\n{server.last_words()}")
        return SceneRobots(path, tuple(message.welcome.robots))
    finally:
        peer.close()
        server.stop()
