"""Opens a log of Echelon in Rerun, or writes what Rerun would show to a file.

    pip install rerun-sdk mcap mcap-protobuf-support
    python rerun_view.py runs/line-three-001/log.mcap [OUT.rrd]

Rerun reads frames, poses and pictures of the log by itself. Bodies, ribbons and curves are added here, with a layout:
the formation on the left, errors and commands on the right, a camera below where robots look.
"""

import sys
from collections import defaultdict

import rerun as rr
import rerun.blueprint as rrb
from mcap.exceptions import EndOfFile
from mcap.reader import NonSeekingReader
from mcap_protobuf.decoder import DecoderFactory

CURVES = {
    "Error of distance, m": "error_distance_m",
    "Error of bearing, rad": "error_bearing_rad",
    "Turn rate applied, rad/s": "applied_turn_rate_rad_s",
}
LEAD = (30, 30, 34)
FOLLOWERS = [(230, 159, 0), (86, 180, 233), (0, 158, 115), (240, 228, 66), (0, 114, 178), (213, 94, 0), (204, 121, 167)]


def colours(members):
    """The robots' colours, as in the pictures of Echelon."""
    followers = 0
    for robot in members:
        if robot.leads:
            yield LEAD
        else:
            yield FOLLOWERS[followers % len(FOLLOWERS)]
            followers += 1


def whole(reader):
    """All messages, up to where a log was cut off."""
    try:
        for _, channel, message, decoded in reader.iter_decoded_messages(log_time_order=False):
            yield channel, message, decoded
    except EndOfFile:
        pass


def read(path):
    """The fleet, the states of each edge with their times in ns, and the path of each robot."""
    fleet, edges, paths, cameras = None, defaultdict(list), defaultdict(list), set()
    with open(path, "rb") as file:
        # One that does not seek also reads a log that was cut off.
        reader = NonSeekingReader(file, decoder_factories=[DecoderFactory()])
        for channel, message, decoded in whole(reader):
            topic = channel.topic
            if topic == "/fleet":
                fleet = decoded
            elif topic.startswith("/edge/") and topic.endswith("/state"):
                edges[topic].append((message.log_time, decoded))
            elif topic.startswith("/robot/") and topic.endswith("/state"):
                paths[topic.split("/")[2]].append((decoded.x_m, decoded.y_m, decoded.height_m + 0.01))
            elif topic.endswith("/camera/image"):
                cameras.add(topic)
    return fleet, edges, paths, sorted(cameras)


def main():
    log = sys.argv[1]
    fleet, edges, paths, cameras = read(log)
    if fleet is None:
        sys.exit(f"{log} is no log of Echelon")
    curves = [rrb.TimeSeriesView(name=name, origin=f"/curves/{field}") for name, field in CURVES.items()]
    lead = next((robot.name for robot in fleet.robots if robot.leads), fleet.robots[0].name)
    space = rrb.Spatial3DView(
        name=fleet.title,
        origin="/",
        contents=["/bodies/**", "/paths/**", "/tf", "/world"],
        background=(232, 236, 241),
        eye_controls=rrb.EyeControls3D(kind=rrb.Eye3DKind.Orbital, tracking_entity=f"/bodies/{lead}"),
    )
    left = [space] + [rrb.Spatial2DView(name=camera, origin=camera) for camera in cameras[:1]]
    blueprint = rrb.Blueprint(
        rrb.Horizontal(rrb.Vertical(*left), rrb.Vertical(*curves), column_shares=[3, 2]), collapse_panels=True
    )
    rr.init("echelon", spawn=len(sys.argv) < 3)
    if len(sys.argv) > 2:
        rr.save(sys.argv[2], default_blueprint=blueprint)
    else:
        rr.send_blueprint(blueprint)
    rr.log_file_from_path(log)
    rr.log("/", rr.CoordinateFrame("world"), static=True)
    rr.log("/world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    by_name = {}
    for robot, colour in zip(fleet.robots, colours(fleet.robots)):
        by_name[robot.name] = colour
        body = f"/bodies/{robot.name}"
        rr.log(body, rr.CoordinateFrame(f"robot/{robot.name}"), static=True)
        box = rr.Boxes3D(
            centers=[(robot.wheelbase_m / 2, 0, robot.height_m / 2)],
            sizes=[(robot.length_m, robot.width_m, robot.height_m)],
            colors=[colour],
            labels=[robot.name],
            fill_mode="solid",
        )
        rr.log(body, box, static=True)
        # Every tenth point is enough for the eye.
        strip = paths[robot.name][::10]
        if len(strip) > 1:
            rr.log(f"/paths/{robot.name}", rr.CoordinateFrame("world"), static=True)
            rr.log(f"/paths/{robot.name}", rr.LineStrips3D([strip], colors=[colour], radii=[0.02]), static=True)
    for topic, rows in edges.items():
        _, _, leader, follower, _ = topic.split("/")
        times = rr.TimeColumn("message_log_time", timestamp=[time * 1e-9 for time, _ in rows])
        for field in CURVES.values():
            place = f"/curves/{field}/{leader}/{follower}"
            line = rr.SeriesLines(colors=[by_name.get(follower, LEAD)], names=[follower])
            rr.log(place, line, static=True)
            rr.send_columns(place, indexes=[times], columns=rr.Scalars.columns(scalars=[getattr(s, field) for _, s in rows]))


if __name__ == "__main__":
    main()
