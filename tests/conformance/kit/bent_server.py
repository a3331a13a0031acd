# SPDX-License-Identifier: MIT
"""`ziggurat serve` behind a relay that bends what is said: bent_server.py ENDPOINT SCENE BUG [OPTION…]

The relay is a server of its own to its clients: it speaks ZMTP, a connection to the real server for each
of its own, and BUG of server_bends.py changes, adds or drops messages on their way. Without BUG it changes
nothing. The environment's ZIGGURAT is the real program; OPTIONs are those of `ziggurat serve`.
"""

import asyncio
import ctypes
import json
import os
import signal
import subprocess
import sys
import threading

from google.protobuf.message import DecodeError

import protocol_pb2 as protocol
import server_bends as bends

_MORE, _LONG, _COMMAND = 1, 2, 4  # flags of a ZMTP frame
_GREETING = 64  # [bytes]
_PR_SET_PDEATHSIG = 1


class Connection:
    """Of one client."""

    connections = []  # all connections, oldest first

    def __init__(self, bug, to_client, to_server):
        self.bug, self.to_client, self.to_server = bug, to_client, to_server
        self.telling = None  # the task that passes on what the server says
        self.hello = self.welcome = None
        self.tick = -1
        self.notes = {}  # of bugs
        self.connections.append(self)

    def tell(self, **fields):
        """A message to the client that the server did not send."""
        write(self.to_client, protocol.ServerMessage(**fields).SerializeToString())

    def say(self, **fields):
        """A message to the server that the client did not send."""
        write(self.to_server, protocol.ClientMessage(**fields).SerializeToString())

    def said(self, data):
        """What goes to the server instead of a client's message."""
        if self.bug in bends.RAW_SAID:
            return bends.RAW_SAID[self.bug](data)
        return self._bent(data, protocol.ClientMessage, bends.SAID)

    def told(self, data):
        if self.bug in bends.RAW:
            return bends.RAW[self.bug](data)
        return self._bent(data, protocol.ServerMessage, bends.TOLD)

    def _bent(self, data, kind, table):
        """A bend returns None for the message as it changed it, or the messages that take its place."""
        if data[:1] == b"{" or not (self.bug in bends.SAID or self.bug in bends.TOLD):
            return [data]
        try:
            message = kind.FromString(data)
        except DecodeError:
            return [data]
        if kind is protocol.ServerMessage:
            self._remember(message)
        elif message.HasField("hello"):
            self.hello = protocol.Hello.FromString(message.hello.SerializeToString())
        instead = table.get(self.bug, lambda *_: None)(self, message)
        return [m.SerializeToString() for m in ([message] if instead is None else instead)]

    def _remember(self, message):
        if message.HasField("welcome"):
            self.welcome = protocol.Welcome.FromString(message.welcome.SerializeToString())
        if message.HasField("observation"):
            self.tick = message.observation.tick


def write(writer, body, more=False):
    flags = _MORE if more else 0
    if len(body) > 255:
        writer.write(bytes([flags | _LONG]) + len(body).to_bytes(8, "big") + body)
    else:
        writer.write(bytes([flags, len(body)]) + body)


async def pump(reader, writer, bend):
    """Greeting, commands and messages of several frames as they are; other messages bent."""
    try:
        left = _GREETING
        while left and (part := await reader.read(left)):  # in parts: each end waits for the other's first ones (T1)
            writer.write(part)
            left -= len(part)
        is_inside = False  # a message of several frames
        while True:
            flags = (await reader.readexactly(1))[0]
            size = int.from_bytes(await reader.readexactly(8 if flags & _LONG else 1), "big")
            body = await reader.readexactly(size)
            if flags & _COMMAND:
                width = 8 if flags & _LONG else 1
                writer.write(bytes([flags]) + size.to_bytes(width, "big") + body)
            elif flags & _MORE or is_inside:
                is_inside = bool(flags & _MORE)
                write(writer, body, is_inside)
            else:
                for frames in bend(body):
                    parts = frames if isinstance(frames, tuple) else (frames,)
                    for i, part in enumerate(parts):
                        write(writer, part, i + 1 < len(parts))
            await writer.drain()
    except (asyncio.IncompleteReadError, ConnectionError):
        pass
    finally:
        writer.close()


def start(scene, bug, options):
    """The real server; it ends with this process."""
    options = bends.OPTIONS.get(bug, lambda given: given)(options)
    server = subprocess.Popen(
        [os.environ["ZIGGURAT"], "serve", scene, "--endpoint", "tcp://127.0.0.1:*", "--json", *options],
        stdout=subprocess.PIPE, text=True,
        preexec_fn=lambda: ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL))
    return server, json.loads(server.stdout.readline())["endpoint"].removeprefix("tcp://").rsplit(":", 1)


async def main(endpoint, scene, bug="", *options):
    host, port = endpoint.removeprefix("tcp://").rsplit(":", 1)
    if host != "127.0.0.1" and bug != "listens-anywhere":
        sys.exit(f"{endpoint}: others can reach that (T8)")
    server, address = start(scene, bug, list(options))

    async def serve(reader, writer):
        far_reader, far_writer = await asyncio.open_connection(*address)
        connection = Connection(bug, writer, far_writer)
        connection.telling = asyncio.create_task(pump(far_reader, writer, connection.told))
        await asyncio.gather(pump(reader, far_writer, connection.said), connection.telling)
        Connection.connections.remove(connection)

    loop = asyncio.get_running_loop()
    loop.add_signal_handler(signal.SIGINT, lambda: server.send_signal(signal.SIGINT))
    if bug == "any-key":
        threading.Thread(target=bends.relay_of_any_key, args=(endpoint, options[1], address), daemon=True).start()
    else:
        await asyncio.start_server(serve, host, int(port), limit=1 << 20)
    await asyncio.to_thread(server.wait)
    for connection in list(Connection.connections):  # what the server has said last is passed on
        await connection.telling
        await connection.to_client.wait_closed()
    os._exit(server.returncode)


if __name__ == "__main__":
    asyncio.run(main(*sys.argv[1:]))
