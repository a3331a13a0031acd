# SPDX-License-Identifier: MIT
"""What is done with a block of each kind; every function takes a folder and a block, and raises Fault."""

import re
import shlex

from documents import ROOT, SHOWN
from running import HANG, INTERRUPTED, Fault, interrupt

CPP = """#include <ziggurat/ziggurat.h>
#include <ziggurat/director.h>
#include <ziggurat/supervisor.h>
#include <cstdio>
#include <string>
"""
FRAGMENT = CPP + """
void block(ziggurat::Session& session, ziggurat::Robot& robot, ziggurat::Options options, const std::string& token) {
  (void)session, (void)robot, (void)options, (void)token;
  {
%s
  }
}
"""
SERVER = '#include "world/described.h"\n#include "scene/devices.h"\nnamespace ziggurat::devices {\n%s\n}\n'

SLOW = 1200  # [s] of wall time

SCENE = """<argos-configuration>
  %(root)s
  <framework><experiment length="1" ticks_per_second="10" random_seed="1"/></framework>
  <controllers>%(controllers)s</controllers>
  <arena size="10,10,4" center="0,0,2">%(arena)s</arena>
  <physics_engines><dynamics3d id="dyn3d">%(engine)s</dynamics3d></physics_engines>
  <media>%(media)s</media>
</argos-configuration>
"""
BODY = '<box id="some" size="1,1,1" movable="false"><body position="0,0,0"/></box>'
IN_ROOT = ("director", "parameters", "models", "include", "loop_functions")
IN_ARENA = ("distribute", "box", "cylinder", "sphere", "capsule", "prototype", "foot-bot", "e-puck", "kilobot", "light", "floor")
IN_ENGINE = ("gravity", "magnetism")
IN_MEDIA = ("led", "tag", "radio", "directional_led", "range_and_bearing")


def run_block(folder, block):
    if block.kind == "indented":
        raise Fault("an indented block: write it between ```sh and ```, or ```text for what is not run")
    if block.kind not in KINDS:
        raise Fault(f"a block of kind '{block.kind}'; there are {', '.join(KINDS)}")
    if (name := block.value("file")) is not None:
        path = folder.work / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(block.text)
        if path.suffix == ".argos" and "<argos-configuration" in block.text and not block.has("then"):
            folder.run(f"ziggurat check {shlex.quote(name)}")
    elif block.has("part of"):
        check_part(block)
    else:
        KINDS[block.kind](folder, block)
    for command in block.values("then"):
        folder.run(command)


def run_shell(folder, block):
    if block.has("goes on"):
        process = folder.start_beside(block.text)
        code, output = interrupt(process)
        if not output or code not in INTERRUPTED:
            raise Fault(f"exit code {code} after Ctrl-C\n{output}")
        return
    folder.run(block.text, block.exit_codes, SLOW if block.has("slow") else HANG)


def run_console(folder, block):
    """Lines that begin with $ are commands, the others their output."""
    expected = [line for line in block.text.splitlines() if not line.startswith("$ ")]
    output = folder.run("\n".join(block.commands), block.exit_codes)
    lines = [line.strip() for line in output.splitlines()]
    for line in expected:
        if line.strip() not in lines:
            raise Fault(f"the output has no line '{line}':\n{output}")


def run_python(folder, block):
    (folder.work / "block.py").write_text(block.text)
    folder.run("python3 block.py")


def run_lua(folder, block):
    (folder.work / "block.lua").write_text(block.text)
    folder.run("lua5.3 block.lua")


def compile_cpp(folder, block):
    if "world::" in block.text:
        text, options = SERVER % block.text, f"-I{ROOT}/server -I/usr/include/eigen3"
    else:
        text = CPP + block.text if "int main(" in block.text else FRAGMENT % block.text
        options = "$(pkg-config --cflags ziggurat)"
    (folder.work / "block.cpp").write_text(text)
    folder.run(f"c++ -std=c++20 -Wall -fsyntax-only {options} block.cpp")


def robot_of(links):
    """A prototype of these links, each fixed to the first."""
    first, *others = re.findall(r'<link [^>]*id="(\w+)"', links)
    joints = "".join(f'<joint id="{other}_joint" type="fixed"><parent link="{first}" position="0,0,0" orientation="0,0,0"/>'
                     f'<child link="{other}" position="0,0,0" orientation="0,0,0"/></joint>' for other in others)
    return (f'<prototype id="some" movable="true"><body position="0,0,0"/><links ref="{first}">{links}</links>'
            f"<joints>{joints}</joints></prototype>")


def check_xml(folder, block):
    """A whole scene is checked as it is; a part of one in a scene around it."""
    text, root = block.text, re.search(r"<([\w-]+)", block.text)[1]
    parts = dict.fromkeys(("root", "arena", "engine", "media"), "")
    parts["controllers"] = ""
    for name, elements in (("root", IN_ROOT), ("arena", IN_ARENA), ("engine", IN_ENGINE), ("media", IN_MEDIA)):
        if root in elements:
            parts[name] = text
    if root.endswith("_controller"):
        parts["controllers"] = text
    if root == "link":
        parts["arena"] = robot_of(text)
    if root != "argos-configuration":
        if not any(parts.values()):
            raise Fault(f"<{root}> has no place in a scene here; name its file (<!-- file: NAME -->)")
        if not parts["arena"]:
            parts["arena"] = BODY
        text = SCENE % parts
    (folder.work / "block.argos").write_text(text)
    folder.run("ziggurat check block.argos")


def check_diff(folder, block):
    raise Fault("name the file that it changes: <!-- part of: PATH -->")


def stands_in(part, whole):
    """Whether the words of a text stand in another one, in a row."""
    return f" {' '.join(part.split())} " in f" {' '.join(whole.split())} "


def check_part(block):
    text = block.text
    if block.kind == "diff":
        text = "".join(line[1:] + "\n" for line in text.splitlines() if not line.startswith("+"))
    path = block.value("part of")
    if not stands_in(text, (ROOT / path).read_text()):
        raise Fault(f"{path} does not have these lines")


def check_hex(folder, block):
    """A recorded message, explained byte by byte."""
    folder.run(f"python3 {ROOT}/protocol/recorded/explain.py --document {ROOT / block.page}")


def fail_without_file(folder, block):
    raise Fault("name the file that this block is: <!-- file: NAME -->")


def show(folder, block):
    pass


KINDS = {"sh": run_shell, "console": run_console, "python": run_python, "lua": run_lua, "cpp": compile_cpp, "xml": check_xml,
         "diff": check_diff, "hex": check_hex, "toml": fail_without_file, "cmake": fail_without_file, "json": fail_without_file,
         SHOWN: show}
