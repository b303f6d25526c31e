"""Writes a log of Echelon as a ROS 2 bag.

    pip install rosbags mcap mcap-protobuf-support
    python to_ros2.py runs/line-three-001/log.mcap BAG_FOLDER
    ros2 bag play BAG_FOLDER

/tf                  tf2_msgs/msg/TFMessage       world → robots → cameras, as in the log
/robot/NAME/odom     nav_msgs/msg/Odometry        pose in world; speed and turn rate in the robot's frame, every sample
/edge/L/F/error      geometry_msgs/msg/Vector3Stamped   x distance in m, y bearing in rad: set point minus truth
/robot/NAME/camera/image/compressed, …/camera_info      pictures, where cameras took any

Names in topics keep to the rules of ROS, one for each robot: the log's metadata `ros2` says which stands for whom. Frames
keep their names.
"""

import math
from pathlib import Path
import sys

from mcap.exceptions import EndOfFile
from mcap.reader import NonSeekingReader
from mcap.records import Metadata, Schema
from mcap.stream_reader import StreamReader
from mcap_protobuf.decoder import DecoderFactory
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore
import numpy as np


def main():
    log, bag = sys.argv[1:3]
    store = get_typestore(Stores.ROS2_JAZZY)
    types = store.types

    def make(name, *fields, **named):
        return types[name](*fields, **named)

    def stamp(time):
        return make("builtin_interfaces/msg/Time", sec=time // 10**9, nanosec=time % 10**9)

    def header(time, frame):
        return make("std_msgs/msg/Header", stamp=stamp(time), frame_id=frame)

    def vector(x, y, z):
        return make("geometry_msgs/msg/Vector3", x=x, y=y, z=z)

    def quaternion(q):
        return make("geometry_msgs/msg/Quaternion", x=q.x, y=q.y, z=q.z, w=q.w)

    def transforms(time, message):
        def one(t):
            move = make(
                "geometry_msgs/msg/Transform",
                translation=vector(t.translation.x, t.translation.y, t.translation.z),
                rotation=quaternion(t.rotation),
            )
            return make(
                "geometry_msgs/msg/TransformStamped",
                header=header(time, t.parent_frame_id),
                child_frame_id=t.child_frame_id,
                transform=move,
            )

        return make("tf2_msgs/msg/TFMessage", transforms=[one(t) for t in message.transforms])

    def turned(heading, pitch, roll):
        (sh, ch), (sp, cp), (sr, cr) = ((math.sin(a / 2), math.cos(a / 2)) for a in (heading, pitch, roll))
        return make(
            "geometry_msgs/msg/Quaternion",
            x=sr * cp * ch - cr * sp * sh,
            y=cr * sp * ch + sr * cp * sh,
            z=cr * cp * sh - sr * sp * ch,
            w=cr * cp * ch + sr * sp * sh,
        )

    def odometry(time, name, s):
        pose = make(
            "geometry_msgs/msg/Pose",
            position=make("geometry_msgs/msg/Point", x=s.x_m, y=s.y_m, z=s.height_m),
            orientation=turned(s.heading_rad, s.pitch_rad, s.roll_rad),
        )
        twist = make(
            "geometry_msgs/msg/Twist",
            linear=vector(s.speed_m_s, 0.0, 0.0),
            angular=vector(0.0, 0.0, s.turn_rate_rad_s),
        )
        exact = np.zeros(36)
        return make(
            "nav_msgs/msg/Odometry",
            header=header(time, "world"),
            child_frame_id=f"robot/{name}",
            pose=make("geometry_msgs/msg/PoseWithCovariance", pose=pose, covariance=exact),
            twist=make("geometry_msgs/msg/TwistWithCovariance", twist=twist, covariance=exact),
        )

    def calibration(time, c):
        roi = make("sensor_msgs/msg/RegionOfInterest", x_offset=0, y_offset=0, height=0, width=0, do_rectify=False)
        return make(
            "sensor_msgs/msg/CameraInfo",
            header=header(time, c.frame_id),
            height=c.height,
            width=c.width,
            distortion_model=c.distortion_model,
            d=np.array(c.D),
            k=np.array(c.K),
            r=np.array(c.R),
            p=np.array(c.P),
            binning_x=0,
            binning_y=0,
            roi=roi,
        )

    def picture(time, image):
        data = np.frombuffer(image.data, dtype=np.uint8)
        return make(
            "sensor_msgs/msg/CompressedImage", header=header(time, image.frame_id), format=image.format, data=data
        )

    def error(time, s):
        return make(
            "geometry_msgs/msg/Vector3Stamped",
            header=header(time, "world"),
            vector=vector(s.error_distance_m, s.error_bearing_rad, 0.0),
        )

    def message_of(topic, time, decoded):
        parts = topic.split("/")
        if topic == "/tf":
            return topic, transforms(time, decoded)
        if topic.startswith("/robot/") and topic.endswith("/state"):
            return f"/robot/{parts[2]}/odom", odometry(time, parts[2], decoded)
        if topic.endswith("/camera/calibration"):
            return topic.replace("/calibration", "/camera_info"), calibration(time, decoded)
        if topic.endswith("/camera/image"):
            return f"{topic}/compressed", picture(time, decoded)
        if topic.startswith("/edge/") and topic.endswith("/state"):
            return f"/edge/{parts[2]}/{parts[3]}/error", error(time, decoded)
        return None

    legal = names(log)

    def legally(topic):
        return "/".join(legal.get(part, part) for part in topic.split("/"))

    connections = {}
    # One that does not seek also reads a log that was cut off.
    reader = NonSeekingReader(open(log, "rb"), decoder_factories=[DecoderFactory()])
    if Path(bag).exists():
        sys.exit(f"{bag} is there already: choose another name, or remove it first")
    with Writer(bag, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        for channel, message, decoded in whole(reader):
            made = message_of(channel.topic, message.log_time, decoded)
            if made is None:
                continue
            topic, out = made
            topic, kind = legally(topic), out.__msgtype__
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=store)
            writer.write(connections[topic], message.log_time, store.serialize_cdr(out, kind))
    for topic, connection in sorted(connections.items()):
        print(topic, connection.msgtype)


def names(log):
    """Names of robots and props as ROS 2 takes them."""
    with open(log, "rb") as file:
        for record in StreamReader(file).records:
            if isinstance(record, Metadata) and record.name == "ros2":
                return record.metadata
            if isinstance(record, Schema):
                break
    return {}


def whole(reader):
    """All messages, up to where a log was cut off."""
    try:
        for _, channel, message, decoded in reader.iter_decoded_messages(log_time_order=False):
            yield channel, message, decoded
    except EndOfFile:
        pass


if __name__ == "__main__":
    main()
