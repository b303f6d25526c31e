"""Lets our planner and others plan for the same car on the same maps, and prints what they found side by side.

Usage: compare.py CAR PYTHON_ROBOTICS [--all], CAR the example of the crate `planning`, PYTHON_ROBOTICS a folder. Fails where
a way of ours is not what it should be, and where the check that planners are given is not Shapely's.
"""

import itertools
import os
import statistics
import sys
import time

import numpy as np
import others
from judge import Judge
from problem import Problem

COUNTS = (20, 50, 100)
OURS = ("ours", "ours, forwards only")
FEWER_MAPS, ALL_MAPS = 20, 100
OMPL_SECONDS, LITTLE, PYTHON_SECONDS = 1.0, 0.1, 20.0
LONGER = 1.3  # times the shortest of the others: worth a look


class Row:
    """What one planner did on the maps of one kind, map by map: a verdict of the judge, or None."""

    def __init__(self):
        self.verdicts, self.seconds, self.checks = [], [], []

    def add(self, verdict, seconds, checks):
        self.verdicts.append(verdict)
        self.seconds.append(seconds)
        self.checks.append(checks)

    def line(self, count, name, ours):
        found = [verdict for verdict in self.verdicts if verdict]
        pairs = [(a, b) for a, b in zip(self.verdicts, ours.verdicts, strict=True) if a and b]
        ratios = [a["length"] / b["length"] for a, b in pairs]
        wrong = {fault: sum(fault in verdict["wrong"] for verdict in found) for fault in ("clearance", "curvature", "ends")}
        cells = [
            count,
            name,
            f"{len(found)} of {len(self.verdicts)}",
            f"{median([verdict['length'] for verdict in found]):.1f} m",
            f"{median(ratios):.3f}",
            f"{sum(ratio < 0.999 for ratio in ratios)}, {sum(ratio > 1.001 for ratio in ratios)}",
            f"{statistics.fmean([verdict['about'] for verdict in found] or [0]):.1f}",
            f"{1e3 * median(self.seconds):.0f} ms",
            f"{1e3 * max(self.seconds):.0f} ms",
            f"{median(self.checks):.0f}" if any(self.checks) else "",
            ", ".join(f"{fault} {times}" for fault, times in wrong.items() if times) or "none",
        ]
        return "| " + " | ".join(map(str, cells)) + " |"


def median(values):
    return statistics.median(values) if values else float("nan")


def check_the_check(problem, judge, poses=300):
    """Whether a pose is clear, as planners are told and as Shapely says."""
    draws = np.random.default_rng(problem.seed)
    low, high = np.min(problem.ground, axis=0), np.max(problem.ground, axis=0)
    poses = np.column_stack([draws.uniform(low, high, (poses, 2)), draws.uniform(-np.pi, np.pi, poses)])
    for pose, clearance in zip(poses, judge.clearances(poses), strict=True):
        if problem.is_clear(*pose) != (clearance >= problem.clearance) and abs(clearance - problem.clearance) > 1e-9:
            sys.exit(f"{problem.count} obstacles, seed {problem.seed}: Shapely finds {clearance} m at {pose}")


def timed(planner, problem, seconds):
    """What a planner found; the time at work, s; how many poses were checked for it."""
    problem.checks = 0
    begun = time.process_time()
    found = planner(problem, seconds)
    return found, time.process_time() - begun, problem.checks


def main():
    car, folder = sys.argv[1:3]
    maps = ALL_MAPS if "--all" in sys.argv[3:] else FEWER_MAPS
    others.quiet_and_seeded(1)
    hybrid = others.PythonRobotics(folder, Problem(car, COUNTS[0], 1))
    planners = {
        f"OMPL RRTConnect, simplified, {OMPL_SECONDS:.0f} s at most": (others.rrt_connect, OMPL_SECONDS),
        f"OMPL Informed RRT*, {LITTLE:.1f} s": (others.informed_rrt_star, LITTLE),
        f"OMPL Informed RRT*, {OMPL_SECONDS:.0f} s": (others.informed_rrt_star, OMPL_SECONDS),
        f"PythonRobotics hybrid A*, {PYTHON_SECONDS:.0f} s at most": (hybrid, PYTHON_SECONDS),
    }
    print("| obstacles | planner | found | length | to ours | shorter, longer | turns about | time | worst | checks | faults |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    notes, faults, check_seconds, check_count = [], [], 0.0, 0
    durations, stopping = {name: [] for name in OURS}, dict.fromkeys(OURS, 0)
    for count in COUNTS:
        rows = {name: Row() for name in [*OURS, *planners]}
        for seed in range(1, maps + 1):
            problem = Problem(car, count, seed)
            judge = Judge(problem)
            check_the_check(problem, judge)
            for name, read in problem.plans.items():
                plan = read["plan"]
                rows[name].add(judge.judge(plan["poses"]) if plan else None, read["seconds"], 0)
                if plan:
                    durations[name].append(plan["duration"])
                    stopping[name] += any(a == b for a, b in itertools.pairwise(plan["backwards"]))
            for name, (planner, seconds) in planners.items():
                found, taken, checks = timed(planner, problem, seconds)
                if found is not None and not isinstance(found, list):
                    found = others.poses_of_ompl(found)
                rows[name].add(judge.judge(found) if found else None, taken, checks)
                check_seconds += taken
                check_count += checks
            told = {name: row.verdicts[-1] for name, row in rows.items()}
            where = f"{count} obstacles, seed {seed}"
            sound = [told[name] for name in planners if told[name] and not told[name]["wrong"]]
            shortest = min((verdict["length"] for verdict in sound), default=float("inf"))
            for name in OURS:
                if told[name] and told[name]["wrong"]:
                    faults.append(f"{where}, {name}: {told[name]}")
                if sound and not told[name]:
                    notes.append(f"{where}, {name}: no way, another's is {shortest:.1f} m: {problem.plans[name]['reason']}")
                if told[name] and told[name]["length"] > LONGER * shortest:
                    notes.append(f"{where}, {name}: {told[name]['length']:.1f} m, another's is {shortest:.1f} m")
        for name, row in rows.items():
            print(row.line(count, name, rows[OURS[0]]), flush=True)
    print(f"\nA check took the others {1e6 * check_seconds / max(check_count, 1):.0f} µs, with all that they did besides.")
    for name in OURS:
        mean, plans = statistics.fmean(durations[name] or [0]), len(durations[name])
        print(f"{name}: {stopping[name]} of {plans} stop to steer, and go on in the same direction; {mean:.1f} s on average.")
    print("\n".join(notes) or f"No map where only others find a way, or one that is shorter by more than {LONGER}.")
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    code = main()
    sys.stdout.flush()
    # Not by way of OMPL's bindings, which list on their way out what they have not let go.
    os._exit(code)
