# SPDX-License-Identifier: MIT
"""All cases for clients."""

from . import client_core, client_hil, client_reconnect, client_secure

CLIENT_CASES = [*client_core.CASES, *client_reconnect.CASES, *client_hil.CASES, *client_secure.CASES]
