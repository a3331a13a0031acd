#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""tools/check_layers.py finds every violation, and nothing else."""

import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import check_layers

TREE = {
    "protocol/ziggurat/v1/envelope.h": '#include "ziggurat/v1/protocol.pb.h"\n',
    "server/math/pose.h": "#include <Eigen/Core>\n",
    "server/scene/scene.h": '#include "math/pose.h"\n',
    "server/scene/reader.cpp": '#include "scene/scene.h"\n#include <pugixml.hpp>\n',
    "server/world/state.h": '#include "math/pose.h"\n',
    "server/physics/bodies.cpp":
        '#include <BulletDynamics/Dynamics/btRigidBody.h>\n#include "world/state.h"\n',
    "server/simulation/simulation.h": '#include "scene/scene.h"\n',
    "server/network/server.cpp": '#include <zmq.hpp>\n#include "world/state.h"\n',
    "server/cli/main.cpp": '#include "simulation/simulation.h"\n',
    "clients/cpp/include/ziggurat/session.h": "#include <string>\n",
    "clients/cpp/session.cpp":
        '#include "ziggurat/session.h"\n#include "ziggurat/v1/protocol.pb.h"\n',
    "clients/lua/main.cpp": '#include "ziggurat/session.h"\n#include <lua.hpp>\n',
}


class CheckLayers(unittest.TestCase):
    def run_on(self, added, check=check_layers.check):
        """What the check finds in TREE and the files of `added`, path to text."""
        with tempfile.TemporaryDirectory() as folder:
            for path, text in {**TREE, **added}.items():
                file = pathlib.Path(folder, path)
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(text)
            return check(pathlib.Path(folder))

    def assert_caught(self, path, text, *words):
        found = self.run_on({path: text})
        self.assertEqual(len(found), 1, found)
        for word in (path, *words):
            self.assertIn(word, found[0])

    def assert_allowed(self, path, text):
        self.assertEqual(self.run_on({path: text}), [])

    def test_accepts_a_tree_in_order(self):
        self.assertEqual(self.run_on({}), [])

    def test_catches_a_dependency_against_the_arrows(self):
        self.assert_caught("server/math/bad.h", '\n#include "scene/scene.h"\n', ":2:", "nothing")
        self.assert_caught("server/world/bad.h", '#include "scene/scene.h"\n', "world", "scene")

    def test_catches_network_that_knows_the_simulation(self):
        self.assert_caught("server/network/bad.cpp", '#include "simulation/simulation.h"\n')

    def test_catches_an_angled_include_of_ours(self):
        self.assert_caught("server/math/bad.h", "#include <scene/scene.h>\n", "math", "scene")

    def test_catches_libraries_outside_their_module(self):
        self.assert_caught("server/world/bad.cpp", "#include <pugixml.hpp>\n", "pugixml")
        self.assert_caught("server/devices/bad.cpp", "#include <bullet/any.h>\n", "Bullet")
        self.assert_caught("server/scene/bad.cpp", "#  include <LinearMath/btQuad.h>\n", "Bullet")
        self.assert_caught("server/cli/bad.cpp", "#include <google/protobuf/any.h>\n", "protobuf")
        self.assert_caught("server/wire/bad.cpp", "#include <zmq.hpp>\n", "ZeroMQ")
        self.assert_caught("server/wire/bad.cpp", "#include <lua.hpp>\n", "Lua")

    def test_catches_generated_messages_outside_their_modules(self):
        text = '#include "ziggurat/v1/protocol.pb.h"\n'
        self.assert_caught("server/simulation/bad.h", text, "protocol")
        self.assert_caught("clients/lua/bad.cpp", text, "protocol")
        self.assert_allowed("server/wire/good.cpp", text)
        self.assert_caught("server/cli/bad.h", '#include "ziggurat/v1/envelope.h"\n', "protocol")

    def test_catches_a_protocol_that_knows_the_server(self):
        self.assert_caught("protocol/ziggurat/v1/bad.h", '#include "world/state.h"\n', "world")

    def test_catches_a_server_that_knows_a_client_and_a_client_that_knows_the_server(self):
        self.assert_caught("server/network/bad.cpp", '#include "ziggurat/session.h"\n', "clients/cpp")
        self.assert_allowed("server/cli/top.cpp", '#include "ziggurat/session.h"\n')
        self.assert_caught("clients/lua/bad.cpp", '#include "world/state.h"\n', "world")

    def test_catches_modules_that_are_not_in_the_table(self):
        self.assert_caught("server/extra/new.h", "", "'extra'")
        self.assert_caught("server/loose.h", "", "'loose.h'")
        self.assert_caught("clients/rust/new.cpp", "", "'clients/rust'")

    def test_catches_includes_that_cannot_be_resolved(self):
        self.assert_caught("server/scene/bad.cpp", '#include "scene.h"\n', "module/file.h")
        self.assert_caught("server/scene/bad.cpp", "#include HEADER\n", "HEADER")

    def test_catches_entries_that_no_include_uses(self):
        modules = {"scene": ["math"], "world": ["math", "scene"]}
        libraries = {"pugixml": (r"pugixml\.hpp$", ["scene", "world"])}
        found = self.run_on({}, lambda root: check_layers.unused(root, modules, libraries))
        self.assertEqual(found, [
            "tools/check_layers.py: world includes nothing of scene; remove the entry",
            "tools/check_layers.py: world includes nothing of pugixml; remove the entry"])


DOCUMENT = """
| Folder | What it is | Knows |
|---|---|---|
| `server/math/` | numbers | nothing |
| `server/scene/` | scenes | math |
| `clients/cpp/` | a client | scene, math |
| `clients/python/`, `clients/json/` | others | the protocol's document |

| Library | Only in |
|---|---|
| Lua | `clients/cpp/`, `scene/` (which compiles scripts) |

| To add | Go to |
"""
MODULES = {"math": [], "scene": ["math"], "clients/cpp": ["math", "scene"]}
LIBRARIES = {"Lua": ("lua", ["scene", "clients/cpp"])}


class Document(unittest.TestCase):
    def differences(self, document=DOCUMENT, modules=MODULES, libraries=LIBRARIES):
        return list(check_layers.differences(document, modules, libraries))

    def test_accepts_the_same_tables(self):
        self.assertEqual(self.differences(), [])

    def test_catches_a_module_that_only_one_table_has(self):
        self.assertEqual(len(self.differences(modules={**MODULES, "world": []})), 1)
        missing = self.differences(DOCUMENT.replace("server/math/", "server/maths/"))
        self.assertEqual(len(missing), 2, missing)

    def test_catches_another_list(self):
        for text in (DOCUMENT.replace("scene, math", "math"),
                     DOCUMENT.replace("nothing", "scene"),
                     DOCUMENT.replace("`clients/cpp/`, `scene/`", "`scene/`")):
            self.assertEqual(len(self.differences(text)), 1, text)


if __name__ == "__main__":
    unittest.main()
