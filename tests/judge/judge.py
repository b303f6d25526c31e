"""Holds exported data sets against pupil-apriltags and OpenCV: ids, corners and poses.

Usage: judge.py FOLDER…, each written by `echelon dataset`. Exits with 1 where something does not hold.
"""

import contextlib
import io
import json
import sys
import time
from pathlib import Path

import cv2
import numpy as np
from pupil_apriltags import Detector
from pycocotools.coco import COCO

# Of the tags that another detector finds, so many may be missed by ours.
MISSED = 0.02
# Two poses agree if they differ by no more than this times the error of the other's, RMS.
AGREE = 1.25
# Below these, RMS range in m, bearing and heading in rad, nobody is told to be worse.
FLOOR = np.array([1e-4, 2e-5, 2e-4])
# Corners that are off by more pixels belong to another tag.
ASTRAY = 8.0
# Tags that cover less of a picture, in square pixels, have no mask.
SLIVER = 25.0


class Pupil:
    """The reference implementation of AprilTag 3. Its pixels' middles are at 0.5, its corners begin at the bottom left."""

    name = "pupil-apriltags"

    def __init__(self):
        self.detector = Detector(families="tag36h11", quad_decimate=1.0, nthreads=2)

    def find(self, picture):
        return [(t.tag_id, t.corners[::-1] - 0.5) for t in self.detector.detect(picture)]


class Aruco:
    """OpenCV's own detector."""

    name = "OpenCV aruco"

    def __init__(self):
        parameters = cv2.aruco.DetectorParameters()
        parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
        family = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11)
        self.detector = cv2.aruco.ArucoDetector(family, parameters)

    def find(self, picture):
        corners, ids, _ = self.detector.detectMarkers(picture)
        ids = [] if ids is None else ids.ravel().tolist()
        # In OpenCV's dictionary tags stand on their heads.
        return [(i, np.roll(c.reshape(4, 2), 2, axis=0)) for i, c in zip(ids, corners)]


def rigid(frame):
    return np.array(frame["rotation"]), np.array(frame["translation"])


def rms(errors):
    errors = np.asarray(errors, float)
    return np.sqrt(np.mean(errors**2, axis=0)) if len(errors) else np.full(errors.shape[1:], np.nan)


def wrap(angle):
    return (angle + np.pi) % (2 * np.pi) - np.pi


def planar_errors(pose, truth):
    """Errors of [x, y, heading] in range, bearing and heading."""
    polar = lambda p: np.array([np.hypot(p[0], p[1]), np.arctan2(p[1], p[0]), p[2]])
    error = polar(pose) - polar(truth)
    error[1:] = wrap(error[1:])
    return error


def numbers(pose):
    return np.array([pose[key] for key in ("x", "y", "heading")])


def leader_pose(camera, picture, points, pixels):
    """The leader in the follower's frame by SQPnP and Levenberg-Marquardt: whoever solves is told nothing of a plane."""
    matrix = np.array([[camera["fx"], 0, camera["cx"]], [0, camera["fy"], camera["cy"]], [0, 0, 1]])
    distortion = np.array(camera["distortion"])
    found, turn, shift = cv2.solvePnP(points, pixels, matrix, distortion, flags=cv2.SOLVEPNP_SQPNP)
    if not found:
        return None
    turn, shift = cv2.solvePnPRefineLM(points, pixels, matrix, distortion, turn, shift)
    rotation, translation = rigid(picture["body_from_camera"])
    body = rotation @ cv2.Rodrigues(turn)[0]
    at = rotation @ shift.ravel() + translation
    return np.array([at[0], at[1], np.arctan2(body[1, 0], body[0, 0])])


class Tally:
    """What was found by one detector, and by ours in the same pictures."""

    def __init__(self):
        self.found = self.wrong = self.astray = self.missed = 0
        self.corners, self.our_corners = [], []


