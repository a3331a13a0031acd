# SPDX-License-Identifier: MIT
"""`ziggurat render`: pictures of a scene, at the start and at times of a run."""

import re
import shutil
import signal
import struct
import subprocess
import unittest
import zlib

from harness import BIN, FAULT, FINISHED, HERE, INTERRUPTED, SceneTest


def read_png(path):
    """(width, height, rows of RGB bytes)"""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    width, height, depth, color = struct.unpack(">IIBB", data[16:26])
    assert (depth, color) == (8, 2), "8 bits, RGB"
    packed, at = b"", 8
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += 12 + size
    lines = zlib.decompress(packed)
    stride, rows, above = 3 * width, [], bytes(3 * width)
    for y in range(height):
        kind, line = lines[y * (stride + 1)], bytearray(lines[y * (stride + 1) + 1:][:stride])
        for i in range(stride):
            left = line[i - 3] if i >= 3 else 0
            corner = above[i - 3] if i >= 3 else 0
            line[i] = (line[i] + predicted(kind, left, above[i], corner)) & 255
        above = bytes(line)
        rows.append(above)
    return width, height, rows


def predicted(kind, left, up, corner):
    if kind == 4:
        _, _, best = min((abs(up - corner), 0, left), (abs(left - corner), 1, up),
                         (abs(left + up - 2 * corner), 2, corner))
        return best
    return (0, left, up, (left + up) // 2)[kind]


class RenderTest(SceneTest):
    def picture(self, name, *options):
        outcome = self.ziggurat("render", self.scene, "--size", "96x64", "--out",
                                self.folder / name, *options)
        self.assertEqual(outcome.code, FINISHED, outcome.err)
        return outcome

    def test_draws_the_start_of_a_scene(self):
        outcome = self.picture("a.png")
        self.assertEqual(outcome.out.strip(), str(self.folder / "a.png"))
        width, height, rows = read_png(self.folder / "a.png")
        self.assertEqual((width, height), (96, 64))
        self.assertGreater(len({row[i:i + 3] for row in rows for i in range(0, 288, 3)}), 10)

    def test_draws_several_times_of_one_run_reproducibly(self):
        self.picture("f%02d.png", "--at", "0,0.5,1")
        frames = [(self.folder / f"f{i:02}.png").read_bytes() for i in range(3)]
        self.assertEqual(len(set(frames)), 3, "the arms move")
        self.picture("g.png", "--at", "0.5")
        self.assertEqual((self.folder / "g.png").read_bytes(), frames[1])

    def test_without_controllers_only_physics_moves(self):
        self.picture("with.png", "--at", "1")
        self.picture("without.png", "--at", "1", "--without-controllers")
        self.assertNotEqual((self.folder / "with.png").read_bytes(),
                            (self.folder / "without.png").read_bytes())

    def test_cameras_with_image_true_take_a_picture_at_every_tick(self):
        self.change("</sensors>", """
          <cameras implementation="default">
            <camera id="eye/1" anchor="origin" position="0,0,1" orientation="0,0,180"
                    range="0.1:2" focal_length="50,50" principal_point="24,16"
                    resolution="48,32" image="true" />
            <camera id="blind" anchor="origin" position="0,0,1" orientation="0,0,180"
                    range="0.1:2" focal_length="50,50" principal_point="24,16"
                    resolution="48,32" />
          </cameras></sensors>""", 1)
        pictures, again = self.folder / "pictures", self.folder / "again"
        plain = self.hash_of("--ticks", 3)
        self.assertEqual(self.hash_of("--ticks", 3, "--images", pictures), plain)
        self.hash_of("--ticks", 3, "--images", again)
        names = sorted(path.name for path in pictures.iterdir())
        self.assertTrue(names and len(names) % 3 == 0, names)
        self.assertTrue(names[0].endswith(".eye%2F1.000001.png"), names)
        self.assertFalse([name for name in names if "blind" in name])
        for name in names:
            self.assertEqual((pictures / name).read_bytes(), (again / name).read_bytes())
        width, height, rows = read_png(pictures / names[0])
        self.assertEqual((width, height), (48, 32))
        self.assertGreater(len({row[i:i + 3] for row in rows for i in range(0, 144, 3)}), 10)

    def test_the_size_of_a_picture_is_limited(self):
        self.change("</sensors>", """
          <cameras implementation="default">
            <camera id="eye" anchor="origin" position="0,0,1" orientation="0,0,180"
                    range="0.1:2" focal_length="50,50" principal_point="24,16"
                    resolution="99999,32" image="true" />
          </cameras></sensors>""", 1)
        outcome = self.ziggurat("check", self.scene)
        self.assertEqual(outcome.code, FAULT)
        self.assertRegex(outcome.out + outcome.err, r"resolution=.99999,32. .*4096,4096")

    def test_wrong_options_have_clear_messages(self):
        for options, message in [
                (["--size", "0x4", "--out", "x.png"], "--size"),
                (["--size", "4", "--out", "x.png"], "WIDTHxHEIGHT"),
                (["--size", "99999x4", "--out", "x.png"], "16384"),
                (["--eye", "1,2", "--out", "x.png"], "x,y,z"),
                (["--eye", "1,2,nan", "--out", "x.png"], "finite"),
                (["--at", "-1", "--out", "x.png"], "negative"),
                (["--at", "1,,2", "--out", "x.png"], "--at"),
                (["--fov", "180", "--out", "x.png"], "degrees"),
                (["--out", self.folder / "none/x.png"], "none/x.png"),
                (["--video", "x.avi"], ".mp4, .webm, .webp or .gif"),
                (["--video", "x.mp4", "--fps", "0"], "--fps"),
                (["--video", "x.mp4", "--from", "2", "--to", "1"], "--to"),
                (["--fps", "10", "--out", "x.png"], "--video"),
                (["--layers", "rays,smoke", "--out", "x.png"], "no layer 'smoke'"),
                (["--follow", "ghost", "--out", "x.png"], "no entity 'ghost'"),
                (["--eye", "1,2,3", "--look-at", "1,2,3.0", "--out", "x.png"], "are the same point"),
                (["--at", "0,1", "--out", "x%03d_%03d.png"], "write %03d once"),
                (["--out", "x%s.png"], "'%s' is no place for a number"),
                (["--follow", "arm", "--look-at", "0,0,0", "--out", "x.png"], "--look-at"),
                ([], "--out")]:
            outcome = self.ziggurat("render", self.scene, *options)
            self.assertEqual(outcome.code, FAULT, options)
            self.assertIn(message, outcome.err)

    def test_a_film_needs_ffmpeg_and_says_how_to_get_it(self):
        self.environment["PATH"] = str(self.folder)
        outcome = self.ziggurat("render", self.scene, "--video", "a.mp4", "--to", "1")
        self.assertEqual(outcome.code, FAULT)
        self.assert_is_sentence(outcome, r"install ffmpeg: sudo apt install ffmpeg")
        self.assertFalse((self.folder / "a.mp4").exists())

    def test_the_view_follows_an_entity_and_layers_are_drawn(self):
        names = {"plain": [], "labels": ["--layers", "labels"], "follow": ["--follow", "r0"]}
        pictures = {}
        for name, options in names.items():
            self.picture(name + ".png", *options)
            pictures[name] = (self.folder / (name + ".png")).read_bytes()
        self.assertEqual(len(set(pictures.values())), 3)


@unittest.skipUnless(shutil.which("ffmpeg"), "needs ffmpeg")
class FilmTest(SceneTest):
    def frames(self, name):
        """The frames of a film as hashes."""
        text = subprocess.run(
            ["ffmpeg", "-v", "error", "-i", self.folder / name, "-f", "framemd5", "-"],
            capture_output=True, text=True, check=True).stdout
        return [line.split()[-1] for line in text.splitlines() if not line.startswith("#")]

    def film(self, name, *options):
        outcome = self.ziggurat("render", self.scene, "--size", "95x64", "--video", name, *options)
        self.assertEqual(outcome.code, FINISHED, outcome.err)
        self.assertIn(name, outcome.out)
        return self.frames(name)

    def test_a_film_has_its_frames_and_is_the_same_again(self):
        frames = self.film("a.mp4", "--to", "1", "--fps", "20")
        self.assertEqual(len(frames), 20)
        self.assertGreater(len(set(frames)), 7, "the arms move")
        self.film("b.mp4", "--to", "1", "--fps", "20")
        self.assertEqual(self.frames("b.mp4"), frames)

    def test_films_have_other_formats_parts_of_a_run_and_more_frames_than_ticks(self):
        self.assertEqual(len(self.film("a.gif", "--from", "0.5", "--to", "1", "--fps", "10")), 5)
        self.assertEqual(len(self.film("a.webm", "--to", "0.2")), 6)
        many = self.film("b.mp4", "--to", "0.2", "--fps", "100")
        self.assertEqual(len(many), 20)
        self.assertEqual(len(self.film("fast.mp4", "--to", "2", "--speed", "4", "--fps", "20")), 10)

    def test_without_a_length_a_film_needs_an_end(self):
        self.change('length="2"', 'length="0"')
        outcome = self.ziggurat("render", self.scene, "--video", "a.mp4")
        self.assertEqual(outcome.code, FAULT)
        self.assert_is_sentence(outcome, r"--to SECONDS")

    def test_ctrl_c_leaves_a_film_that_can_be_played_and_says_so(self):
        process = self.start("render", self.scene, "--size", "320x240", "--video", "a.mp4", "--to", "900")
        film = self.folder / "a.mp4"
        self.wait_for(lambda: film.exists() and film.stat().st_size, bool, "frames in the film")
        process.send_signal(signal.SIGINT)
        outcome = self.finish(process)
        self.assertEqual(outcome.code, INTERRUPTED)
        self.wait_for(lambda: self.processes("ffmpeg", str(self.folder)), lambda all: not all, "end")
        number = int(re.search(r"the first (\d+) of 27000 frames", outcome.err)[1])
        self.assertGreater(number, 0)
        self.assertEqual(len(self.frames("a.mp4")), number)


@unittest.skipUnless(shutil.which("ffmpeg"), "needs ffmpeg")
class DocumentsTest(SceneTest):
    def test_the_commands_that_make_the_pictures_of_the_documents_work(self):
        root = HERE.parents[1]
        made = subprocess.run(
            [root / "docs/pictures/make.sh", BIN, self.folder], capture_output=True, text=True, timeout=300,
            env=dict(self.environment, SCREENSHOTS="no", LONG="no"))
        self.assertEqual(made.returncode, 0, made.stderr)
        texts = [root / "README.md", *(root / "docs").glob("*.md")]
        shown = {name for text in texts
                 for name in re.findall(r"pictures/([\w.]+\.(?:png|webp|jpg))", text.read_text())}
        for path in self.folder.iterdir():
            if path.suffix not in (".png", ".webp"):
                continue
            self.assertIn(path.name, shown, "no document shows it")
            self.assertTrue((root / "docs/pictures" / path.name).exists(), path.name)
            self.assertLess(path.stat().st_size, 3 << 20)
        sizes = sum(path.stat().st_size for path in (root / "docs/pictures").iterdir())
        self.assertLess(sizes, 3 << 20, "all pictures together")


if __name__ == "__main__":
    unittest.main()
