"""A screen of its own: Xvfb, what is seen on it, and xdotool."""

import os
import struct
import subprocess
import time


class Picture:
    """One moment of the screen. Pixels are 4 bytes: blue, green, red and nothing."""

    def __init__(self, data):
        header = struct.unpack(">25I", data[:100])
        self.width, self.height, self.stride = header[4], header[5], header[12]
        if header[1] != 7 or header[11] != 32 or header[7] != 0:
            raise ValueError("expected an XWD file of 32-bit pixels, least byte first")
        self.start = header[0] + 12 * header[19]
        self.data = data

    def row(self, y, left, right):
        at = self.start + y * self.stride
        return self.data[at + 4 * left : at + 4 * right]

    def mean(self, left, top, right, bottom):
        """Of red, green and blue in a rectangle, 0 to 255."""
        total = 0
        for y in range(top, bottom):
            row = self.row(y, left, right)
            total += sum(row[0::4]) + sum(row[1::4]) + sum(row[2::4])
        return total / (3 * (right - left) * (bottom - top))


def changed_area(before, after):
    """(left, top, right, bottom) of the largest run of rows of which at least a sixth differs; None: there is none."""
    runs, start = [], None
    for y in range(before.height + 1):
        differs = False
        if y < before.height:
            a, b = before.row(y, 0, before.width), after.row(y, 0, after.width)
            differs = a != b and sum(p != q for p, q in zip(a[1::4], b[1::4])) > before.width // 6
        if differs and start is None:
            start = y
        if not differs and start is not None:
            runs.append((start, y))
            start = None
    if not runs:
        return None
    top, bottom = max(runs, key=lambda run: run[1] - run[0])
    columns = set()
    for y in range(top, bottom, 4):
        a, b = before.row(y, 0, before.width), after.row(y, 0, after.width)
        columns.update(x for x, (p, q) in enumerate(zip(a[1::4], b[1::4])) if p != q)
    return min(columns), top, max(columns) + 1, bottom


class Screen:
    def __init__(self, folder, width=1280, height=800):
        read, write = os.pipe()
        self.process = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", f"{width}x{height}x24", "-fbdir", folder,
             "-nolisten", "tcp"],
            pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as numbers:
            number = numbers.readline().strip()
        if not number:
            raise RuntimeError("Xvfb does not start")
        self.display = ":" + number
        self.file = os.path.join(folder, "Xvfb_screen0")

    def close(self):
        self.process.terminate()
        self.process.wait()

    def see(self):
        with open(self.file, "rb") as file:
            return Picture(file.read())

    def do(self, *arguments):
        """xdotool; returns what it prints."""
        result = subprocess.run(["xdotool", *map(str, arguments)], env={**os.environ, "DISPLAY": self.display},
                                capture_output=True, text=True, timeout=60)
        return result.stdout

    def find_window(self, name, seconds=60):
        """The number of the window that has a title like that, which then has the keyboard."""
        found = wait_for(lambda: self.do("search", "--onlyvisible", "--name", name).split(), seconds,
                         f"a window called {name}")
        self.do("windowfocus", "--sync", found[-1])
        return found[-1]

    def press(self, *keys):
        self.do("key", "--delay", "60", *keys)

    def click(self, x, y):
        self.do("mousemove", x, y, "sleep", ".1", "click", 1)

    def drag(self, x, y, to_x, to_y, button=1, steps=10):
        """Slowly, as a hand does."""
        moves = []
        for i in range(1, steps + 1):
            moves += ["mousemove", x + (to_x - x) * i // steps, y + (to_y - y) * i // steps, "sleep", ".02"]
        self.do("mousemove", x, y, "sleep", ".1", "mousedown", button, *moves, "sleep", ".1", "mouseup", button)


def wait_for(what, seconds=60, name="something"):
    """Asks until the answer is true, and returns it; TimeoutError after so many seconds."""
    end = time.monotonic() + seconds
    while True:
        answer = what()
        if answer:
            return answer
        if time.monotonic() > end:
            raise TimeoutError(f"waited {seconds} seconds for {name}")
        time.sleep(0.1)