class Judge:
    def __init__(self):
        self.others = [Pupil(), Aruco()]
        self.tallies = {other.name: Tally() for other in self.others}
        self.ours = Tally()
        self.truths = self.readable = self.pictures = 0
        self.tag_sizes = {}
        # By whether two faces or more were seen: errors of theirs, of ours, and between the two.
        self.poses = {True: [], False: []}
        self.complaints = []

    def look(self, folder):
        data = json.loads((folder / "dataset.json").read_text())
        self.expect(data["status"] == "complete", f"{folder} is {data['status']}")
        self.tag_sizes = {robot["name"]: robot["tag_size"] for robot in data["robots"]}
        self.check_coco(folder, data)
        robots = {robot["name"]: robot for robot in data["robots"]}
        cameras = {camera["robot"]: camera for camera in data["cameras"]}
        for picture in data["pictures"]:
            grey = cv2.imread(str(folder / picture["file"]), cv2.IMREAD_UNCHANGED)
            camera = cameras[picture["robot"]]
            self.expect(
                grey is not None and grey.dtype == np.uint8 and grey.shape == (camera["height"], camera["width"]),
                f"{picture['file']} is no grey picture of its camera's size",
            )
            self.pictures += 1
            self.one(picture, grey, camera, robots[picture["leader"]["robot"]])

    def one(self, picture, grey, camera, leader):
        where = picture["file"]
        truth = {tag["id"]: np.array(tag["corners"]) for tag in picture["tags"]}
        ours = {tag["id"]: np.array(tag["corners"]) for tag in picture["detected"] if tag["accepted"]}
        self.truths += len(truth)
        self.readable += sum(tag["readable"] and not tag["hidden"] for tag in picture["tags"])
        self.check_projection(picture, camera)
        self.count("ours", self.ours, list(ours.items()), truth, where)
        for other in self.others:
            tally, found = self.tallies[other.name], other.find(grey)
            self.count(other.name, tally, found, truth, where)
            for tag, corners in found:
                if tag not in ours:
                    tally.missed += 1
                elif tag in truth and np.abs(corners - truth[tag]).max() <= ASTRAY:
                    tally.corners.extend(corners - truth[tag])
                    tally.our_corners.extend(ours[tag] - truth[tag])
            if other.name == Pupil.name:
                self.locate(picture, camera, leader, dict(found))

    def count(self, name, tally, found, truth, where):
        for tag, corners in found:
            tally.found += 1
            if tag not in truth:
                tally.wrong += 1
                self.complaints.append(f"{where}: {name} found tag {tag}, which is not in the picture")
            elif np.abs(corners - truth[tag]).max() > ASTRAY:
                tally.astray += 1
                self.expect(name != "ours", f"{where}: ours found tag {tag} elsewhere than it is")

    def check_projection(self, picture, camera):
        """Corners are where OpenCV's own camera model puts them."""
        matrix = np.array([[camera["fx"], 0, camera["cx"]], [0, camera["fy"], camera["cy"]], [0, 0, 1.0]])
        for tag in picture["tags"]:
            rotation, translation = rigid(tag["camera_from_tag"])
            half = 0.5 * self.tag_sizes[tag["robot"]]
            square = np.array([[-half, half, 0], [half, half, 0], [half, -half, 0], [-half, -half, 0]])
            seen, _ = cv2.projectPoints(
                square, cv2.Rodrigues(rotation)[0], translation, matrix, np.array(camera["distortion"])
            )
            off = np.abs(seen.reshape(4, 2) - np.array(tag["corners"])).max()
            self.expect(off < 1e-6, f"{picture['file']}: corners of tag {tag['id']} are {off} px from OpenCV's")

    def check_coco(self, folder, data):
        with contextlib.redirect_stdout(io.StringIO()):
            coco = COCO(str(folder / "coco.json"))
        tags = sum(len(picture["tags"]) for picture in data["pictures"])
        self.expect(len(coco.getImgIds()) == len(data["pictures"]), f"{folder}: COCO has other pictures")
        self.expect(len(coco.getAnnIds(catIds=coco.getCatIds())) == tags, f"{folder}: COCO has other tags")
        for note in coco.loadAnns(coco.getAnnIds()):
            # A tag seen from its edge may cover no pixel.
            covers = note["area"] < SLIVER or coco.annToMask(note).any()
            self.expect(len(note["keypoints"]) == 12 and covers, f"{folder}: an annotation is empty")

    def locate(self, picture, camera, leader, found):
        faces = {face["id"]: np.array(face["corners"]) for face in leader["faces"] if face["id"] in found}
        estimate = picture["leader"]["estimate"]
        if not faces or estimate is None:
            return
        points = np.concatenate(list(faces.values()))
        pixels = np.concatenate([found[tag] for tag in faces])
        pose = leader_pose(camera, picture, points, pixels)
        if pose is None:
            return
        truth, ours = numbers(picture["leader"]["truth"]), numbers(estimate)
        errors = planar_errors(pose, truth), planar_errors(ours, truth), planar_errors(pose, ours)
        self.poses[len(faces) >= 2].append(errors)

    def expect(self, holds, complaint):
        if not holds:
            self.complaints.append(complaint)

    def verdict(self):
        print(f"{self.pictures} pictures, {self.truths} tags in view, {self.readable} of them readable and not hidden\n")
        print(f"{'detector':18}{'found':>8}{'wrong':>8}{'astray':>8}{'of these not by us':>22}{'corners RMS px':>17}{'ours, same tags':>17}")
        print(f"{'ours':18}{self.ours.found:8}{self.ours.wrong:8}{self.ours.astray:8}")
        for name, tally in self.tallies.items():
            theirs, ours = rms(np.ravel(tally.corners)), rms(np.ravel(tally.our_corners))
            missed = tally.missed / max(tally.found, 1)
            print(f"{name:18}{tally.found:8}{tally.wrong:8}{tally.astray:8}{tally.missed:12} ({100 * missed:5.1f} %){theirs:17.4f}{ours:17.4f}")
            self.expect(tally.found > 0, f"{name} found nothing")
            self.expect(missed <= MISSED, f"ours misses {100 * missed:.1f} % of what {name} finds")
            self.expect(ours <= theirs, f"our corners are worse than those of {name}")
        print(f"\n{'leader located, RMS':44}{'pictures':>9}{'range mm':>10}{'bearing °':>11}{'heading °':>11}")
        for several, poses in self.poses.items():
            if not poses:
                continue
            what = "two faces or more" if several else "one face found by pupil-apriltags"
            errors = [np.array([p[k] for p in poses]) for k in range(3)]
            rows = ["pupil-apriltags, SQPnP, Levenberg-Marquardt", "ours", "the one from the other"]
            print(what)
            for row, error in zip(rows, errors):
                r, b, h = rms(error) * [1e3, 180 / np.pi, 180 / np.pi]
                print(f"  {row:42}{len(poses):9}{r:10.3f}{b:11.4f}{h:11.4f}")
            if several:
                theirs, ours, between = (rms(error) for error in errors)
                for k, name in enumerate(["range", "bearing", "heading"]):
                    self.expect(
                        ours[k] <= max(theirs[k], FLOOR[k]), f"our {name} is worse: {ours[k]:.2e} against {theirs[k]:.2e}"
                    )
                    self.expect(
                        between[k] <= AGREE * max(theirs[k], FLOOR[k]),
                        f"the two differ in {name} by {between[k]:.2e}, theirs errs by {theirs[k]:.2e}",
                    )
        self.expect(len(self.poses[True]) >= 50, "there were hardly any pictures with two faces")
        for complaint in self.complaints[:20]:
            print(f"FAILED: {complaint}")
        if len(self.complaints) > 20:
            print(f"… and {len(self.complaints) - 20} more")
        return 1 if self.complaints else 0


def main():
    began = time.monotonic()
    judge = Judge()
    for folder in sys.argv[1:]:
        judge.look(Path(folder))
    code = judge.verdict()
    print(f"\njudged in {time.monotonic() - began:.1f} s: {'nothing to complain about' if code == 0 else 'FAILED'}")
    return code


if __name__ == "__main__":
    sys.exit(main())
