# SPDX-License-Identifier: MIT
"""Bends of section 8: keys."""

from pathlib import Path

import zmq

from .kinds import OPTIONS

OPTIONS["plain-text"] = OPTIONS["any-key"] = lambda options: []


def relay_of_any_key(endpoint, secret, address):
    """Encrypts what a server without keys says, and lets no list decide: libzmq takes each key then."""
    context = zmq.Context.instance()
    clients = context.socket(zmq.ROUTER)
    clients.curve_server, clients.curve_secretkey = True, Path(secret).read_bytes().strip()
    clients.bind(endpoint)
    poller = zmq.Poller()
    poller.register(clients, zmq.POLLIN)
    sockets, peers = {}, {}
    while True:
        for socket, _ in poller.poll():
            if socket is not clients:
                clients.send_multipart([peers[socket], socket.recv()])
                continue
            peer, data = clients.recv_multipart()
            if peer not in sockets:
                sockets[peer] = context.socket(zmq.DEALER)
                sockets[peer].connect(f"tcp://{':'.join(address)}")
                peers[sockets[peer]] = peer
                poller.register(sockets[peer], zmq.POLLIN)
            sockets[peer].send(data)


def _all_roles(options):
    """Each listed key may have each role."""
    *options, clients = options  # the last option is --curve-clients
    generous = Path(clients).with_name("generous")
    generous.write_text("".join(f"{key} controller,supervisor,observer {name}\n" for key, _, name in
                                map(str.split, Path(clients).read_text().splitlines())))
    return [*options, str(generous)]


OPTIONS["any-role"] = OPTIONS["grants-stop"] = _all_roles
