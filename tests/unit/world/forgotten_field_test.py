# SPDX-License-Identifier: MIT
"""A field that is added to a struct, but not to its table, does not compile.

usage: forgotten_field_test.py STRUCT COMPILER SERVER_FOLDER EIGEN_FOLDER...
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

struct, compiler, server, *folders = sys.argv[1:]


def compiles(include):
    command = [compiler, "-std=c++20", "-fsyntax-only", f"{include}/world/complete.cpp", "-I", include,
               "-I", server] + [f"-I{folder}" for folder in folders]
    done = subprocess.run(command, text=True, capture_output=True)
    return done.returncode == 0, done.stderr


with tempfile.TemporaryDirectory() as folder:
    world = pathlib.Path(folder, "world")
    shutil.copytree(pathlib.Path(server, "world"), world)
    works, errors = compiles(folder)
    assert works, errors

    home = next(path for path in world.glob("*.h") if f"struct {struct} {{" in path.read_text())
    head = f"struct {struct} {{"
    home.write_text(home.read_text().replace(head, head + "\n  std::vector<double> forgotten;"))
    works, errors = compiles(folder)
    assert not works, f"a field of {struct} that is in no table compiles"
    assert f"list each field of {struct} once" in errors, errors
