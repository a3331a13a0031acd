#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Finds functions that are too long, and classes with too many data members or friends, in server/.

usage: check_sizes.py [ROOT]     ROOT is the top of the checkout (default: this file's)

A function may have 59 lines, from its name to its last brace. A class may have 30 data members, without static ones
and what is nested in it, and 3 friends; a struct is plain data and may have more. A limit on functions would make
friends of members. Each violation is printed as
file:line: text; the exit code is 1 if there is any.

This is no C++ parser. It removes comments and texts, follows braces, and looks at what stands before
each of them, which is enough for clang-formatted sources.
"""

import dataclasses
import re
import sys

from checkout import named_root

LONGEST_FUNCTION = 59  # lines
MOST_MEMBERS = 30  # data members of a class
MOST_FRIENDS = 3

IGNORED = re.compile(r"""
      //[^\n]*                                       # comments
    | /\*.*?\*/
    | R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)"           # texts
    | "(?:\\.|[^"\\\n])*"
    | (?<![\w'])'(?:\\.|[^'\\\n])+'                  # characters, but not digits' separators
    | ^[ \t]*\#(?:[^\n]*\\\n)*[^\n]*                 # the preprocessor
    """, re.X | re.S | re.M)
CLASS = re.compile(r"\b(?:class|struct|union)\s+(?:\[\[[^]]*\]\]\s*)*([\w:]+)[^()=]*$")
NOT_FUNCTIONS = {"if", "for", "while", "switch", "catch", "do", "else", "try", "return", "requires"}
NAME = re.compile(r"(~?\w+(?:::~?\w+)*|operator\s*\S+?)\s*\((?!\s*\*)")


@dataclasses.dataclass
class Block:
    """What stands between two braces."""
    kind: str  # "class", "function", "namespace" or "other"
    name: str
    line: int  # on which it is introduced, from 1 on
    members: int = 0  # data members of a class
    friends: int = 0
    is_plain: bool = False  # a struct or union


def without_texts(source):
    """The source with every comment, text and directive replaced by spaces; lines stay."""
    return IGNORED.sub(lambda match: re.sub(r"[^\n]", " ", match.group()), source)


def without_templates(text):
    """The text without what stands in angle brackets."""
    for _ in range(8):
        text = re.sub(r"(?<=\w)<[^<>;{}]*>", "", text)
    return text


def function_name(declaration):
    """The name of the function that a declaration or definition introduces, or None."""
    text = re.sub(r"\bdecltype\([^()]*\)", "decltype", without_templates(declaration))
    match = NAME.search(text)
    if not match or "=" in text[:match.start()].replace("==", ""):
        return None
    name = match.group(1)
    before = text[:match.start()].strip()
    if name in NOT_FUNCTIONS or (before and before.split()[0] in NOT_FUNCTIONS):
        return None
    return name


def kind_of(declaration, outer):
    """What a brace begins, by the text before it and the block around it."""
    if outer in ("function", "other"):
        return "other", ""
    if re.search(r"\bnamespace\b[\w:\s]*$", declaration) or re.search(r"\bextern\s*$", declaration):
        return "namespace", ""
    if re.search(r"\benum\b[^()]*$", declaration):
        return "other", ""
    match = CLASS.search(without_templates(declaration))
    if match and not function_name(declaration):
        return "class", match.group(1)
    name = function_name(declaration)
    return ("function", name) if name else ("other", "")


def count(declaration, block):
    """Adds what a declaration of a class declares to its data members or friends."""
    text = without_templates(declaration).strip()
    if re.match(r"friend\b", text):
        block.friends += 1
    elif text and not re.match(r"(using|typedef|static|static_assert|enum|class|struct|union|template)\b", text):
        if not function_name(declaration):
            block.members += 1 + len(re.findall(r",", re.sub(r"[({\[].*?[)}\]]", "", text)))


def measure(source):
    """Yields ("function", line, name, lines) of each function, and ("class", line, name, (members, friends)) of each
    class."""
    text = without_texts(source)
    blocks = [Block("namespace", "", 1)]
    begin = 0  # of the present declaration
    line = 1
    begin_line = 1
    parentheses = 0
    for at, character in enumerate(text):
        if character == "\n":
            line += 1
        if not text[begin:at].strip():
            begin_line = line
        outer = blocks[-1]
        if character in "()":
            parentheses += 1 if character == "(" else -1
        elif character == "{":
            if parentheses > 0 or outer.kind in ("function", "other"):
                blocks.append(Block("other", "", line))
                continue
            declaration = re.sub(r"^\s*(public|private|protected)\s*:", "", text[begin:at])
            kind, name = kind_of(declaration, outer.kind)
            if kind == "other" and ":" in declaration and function_name(declaration):
                kind, name = "function", function_name(declaration)
            is_initialiser = (kind == "function" and re.search(r"[\w>]\s*$", text[begin:at])
                              and re.search(r"\)\s*:[^:]", declaration))
            if is_initialiser:
                kind = "other"  # of a member, before the body of a constructor
            if outer.kind == "class" and re.match(r"\s*friend\b", declaration):
                outer.friends += 1
            is_plain = kind == "class" and not re.search(r"\bclass\b", without_templates(declaration))
            blocks.append(Block(kind, name, begin_line, is_plain=is_plain))
            if kind != "other":
                begin = at + 1
        elif character == "}" and len(blocks) > 1:
            block = blocks.pop()
            if block.kind == "function":
                yield "function", block.line, block.name, line - block.line + 1
            elif block.kind == "class" and not block.is_plain:
                yield "class", block.line, block.name, (block.members, block.friends)
            if block.kind != "other":
                begin = at + 1
        elif character == ";" and parentheses == 0 and outer.kind in ("class", "namespace"):
            declaration = re.sub(r"^\s*(public|private|protected)\s*:", "", text[begin:at])
            if outer.kind == "class":
                count(declaration, outer)
            begin = at + 1


def violations(source):
    """Yields (line, sentence) for one file."""
    for kind, line, name, size in measure(source):
        if kind == "function" and size > LONGEST_FUNCTION:
            yield line, f"{name}() has {size} lines; {LONGEST_FUNCTION} are allowed, divide it"
        if kind == "class":
            for number, most, what in zip(size, (MOST_MEMBERS, MOST_FRIENDS), ("data members", "friends")):
                if number > most:
                    yield line, f"{name} has {number} {what}; {most} are allowed, divide it"


def main():
    root = named_root(__doc__)
    files = sorted(path for path in (root / "server").rglob("*") if path.suffix in {".h", ".cpp"})
    if not files:
        print(f"{root}: there is no server/ here; write the top of the checkout", file=sys.stderr)
        return 1
    found = [f"{path.relative_to(root)}:{line}: {sentence}"
             for path in files for line, sentence in violations(path.read_text())]
    print("\n".join(found) or f"{len(files)} files: no function or class is too large")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
