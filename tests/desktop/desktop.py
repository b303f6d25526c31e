"""Works in the window as a person would, and holds what it sees against what should be.

Each step says what it does, keeps a picture of the screen, and fails by itself: the steps after it go on.
"""

import difflib
import json
import math
import os
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import tomllib
import zlib
from pathlib import Path

from screen import Failed, Screen, wait

SCENES = Path(__file__).parents[2] / "scenes"
# Colours of the window's dark theme: buttons, wells that things lie in, the accent.
BUTTON, WELL, ACCENT = (50, 50, 50), (0x14, 0x16, 0x1A), (0x3D, 0x8B, 0xE0)
# The view `fixed`: eye, target (m), vertical field of view (rad).
EYE, TARGET, FIELD = (-8.0, -8.0, 6.0), (0.0, 0.0, 0.0), 0.7
# Simulated time that the scene plans, s: the span of the timeline.
DURATION = 15.0


def check(right, what):
    if not right:
        raise Failed(what)


class Lab:
    """A window of the program."""

    def __init__(self, test, *words, drawn=None, colours=500):
        self.screen, self.folder = test.screen, test.folder
        self.out = test.work / f"out-{test.windows}.txt"
        self.err = test.work / f"err-{test.windows}.txt"
        test.windows += 1
        command = [test.echelon, "lab", *words, "--size", "1280x800", "--timings"]
        with open(self.out, "wb") as out, open(self.err, "wb") as err:
            self.process = subprocess.Popen(
                command, cwd=self.folder, env=test.environment, stdin=subprocess.DEVNULL, stdout=out, stderr=err
            )
        test.lab = self
        self.play_sign = test.play_sign
        self.read = 0
        self.window = int(wait("a window", self.find, 60, 0.2)[0])
        self.screen.xdotool("windowfocus", self.window)
        # Out of the way, where nothing is under the pointer.
        self.screen.move(*AWAY)
        wait("a first picture", lambda: self.screen.look().colours(drawn or ROBOTS) > colours, 60, 0.2)

    def find(self):
        self.alive()
        return self.screen.xdotool("search", "--onlyvisible", "--pid", self.process.pid)

    def alive(self):
        code = self.process.poll()
        check(code is None, f"the window ended by itself, with {code}:\n{self.err.read_text()}")

    def hears(self, words, seconds=30.0):
        """Waits for a line of the log, and goes on behind it."""

        def line():
            self.alive()
            found = re.compile(words, re.M).search(self.out.read_text(), self.read)
            return found if found and self.out.read_text().find("\n", found.end()) >= 0 else None

        try:
            found = wait(f"`{words}` in the log", line, seconds)
        except Failed as failed:
            raise Failed(f"{failed}; it says\n{self.out.read_text()[self.read :]}") from None
        self.read = self.out.read_text().find("\n", found.end())
        return found

    def key(self, *keys):
        self.screen.key(*keys)

    def still(self, seconds=0.7):
        """What is seen once nothing has changed for a while."""
        last, since, end = self.screen.look(), time.monotonic(), time.monotonic() + 30
        while time.monotonic() - since < seconds:
            check(time.monotonic() < end, "the window never comes to rest")
            time.sleep(0.1)
            now = self.screen.look()
            if now.raw != last.raw:
                last, since = now, time.monotonic()
        return last

    def line_of_time(self):
        """The row above the bars on the timeline, and its ends."""
        look = self.screen.look()
        wells = [run for run in look.runs(WELL, (200, 2, 1200, 20), 20)]
        check(wells, "there is no line of time")
        y = min(y for y, _, _ in wells) + 1
        ends = [(a, b) for row, a, b in wells if row == y]
        return look, y, min(a for a, _ in ends), max(b for _, b in ends)

    def time(self):
        """The time that is looked at, s, from where the mark is."""
        look, y, left, right = self.line_of_time()
        mark = [x for x in range(left - 6, right + 6) if min(look.at(x, y)) > 230]
        check(mark, "there is no mark on the timeline")
        return (sum(mark) / len(mark) + 0.5 - left) / (right - left) * DURATION

    def stand(self):
        """Pauses, and waits until the window does: its first button says Play again."""
        self.key("space")
        wait("the button Play", lambda: self.screen.look().crop(FIRST_BUTTON) == self.play_sign, 20)
        self.still()

    def run_until(self, end, meanwhile=lambda: None):
        """Plays up to a time, and stands."""
        self.key("space")
        wait(f"{end} s on the timeline", lambda: self.time() >= end, 60)
        meanwhile()
        self.stand()

    def buttons(self, box):
        """Middles of buttons, in the order of reading."""
        plates = self.screen.look().plates(BUTTON, box, 12, gap=14)
        return [((a + b) // 2, (top + bottom) // 2) for a, top, b, bottom in plates if bottom - top > 12]

    def close(self):
        self.screen.ask_to_close(self.window)

    def ended(self, seconds=60.0):
        """The exit code, once there is one."""
        try:
            return self.process.wait(seconds)
        except subprocess.TimeoutExpired:
            raise Failed(f"the window is still there after {seconds:.0f} s") from None


AWAY = (1180, 560)
# The upper edge of the view, when the arrangement is the first one.
VIEW_TOP = 42
# The tab of the panel Safety, and the box in it that switches filters, when the arrangement is the first one.
SAFETY, FILTER = (1205, 54), (974, 112)
# The tab of the panel Sweep, its button Start, and a cell of its map with a large gain.
SWEEP, START, CELL = (1140, 324), (1020, 515), (1225, 520)
# As no window manager does it.
DESTROY = """
import ctypes, sys
x = ctypes.CDLL("libX11.so.6")
x.XOpenDisplay.restype = ctypes.c_void_p
display = ctypes.c_void_p(x.XOpenDisplay(None))
x.XDestroyWindow(display, ctypes.c_ulong(int(sys.argv[1])))
x.XSync(display, 0)
"""
FIRST_BUTTON = (10, 7, 32, 27)
# Where the robots of the scene are when the arrangement is the first one.
ROBOTS = (250, 150, 950, 590)


class Test:
    """The steps, their folders, and how they went."""

    def __init__(self, echelon, artefacts, work):
        self.echelon, self.artefacts, self.work = echelon, artefacts, work
        self.folder, home = work / "folder", work / "home"
        self.data = home / "data" / "echelon-lab"
        for folder in (self.folder, home / "run"):
            folder.mkdir(parents=True)
        (home / "run").chmod(0o700)
        self.screen = Screen(work / "screen")
        without = ("WAYLAND_DISPLAY", "WAYLAND_SOCKET", "DISPLAY")
        self.bare = {
            **{key: value for key, value in os.environ.items() if key not in without},
            "HOME": str(home),
            "XDG_DATA_HOME": str(home / "data"),
            "XDG_CONFIG_HOME": str(home / "config"),
            "XDG_CACHE_HOME": str(home / "cache"),
            "XDG_RUNTIME_DIR": str(home / "run"),
        }
        self.environment = {**self.bare, "DISPLAY": self.screen.display}
        self.scene = self.folder / "circle.toml"
        # The camera stands, so that places on the ground can be told; all else is as it comes with the program.
        self.shipped = (SCENES / "circle-three.toml").read_text() + '\n[views]\ndefault = "fixed"\n'
        self.scene.write_text(self.shipped)
        self.windows, self.lab, self.failed, self.pictures, self.play_sign = 0, None, [], 0, b""

    def echelons(self, *words, environment=None):
        """The program, run to its end."""
        environment = environment or self.environment
        command = [self.echelon, *words]
        return subprocess.run(command, cwd=self.folder, env=environment, capture_output=True, text=True, timeout=60)

    def step(self, what, do):
        began = time.monotonic()
        print(f"{what}…", flush=True)
        try:
            told = do()
            print(f"  {told or 'done'} ({time.monotonic() - began:.1f} s)", flush=True)
        except Exception as failed:  # noqa: BLE001
            self.failed.append(what)
            self.see("FAILED")
            kind = "" if isinstance(failed, Failed) else f"{type(failed).__name__}: "
            print(f"  FAILED: {kind}{failed}", flush=True)

    def see(self, name):
        self.pictures += 1
        look = self.screen.look()
        look.save(self.artefacts / f"{self.pictures:02}-{name}.png")
        return look

    def set_point(self, text=None, robot=1):
        robot = tomllib.loads(text or self.scene.read_text())["robots"][robot]
        return robot["distance"], robot["bearing"]

    def kept(self):
        """Unsaved work of the window that is open."""
        file = self.data / f"work-{self.lab.process.pid}.toml"
        return file.read_text() if file.exists() else None

    # --- the steps -------------------------------------------------------------------------------------------

    def opens(self):
        began = time.monotonic()
        lab = Lab(self, str(self.scene.name), "--paused")
        taken = time.monotonic() - began
        look = lab.still()
        self.play_sign = lab.play_sign = look.crop(FIRST_BUTTON)
        self.see("open")
        check(look.colours() > 2000, f"there are but {look.colours()} colours")
        lab.key("Escape")
        wait("the hints to go", lambda: self.screen.look().differs(look, ROBOTS) > 0.05, 10)
        lab.still()
        return f"a picture of {look.colours()} colours after {taken:.1f} s; Esc closes the hints"

    def idles(self):
        lab = self.lab
        lab.still(1.0)
        stat = Path(f"/proc/{lab.process.pid}/stat")
        # What stands behind the name: the time spent in the program, and for it.
        spent = lambda: sum(map(int, stat.read_text().rsplit(")", 1)[1].split()[11:13]))
        before, began = spent(), time.monotonic()
        time.sleep(3)
        share = (spent() - before) / os.sysconf("SC_CLK_TCK") / (time.monotonic() - began)
        check(share < 0.3, f"{100 * share:.0f} % of a processor while nothing moves")
        return f"{100 * share:.1f} % of a processor while nothing moves"

    def view(self):
        """The box of the view: gaps between tiles are of one colour, what is drawn is not."""
        look = self.screen.look()

        def edge(at, by, drawn):
            while drawn(at + by):
                at += by
            return at

        column = lambda x: len({look.at(x, y) for y in range(440, 520)}) > 3
        left, right = edge(600, -1, column), edge(600, 1, column) + 1
        row = lambda y: len({look.at(x, y) for x in range(left + 350, left + 500)}) > 3
        return left, edge(500, -1, row), right, edge(500, 1, row) + 1

    def pixel(self, box, x, y, view=None):
        """Where a place on the ground is seen, from eye to target with a field of view."""
        eye, target, field = view or (EYE, TARGET, FIELD)
        take = lambda a, b: tuple(p - q for p, q in zip(a, b))
        dot = lambda a, b: sum(p * q for p, q in zip(a, b))
        forward = take(target, eye)
        forward = tuple(p / math.hypot(*forward) for p in forward)
        flat = math.hypot(*forward[:2])
        right = (forward[1] / flat, -forward[0] / flat, 0.0)
        up = (
            right[1] * forward[2] - right[2] * forward[1],
            right[2] * forward[0] - right[0] * forward[2],
            right[0] * forward[1] - right[1] * forward[0],
        )
        way = take((x, y, 0.0), eye)
        left, top, end, bottom = box
        unit = 0.5 * (bottom - top) / math.tan(0.5 * field) / dot(way, forward)
        return (left + end) / 2 + unit * dot(way, right), (top + bottom) / 2 - unit * dot(way, up)

    def set_point_at(self, box, distance, degrees):
        """Where a set point of the leader, which still is where it starts, is seen."""
        angle = math.radians(degrees)
        return self.pixel(box, distance * math.cos(angle), distance * math.sin(angle))

    def drags(self):
        lab = self.lab
        box = self.view()
        first, last = self.set_point_at(box, 2.0, -135.0), self.set_point_at(box, 2.5, -120.0)
        lab.screen.move(*AWAY)
        before = lab.still()
        path = [tuple(round(a + k / 8 * (b - a)) for a, b in zip(first, last)) for k in range(9)]

        def until():
            lab.hears(r"^log .*Set point of follower-1")
            lab.still()
            self.see("in-the-drag")

        lab.screen.drag(path, until)
        lab.still(0.3)
        lab.screen.move(*AWAY)
        after = lab.still()
        self.see("after-the-drag")
        text = wait("unsaved work", self.kept, 10)
        wait("the last of it", lambda: self.set_point(self.kept()) == (2.5, "-120 deg"), 5)
        check(self.set_point(text, 2) == (2.0, "135 deg"), "the other set point moved too")
        # Where the follower will be in a while; neither ring nor robot is there.
        x, y = self.pixel(box, 3.0, 0.0)
        ahead = (round(x) - 130, round(y) - 120, round(x) + 130, round(y) + 60)
        moved = after.differs(before, ahead)
        check(moved > 0.004, f"the future did not move: {100 * moved:.2f} % of the pixels ahead are others")
        lab.key("ctrl+s")
        lab.hears(r"^log .*Saved: .*circle.toml")
        check(self.set_point() == (2.5, "-120 deg"), "the file has not got it")
        return f"2 m, −135° to 2.5 m, −120°; {100 * moved:.1f} % of the pixels ahead are others; view {box}"

    def flicks(self):
        """Much between two frames of the window, as it is on slow machines."""
        lab = self.lab
        box = self.view()
        distance, bearing = self.set_point(self.kept() or self.scene.read_text())
        first = self.set_point_at(box, distance, float(bearing.split()[0]))
        last = self.set_point_at(box, 2.2, -130.0)
        middle = [(a + b) / 2 for a, b in zip(first, last)]
        places = [tuple(map(round, place)) for place in (first, middle, last)]
        lab.screen.move(*places[0])
        lab.still()
        lab.screen.xdotool("mousedown", 1, "mousemove", *places[1])
        lab.hears(r"^log .*Set point of follower-1", 10)
        lab.screen.xdotool("mousemove", *places[2], "mouseup", 1, "mousemove", *AWAY)
        lab.still(1.2)
        self.see("flicked")
        now = self.set_point(self.kept())
        check(now == (2.2, "-130 deg"), f"let go at 2.2 m, −130°, but it says {now}")
        return "the set point is where the button was released"

    def types(self):
        lab = self.lab
        _, before = self.set_point(self.kept())
        lab.screen.xdotool("key", "--delay", 4, "a", "a", "a")
        lab.hears(r"^log .*Set point of follower-1", 10)
        lab.still(1.2)
        _, after = self.set_point(self.kept())
        turned = float(after.split()[0]) - float(before.split()[0])
        check(turned == 15.0, f"three times 5° are {turned}°")
        return "three presses, 15°"

    def branches(self):
        lab = self.lab
        lab.run_until(1.5)
        self.see("ran")
        now = lab.time()
        _, y, left, right = lab.line_of_time()
        x_of = lambda t: round(left + t / DURATION * (right - left))
        until = lambda: wait("the mark at 0.8 s", lambda: abs(lab.time() - 0.8) < 0.12, 20)
        lab.screen.drag([(x_of(t), y + 10) for t in (now, 1.2, 0.9, 0.8)], until)
        lab.still(0.3)
        lab.screen.move(*AWAY)
        lab.still()
        self.see("in-the-past")
        lab.key("b")
        at = float(lab.hears(r"^log ([\d.]+) s: branch 1 forks from main").group(1))
        check(abs(at - 0.8) < 0.12, f"the branch leaves at {at} s, not at 0.8 s")
        # The first slider of the laws: a bar in the accent that is not as high as a button.
        rails = [p for p in self.screen.look().plates(ACCENT, (960, 60, 1280, 320), 6) if p[3] - p[1] <= 10]
        check(rails, "there is no slider")
        a, top, b, bottom = rails[0]
        middle = (top + bottom) // 2
        lab.screen.drag([(b + by, middle) for by in (4, -8, -20, -30)], lambda: lab.hears(r"^log .*of all"))
        lab.still(0.3)
        lab.screen.move(*AWAY)
        gain = lambda: tomllib.loads(self.kept() or "").get("law", {}).get("k", 5.0)
        value = wait("a smaller gain in the unsaved work", lambda: gain() < 4.0 and gain(), 10)
        lab.run_until(2.0)
        self.see("two-branches")
        return f"from {at} s on, with K = {value}"

    def saves(self):
        lab = self.lab
        lab.key("ctrl+s")
        lab.hears(r"^log .*Saved: .*circle.toml")
        diff = list(difflib.ndiff(self.shipped.splitlines(), self.scene.read_text().splitlines()))
        gone = [line[2:] for line in diff if line.startswith("- ")]
        new = [line[2:] for line in diff if line.startswith("+ ")]
        check(gone == ["distance = 2.0", 'bearing = "-135 deg"'], f"these lines are gone: {gone}")
        allowed = re.compile(r'distance = 2\.5|bearing = "-120 deg"|\[law\]|k = [\d.]+|')
        check(all(allowed.fullmatch(line) for line in new), f"these lines are new: {new}")
        return f"{len(gone)} lines changed, {len(new) - len(gone)} added, every comment kept"

    def reloads(self):
        lab = self.lab
        before = self.scene.read_text()
        two = ['distance = 2.0\nbearing = "135 deg"', 'distance = 2.4\nbearing = "150 deg"']
        self.scene.write_text(before.replace(*two))
        check(self.scene.read_text() != before, "nothing to change in the file")
        lab.hears(r"^log .*Reloaded from disk", 15)
        lab.still()
        self.see("read-again")
        return "the window took what another program wrote"

    def takes_picture(self):
        lab = self.lab
        at = lab.time()
        self.seen = lab.still()
        lab.key("p")
        name = lab.hears(r"^log .*Written: (.*\.png)", 60).group(1)
        self.picture = self.folder / name
        shutil.copy(self.picture, self.artefacts / "picture.png")
        self.texts = texts(self.picture)
        check({"Scene", "Time", "View", "Home"} <= set(self.texts), f"it holds {sorted(self.texts)} only")
        taken = float(self.texts["Time"])
        check(abs(taken - at) < 0.06, f"its time is {taken} s, that on screen {at:.2f} s")
        scene = tomllib.loads(self.texts["Scene"])
        check(scene.get("changes"), "its scene has no changes")
        kind, _, numbers = self.texts["View"].partition(":")
        eye = [float(x) for x in numbers.split(",")[:3]]
        near = len(eye) == 3 and all(abs(a - b) < 1e-3 for a, b in zip(eye, EYE))
        check(kind == "fixed" and near, f"its view is {self.texts['View']}")
        return f"{name}: t = {taken} s, {len(scene['changes'])} changes, view {self.texts['View']}"

    def films(self):
        lab = self.lab
        begin = lab.time()
        lab.key("f")
        lab.hears(r"^log .*Filming to (.*\.mp4)")
        lab.run_until(begin + 1.9, lambda: self.see("filming"))
        end = lab.time()
        lab.key("f")
        name = lab.hears(r"^log .*Written: (.*\.mp4)", 120).group(1)
        return self.judge_film(self.folder / name, end - begin)

    def judge_film(self, path, seconds=None):
        shutil.copy(path, self.artefacts / path.name)
        entries = "stream=codec_name,width,height,avg_frame_rate:packet=pts_time"
        probe = ["ffprobe", "-v", "error", "-select_streams", "v", "-show_entries", entries, "-of", "json", str(path)]
        told = json.loads(subprocess.run(probe, check=True, capture_output=True, timeout=30).stdout)
        stream = told["streams"][0]
        check(stream["codec_name"] == "h264", f"it is {stream['codec_name']}")
        stamps = sorted(float(packet["pts_time"]) for packet in told["packets"])
        steps = [b - a for a, b in zip(stamps, stamps[1:])]
        shortest, longest = min(steps, default=0.0), max(steps, default=1.0)
        check(longest - shortest < 2e-3, f"frames are {shortest} to {longest} s apart")
        check(stream["avg_frame_rate"] == "30/1", f"it has {stream['avg_frame_rate']} frames a second")
        lasts = len(stamps) / 30
        if seconds is not None:
            check(len(stamps) > 30, f"it has {len(stamps)} frames only")
            check(abs(lasts - seconds) < 0.15, f"it lasts {lasts:.2f} s, {seconds:.2f} s were simulated")
        play = ["ffmpeg", "-v", "error", "-i", str(path), "-f", "null", "-"]
        decode = subprocess.run(play, capture_output=True, text=True, timeout=60)
        check(decode.returncode == 0 and not decode.stderr, f"it does not play: {decode.stderr}")
        return f"{path.name}: h264, {stream['width']} × {stream['height']}, {len(stamps)} frames, {lasts:.2f} s"

    def keeps_run(self):
        lab = self.lab
        lab.key("k")
        told = lab.hears(r"^(log|fault) .*runs/(\S+?):? .*?(\d+) samples,? (?:with )?digest (\w+)", 60)
        folder = self.folder / "runs" / told.group(2)
        check(told.group(1) == "log", told.group(0))
        check(folder.name == "circle-lab-001" and folder.is_dir(), f"it is in {folder}")
        replay = self.echelons("replay", str(folder))
        check(replay.returncode == 0, f"replay ends with {replay.returncode}: {replay.stdout}{replay.stderr}")
        check(told.group(4) in replay.stdout + replay.stderr, f"another digest: {replay.stdout}")
        scene = tomllib.loads((folder / "scene.toml").read_text())
        check(len(scene.get("changes", [])) >= 2, f"its scene has {len(scene.get('changes', []))} changes")
        return f"{told.group(3)} samples, {len(scene['changes'])} changes; replay gives the same digest"

    def keeps_run_while_it_runs(self):
        lab = self.lab
        lab.key("space")
        begin = lab.time()
        wait("a moment", lambda: lab.time() > begin + 0.3, 30)
        lab.key("k")
        told = lab.hears(r"^(log|fault) .*runs/circle-lab-002.*digest.*$", 60)
        lab.stand()
        check(told.group(1) == "log", told.group(0))
        return "as seen, though the run went on meanwhile"

    def closes(self):
        lab = self.lab
        if self.kept():
            lab.key("ctrl+s")
            lab.hears(r"^log .*Saved")
        lab.close()
        code = lab.ended()
        out = lab.out.read_text()
        check(code == 0, f"exit code {code}: {lab.err.read_text()}")
        check("branches: 2" in out, f"it says {out[lab.read:]}")
        check(not list(self.data.glob("work-*")), "unsaved work is left, though all is saved")
        return "exit code 0\n    " + out[out.rfind("work in a frame") :].strip().replace("\n", "\n    ")

    def opens_picture(self):
        lab = Lab(self, self.picture.name)
        told = lab.hears(r"^(log|fault) .*$").group(0)
        check(told.startswith("log") and "Restored from" in told, told)
        look = lab.still()
        self.see("picture-opened")
        left, top, right, bottom = self.view()
        differs = look.differs(self.seen, (left, top + 100, right, bottom), 60)
        check(differs < 0.02, f"{100 * differs:.1f} % of the view are others than when the picture was taken")
        lab.close()
        wait("the end, or the question", lambda: lab.process.poll() is not None or self.asked(look), 30)
        if lab.process.poll() is None:
            lab.process.kill()
            raise Failed("it asks about unsaved changes, though nobody has changed anything")
        said = re.search(r"t = ([\d.]+) s", lab.out.read_text())
        taken = float(self.texts["Time"])
        stands = float(said.group(1)) if said else math.nan
        check(abs(stands - taken) < 0.011, f"it was taken at {taken} s and stands at {stands} s")
        return f"at t = {taken} s again; {100 * differs:.1f} % of the view are others"

    def asked(self, before):
        """Whether a question lies over the window: all that is behind it has become darker."""
        return self.screen.look().differs(before, (970, 600, 1270, 790), 4) > 0.3

    def crashes(self):
        lab = Lab(self, self.scene.name, "--paused")
        lab.still()
        before = self.set_point()
        lab.key("s")
        wait("unsaved work", self.kept, 15)
        self.unsaved = self.set_point(self.kept())
        check(abs(self.unsaved[0] - before[0] - 0.1) < 1e-9, f"{before} became {self.unsaved}")
        lab.process.send_signal(signal.SIGKILL)
        lab.process.wait()
        lab = Lab(self, self.scene.name, "--paused")
        lab.still()
        look = self.see("after-the-crash")
        offers = lab.buttons((0, 42, 1280, 76))
        check(len(offers) == 2, f"{len(offers)} buttons where the offer should be")
        check(look.colours((0, 42, 600, 76)) > 20, "the offer says nothing")
        lab.screen.click(*offers[0])
        text = wait("the work as work of this window", self.kept, 15)
        lab.screen.move(*AWAY)
        lab.still()
        self.see("gone-on")
        check(self.set_point(text) == self.unsaved, f"it is {self.set_point(text)}, it was {self.unsaved}")
        check(len(list(self.data.glob("work-*"))) == 1, "the work of the window that is gone is still there")
        check(self.set_point() == before, "the file was written, though nobody saved it")
        return f"{self.unsaved} is there again, unsaved"

    def closes_in_a_film(self):
        lab = self.lab
        lab.key("f")
        name = lab.hears(r"^log .*Filming to (.*\.mp4)").group(1)
        lab.run_until(0.5)
        before = lab.still()
        lab.close()
        wait("the question", lambda: self.asked(before), 30)
        lab.still(0.3)
        self.see("closing")
        buttons = lab.buttons((300, 200, 980, 600))
        check(len(buttons) == 3, f"{len(buttons)} answers")
        lab.screen.click(*buttons[1])
        code = lab.ended(90)
        check(code == 0, f"exit code {code}: {lab.err.read_text()}")
        check(not list(self.data.glob("work-*")), "the work that was thrown away is offered again")
        return "asked first; exit code 0; " + self.judge_film(self.folder / name)

    def keeps_apart(self):
        """A safety filter is switched off in its panel, and on again by undoing that."""
        shutil.copy(SCENES / "pillar.toml", self.folder)
        lab = Lab(self, "pillar.toml", "--paused")
        lab.still()
        lab.screen.click(*SAFETY)
        lab.still()
        self.see("safety")
        lab.screen.click(*FILTER)
        lab.hears(r"^log .*Safety filter of all")
        text = wait("unsaved work", self.kept, 15)
        check(tomllib.loads(text)["safety"]["filter"] is False, "the filter is still on")
        lab.screen.move(*AWAY)
        lab.still()
        self.see("safety-off")
        lab.key("ctrl+z")
        lab.hears(r"^log .*Undo: Safety filter of all")
        lab.close()
        code = lab.ended()
        check(code == 0, f"exit code {code}: {lab.err.read_text()}")
        return "off, and on again"

    def sweeps(self):
        """A sweep of two keys in its panel, and a click into its map, which is undone."""
        shutil.copy(SCENES / "circle-three.toml", self.folder)
        lab = Lab(self, "circle-three.toml", "--paused")
        lab.still()
        lab.screen.click(*SWEEP)
        lab.still()
        self.see("sweep-choices")
        lab.screen.click(*START)
        told = lab.hears(r"^log .*Sweep of 81 runs: (\d+) meet", 180)
        check(10 < int(told.group(1)) < 71, told.group(0))
        lab.screen.move(*AWAY)
        lab.still()
        self.see("sweep-map")
        lab.screen.click(*CELL)
        lab.hears(r"^log .*From the sweep: law.k = ")
        law = tomllib.loads(wait("unsaved work", self.kept, 15))
        check(law["law"]["k"] > 10.0, f"the gain is {law['law']['k']}")
        lab.screen.move(*AWAY)
        lab.still()
        self.see("sweep-gone-to")
        lab.key("ctrl+z")
        lab.hears(r"^log .*Undo: From the sweep")
        lab.close()
        code = lab.ended()
        check(code == 0, f"exit code {code}: {lab.err.read_text()}")
        return told.group(0).removeprefix("log ")

    def drags_goal(self):
        """A goal, while nothing moves: the way on the ground leads to where it is put, at once."""
        scene = self.folder / "maze-three.toml"
        shutil.copy(SCENES / "maze-three.toml", scene)
        lab = Lab(self, scene.name, "--paused")
        lab.key("Escape")
        lab.still()
        # All of the maze, from above.
        lab.screen.xdotool("mousemove", 600, 400, "click", "--repeat", 7, "--delay", 80, 5)
        lab.screen.drag([(420, 480), (420, 500), (420, 550), (420, 590)], lambda: None)
        lab.screen.move(*AWAY)
        before = lab.still()
        self.see("goal")
        lab.key("p")
        name = lab.hears(r"^log .*Written: (.*\.png)", 60).group(1)
        numbers = [float(x) for x in texts(self.folder / name)["View"].partition(":")[2].split(",")]
        view = numbers[:3], numbers[3:6], math.radians(numbers[6])
        left, _, right, bottom = self.view()
        place = lambda x, y: tuple(map(round, self.pixel((left, VIEW_TOP, right, bottom), x, y, view)))
        # The last stretch of the way there was, and that of the way there is to be.
        around = lambda x, y: (x - 10, y - 8, x + 10, y + 8)
        old, new = around(*place(17.7, -1.7)), around(*place(16.6, -5.2))
        (x0, y0), (x1, y1) = place(20, 0), place(18, -6)
        path = [(round(x0 + k / 8 * (x1 - x0)), round(y0 + k / 8 * (y1 - y0))) for k in range(9)]

        def until():
            lab.hears(r"^log .*Goal of robot-1")
            lab.still()
            self.see("goal-in-the-drag")

        lab.screen.drag(path, until)
        lab.screen.move(*AWAY)

        def leads_there():
            look = lab.still()
            return look if look.differs(before, old) > 0.08 else None

        # The prediction tells where the new way leads.
        after = wait("the new way", leads_there, 30)
        self.see("goal-after-the-drag")
        goal = lambda text: tomllib.loads(text)["groups"][0]["path"]["pose"]
        now = goal(wait("unsaved work", self.kept, 10))
        # From so far above a pixel is a decimetre.
        there = math.dist(now[:2], (18.0, -6.0)) < 0.25 and now[2] == 0.0
        check(there, f"the goal is at {now}")
        for what, box in (("the old way is still there", old), ("there is no way to the new place", new)):
            moved = after.differs(before, box)
            check(moved > 0.08, f"{what}: {100 * moved:.1f} % of the pixels of {box} are others")
        lab.key("ctrl+s")
        lab.hears(r"^log .*Saved: .*maze-three.toml")
        check(goal(scene.read_text()) == now, "the file has not got it")
        lab.close()
        code = lab.ended()
        check(code == 0, f"exit code {code}: {lab.err.read_text()}")
        told = re.search(r"^from a change to its prediction: .*$", lab.out.read_text(), re.M)
        return told.group(0) if told else "there"

    def shows_faults(self):
        (self.folder / "broken.toml").write_text(self.shipped.replace("speed = 1.0", "sped = 1.0", 1))
        lab = Lab(self, "broken.toml", drawn=(244, 42, 960, 600), colours=20)
        told = lab.hears(r"^fault .*$").group(0)
        check("sped" in told, told)
        look = lab.still()
        self.see("broken")
        check(look.colours((0, 42, 1280, 200)) > 20, "the message is not seen")
        # The window is of use all the same.
        lab.key("ctrl+o")
        wait("the scenes", lambda: self.screen.look().colours() > look.colours() + 500, 20)
        self.see("broken-scenes")
        lab.close()
        code = lab.ended()
        check(code == 0, f"exit code {code}: {lab.err.read_text()}")
        return told.split(": ", 1)[1]

    def is_interrupted(self):
        lab = Lab(self, self.scene.name, "--paused")
        lab.process.send_signal(signal.SIGINT)
        code = lab.ended(20)
        check(code == 130, f"exit code {code}: {lab.err.read_text()}")
        return "exit code 130"

    def is_destroyed(self):
        lab = Lab(self, self.scene.name, "--paused")
        subprocess.run([sys.executable, "-c", DESTROY, str(lab.window)], env=self.environment, check=True)
        code, said = lab.ended(20), lab.err.read_text().strip()
        check(code == 3 and "another program destroyed the window" in said, f"exit code {code}: {said}")
        check("\n" not in said and "panick" not in said, f"not one line: {said}")
        return said

    def refuses(self):
        lines = []
        for words, environment in (
            ([self.scene.name], self.bare),
            ([self.scene.name], {**self.environment, "DISPLAY": ":4711"}),
            ([self.scene.name, "--adapter", "no such adapter"], self.environment),
        ):
            done = self.echelons("lab", *words, environment=environment)
            said = (done.stdout + done.stderr).strip()
            check(done.returncode == 3, f"exit code {done.returncode}: {said}")
            check(said and "\n" not in said and "panick" not in said, f"not one line: {said}")
            check(".cargo" not in said and ".rs:" not in said, f"a place of whoever built it: {said}")
            lines.append(said)
        return "exit code 3 each time:\n    " + "\n    ".join(lines)


def texts(path):
    """Text chunks of a PNG."""
    raw, at, found = path.read_bytes(), 8, {}
    while at < len(raw):
        length, kind = struct.unpack(">I4s", raw[at : at + 8])
        body = raw[at + 8 : at + 8 + length]
        at += 12 + length
        if kind not in (b"tEXt", b"zTXt", b"iTXt"):
            continue
        key, _, rest = body.partition(b"\0")
        if kind == b"zTXt":
            text = zlib.decompress(rest[1:]).decode("latin-1")
        elif kind == b"iTXt":
            packed, rest = rest[0], rest[2:].split(b"\0", 2)[2]
            text = (zlib.decompress(rest) if packed else rest).decode()
        else:
            text = rest.decode("latin-1")
        found[key.decode("latin-1")] = text
    return found


def main():
    began = time.monotonic()
    # Behind `&` and under nohup signals are ignored, and what is started would ignore them too.
    for number in (signal.SIGINT, signal.SIGHUP):
        signal.signal(number, signal.default_int_handler)
    echelon, artefacts = sys.argv[1], Path(sys.argv[2]).resolve()
    # Nothing but what an earlier run has left.
    for old in artefacts.glob("[0-9][0-9]-*.png"):
        old.unlink()
    work = Path(tempfile.mkdtemp(prefix="echelon-desktop-"))
    test = Test(echelon, artefacts, work)
    try:
        test.step("Opening a scene", test.opens)
        test.step("Doing nothing for 3 s", test.idles)
        test.step("Dragging a set point", test.drags)
        test.step("Running, going back, branching, changing a gain", test.branches)
        test.step("Saving", test.saves)
        test.step("Changing the file outside", test.reloads)
        test.step("Taking a picture", test.takes_picture)
        test.step("Filming 2 s", test.films)
        test.step("Keeping the run", test.keeps_run)
        test.step("Keeping it while it runs", test.keeps_run_while_it_runs)
        test.step("Closing", test.closes)
        test.step("Opening the picture", test.opens_picture)
        test.step("Killing the window, starting again", test.crashes)
        test.step("Dragging faster than the window draws", test.flicks)
        test.step("Typing faster than the window draws", test.types)
        test.step("Closing in the middle of a film", test.closes_in_a_film)
        test.step("Switching a safety filter", test.keeps_apart)
        test.step("Sweeping two keys", test.sweeps)
        test.step("Dragging a goal", test.drags_goal)
        test.step("Opening a broken scene", test.shows_faults)
        test.step("Ctrl C in the terminal", test.is_interrupted)
        test.step("Another program destroys the window", test.is_destroyed)
        test.step("Starting where there is no screen, and no such adapter", test.refuses)
    finally:
        if test.lab and test.lab.process.poll() is None:
            test.lab.process.kill()
            test.lab.process.wait()
        test.screen.close()
        for log in work.glob("*.txt"):
            shutil.copy(log, artefacts)
        shutil.rmtree(work, ignore_errors=True)
    verdict = "the window does what it should" if not test.failed else f"FAILED: {', '.join(test.failed)}"
    print(f"\nworked in the window for {time.monotonic() - began:.0f} s: {verdict}")
    print(f"pictures of it are in {artefacts}")
    sys.exit(bool(test.failed))


if __name__ == "__main__":
    main()
