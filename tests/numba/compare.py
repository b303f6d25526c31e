"""Times a study of circle-three beside the same study in Numba, in turns, and prints both.

Usage: compare.py ECHELON [--runs 10000] [--pairs 5] [--substeps 10]

A leader on a circle and two followers under output feedback with a high-gain observer, 15 s, law every 10 ms, each follower
started within 0.3 m of its place along each axis. The Numba side is what one would write by hand: the equations of docs/laws.md,
the classical Runge-Kutta method with `--substeps` steps to a period, all runs side by side on all cores. It fails where the
errors at the end of any run differ from those of the program by more than TOLERANCE.

What is timed is not all the same. The program is timed from its start to its end; it looks for contacts in every run, computes
the metrics of its rows, and writes them, their summary and a report. Numba is timed without its compilation, and keeps nothing
but the errors at the end.
"""

import argparse
import math
import os
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np
import pyarrow.parquet as pq
from numba import njit, prange

# m and rad, in the errors at the end of a run: a fiftieth of what the outer follower is left with.
TOLERANCE = 1e-4
SCENE, SPREAD = "circle-three", 0.3
# Starts of the followers, m, and their set points, m and rad.
STARTS = np.array([[-2.0, -1.0], [-2.0, 1.0]])
WANTED = np.array([[2.0, math.radians(-135)], [2.0, math.radians(135)]])
START_SPEED = 0.01
# The scene: leader, law, observer and limits.
SPEED, TURN_RATE = 1.0, 0.3
K, BETA, SLOPE = 5.0, 5.0, 24.53
EPSILON, ALPHA1, ALPHA2 = 1e-3, 2.0, 1.0
SPEED_MIN, SPEED_MAX, TURN_RATE_MAX = 0.01, 1.6, 11.5
PERIOD, DURATION = 0.01, 15.0


@njit(fastmath=True)
def wrapped(angle):
    """An angle in [-pi, pi)."""
    return angle - 2 * math.pi * math.floor((angle + math.pi) / (2 * math.pi))


@njit(fastmath=True)
def relative(x, y, ahead, left, time):
    """Distance and bearing of a follower, cosine and sine of its view angle, eqs 2-4; the leader is on its circle.

    `ahead` and `left` are cosine and sine of the heading.
    """
    lead = TURN_RATE * time
    radius = SPEED / TURN_RATE
    dx, dy = radius * math.sin(lead) - x, radius * (1 - math.cos(lead)) - y
    distance = math.sqrt(dx * dx + dy * dy)
    bearing = wrapped(math.pi + math.atan2(dy, dx) - lead)
    return distance, bearing, -(dx * ahead + dy * left) / distance, -(dy * ahead - dx * left) / distance


@njit(fastmath=True)
def law(state, time, wanted):
    """Acceleration and turn rate by output feedback, eq 42 with tanh for sign, before limits."""
    distance, bearing, c, s = relative(state[0], state[1], math.cos(state[2]), math.sin(state[2]), time)
    speed, rate, turn = max(state[3], SPEED_MIN), state[6], state[7]
    e0, e1 = wanted[0] - distance, wrapped(wanted[1] - bearing)
    b0 = -speed**2 / distance + speed * c / distance * rate - 2 * K * rate + K**2 * e0 + BETA * math.tanh(SLOPE * e0)
    b1 = -2 * speed * s / distance**2 * rate - 2 * K * turn + K**2 * e1 + BETA * math.tanh(SLOPE * e1)
    # The inverse of g, whose determinant is speed / distance.
    return c * b0 - distance * s * b1, (s * b0 + distance * c * b1) / speed


@njit(fastmath=True)
def rates(state, time, begun, free, acceleration, turn_rate, out):
    """Rates of x, y, heading and the four numbers of the observer, eqs 1, 31 and 32; `free` is the speed at `begun`."""
    unbounded = free + acceleration * (time - begun)
    speed = min(max(unbounded, SPEED_MIN), SPEED_MAX)
    acts = acceleration if speed == unbounded else 0.0
    ahead, left = math.cos(state[2]), math.sin(state[2])
    distance, bearing, c, s = relative(state[0], state[1], ahead, left, time)
    out[0], out[1], out[2] = speed * ahead, speed * left, turn_rate
    off0, off1 = distance - state[4], wrapped(bearing - state[5])
    out[4] = state[6] + ALPHA1 / EPSILON * off0
    out[5] = state[7] + ALPHA1 / EPSILON * off1
    push = speed * c / distance
    out[6] = c * acts + speed * s * turn_rate + speed**2 / distance - push * state[6] + ALPHA2 / EPSILON**2 * off0
    out[7] = (-s * acts / distance + push * turn_rate + 2 * speed * s / distance**2 * state[6] + ALPHA2 / EPSILON**2 * off1)


