#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""docs/scene-reference.md is whole: it has each attribute that the reader's sources ask for, and each of our scenes.
docs/scene-format.md, which says what they mean, names each of them, too.

usage: scene_reference_test.py ROOT

The test `reference` compares the page with the program; this one finds what the program does not know of itself.
"""

import pathlib
import re
import sys
import xml.etree.ElementTree as ElementTree

OWN = {"params", "parameters"}  # elements whose attributes have any name
OLD = {"principle_point"}  # words of other versions, which are notices


def on_page(page):
    """{element: its attributes in any of its places}, and all attributes."""
    elements, names = {}, []
    for line in page.splitlines():
        if line.startswith("## "):
            names = re.findall(r"<([\w-]+)>", line)
        match = re.match(r"\| `([\w-]+)` \|", line)
        for name in names:
            elements.setdefault(name, set()).update([match[1]] if match else [])
    return elements, set().union(*elements.values())


def asked_by_sources(root):
    """(file, attribute) of each attribute that a reader names."""
    for path in sorted((root / "server/scene").rglob("*.cpp")):
        for name in re.findall(r'\b(?:optional|required|needed)\(\s*(?:\w+,\s*)?"([\w-]+)"', path.read_text()):
            yield path, name


def in_scenes(root):
    """(file, element, attribute) of our scenes."""
    for path in sorted((root / "scenes").rglob("*.argos")):
        for element in ElementTree.parse(path).iter():
            for name in element.attrib if element.tag not in OWN else ():
                yield path, element.tag, name


def not_explained(attributes, text):
    """Attributes that a text does not name; one of a wheel is named with both, as in bias_avg_left."""
    words = set(re.findall(r"[\w-]+", text))
    return sorted(name for name in attributes if not {name, re.sub("_(left|right)$", "", name)} & words)


def main(root):
    elements, attributes = on_page((root / "docs/scene-reference.md").read_text())
    missing = [f"{path}: {name} is asked for, and not on the page" for path, name in asked_by_sources(root)
               if name not in attributes]
    missing += [f"{path}: {name} of <{element}> is not on the page" for path, element, name in in_scenes(root)
                if name not in elements.get(element, ()) and name not in OLD]
    missing += [f"docs/scene-format.md does not name the attribute {name}"
                for name in not_explained(attributes, (root / "docs/scene-format.md").read_text())]
    assert len(elements) > 60 and len(attributes) > 100, "the page could not be read"
    print("\n".join(dict.fromkeys(missing)) or f"{len(elements)} elements, {len(attributes)} attributes")
    return bool(missing)


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
