# SPDX-License-Identifier: MIT
"""Proves servers and clients of the Ziggurat controller protocol right, or shows where they are not.

Written from docs/protocol.md and protocol.proto alone: it shares no code with our server or clients.
"""
