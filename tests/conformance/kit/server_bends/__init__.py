# SPDX-License-Identifier: MIT
"""What the bugs of bent_server.py change, a file for each part of the protocol."""

from . import beginning, deadlines, directing, keys, later_versions, states, supervision, tick
from . import several  # last: it has bends of the others under other names
from .keys import relay_of_any_key
from .kinds import OPTIONS, RAW, RAW_SAID, SAID, TOLD
