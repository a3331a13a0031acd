# SPDX-License-Identifier: MIT
"""The scenes that servers under test load."""

from pathlib import Path

_FOLDER = Path(__file__).resolve().parent.parent / "scene"
IDLE_SCRIPT = str(_FOLDER / "idle.lua")


def path_of(scene: str) -> Path:
    """By the name that cases give it."""
    return _FOLDER / f"{scene}.argos"


MAIN = "conformance"
CROWDED = "crowded"  # takes a while to load
SCENE = path_of(MAIN)
