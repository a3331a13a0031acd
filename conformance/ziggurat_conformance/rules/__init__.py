# SPDX-License-Identifier: MIT
"""The rules of docs/protocol.md for single messages and for the order of messages.

Both modes of the kit judge by this code: a client's messages in client mode, a server's in server
mode. No sockets and no clocks."""
