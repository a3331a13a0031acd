# SPDX-License-Identifier: MIT
"""The session token, which is a secret (T10)."""

import base64

from ..wire import protocol


def is_told(token: bytes, text: bytes) -> bool:
    """Whether a text has the token: its bytes, in hexadecimal digits or in base64."""
    in_base64 = (base64.b64encode(token), base64.urlsafe_b64encode(token))
    forms = (token, token.hex().encode(), token.hex().upper().encode(), *(form.rstrip(b"=") for form in in_base64))
    return any(form in text for form in forms)


def is_sent_astray(token: bytes, message: protocol.ClientMessage, data: bytes) -> bool:
    """Whether a message has the token in another place than that of a Hello which resumes a session. data: as it came,
    with what the protocol does not know."""
    others = protocol.ClientMessage()
    others.CopyFrom(message)
    if others.HasField("hello"):
        others.hello.ClearField("session_token")
    if is_told(token, others.SerializeToString()):
        return True
    if data[:1] != b"{":
        return False  # unknown fields are kept
    resumes = message.hello.session_token == token
    in_base64 = (base64.b64encode(token), base64.urlsafe_b64encode(token))
    for form in in_base64 if resumes else ():
        stem = form.rstrip(b"=")
        if stem in data:
            data = data.replace(stem, b"", 1)
            break
    return is_told(token, data)
