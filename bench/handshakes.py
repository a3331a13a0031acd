# SPDX-License-Identifier: MIT
"""How long a new client waits for its session at a protected server while others open connections, begin handshakes and hold them.

    PYTHONPATH=build/release/python:tests/scenes/disturbances:bench python3 bench/handshakes.py build/release/bin/ziggurat

One that the server ends is opened anew at once. They say nothing, or a HELLO, the same each time, as played back from the wire. Then
the same beside four Lua controllers, with their ticks per second.
"""

import argparse
import contextlib
import multiprocessing
import os
import pathlib
import select
import socket
import statistics
import subprocess
import tempfile
import time

import zmq
from floods import request, write_scene
from zmtp import free_port
from ziggurat import protocol_pb2 as v1

LONGEST = 30.0  # [s]
HELLO = 64 + 202  # [bytes] of a greeting and a HELLO


def client(endpoint, keys):
    """With a session of an observer."""
    dealer = zmq.Context.instance().socket(zmq.DEALER)
    dealer.linger = 0
    dealer.curve_serverkey, dealer.curve_publickey, dealer.curve_secretkey = keys
    dealer.connect(endpoint)
    dealer.send(v1.ClientMessage(hello=v1.Hello(version=v1.Version(major=1), role=v1.ROLE_OBSERVER)).SerializeToString())
    if not dealer.poll(1000 * LONGEST):
        return None
    dealer.recv()
    return dealer


def waits(endpoint, keys, count):
    """[s] of clients that come one after the other."""
    found = []
    for _ in range(count):
        begun = time.monotonic()
        dealer = client(endpoint, keys)
        found.append(time.monotonic() - begun if dealer else float("inf"))
        if dealer:
            dealer.close()
        time.sleep(0.2)
    return found


def recorded_hello(server_key):
    """What a client with a key of its own says first."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        dealer = zmq.Context.instance().socket(zmq.DEALER)
        dealer.linger = 0
        dealer.curve_serverkey = server_key
        dealer.curve_publickey, dealer.curve_secretkey = zmq.curve_keypair()
        dealer.connect(f"tcp://127.0.0.1:{listener.getsockname()[1]}")
        connection, _ = listener.accept()
        connection.sendall(b"\xff" + bytes(8) + b"\x7f\x03\x01CURVE" + bytes(15) + b"\x01" + bytes(31))
        said = b""
        while len(said) < HELLO:
            said += connection.recv(4096)
        dealer.close()
        return said


def hold(endpoint, said, count):
    """So many connections at a time that say this: one that the server ends is opened anew at once."""
    address = ("127.0.0.1", int(endpoint.rsplit(":", 1)[1]))
    poll, held = select.epoll(), {}

    def begin():
        with contextlib.suppress(OSError):
            connection = socket.socket()
            connection.setblocking(False)
            connection.connect_ex(address)
            held[connection.fileno()] = connection
            poll.register(connection, select.EPOLLIN | (select.EPOLLOUT if said else 0))

    while True:
        while len(held) < count:
            begin()
        for number, event in poll.poll(1):
            connection = held[number]
            try:
                if event & select.EPOLLOUT:
                    connection.send(said)
                    poll.modify(connection, select.EPOLLIN)
                if event & select.EPOLLIN and not connection.recv(4096):
                    raise ConnectionError
                if event & (select.EPOLLHUP | select.EPOLLERR):
                    raise ConnectionError
            except BlockingIOError:
                pass
            except OSError:
                poll.unregister(connection)
                held.pop(number).close()


def ticks(watcher):
    watcher.send(request(1, status=v1.StatusRequest()))
    while True:
        message = v1.ServerMessage.FromString(watcher.recv())
        if message.HasField("response"):
            return message.response.tick


def measure(name, endpoint, keys, watcher, attackers, clients):
    processes = [multiprocessing.Process(target=hold, args=(endpoint, *attacker), daemon=True) for attacker in attackers]
    for process in processes:
        process.start()
    time.sleep(2 if processes else 0)
    first, begun = ticks(watcher), time.monotonic()
    found = waits(endpoint, keys, clients)
    rate = (ticks(watcher) - first) / (time.monotonic() - begun)
    for process in processes:
        process.kill()
        process.join()
    print(f"{name:44} median {statistics.median(found):6.3f} s, most {max(found):6.3f} s; {rate:6.0f} ticks/s", flush=True)
    time.sleep(2)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("ziggurat", type=pathlib.Path)
    parser.add_argument("--clients", type=int, default=10)
    options = parser.parse_args()
    ziggurat = options.ziggurat.resolve()
    server, own = zmq.curve_keypair(), zmq.curve_keypair()
    keys = (server[0], *own)
    said = recorded_hello(server[0])
    with tempfile.TemporaryDirectory() as folder:
        write_scene(folder)
        for name, text in (("secret", server[1]), ("clients", own[0] + b" controller,observer,supervisor me")):
            with os.fdopen(os.open(pathlib.Path(folder, name), os.O_WRONLY | os.O_CREAT, 0o600), "wb") as file:
                file.write(text + b"\n")
        for command in (("serve", "arms.argos", "--ticks", "0", "--paused"),
                        ("run", "arms.argos", "--duration", "0", "--quiet", "--lua-processes", "4")):
            endpoint = f"tcp://127.0.0.1:{free_port()}"
            process = subprocess.Popen([ziggurat, *command, "--endpoint", endpoint, "--curve-secret", "secret",
                                        "--curve-clients", "clients"], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            try:
                watcher = client(endpoint, keys)
                for name, attackers in (("alone", []), ("600 that say nothing", [(b"", 600)]), ("600 with a HELLO", [(said, 600)]),
                                        ("2000 with a HELLO", [(said, 2000)]), ("8000 with a HELLO", [(said, 4000)] * 2)):
                    measure(f"{command[0]}: {name}", endpoint, keys, watcher, attackers, options.clients)
                watcher.close()
            finally:
                process.terminate()
                process.wait()


if __name__ == "__main__":
    main()
