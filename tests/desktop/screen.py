"""A screen of our own, and hands on it: Xvfb, whose picture lies in a file, and xdotool."""

import ctypes
import mmap
import os
import struct
import subprocess
import time
import zlib

SIZE = (1280, 800)


class Failed(Exception):
    """Something is not as it should be."""


def wait(what, condition, seconds=20.0, every=0.05):
    """What `condition` gives as soon as it gives something."""
    end = time.monotonic() + seconds
    while True:
        got = condition()
        if got:
            return got
        if time.monotonic() > end:
            raise Failed(f"waited {seconds:.0f} s in vain: {what}")
        time.sleep(every)


class Picture:
    """Pixels as they were at one time."""

    def __init__(self, width, height, stride, raw):
        self.width, self.height, self.stride, self.raw = width, height, stride, raw

    def at(self, x, y):
        """Red, green, blue."""
        i = y * self.stride + 4 * x
        blue, green, red = self.raw[i : i + 3]
        return red, green, blue

    def row(self, y, x0, x1):
        """Pixels of a part of a row, as bytes of four each."""
        return self.raw[y * self.stride + 4 * x0 : y * self.stride + 4 * x1]

    def crop(self, box):
        x0, y0, x1, y1 = box
        return b"".join(self.row(y, x0, x1) for y in range(y0, y1))

    def colours(self, box=None):
        """How many colours there are."""
        raw = self.crop(box or (0, 0, self.width, self.height))
        return len(set(struct.unpack(f"={len(raw) // 4}I", raw)))

    def differs(self, other, box, by=24):
        """Share of the pixels of a box that are others there, by more than a little."""
        mine, theirs = self.crop(box), other.crop(box)
        if mine == theirs:
            return 0.0
        apart = lambda i: max(abs(a - b) for a, b in zip(mine[i : i + 3], theirs[i : i + 3])) > by
        return sum(apart(i) for i in range(0, len(mine), 4)) / (len(mine) // 4)

    def runs(self, colour, box, least=8):
        """Where a row holds at least so many pixels of a colour one after the other: (y, x0, x1)."""
        x0, y0, x1, y1 = box
        wanted = bytes((colour[2], colour[1], colour[0]))
        for y in range(y0, y1):
            raw = self.row(y, x0, x1)
            if wanted not in raw:
                continue
            since = None
            for x in range(x1 - x0 + 1):
                same = raw[4 * x : 4 * x + 3] == wanted
                if same and since is None:
                    since = x
                elif not same and since is not None:
                    if x - since >= least:
                        yield y, x0 + since, x0 + x
                    since = None

    def plates(self, colour, box, least=8, gap=0):
        """Boxes that hold the runs of a colour which lie one under the other, in the order of reading.

        So many rows may be missing in between, for letters.
        """
        plates = []
        for y, a, b in self.runs(colour, box, least):
            for plate in plates:
                if plate[3] >= y - 1 - gap and a < plate[2] and b > plate[0]:
                    plate[0], plate[2], plate[3] = min(a, plate[0]), max(b, plate[2]), y
                    break
            else:
                plates.append([a, y, b, y])
        return [(a, top, b, bottom + 1) for a, top, b, bottom in plates]

    def save(self, path):
        rows = []
        for y in range(self.height):
            raw = self.row(y, 0, self.width)
            row = bytearray(3 * self.width)
            row[0::3], row[1::3], row[2::3] = raw[2::4], raw[1::4], raw[0::4]
            rows.append(b"\0" + bytes(row))

        def chunk(kind, data):
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

        head = struct.pack(">IIBBBBB", self.width, self.height, 8, 2, 0, 0, 0)
        body = zlib.compress(b"".join(rows), 1)
        path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", body) + chunk(b"IEND", b""))


class Screen:
    """An X server that only we see."""

    def __init__(self, folder):
        folder.mkdir(parents=True)
        read, write = os.pipe()
        screen = ["-screen", "0", f"{SIZE[0]}x{SIZE[1]}x24", "-fbdir", str(folder)]
        command = ["Xvfb", "-displayfd", str(write), *screen, "-nolisten", "tcp", "-noreset"]
        with open(folder / "xvfb.log", "wb") as log:
            self.server = subprocess.Popen(command, pass_fds=[write], stdin=subprocess.DEVNULL, stdout=log, stderr=log)
        os.close(write)
        number = b""
        while not number.endswith(b"\n"):
            more = os.read(read, 16)
            if not more:
                raise Failed(f"Xvfb did not start: {(folder / 'xvfb.log').read_text()}")
            number += more
        os.close(read)
        self.display = ":" + number.decode().strip()
        self.file = open(folder / "Xvfb_screen0", "rb")
        self.memory = mmap.mmap(self.file.fileno(), 0, prot=mmap.PROT_READ)

    def look(self):
        """What is on it now: the file is an X window dump."""
        head = struct.unpack(">25I", self.memory[:100])
        header, width, height, stride, colours = head[0], head[4], head[5], head[12], head[19]
        start = header + 12 * colours
        return Picture(width, height, stride, self.memory[start : start + stride * height])

    def close(self):
        self.server.terminate()
        self.server.wait()
        self.memory.close()
        self.file.close()

    def xdotool(self, *words):
        environment = {**os.environ, "DISPLAY": self.display}
        command = ["xdotool", *map(str, words)]
        done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=20)
        if done.stderr.strip():
            raise Failed(f"{' '.join(command)}: {done.stderr.strip()}")
        return done.stdout.split()

    def key(self, *keys):
        self.xdotool("key", "--delay", 30, *keys)

    def move(self, x, y):
        self.xdotool("mousemove", x, y)

    def click(self, x, y):
        self.xdotool("mousemove", x, y, "sleep", 0.1, "mousedown", 1, "sleep", 0.05, "mouseup", 1)

    def drag(self, places, until, pause=0.06):
        """Presses at the first place, moves through the others, and lets go at the last once `until` returns."""
        (x, y), *others = places
        words = ["mousemove", x, y, "sleep", 0.3, "mousedown", 1, "sleep", pause]
        for x, y in others:
            words += ["mousemove", x, y, "sleep", pause]
        self.xdotool(*words)
        try:
            until()
        finally:
            self.xdotool("mouseup", 1)

    def ask_to_close(self, window):
        """What a window manager sends when somebody clicks ×; Debian's xdotool cannot."""
        x = ctypes.CDLL("libX11.so.6")
        x.XOpenDisplay.restype = ctypes.c_void_p
        x.XInternAtom.restype = ctypes.c_ulong
        display = ctypes.c_void_p(x.XOpenDisplay(self.display.encode()))
        names = [x.XInternAtom(display, name, 0) for name in (b"WM_PROTOCOLS", b"WM_DELETE_WINDOW")]
        # XClientMessageEvent: type 33, serial, send_event, display, window, message_type, format, data.
        event = struct.pack("@iLiPLLi5l", 33, 0, 1, display.value, window, names[0], 32, names[1], 0, 0, 0, 0)
        event = event.ljust(192, b"\0")
        x.XSendEvent(display, ctypes.c_ulong(window), 0, ctypes.c_long(0), event)
        x.XCloseDisplay(display)
