"""Planners that nobody here wrote, each a function of a problem and a number of seconds: OMPL's, and PythonRobotics' hybrid A*.

They return poses, or None. All have the car's turning circle, may reverse, and are given `Problem.is_clear`. Seconds are those
that the processor is at work, so that what else runs on the machine takes nothing from them.
"""

import contextlib
import functools
import io
import math
import signal
import sys
import time

from ompl import base, geometric, util

STEP = 0.05  # m between poses that are checked
FINE = 0.01  # m between poses that are returned: the car may turn about twice on short ways


def quiet_and_seeded(seed):
    util.setLogLevel(util.LOG_NONE)
    util.RNG.setSeed(seed)


def ompl(kind, simplifies, problem, seconds):
    """Reeds' and Shepp's ways between samples."""
    space = base.ReedsSheppStateSpace(problem.radius)
    bounds = base.RealVectorBounds(2)
    for index in range(2):
        values = [corner[index] for corner in problem.ground]
        bounds.setLow(index, min(values))
        bounds.setHigh(index, max(values))
    space.setBounds(bounds)
    setup = geometric.SimpleSetup(space)
    setup.setStateValidityChecker(lambda state: problem.is_clear(state.getX(), state.getY(), state.getYaw()))
    ends = []
    for x, y, heading in (problem.start, problem.goal):
        state = space.allocState()
        state.setX(x)
        state.setY(y)
        state.setYaw(heading)
        ends.append(state)
    setup.setStartAndGoalStates(*ends)
    information = setup.getSpaceInformation()
    information.setStateValidityCheckingResolution(STEP / space.getMaximumExtent())
    setup.setPlanner(kind(information))
    until = time.process_time() + seconds
    over = base.PlannerTerminationCondition(lambda: time.process_time() > until)
    setup.solve(over)
    if not setup.haveExactSolutionPath():
        return None
    if simplifies:
        setup.simplifySolution(over)
    return setup.getSolutionPath()


def poses_of_ompl(path):
    path.interpolate(max(2, math.ceil(path.length() / FINE)))
    states = [path.getState(index) for index in range(path.getStateCount())]
    return [(state.getX(), state.getY(), state.getYaw()) for state in states]


rrt_connect = functools.partial(ompl, geometric.RRTConnect, True)
informed_rrt_star = functools.partial(ompl, geometric.InformedRRTstar, False)


class TooLong(Exception):
    pass


def too_long(*_):
    raise TooLong


class PythonRobotics:
    """Its car at half its size, and so with half its lengths of grid and of motion; costs and angles are its own."""

    def __init__(self, folder, problem):
        sys.path[:0] = [f"{folder}", f"{folder}/PathPlanning/HybridAStar"]
        import car
        import hybrid_a_star

        self.planner = hybrid_a_star
        hybrid_a_star.show_animation = False
        hybrid_a_star.WB = problem.wheelbase
        hybrid_a_star.MAX_STEER = problem.steering
        hybrid_a_star.BUBBLE_R = math.hypot(problem.half_length, problem.half_width)
        hybrid_a_star.XY_GRID_RESOLUTION *= 0.5
        hybrid_a_star.MOTION_RESOLUTION *= 0.5
        hybrid_a_star.move = functools.partial(car.move, L=problem.wheelbase)

    def __call__(self, problem, seconds):
        def are_clear(xs, ys, headings, *_):
            return all(map(problem.is_clear, xs, ys, headings))

        # What it plans with is checked as everybody's; its estimate has points on the boundaries.
        self.planner.check_car_collision = are_clear
        xs, ys = map(list, zip(*boundary_points(problem), strict=True))
        signal.signal(signal.SIGVTALRM, too_long)
        signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
        try:
            with contextlib.redirect_stdout(io.StringIO()):
                path = self.planner.hybrid_a_star_planning(
                    list(problem.start),
                    list(problem.goal),
                    xs,
                    ys,
                    self.planner.XY_GRID_RESOLUTION,
                    self.planner.YAW_GRID_RESOLUTION,
                )
        except TooLong:
            return None
        finally:
            signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        return list(zip(path.x_list, path.y_list, path.yaw_list, strict=True)) or None


def boundary_points(problem, step=0.25):
    """Points on everything that a car can touch."""
    for ring in [problem.ground] + [obstacle["corners"] for obstacle in problem.obstacles if not obstacle["radius"]]:
        for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1], strict=True):
            parts = math.ceil(math.hypot(bx - ax, by - ay) / step)
            for k in range(parts):
                yield ax + (bx - ax) * k / parts, ay + (by - ay) * k / parts
    for x, y, radius in problem.discs:
        parts = max(8, math.ceil(2 * math.pi * radius / step))
        for k in range(parts):
            angle = 2 * math.pi * k / parts
            yield x + radius * math.cos(angle), y + radius * math.sin(angle)
