"""`ziggurat render`: pictures of a scene, at the start and at times of a run."""

import struct
import unittest
import zlib

from harness import FAULT, FINISHED, SceneTest


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
                ([], "--out")]:
            outcome = self.ziggurat("render", self.scene, *options)
            self.assertEqual(outcome.code, FAULT, options)
            self.assertIn(message, outcome.err)


if __name__ == "__main__":
    unittest.main()
