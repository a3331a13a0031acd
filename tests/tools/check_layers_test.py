#!/usr/bin/env python3
"""tools/check_layers.py finds what it is there to find, and nothing else."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "tools/check_layers.py"

TREE = {
    "protocol/ziggurat/v1/envelope.h": '#include "ziggurat/v1/protocol.pb.h"\n',
    "server/math/pose.h": "#include <Eigen/Core>\n",
    "server/scene/scene.h": '#include "math/pose.h"\n',
    "server/scene/reader.cpp": '#include "scene/scene.h"\n#include <pugixml.hpp>\n',
    "server/world/state.h": '#include "math/pose.h"\n',
    "server/physics/bodies.cpp":
        '#include <BulletDynamics/Dynamics/btRigidBody.h>\n#include "world/state.h"\n',
    "server/simulation/simulation.h": '#include "scene/scene.h"\n',
    "server/network/server.cpp":
        '#include <zmq.hpp>\n#include "ziggurat/v1/protocol.pb.h"\n#include "world/state.h"\n',
    "server/cli/main.cpp": '#include "simulation/simulation.h"\n',
    "clients/cpp/include/ziggurat/session.h": "#include <string>\n",
    "clients/cpp/session.cpp":
        '#include "ziggurat/session.h"\n#include "ziggurat/v1/protocol.pb.h"\n',
    "clients/lua/main.cpp": '#include "ziggurat/session.h"\n#include <lua.hpp>\n',
}


class CheckLayers(unittest.TestCase):
    def run_on(self, added):
        """Exit code and output of the check on TREE and the files of `added`, path to text."""
        with tempfile.TemporaryDirectory() as folder:
            for path, text in {**TREE, **added}.items():
                file = pathlib.Path(folder, path)
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(text)
            done = subprocess.run([sys.executable, SCRIPT, folder], capture_output=True, text=True)
            return done.returncode, done.stdout

    def assert_caught(self, path, text, *words):
        code, out = self.run_on({path: text})
        self.assertEqual(code, 1, out)
        self.assertEqual(len(out.splitlines()), 1, out)
        for word in (path, *words):
            self.assertIn(word, out)

    def assert_allowed(self, path, text):
        code, out = self.run_on({path: text})
        self.assertEqual(code, 0, out)

    def test_accepts_a_tree_in_order(self):
        code, out = self.run_on({})
        self.assertEqual((code, out), (0, f"{len(TREE)} files: every include is allowed\n"))

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

    def test_catches_includes_in_another_form(self):
        self.assert_caught("server/scene/bad.cpp", '#include "scene.h"\n', "module/file.h")
        self.assert_caught("server/scene/bad.cpp", "#include HEADER\n", "HEADER")


if __name__ == "__main__":
    unittest.main()
