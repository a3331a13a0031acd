# SPDX-License-Identifier: MIT
# Messages of the protocol, whose classes protobuf makes at run time: docs/protocol.md has their fields.
from typing import Any

def __getattr__(name: str) -> Any: ...
