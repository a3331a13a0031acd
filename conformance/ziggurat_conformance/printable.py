# SPDX-License-Identifier: MIT
"""Texts of programs under test, for terminals and reports."""

import unicodedata

_UNSEEN = ("Cc", "Cf", "Cs", "Zl", "Zp")  # Unicode's categories


def printable(text: str) -> str:
    """Control characters other than line feeds and tabs, and characters that change the order of text or are not seen, as
    numbers: none has an effect on a terminal."""
    return "".join(f"\\u{ord(c):04x}" if unicodedata.category(c) in _UNSEEN and c not in "\n\t" else c for c in text)