@njit(fastmath=True)
def follower(x, y, wanted, substeps):
    """Errors of a follower at the end of a run, m and rad."""
    state, middle = np.zeros(8), np.zeros(8)
    k1, k2, k3, k4 = np.zeros(8), np.zeros(8), np.zeros(8), np.zeros(8)
    state[0], state[1], state[3] = x, y, START_SPEED
    state[4], state[5], _, _ = relative(x, y, 1.0, 0.0, 0.0)
    step = PERIOD / substeps
    for sample in range(round(DURATION / PERIOD)):
        begun = sample * PERIOD
        acceleration, turn_rate = law(state, begun, wanted)
        turn_rate = min(max(turn_rate, -TURN_RATE_MAX), TURN_RATE_MAX)
        free = state[3]
        for substep in range(substeps):
            time = begun + substep * step
            rates(state, time, begun, free, acceleration, turn_rate, k1)
            for i in range(8):
                middle[i] = state[i] + 0.5 * step * k1[i]
            rates(middle, time + 0.5 * step, begun, free, acceleration, turn_rate, k2)
            for i in range(8):
                middle[i] = state[i] + 0.5 * step * k2[i]
            rates(middle, time + 0.5 * step, begun, free, acceleration, turn_rate, k3)
            for i in range(8):
                middle[i] = state[i] + step * k3[i]
            rates(middle, time + step, begun, free, acceleration, turn_rate, k4)
            for i in range(8):
                state[i] += step / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i])
        state[3] = min(max(free + acceleration * PERIOD, SPEED_MIN), SPEED_MAX)
    distance, bearing, _, _ = relative(state[0], state[1], 1.0, 0.0, DURATION)
    return wanted[0] - distance, wrapped(wanted[1] - bearing)


@njit(parallel=True, fastmath=True)
def study(starts, wanted, substeps):
    """The largest errors of both followers at the end of every run."""
    found = np.zeros((len(starts), 2))
    for run in prange(len(starts)):
        for one in range(2):
            distance, bearing = follower(starts[run, one, 0], starts[run, one, 1], wanted[one], substeps)
            found[run, 0] = max(found[run, 0], abs(distance))
            found[run, 1] = max(found[run, 1], abs(bearing))
    return found


def keys():
    """The numbers that are drawn, each with the middle of its range."""
    return {f"robots.follower-{one + 1}.pose.{axis}": STARTS[one, axis] for one in range(2) for axis in range(2)}


def timed(work):
    """What some work returns; the time it took, and the time of all processors that it took, s."""
    begun, before = time.perf_counter(), os.times()
    found = work()
    taken, after = time.perf_counter() - begun, os.times()
    return found, (taken, sum(after[:4]) - sum(before[:4]))


def sweep(program, runs, folder):
    """Makes the study with the program."""
    vary = [f"--vary={key}=uniform:{middle - SPREAD}..{middle + SPREAD}" for key, middle in keys().items()]
    command = [program, "sweep", SCENE, *vary, "--samples", str(runs), "--quiet", "--force", "-o", folder]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{done.stderr.strip()}")


def spread(values, digits):
    """The median of some numbers, with their range."""
    return f"{statistics.median(values):.{digits}f} ({min(values):.{digits}f} to {max(values):.{digits}f})"


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("program", metavar="ECHELON", help="the program")
    arguments.add_argument("--runs", type=int, default=10_000, help="runs of the study")
    arguments.add_argument("--pairs", type=int, default=5, help="measurements of each side")
    arguments.add_argument("--substeps", type=int, default=10, help="steps of Runge-Kutta in a period of the law")
    given = arguments.parse_args()
    if min(given.runs, given.pairs, given.substeps) < 1:
        arguments.error("runs, pairs and substeps are 1 at least")
    ours, theirs = [], []
    with tempfile.TemporaryDirectory() as folder:
        sweep(given.program, given.runs, folder)
        rows = pq.read_table(os.path.join(folder, "runs.parquet"))
        starts = np.column_stack([np.asarray(rows[key], float) for key in keys()]).reshape(-1, 2, 2)
        told = np.column_stack([rows["final_distance_error_m"], rows["final_bearing_error_rad"]])
        found = study(starts, WANTED, given.substeps)
        off = np.abs(np.abs(told) - found).max(axis=0)
        print(f"{len(starts)} runs; errors at the end differ by {off[0]:.1e} m and {off[1]:.1e} rad at most")
        if not (off <= TOLERANCE).all():
            sys.exit(f"that is more than {TOLERANCE:g}: it is not the same study")
        for _ in range(given.pairs):
            ours.append(timed(lambda: sweep(given.program, given.runs, folder))[1])
            theirs.append(timed(lambda: study(starts, WANTED, given.substeps))[1])
    print(f"{os.cpu_count()} processors, {given.pairs} pairs, {given.substeps} steps of Runge-Kutta to a period; medians (ranges)")
    for which, what in enumerate(("s", "s of processors")):
        a, b = ([both[which] for both in side] for side in (ours, theirs))
        ratios = [their / our for our, their in zip(a, b, strict=True)]
        print(f"echelon sweep {spread(a, 1)} {what}, Numba {spread(b, 1)} {what}: {spread(ratios, 2)} times as much")


main()
