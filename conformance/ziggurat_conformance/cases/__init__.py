# SPDX-License-Identifier: MIT
"""All cases for servers, in the order of the document's sections."""

from . import (deadlines, directing, hello, later_versions, leaving, results, rovers, security, states, supervision, tick,
               transport)

SERVER_CASES = [
    *transport.CASES,
    *hello.CASES,
    *tick.CASES,
    *rovers.CASES,
    *deadlines.CASES,
    *results.CASES,
    *states.CASES,
    *leaving.CASES,
    *security.CASES,
    *supervision.CASES,
    *later_versions.CASES,
    *directing.CASES,
]
