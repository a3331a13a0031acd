# SPDX-License-Identifier: MIT
"""What a case's variant puts around a controller program: keys, a socket, an environment."""

from typing import Optional, Union

from .client_socket import PlainGreeter, ServerSocket
from .keys import MISLED, PLAIN_SERVER, RESTARTED, SPACED_FILE, UNLISTED, VARIANT, WRONG_FILE, Keys

TOKEN = b"token of the kit"  # of the session
_PROTECTED = (VARIANT, MISLED, UNLISTED, SPACED_FILE, WRONG_FILE)


def keys_for(variant: str) -> Optional[Keys]:
    return Keys() if variant in (PLAIN_SERVER, *_PROTECTED) else None


def socket_for(variant: str, keys: Optional[Keys]) -> Union[PlainGreeter, ServerSocket]:
    if variant == PLAIN_SERVER:
        return PlainGreeter()
    if keys is not None:
        return ServerSocket(keys.server[1], is_open=variant != UNLISTED)
    return ServerSocket()


def environment_for(variant: str, keys: Optional[Keys], endpoint: str, controller: str) -> dict:
    names = {"ZIGGURAT_ENDPOINT": endpoint, "ZIGGURAT_CONTROLLER": controller}
    if keys is not None:
        server = keys.of(MISLED if variant == MISLED else "controller")[0]
        names["ZIGGURAT_SERVER_KEY"] = server.decode()
        names["ZIGGURAT_CURVE_SECRET"] = keys.client_file(variant)
    if variant == RESTARTED:
        names["ZIGGURAT_SESSION_TOKEN"] = TOKEN.hex()
    return names
