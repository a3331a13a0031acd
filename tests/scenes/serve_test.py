# SPDX-License-Identifier: MIT
"""`ziggurat serve`: controllers connect from outside, and so do unknown peers."""

import json
import pathlib
import socket
import subprocess

import zmq
from harness import FINISHED, INTERRUPTED, LUA, ZIGGURAT, SceneTest, main


class Serve(SceneTest):
    def serve(self, *arguments):
        """The process and its endpoint."""
        process = self.start("serve", self.scene, "--json", "--endpoint", "tcp://127.0.0.1:*",
                             *arguments)
        return process, json.loads(process.stdout.readline())["endpoint"]

    def connect(self, endpoint, *robots):
        """A Lua process for these robots; for all if none is given."""
        arguments = [str(LUA), "--connect", endpoint, "--quiet"]
        if robots:
            arguments += ["--robots-file", str(self.write("-".join(robots), "\n".join(robots)))]
        client = subprocess.Popen(arguments, cwd=self.folder, stdin=subprocess.DEVNULL,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.started.append(client)
        return client

    def test_waits_for_controllers_then_runs_to_the_end(self):
        expected = self.hash_of("--ticks", 20)
        process, endpoint = self.serve("--hash")
        self.assertRegex(endpoint, r"^tcp://127\.0\.0\.1:[1-9]\d*$")
        client = self.connect(endpoint)
        outcome = self.finish(process)
        self.assertEqual(outcome.code, FINISHED, outcome.err)
        self.assertEqual(outcome.lines[-1], expected)
        self.assertIn("[20 r2] step 20", outcome.lines)
        client.wait(timeout=60)

    def test_without_endpoint_it_listens_for_its_user_and_is_found(self):  # T11
        process = self.start("serve", self.scene, "--json")
        endpoint = json.loads(process.stdout.readline())["endpoint"]
        self.assertTrue(endpoint.startswith(f"ipc://{self.runtime}/ziggurat/"), endpoint)
        folder = pathlib.Path(endpoint.removeprefix("ipc://")).parent
        self.assertEqual(folder.stat().st_mode & 0o777, 0o700)
        outcome = self.finish(self.start("ctl", "status"))
        self.assertEqual(outcome.code, FINISHED, outcome.err)
        self.interrupt(process)
        self.assertEqual(self.finish(process).code, INTERRUPTED)

    def test_reports_the_robots_it_waits_for(self):
        process, endpoint = self.serve()
        self.read_until(process.stderr, r"waiting for robots r0, r1, r2")
        self.connect(endpoint, "r0", "r2")
        self.read_until(process.stderr, r"waiting for robot r1 ")
        self.connect(endpoint, "r1")
        self.assertEqual(self.finish(process).code, FINISHED)

    def test_a_killed_controller_can_be_replaced(self):
        process, endpoint = self.serve("--duration", 0, "--real-time", 4)
        self.read_until(process.stderr, r"waiting for robots r0, r1, r2")
        first = self.connect(endpoint)
        self.read_until(process.stdout, r"^\[5 r2\]")
        first.kill()
        self.read_until(process.stderr, r"waiting for robots r0, r1, r2")
        self.connect(endpoint)
        self.read_until(process.stdout, r"^\[\d+ r2\] step 3")  # a new process counts from 1
        self.interrupt(process)
        self.assertEqual(self.finish(process).code, INTERRUPTED)

    def test_names_addresses_that_can_be_called(self):
        """All addresses of a machine have a name to listen at, and none to call."""
        process = self.start("serve", self.scene, "--duration", 0, "--endpoint", "tcp://0.0.0.0:*",
                             "--view=0.0.0.0:0", "--insecure")
        port = self.read_until(process.stdout, r"^endpoint tcp://0\.0\.0\.0:(\d+)$")[1]
        self.read_until(process.stderr, f"connect with: ziggurat-lua --connect tcp://127.0.0.1:{port}")
        self.read_until(process.stderr, "from other machines: this machine's name in place of 127.0.0.1")
        self.read_until(process.stderr, r"watch this run at http://127\.0\.0\.1:\d+/\?token=")
        self.interrupt(process)
        self.finish(process)

    def test_listens_where_only_this_user_can_connect(self):
        def ctl(*words):
            return subprocess.run([str(ZIGGURAT), "ctl", *words], env=self.environment, text=True,
                                  capture_output=True, timeout=60)

        self.assertIn("no server of this user runs here", ctl("status").stderr)
        folder = self.runtime / "ziggurat"
        folder.mkdir(mode=0o700)
        (folder / "dead-4194999").touch()  # no socket: it stays
        process = self.start("serve", self.scene, "--duration", 0)
        endpoint = self.read_until(process.stdout, "^endpoint (ipc://.*)$")[1]
        self.read_until(process.stderr, f"connect with: ziggurat-lua --connect {endpoint}")
        path = pathlib.Path(endpoint.removeprefix("ipc://"))
        self.assertEqual((path.parent, path.name), (folder, f"arms-{process.pid}"))
        self.assertEqual(folder.stat().st_mode & 0o777, 0o700)
        self.assertIn("arms.argos", ctl("status").stdout)
        found = subprocess.run([str(LUA), "--quiet", "--robot", "none"], env=self.environment, text=True,
                               capture_output=True, timeout=60)
        self.assertIn("UNKNOWN_ROBOT", found.stderr)
        other = self.start("serve", self.scene, "--duration", 0)
        self.read_until(other.stdout, "^endpoint")
        self.assertIn("2 servers run here", ctl("status").stderr)
        self.interrupt(other)
        self.finish(other)
        (folder / "dead-4194999").unlink()
        process.kill()
        process.wait()
        self.wait_for(path.exists, lambda there: not there, "removal of the socket")

    def test_a_folder_that_others_can_enter_is_not_used(self):
        folder = self.runtime / "ziggurat"
        folder.mkdir(mode=0o755)
        process = self.start("serve", self.scene, "--duration", 0)
        endpoint = self.read_until(process.stdout, "^endpoint (ipc://.*)$")[1]
        self.assertNotIn(str(folder), endpoint)
        self.interrupt(process)
        self.finish(process)
        folder.rmdir()

    def test_the_folder_of_any_path_is_removed_when_the_server_is_killed(self):
        process = self.start("serve", self.scene, "--duration", 0, "--endpoint", "ipc://*")
        path = pathlib.Path(self.read_until(process.stdout, "^endpoint ipc://(.*)$")[1])
        self.assertEqual(path.parent.stat().st_mode & 0o777, 0o700)
        process.kill()
        process.wait()
        self.wait_for(path.parent.exists, lambda there: not there, "removal of the folder")

    def test_endpoint_is_plain_text_without_json(self):
        process = self.start("serve", self.scene, "--endpoint", f"ipc://{self.folder}/s")
        self.assertEqual(process.stdout.readline(), f"endpoint ipc://{self.folder}/s\n")
        self.interrupt(process)
        self.assertEqual(self.finish(process).code, INTERRUPTED)

    def hello(self, endpoint, meanwhile=lambda: None):
        """The first answer to a Hello, and the first other than Loading. Calls `meanwhile` between them."""
        with zmq.Context() as context, context.socket(zmq.DEALER) as dealer:
            dealer.linger, dealer.rcvtimeo = 0, 20_000
            dealer.connect(endpoint)
            hello = {"version": {"major": 1}, "role": "ROLE_CONTROLLER", "robots": ["*"]}
            dealer.send_json({"hello": hello})
            first = answer = dealer.recv_json()
            meanwhile()
            while "loading" in answer:
                answer = dealer.recv_json()
            return first, answer

    def slow_scene(self):
        """The test's scene with 15 000 boxes more: placing them takes a second or more."""
        text = self.scene.read_text()
        boxes = '''<distribute>
          <position method="uniform" min="-99,-99,9" max="99,99,9"/>
          <orientation method="constant" values="0,0,0"/>
          <entity quantity="15000" max_trials="1000">
            <box id="crate" size="0.5,0.5,0.1" movable="false"/>
          </entity>
        </distribute>'''
        return self.write("slow.argos", text.replace("</arena>", boxes + "</arena>"))

    def test_listens_before_the_scene_is_loaded(self):
        self.scene = self.slow_scene()
        process, endpoint = self.serve("--ticks", 0)
        loading, answer = self.hello(endpoint)
        self.assertIn("loading", loading)
        self.assertIn("welcome", answer)
        self.interrupt(process)
        self.assertEqual(self.finish(process).code, INTERRUPTED)

    def test_interrupted_while_loading(self):
        self.scene = self.slow_scene()
        process, endpoint = self.serve("--ticks", 0)
        loading, answer = self.hello(endpoint, lambda: self.interrupt(process))
        self.assertIn("loading", loading)
        self.assertEqual(answer["refusal"]["error"]["code"], "OUT_OF_STATE")
        outcome = self.finish(process)
        self.assertEqual(outcome.code, INTERRUPTED)
        self.assertIn("interrupted while loading", outcome.err)

    def test_scene_without_controllers_is_paused(self):
        begin, end = self.text.index("<prototype"), self.text.rindex("</prototype>")
        self.change(self.text[begin:end + len("</prototype>")], "")
        process, _ = self.serve()
        self.read_until(process.stderr, r"paused: .*--real-time")
        self.interrupt(process)
        self.assertEqual(self.finish(process).code, INTERRUPTED)
        outcome = self.ziggurat("serve", self.scene, "--endpoint", "tcp://127.0.0.1:*",
                                "--real-time", "20")
        self.assertEqual(outcome.code, FINISHED, outcome.err)


if __name__ == "__main__":
    main()
