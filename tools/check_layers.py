#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compares every #include in server/, clients/ and protocol/ with the table of allowed dependencies.

usage: check_layers.py [ROOT]     ROOT is the top of the checkout (default: this file's)

Each violation is printed as file:line: text; the exit code is 1 if there is any. Violations are also
a module that is not in the table, an entry of the table that no include uses, and a difference between
this table and the one in docs/architecture.md. A new module is added to both first.
"""

import re
import sys

from checkout import named_root

# module -> modules whose headers it may include, besides its own.
MODULES = {
    "protocol": [],
    "posix": [],
    "text": [],
    "math": [],
    "timing": [],
    "http": ["text"],
    "images": [],
    "scene": ["images", "text", "math"],
    "world": ["images", "math"],
    "magnetism": ["math"],
    "physics/multibody": ["math"],
    "physics/solver": ["physics/multibody"],
    "physics/stepping": ["physics/multibody", "physics/solver", "timing", "math"],
    "physics/bodies": ["physics/multibody", "physics/stepping", "scene", "math"],
    "physics/collision": ["physics/multibody", "physics/solver", "physics/stepping", "physics/bodies", "scene", "world"],
    "physics": ["physics/multibody", "physics/stepping", "physics/bodies", "physics/collision", "scene", "world", "magnetism",
                "timing", "math"],
    "media": ["world", "math"],
    "camera": ["world", "media", "math"],
    "render": ["camera", "scene", "world", "images", "math"],
    "devices": ["scene", "world", "images", "physics", "physics/collision", "media", "camera", "render", "math"],
    "simulation": ["scene", "world", "physics", "physics/bodies", "physics/collision", "media", "devices", "timing", "math"],
    "wire": ["scene", "world", "protocol"],
    "outputs": ["posix", "text", "world", "protocol", "math"],
    "channels": ["scene", "world", "images", "wire", "outputs", "render", "magnetism", "protocol", "timing", "math"],
    "network": ["posix", "scene", "world", "wire", "protocol", "math"],
    "view": ["posix", "http", "channels", "wire", "text", "math"],
    "reports": ["http", "text", "scene", "wire", "network", "timing", "math"],
    "processes": ["scene", "world", "outputs", "text"],
    "supervision": ["reports", "processes", "network", "simulation", "wire", "scene", "timing", "math"],
    "recording": ["world", "protocol"],
    "recording/mcap": ["posix"],
    "recording/recorder": ["recording", "recording/mcap", "channels", "outputs", "world", "protocol", "math"],
    "recording/replay": ["recording", "recording/mcap", "outputs", "simulation", "scene", "world", "protocol", "timing", "math"],
    "run": ["supervision", "recording/recorder", "recording/mcap", "view", "channels", "reports", "processes",
            "network", "outputs", "simulation", "render", "scene", "world", "timing", "math", "text"],
    "rerun": ["run", "supervision", "recording/mcap", "recording/replay", "channels", "reports", "processes", "network", "outputs",
              "scene", "world", "timing", "math", "text"],
    "sweep": ["reports", "processes", "scene", "text", "math"],
    "gallery": ["http", "processes", "text", "math"],
    "cli": ["gallery", "view", "http", "sweep", "rerun", "run", "recording/replay", "recording/recorder", "recording/mcap", "outputs", "reports", "processes", "network",
            "simulation", "physics", "magnetism", "scene", "text", "clients/cpp"],
    "clients/cpp": ["protocol", "text"],
    "clients/lua": ["text", "clients/cpp"],
    "clients/templates": ["clients/cpp"],
}

# library -> (pattern of its headers, modules that may include them). Libraries that are not here,
# such as Eigen and fmt, are free.
LIBRARIES = {
    "pugixml": (r"pugixml\.hpp$|pugiconfig\.hpp$", ["scene"]),
    "Qhull": (r"libqhull_r/", ["scene"]),
    "tinyobjloader": (r"tiny_obj_loader\.h$", ["scene"]),
    "Bullet": (r"bullet/|bt[A-Z]\w*\.h$|Bullet\w*/|LinearMath/", ["physics/bodies", "physics/collision", "physics"]),
    "protobuf": (r"google/protobuf/", ["protocol", "wire", "outputs", "channels", "recording", "recording/replay"]),
    "ZeroMQ": (r"zmq(_addon)?\.hp?p?$", ["network", "clients/cpp"]),
    "libsodium": (r"sodium\.h$", ["network"]),
    "SQLite": (r"sqlite3\.h$", ["sweep"]),
    "toml++": (r"toml\+\+/", ["cli", "sweep"]),
    "libpng": (r"png\.h$", ["outputs", "images"]),
    "libzstd": (r"zstd\.h$", ["recording/mcap"]),
    "liblz4": (r"lz4\w*\.h$", ["recording/mcap"]),
    "zlib": (r"zlib\.h$", ["recording/mcap"]),
    "Boost.Beast": (r"boost/(beast|asio)", ["http", "view"]),
    "Lua": (r"(lua5\.3/)?(lua|lauxlib|lualib|luaconf)\.hp?p?$", ["clients/lua", "processes", "clients/cpp"]),
}

SUFFIXES = {".h", ".hpp", ".hh", ".inl", ".ipp", ".c", ".cc", ".cpp", ".cxx"}
INCLUDE = re.compile(r'^\s*#\s*include\s*(<[^>]*>|"[^"]*"|\S+)')


def module_of(path):
    """The module that a file belongs to; path is relative to the root."""
    if path.parts[0] == "protocol":
        return "protocol"
    if path.parts[0] == "server":
        part = "/".join(path.parts[1:3])
        return part if part in MODULES else path.parts[1]
    return "/".join(path.parts[:2])


def target_of(header, root, including):
    """The module that provides a header of ours, or None for a header from elsewhere."""
    if header.endswith(".pb.h"):
        return "protocol"
    servers = [root / "server", root / "protocol"]
    clients = [root / "clients/cpp/include", root / "clients/cpp/source", root / "clients/lua"]
    if root / "clients" in including.parents:  # whose folders may be called as the server's
        bases = [including.parent, *clients, *servers]
    else:
        bases = [*servers, *clients]
    for base in bases:
        found = base / header
        if found.is_file():
            return module_of(found.resolve().relative_to(root))
    return None


def violations_of_include(header, quoted, module, root, including):
    """What is wrong with one include, as sentences."""
    target = target_of(header, root, including)
    if target is None and quoted:
        yield f'"{header}" is not found; headers of this project are included as "module/file.h"'
    elif target is not None and target != module and target not in MODULES[module]:
        allowed = ", ".join(MODULES[module]) or "nothing"
        yield f"{module} includes {header} of {target}; it may know: {allowed}"
    for library, (pattern, allowed) in LIBRARIES.items():
        if target is None and re.match(pattern, header) and module not in allowed:
            yield f"{module} includes {header}; {library} belongs to: {', '.join(allowed)}"


def violations_of_file(path, root):
    """Yields (line number, sentence) for one source file."""
    module = module_of(path.relative_to(root))
    if module not in MODULES:
        yield 1, f"module '{module}' is not in the table of tools/check_layers.py"
        return
    for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        header = match.group(1)
        if header[0] not in '<"':
            yield number, f"include of the macro {header}: write the name of the header"
            continue
        for sentence in violations_of_include(header[1:-1], header[0] == '"', module, root, path):
            yield number, sentence


def sources(root):
    """All C and C++ files that belong to a module, in a fixed order."""
    for top in ["server", "clients", "protocol"]:
        for path in sorted((root / top).rglob("*")):
            if path.suffix in SUFFIXES and path.is_file() and "node_modules" not in path.parts:
                yield path


def check(root):
    """All includes under root that are not allowed, as file:line: text."""
    root = root
    return [f"{path.relative_to(root)}:{number}: {sentence}"
            for path in sources(root) for number, sentence in violations_of_file(path, root)]


def unused(root, modules, libraries):
    """The entries of both tables that no include uses, as sentences."""
    root = root
    used = set()
    for path in sources(root):
        module = module_of(path.relative_to(root))
        for match in filter(None, map(INCLUDE.match, path.read_text(errors="replace").splitlines())):
            header = match.group(1)[1:-1]
            target = target_of(header, root, path)
            used.add((module, target))
            used |= {(module, library) for library, (pattern, _) in libraries.items()
                     if target is None and re.match(pattern, header)}
    entries = [(module, target) for module, targets in modules.items() for target in targets]
    entries += [(module, library) for library, (_, users) in libraries.items() for module in users]
    return [f"tools/check_layers.py: {module} includes nothing of {target}; remove the entry"
            for module, target in entries if (module, target) not in used]


def rows(text, heading):
    """The cells of the Markdown table that begins with this heading."""
    table = text.partition(heading)[2].partition("\n\n")[0]
    for line in table.splitlines()[2:]:
        yield [cell.strip() for cell in line.strip("|").split("|")]


def named_folders(cell):
    """The modules that a cell names, as `server/run/`, `run/` or `clients/cpp/`."""
    return [name.removeprefix("server/") for name in re.findall(r"`([\w/]+?)/?`", cell)]


def differences(document, modules, libraries):
    """Where the tables of docs/architecture.md say something else, as sentences."""
    told = {}
    for folder, _, knows in rows(document, "| Folder |"):
        names = [] if knows == "nothing" else knows.split(", ")
        told |= {module: names for module in named_folders(folder)}
    for module in sorted(modules.keys() | told.keys()):
        here, there = modules.get(module), told.get(module)
        if here is None and there is not None and not module.startswith("clients/"):
            yield f"docs/architecture.md: module '{module}' is not in tools/check_layers.py"
        elif here is not None and there is None:
            yield f"docs/architecture.md: module '{module}' is missing"
        elif here is not None and set(here) != set(there):
            yield (f"docs/architecture.md: {module} knows {', '.join(sorted(there)) or 'nothing'}; "
                   f"tools/check_layers.py has {', '.join(sorted(here)) or 'nothing'}")
    told = {library: named_folders(only) for library, only in rows(document, "| Library |")}
    for library, (_, here) in libraries.items():
        if set(told.get(library, [])) != set(here):
            yield (f"docs/architecture.md: {library} is in {', '.join(told.get(library, []))}; "
                   f"tools/check_layers.py has {', '.join(here)}")


def main():
    root = named_root(__doc__)
    if not (root / "server").is_dir():
        print(f"{root}: there is no server/ here; write the top of the checkout", file=sys.stderr)
        return 1
    document = (root / "docs/architecture.md").read_text()
    found = [*check(root), *unused(root, MODULES, LIBRARIES), *differences(document, MODULES, LIBRARIES)]
    print("\n".join(found) or f"{sum(1 for _ in sources(root))} files: every include is allowed")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
