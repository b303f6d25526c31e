"""A map for a car, as the example `car` prints it, and whether the car is clear of everything at a pose.

This is the check that all other planners are given. A pose is clear where the car's rectangle is as far from every obstacle and
from the edge of the ground as the map wants it; distances are exact. It is called a hundred thousand times a second, and so does
without numpy, whose calls would take longer than the sums.
"""

import json
import math
import subprocess

CELL = 0.5  # m: obstacles that can matter are listed by cells of this size


class Problem:
    def __init__(self, car, count, seed):
        read = planned(car, count, seed)
        self.count, self.seed = count, seed
        self.clearance, self.radius = read["clearance"], read["radius"]
        self.front, self.back, self.half_width = read["front"], read["back"], read["half_width"]
        self.wheelbase, self.steering = read["wheelbase"], read["steering"]
        self.start, self.goal, self.ground = read["start"], read["goal"], read["ground"]
        self.obstacles = read["obstacles"]
        self.plans = {"ours": read, "ours, forwards only": planned(car, count, seed, "forwards")}
        self.checks = 0
        self.half_length = 0.5 * (self.front + self.back)
        self.ahead = 0.5 * (self.front - self.back)  # of the reference point the middle is
        self.discs, self.boxes, self.near = [], [], {}
        for obstacle in self.obstacles:
            corners, radius = obstacle["corners"], obstacle["radius"]
            if len(corners) == 1:
                self.discs.append((*corners[0], radius))
            elif len(corners) == 4 and radius == 0.0:
                self.boxes.append(box(corners))
            else:
                raise ValueError(f"neither a disc nor a box: {obstacle}")
        self.sides = list(zip(self.ground, self.ground[1:] + self.ground[:1], strict=True))

    def is_clear(self, x, y, heading):
        self.checks += 1
        c, s = math.cos(heading), math.sin(heading)
        length, width, clearance = self.half_length, self.half_width, self.clearance
        x, y = x + self.ahead * c, y + self.ahead * s
        cell = (math.floor(x / CELL), math.floor(y / CELL))
        near = self.near.get(cell)
        if near is None:
            near = self.near[cell] = self.near_cell(cell)
        sides, discs, boxes = near
        for px, py, nx, ny in sides:
            reach = length * abs(nx * c + ny * s) + width * abs(ny * c - nx * s)
            if (x - px) * nx + (y - py) * ny - reach < clearance:
                return False
        for ox, oy, radius in discs:
            ox, oy = ox - x, oy - y
            if outside(ox * c + oy * s, oy * c - ox * s, length, width) - radius < clearance:
                return False
        return all(self.is_clear_of(box, x, y, c, s) for box in boxes)

    def is_clear_of(self, box, x, y, c, s):
        """Whether a rectangle around a point is clear of a box: by the axes of both, then by corners."""
        ox, oy, bc, bs, a, b, corners = box
        length, width = self.half_length, self.half_width
        dx, dy = ox - x, oy - y
        rc, rs = abs(c * bc + s * bs), abs(c * bs - s * bc)
        apart = max(
            abs(dx * c + dy * s) - length - a * rc - b * rs,
            abs(dy * c - dx * s) - width - a * rs - b * rc,
            abs(dx * bc + dy * bs) - a - length * rc - width * rs,
            abs(dy * bc - dx * bs) - b - length * rs - width * rc,
        )
        if apart >= self.clearance or apart < 0.0:
            return apart >= self.clearance
        theirs = (((px - x) * c + (py - y) * s, (py - y) * c - (px - x) * s) for px, py in corners)
        if any(outside(px, py, length, width) < self.clearance for px, py in theirs):
            return False
        for u, v in ((length, width), (length, -width), (-length, width), (-length, -width)):
            px, py = u * c - v * s - dx, u * s + v * c - dy
            if outside(px * bc + py * bs, py * bc - px * bs, a, b) < self.clearance:
                return False
        return True

    def near_cell(self, cell):
        """Sides, discs and boxes that a car with its middle in a cell can be too near to."""
        x, y = ((index + 0.5) * CELL for index in cell)
        far = math.hypot(self.half_length, self.half_width) + self.clearance + 0.71 * CELL
        sides = []
        for (px, py), (qx, qy) in self.sides:  # counter-clockwise: inwards is to the left
            size = math.hypot(qx - px, qy - py)
            nx, ny = (py - qy) / size, (qx - px) / size
            if (x - px) * nx + (y - py) * ny < far:
                sides.append((px, py, nx, ny))
        discs = [disc for disc in self.discs if math.hypot(disc[0] - x, disc[1] - y) - disc[2] < far]
        boxes = [box for box in self.boxes if math.hypot(box[0] - x, box[1] - y) - math.hypot(box[4], box[5]) < far]
        return sides, discs, boxes


def planned(car, count, seed, *how):
    """A map and our plan for it."""
    call = subprocess.run([car, str(count), str(seed), *how], check=True, capture_output=True, text=True)
    return json.loads(call.stdout)


def box(corners):
    """Middle, axis, half length and width, and corners of a box."""
    (ax, ay), (bx, by), (cx, cy), _ = corners
    length, width = math.hypot(bx - ax, by - ay), math.hypot(cx - bx, cy - by)
    return 0.5 * (ax + cx), 0.5 * (ay + cy), (bx - ax) / length, (by - ay) / length, 0.5 * length, 0.5 * width, corners


def outside(x, y, length, width):
    """Distance of a point to a rectangle around the origin, 0 within."""
    return math.hypot(max(abs(x) - length, 0.0), max(abs(y) - width, 0.0))
