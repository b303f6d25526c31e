"""Judges ways that any planner found, by Shapely and by nothing that planners were given: clearance, curvature, ends, length."""

import math

import numpy as np
import shapely

STEP = 0.05  # m between poses at most
SLACK = 0.01  # m and rad: what ways may be off at their ends, and nearer than they should be between poses
STEEPER = 1.02  # times the largest curvature: turns are seen by chords


class Judge:
    def __init__(self, problem):
        self.problem = problem
        self.ground = shapely.Polygon(problem.ground)
        corners = [obstacle["corners"] for obstacle in problem.obstacles]
        self.cores = np.array([shapely.Polygon(c) if len(c) > 1 else shapely.Point(c[0]) for c in corners])
        self.radii = np.array([obstacle["radius"] for obstacle in problem.obstacles])
        self.tree = shapely.STRtree(self.cores)

    def clearances(self, poses):
        """Of the car at every pose, m; no more than 1 m."""
        problem = self.problem
        ends = ((-problem.back, -1), (problem.front, -1), (problem.front, 1), (-problem.back, 1))
        local = np.array([(x, side * problem.half_width) for x, side in ends])
        c, s = np.cos(poses[:, 2, None]), np.sin(poses[:, 2, None])
        xs = poses[:, 0, None] + c * local[:, 0] - s * local[:, 1]
        ys = poses[:, 1, None] + s * local[:, 0] + c * local[:, 1]
        bodies = shapely.polygons(np.stack([xs, ys], axis=-1))
        within = shapely.contains(self.ground, bodies)
        least = np.where(within, shapely.distance(self.ground.exterior, bodies), 0.0)
        body, near = self.tree.query(bodies, predicate="dwithin", distance=1.0 + self.radii.max())
        apart = shapely.distance(bodies[body], self.cores[near]) - self.radii[near]
        np.minimum.at(least, body, apart)
        return np.minimum(least, 1.0)

    def judge(self, poses):
        """What is wrong with a way, in words; its length, m, and how often the car turns about."""
        poses = apart(np.array(poses))
        moved, turned = np.diff(poses[:, :2], axis=0), wrapped(np.diff(poses[:, 2]))
        length = np.hypot(*moved.T)
        middle = poses[:-1, 2] + 0.5 * turned
        side = np.sign(moved[:, 0] * np.cos(middle) + moved[:, 1] * np.sin(middle))
        # A step in which the car turns about is shorter than its way: the steps around it say nothing of the curvature.
        about = np.flatnonzero(side[1:] != side[:-1])
        sound = np.ones(len(side), dtype=bool)
        sound[np.concatenate([about, about + 1])] = False
        curvature = np.max(np.abs(turned[sound]) / length[sound], initial=0.0)
        clearance = self.clearances(dense(poses)).min()
        ends = []
        for pose, wanted in ((poses[0], self.problem.start), (poses[-1], self.problem.goal)):
            ends += [math.dist(pose[:2], wanted[:2]), abs(wrapped(pose[2] - wanted[2]))]
        wrong = []
        if clearance < self.problem.clearance - SLACK:
            wrong.append("clearance")
        if curvature > STEEPER / self.problem.radius:
            wrong.append("curvature")
        if max(ends) > SLACK:
            wrong.append("ends")
        return {"length": length.sum(), "about": len(about), "clearance": clearance, "wrong": wrong}


def wrapped(angle):
    return (angle + np.pi) % (2 * np.pi) - np.pi


def apart(poses):
    """Without poses twice in a row, and with headings that do not jump."""
    poses = poses[np.concatenate([[True], np.hypot(*np.diff(poses[:, :2], axis=0).T) > 1e-6])]
    poses[:, 2] = np.unwrap(poses[:, 2])
    return poses


def dense(poses):
    """With as many poses between as it takes."""
    parts = max(1, math.ceil(np.hypot(*np.diff(poses[:, :2], axis=0).T).max() / STEP))
    at = np.arange((len(poses) - 1) * parts + 1) / parts
    return np.stack([np.interp(at, np.arange(len(poses)), column) for column in poses.T], axis=1)
