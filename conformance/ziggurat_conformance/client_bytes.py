# SPDX-License-Identifier: MIT
"""What a client sends: bytes that must be a ClientMessage."""

from . import wire
from .case import Failed
from .rules.client_text import client_text_faults
from .rules.cost import MOST_FIELDS, has_too_many_fields
from .wire import protocol


def form_of(data: bytes) -> str:
    return wire.JSON if data[:1] == b"{" else wire.BINARY


def client_message(data: bytes) -> protocol.ClientMessage:
    """Raises Failed for what a server answers with MALFORMED."""
    form = form_of(data)
    if has_too_many_fields(data):
        raise Failed(f"the client sent a message of more than {MOST_FIELDS} fields (K5)")
    if form == wire.JSON and (faults := list(client_text_faults(data))):
        raise Failed(f"the client sent JSON that a server refuses: {'; '.join(faults[:5])} (T6)")
    try:
        return wire.decode(protocol.ClientMessage, data, form)
    except ValueError as error:
        if form == wire.BINARY and data.lstrip(b" \t\r\n\xef\xbb\xbf")[:1] == b"{":
            raise Failed("the client sent JSON that does not begin with `{`: nothing may stand before it (T6)") from None
        raise Failed(f"the client sent {error} ({'T6' if form == wire.JSON else 'T2, T5'})") from None
