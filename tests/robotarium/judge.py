"""Plays the commands of a recorded run through the rules of the Robotarium, and counts what that testbed would refuse.

Usage: judge.py RUN, with tables as CSV. Prints as JSON how many samples break each rule, and what came nearest to it. Rules
and numbers are those of `_validate` and `step` in robotarium/robotarium_python_simulator, rps/robotarium_abc.py: robots are
unicycles, moved by Euler steps of their held velocities; points a little ahead of their wheels stay apart, the wheels' middles
stay inside the arena, and no wheel turns faster than its motor can. Nothing of Echelon takes part but the poses at the start
and the commands that were applied.
"""

import csv
import json
import math
import sys
from pathlib import Path

STEP = 0.033  # s
ARENA = (-1.6, -1.0, 1.6, 1.0)  # m
AHEAD, APART = 0.025, 0.135  # m: from the wheels to the points, and between two of these
WHEEL_RADIUS, BASE, WHEEL_MAX = 0.016, 0.105, 0.2 / 0.016  # m, m, rad/s


def rows(run, table):
    with open(run / "tables" / f"{table}.csv", newline="") as file:
        return list(csv.DictReader(file))


def commands(run):
    """Per sample and robot: what was applied, [m/s², rad/s]: by its filter, or else by its law, or else by its path."""
    found = {}
    for table, name in (("robots", "robot"), ("edges", "follower"), ("safety", "robot")):
        prefix = "" if table == "robots" else "applied_"
        path = run / "tables" / f"{table}.csv"
        for row in rows(run, table) if path.exists() else []:
            command = (float(row[f"{prefix}acceleration_m_s2"]), float(row[f"{prefix}turn_rate_rad_s"]))
            found.setdefault(float(row["time_s"]), {})[row[name]] = command
    return [found[time] for time in sorted(found)]


def start(run):
    """[x, y, heading, speed] of every robot."""
    first = [row for row in rows(run, "robots") if float(row["time_s"]) == 0.0]
    keys = ("x_m", "y_m", "heading_rad", "speed_m_s")
    return {row["robot"]: [float(row[key]) for key in keys] for row in first}


def play(robots, samples):
    """How many samples break each rule, and the least room, in m and rad/s."""
    broken = {"collision": 0, "boundary": 0, "actuator": 0}
    room = dict.fromkeys(broken, math.inf)

    def judge(rule, margins):
        least = min(margins, default=math.inf)
        room[rule] = min(room[rule], least)
        broken[rule] += least < 0.0

    for sample in samples:
        # A velocity is held for a step; of one that changes, the mean is.
        held = {}
        for name, (acceleration, turn_rate) in sample.items():
            held[name] = (robots[name][3] + 0.5 * STEP * acceleration, turn_rate)
            robots[name][3] += STEP * acceleration
        points = [(x + AHEAD * math.cos(a), y + AHEAD * math.sin(a)) for x, y, a, _ in robots.values()]
        pairs = [math.dist(p, q) for k, p in enumerate(points) for q in points[:k]]
        judge("collision", [distance - APART for distance in pairs])
        x0, y0, x1, y1 = ARENA
        judge("boundary", [min(x - x0, y - y0, x1 - x, y1 - y) for x, y, _, _ in robots.values()])
        wheels = [(abs(v) + 0.5 * BASE * abs(turn)) / WHEEL_RADIUS for v, turn in held.values()]
        judge("actuator", [WHEEL_MAX - wheel for wheel in wheels])
        for name, (v, turn) in held.items():
            x, y, heading, speed = robots[name]
            x, y = x + STEP * v * math.cos(heading), y + STEP * v * math.sin(heading)
            robots[name] = [x, y, heading + STEP * turn, speed]
    return {"samples": len(samples), "broken": broken, "room": room, "end": robots}


def main():
    run = Path(sys.argv[1])
    result = play(start(run), commands(run))
    # Where the testbed's robots are in the end, and where ours are: by Euler steps they drift.
    last = rows(run, "robots")[-len(result["end"]) :]
    off = [math.dist(result["end"][row["robot"]][:2], (float(row["x_m"]), float(row["y_m"]))) for row in last]
    result["off"] = max(off)
    del result["end"]
    print(json.dumps(result))


main()
