"""Drives the real editor on a screen of its own, by mouse and keys alone, and looks at its pixels and files.

usage: editor_window_test.py PARIAN-EDITOR PARIAN SCENES. Ends with 77 where Xvfb or xdotool are missing."""

import glob
import json
import math
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

from x_screen import Screen, changed_area, wait_for

SKIPPED = 77
BLOCK = 6  # node and mesh of the tall block
LEAST_RATE = 5  # pictures a second, on a machine that has other things to do


class EditorWindow(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="parian-editor-")
        self.addCleanup(shutil.rmtree, self.folder)
        self.scene = os.path.join(self.folder, "cornell-box.gltf")
        for file in glob.glob(os.path.join(SCENES, "cornell-box", "cornell-box.*")):
            shutil.copy(file, self.folder)
        self.screen = Screen(self.folder)
        self.addCleanup(self.screen.close)
        self.environment = {**os.environ, "DISPLAY": self.screen.display, "QT_QPA_PLATFORM": "xcb",
                            "HOME": self.folder, "XDG_CONFIG_HOME": os.path.join(self.folder, "config"),
                            "XDG_DATA_HOME": os.path.join(self.folder, "data"), "LC_ALL": "C"}

    def start(self, window="Parian$"):
        program = subprocess.Popen([EDITOR, "--autosave", "1", self.scene], env=self.environment)
        self.addCleanup(lambda: program.poll() is None and program.kill())
        self.window = self.screen.find_window(window)
        return program

    def find_viewport(self):
        """Where the picture is: what changes over a wide area while it refines and nobody touches anything."""
        self.screen.do("mousemove", 5, 790)

        def look():
            before = self.screen.see()
            time.sleep(0.25)
            area = changed_area(before, self.screen.see())
            return area if area and area[3] - area[1] > 300 else None

        self.left, self.top, self.right, self.bottom = wait_for(look, 30, "a picture that refines")

    def scale(self):
        """Pixels for a tangent."""
        camera = self.nodes()[1]["cameras"][0]["perspective"]
        return 0.5 * (self.bottom - self.top) / math.tan(0.5 * camera["yfov"])

    def project(self, x, y, z):
        eye = (0, 0.273, 0.8)
        pixels = self.scale() / (eye[2] - z)
        return (round(0.5 * (self.left + self.right) + (x - eye[0]) * pixels),
                round(0.5 * (self.top + self.bottom) - (y - eye[1]) * pixels))

    def block_centre(self):
        _, document = self.nodes()
        positions = document["meshes"][BLOCK]["primitives"][0]["attributes"]["POSITION"]
        bounds = document["accessors"][positions]
        return [0.5 * (a + b) for a, b in zip(bounds["min"], bounds["max"])]

    def nodes(self):
        with open(self.scene) as file:
            document = json.load(file)
        return document["nodes"], document

    def save(self):
        """By Ctrl+S; returns the nodes of the new file."""
        before = os.stat(self.scene)
        self.screen.press("ctrl+s")
        wait_for(lambda: os.stat(self.scene).st_ino != before.st_ino or
                 os.stat(self.scene).st_mtime_ns != before.st_mtime_ns, 30, "the saved file")
        result = subprocess.run([PARIAN, "info", self.scene], capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.nodes()[0]

    def close(self, program):
        self.screen.press("ctrl+q")
        self.assertEqual(program.wait(timeout=30), 0)

    def region(self):
        """Mean of where the upper half of the block is before it is moved."""
        x, y, z = self.block_centre()
        left, top = self.project(x - 0.05, y + 0.12, z)
        right, bottom = self.project(x + 0.05, y + 0.05, z)
        return self.screen.see().mean(left, top, right, bottom)

    def test_edits(self):
        program = self.start()
        self.find_viewport()
        seen = self.screen.see().mean(self.left, self.top, self.right, self.bottom)
        self.assertGreater(seen, 20, "the picture is black")
        x, y, z = self.block_centre()
        self.screen.click(*self.project(x, y + 0.1, z))
        self.screen.do("mousemove", self.left + 20, self.top + 20)
        time.sleep(1)  # noise settles
        before = self.region()

        # Its x axis goes to the right from the middle.
        from_x, from_y = self.project(x, y, z)
        self.screen.drag(from_x + 60, from_y, from_x + 60 - 150, from_y)
        moved = 150 * (0.8 - z) / self.scale()
        wait_for(lambda: abs(self.region() - before) > 8, 20, "the block to be gone from where it was")
        self.screen.press("ctrl+z")
        wait_for(lambda: abs(self.region() - before) < 6, 20, "the block to be back")
        self.screen.press("ctrl+y")
        wait_for(lambda: abs(self.region() - before) > 8, 20, "the block to be gone again")
        self.screen.press("alt+a", "Return")  # the first entry of the menu: a sphere
        nodes = self.save()
        self.assertEqual(len(nodes), 10)
        self.assertIn("PARIAN_shape", json.dumps(nodes[9]))
        self.assertAlmostEqual(nodes[BLOCK]["translation"][0], -moved, delta=0.1 * moved)
        for other in nodes[BLOCK]["translation"][1:]:
            self.assertAlmostEqual(other, 0, delta=1e-4)
        self.close(program)

    def test_shows_many_pictures_a_second(self):
        program = self.start()
        self.find_viewport()
        x, y = (self.left + self.right) // 2, (self.top + self.bottom) // 2
        # Not so far that it looks at the dark outside of the box, where all pictures are alike.
        hand = threading.Thread(target=self.screen.drag, args=(x, y, x + 100, y + 10, 2, 100))
        pictures, last = 0, None
        end = begin = time.monotonic()
        hand.start()
        time.sleep(0.3)
        with open(self.screen.file, "rb", buffering=0) as file:
            picture = self.screen.see()
            rows = [picture.start + row * picture.stride for row in range(self.top + 20, self.bottom - 20, 40)]
            begin = time.monotonic()
            while hand.is_alive():
                now = b"".join(os.pread(file.fileno(), 4 * (self.right - self.left), at + 4 * self.left) for at in rows)
                pictures += now != last
                last = now
                end = time.monotonic()
                time.sleep(0.002)
        hand.join()
        rate = pictures / (end - begin)
        print(f"\n{rate:.0f} pictures a second while the view turns, over {end - begin:.1f} s")
        self.assertGreater(rate, LEAST_RATE)
        self.close(program)

    def test_recovers(self):
        program = self.start()
        self.find_viewport()
        x, y, z = self.block_centre()
        self.screen.click(*self.project(x, y + 0.1, z))
        self.screen.press("ctrl+d")
        copies = lambda: glob.glob(os.path.join(self.folder, "data", "**", "autosave", "*.json"), recursive=True)
        wait_for(copies, 30, "a copy of what is unsaved")
        program.send_signal(signal.SIGKILL)
        program.wait()
        program = self.start("Recover")
        self.screen.press("Return")  # Yes
        self.window = self.screen.find_window("Parian$")
        self.assertEqual(len(self.nodes()[0]), 9, "not saved yet")
        self.assertEqual(len(self.save()), 10)
        self.close(program)
        self.assertEqual(copies(), [])


if __name__ == "__main__":
    EDITOR, PARIAN, SCENES = (os.path.abspath(path) for path in sys.argv[1:4])
    missing = [tool for tool in ("Xvfb", "xdotool") if not shutil.which(tool)]
    if missing:
        print("skipped: not installed:", ", ".join(missing))
        sys.exit(SKIPPED)
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=2)
