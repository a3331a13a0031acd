# SPDX-License-Identifier: MIT
"""python3 -m ziggurat_conformance"""

import sys

from .cli import main

sys.exit(main())
