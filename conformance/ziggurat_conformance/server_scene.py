"""The scene that servers under test load."""

from pathlib import Path

SCENE = Path(__file__).resolve().parent.parent / "scene" / "conformance.argos"
IDLE_SCRIPT = str(SCENE.parent / "idle.lua")
