"""All cases for servers, in the order of the document's sections."""

from . import hello, leaving, states, tick, transport

SERVER_CASES = [
    *transport.CASES,
    *hello.CASES,
    *tick.CASES,
    *states.CASES,
    *leaving.CASES,
]
