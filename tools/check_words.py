#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Finds words that make our texts hard to read for people in a hurry.

usage: check_words.py [ROOT]     ROOT is the top of the checkout (default: this file's)

Texts and identifiers here are plain technical English: short active sentences with the field's
standard words. WORDS lists what came up again and again in their place, with what to write instead.
Each use is printed as file:line: text; the exit code is 1 if there is any. Recorded messages, the
licence and results of benchmarks are left out.

Comments of the C++ sources below COMMENTED begin with the field's noun, or with a verb. No
sentence of theirs has more than 25 words; text in parentheses does not count, and a blank line ends a sentence.
In a document none has more than 30; code counts as one word, a list of it too, and a cell of a table is text of its own.
"""

import os
import pathlib
import re
import sys

from checkout import named_root

# pattern -> what to write instead. Patterns match whole words, also between the underscores of a name;
# case counts where they have capitals.
WORDS = {
    r"(?<!\")[Nn]obody": "no client, no session, no one; better: make the thing itself the subject",
    r"[Ww]ho(m?)ever": "the client that …, each peer that …",
    r"([Aa]ny|[Ee]very)body|[Ee]veryone|[Ss]omeone": "any program, all peers, each client, a user",
    r"[Hh]e|[Hh]im|[Hh]is": "the client, its …",
    r"that there (is|are)": "the … of, the existing …",
    r"for ever": "forever, without end",
    r"of somebody else": "of another client",
    r"([Ii]s|[Aa]re|[Ww]as|[Ww]ere)[ _]due": "must be, is expected",
    r"(comes?|came|coming) about": "happens, is created",
    r"[Ss]trangers?": "a peer without a session, an unknown peer",
    r"[Ff]urnish\w*": "fill, provide",
    r"[Ee]mploy\w*": "use",
    r"say_[a-z_]+": "send_… or handle_…",
    r"[Ss]urroundings": "settings, environment",
    r"Lack|Fate|Room|Laps": "a name that says what it holds: missing part, decision, budget, timings",
}
PATTERN = re.compile("(?<![A-Za-z0-9-])(?:" + "|".join(f"(?P<w{i}>{word})" for i, word in enumerate(WORDS))
                     + ")(?![A-Za-z0-9-])")

COMMENTED = ("clients/", "protocol/", "server/", "tests/")
LONGEST_SENTENCE = 25  # words
LONGEST_OF_DOCUMENTS = 30
COMMENT = re.compile(r"(?P<code>.*?)//[/!]?<?(?P<text> .*)?$")
VAGUE = re.compile(r"\W*(What|Of|Those|That|How|Where|Whose)\b")
END = re.compile(r"(?<=[.;:?])\s+|\s{2,}|\s@\w+\s+|\s- ")  # of a sentence

TOPS = ["README.md", "CONTRIBUTING.md", "SECURITY.md", "quickstart", "CMakeLists.txt", "bench", "clients", "cmake", "conformance",
        "docker", "docs", "protocol", "scenes", "server", "tests", "tools"]
SUFFIXES = {".h", ".cpp", ".py", ".lua", ".md", ".proto", ".argos", ".cmake", ".txt", ".sh", ""}
GENERATED = {"server/render/tag36h11.cpp"}  # with a licence
LEFT_OUT = ("protocol/recorded/", "bench/results/", "tools/packaging/debian/copyright", "tools/check_words.py", "tests/tools/check_words_test.py")


def texts(root):
    """(name, content) of all texts of ours below root, in a fixed order."""
    for top in TOPS:
        start = root / top
        walked = os.walk(start) if start.is_dir() else [(root, [], [top] if start.is_file() else [])]
        for folder, folders, names in walked:
            folders[:] = sorted(set(folders) - {"node_modules"})
            for path in sorted(pathlib.Path(folder, name) for name in names):
                name = path.relative_to(root).as_posix()
                if path.suffix not in SUFFIXES or name.startswith(LEFT_OUT):
                    continue
                try:
                    yield name, path.read_text(encoding="utf-8")
                except UnicodeDecodeError:
                    continue


def check_text(name, text):
    """All uses in a text, as file:line: text."""
    found = []
    for match in PATTERN.finditer(text):
        instead = list(WORDS.values())[int(match.lastgroup[1:])]
        found.append(f"{name}:{text.count(chr(10), 0, match.start()) + 1}: '{match.group()}'; "
                     f"write instead: {instead}")
    return found


def comments(lines):
    """Yields (line number, text) of each comment; lines of comments that follow each other are one."""
    number, text, code = 0, [], ""
    for at, line in enumerate([*lines, ""], 1):
        match = COMMENT.fullmatch(line) if "//" in line else None
        continues = match and text and not match["code"].strip() and not code
        if not continues and text:
            yield number, " ".join(text)
            text = []
        if match and match["code"].count('"') % 2 == 0:
            number, code = (number if continues else at), match["code"].strip()
            text.append((match["text"] or "").strip())


def check_comments(name, text):
    """All comments of a text that begin vaguely or have a long sentence, as file:line: text."""
    found = []
    if not name.endswith((".h", ".cpp")) or not name.startswith(COMMENTED) or name in GENERATED:
        return found
    for number, comment in comments(text.splitlines()):
        if match := VAGUE.match(comment):
            found.append(f"{name}:{number}: '{match[1]} …'; begin the comment with the field's noun, or with a verb")
        longest = max(END.split(re.sub(r"\([^()]*\)", "", " " + comment)), key=lambda sentence: len(sentence.split()))
        if len(longest.split()) > LONGEST_SENTENCE:
            found.append(f"{name}:{number}: a sentence of {len(longest.split())} words; write at most "
                         f"{LONGEST_SENTENCE}: '{longest.strip()[:60]} …'")
    return found


def paragraphs(text):
    """Yields (line number, text) of each paragraph, item and cell of a document; blocks of code are left out."""
    number, words, is_code = 0, [], False
    for at, line in enumerate([*text.splitlines(), ""], 1):
        is_fence = line.lstrip().startswith("```")
        is_code ^= is_fence
        begins = not line.strip() or is_fence or re.match(r"\s*([-*|#]|\d+\.|<!--)", line)
        if begins and words:
            yield number, " ".join(words)
            words = []
        if line.startswith("|"):
            yield from ((at, cell) for cell in re.split(r"(?<!\\)\|", line))
        elif line.strip() and not is_code and not is_fence and not line.lstrip().startswith("<!--"):
            number = number if words else at
            words.append(line.strip())


def check_sentences(name, text):
    """All long sentences of a document, as file:line: text."""
    if not name.endswith(".md"):
        return []
    found = []
    for number, paragraph in paragraphs(text):
        plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", re.sub(r"`[^`]*`", "code", paragraph))
        plain = re.sub(r"code(, code)+", "code", plain)
        for sentence in END.split(re.sub(r"\([^()]*\)", "", plain)):
            if len(sentence.split()) > LONGEST_OF_DOCUMENTS:
                found.append(f"{name}:{number}: a sentence of {len(sentence.split())} words; write at most "
                             f"{LONGEST_OF_DOCUMENTS}: '{sentence.strip()[:60]} …'")
    return found


def main():
    all_texts = list(texts(named_root(__doc__)))
    found = [fault for name, text in all_texts for fault in check_text(name, text) + check_comments(name, text)
             + check_sentences(name, text)]
    print("\n".join(found) or f"{len(all_texts)} texts: no word of the list")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
