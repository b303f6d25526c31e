"""Opens logs with other people's libraries: `mcap`, `mcap-protobuf-support`, Rerun, `rosbags`.

Every message is decoded by the schema in the file, and what it says is held against the tables of the run, which come by
another way from the same moments.
"""

import csv
import json
import pathlib
import re
import subprocess
import sys
from collections import defaultdict

from mcap.exceptions import McapError
from mcap.reader import make_reader
from mcap.stream_reader import StreamReader
from mcap_protobuf.decoder import DecoderFactory

failures = 0


def check(what, holds):
    global failures
    print(("ok    " if holds else "FAILS ") + what)
    failures += not holds


def decoded(path):
    """Messages by topic, each with its time in ns."""
    found = defaultdict(list)
    with open(path, "rb") as file:
        for _, channel, message, decoded in make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages():
            found[channel.topic].append((message.log_time, decoded))
    return found


def rows(run, table):
    path = run / "tables" / f"{table}.csv"
    return list(csv.DictReader(open(path, newline=""))) if path.exists() else []


def value(message, field):
    """A field as the tables have it: enums by their word."""
    descriptor = message.DESCRIPTOR.fields_by_name[field]
    found = getattr(message, field)
    return descriptor.enum_type.values_by_number[found].name if descriptor.enum_type else found


def same(text, found):
    if isinstance(found, bool):
        return text == str(found).lower()
    return text == found if isinstance(found, str) else float(text) == found or text == "NaN" and found != found


def agree(run, messages, table, topic_of):
    """All columns of a table whose names are fields of the messages, bit for bit."""
    at, compared, wrong = defaultdict(int), 0, 0
    for row in rows(run, table):
        topic = topic_of(row)
        _, message = messages[topic][at[topic]]
        at[topic] += 1
        for field in row.keys() & message.DESCRIPTOR.fields_by_name.keys():
            compared += 1
            wrong += not same(row[field], value(message, field))
    whole = all(len(messages[topic]) == count for topic, count in at.items())
    check(f"{run.name}: {compared} values of {table} equal the log's", compared > 0 and wrong == 0 and whole)


def against_tables(run, messages):
    agree(run, messages, "robots", lambda row: f"/robot/{row['robot']}/state")
    agree(run, messages, "edges", lambda row: f"/edge/{row['leader']}/{row['follower']}/state")
    if rows(run, "measurements"):
        agree(run, messages, "measurements", lambda row: f"/edge/{row['leader']}/{row['follower']}/measurements")
    times = sorted({float(row["time_s"]) for row in rows(run, "robots")})
    check(f"{run.name}: {len(times)} times equal", times == [sample.time_s for _, sample in messages["/samples"]])


def layout_fits(layout, messages):
    """Topics that a layout names are in the log, and fields that it plots are in the messages."""
    text = pathlib.Path(layout).read_text()
    json.loads(text)
    named = re.findall(r'"(/[\w/-]+)(?:\.(\w+))?"', text)
    missing = [topic for topic, _ in named if topic not in messages]
    fields = [f for t, f in named if f and f not in messages[t][0][1].DESCRIPTOR.fields_by_name]
    check(f"{layout}: {len(named)} topics and fields are in a log", len(named) > 8 and not missing + fields)


def command(*words):
    done = subprocess.run(words, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


def killed(run, echelon):
    """A run that was killed reads up to its last chunk, for others and for ourselves."""
    samples = 0
    try:
        with open(run / "log.mcap", "rb") as file:
            names = {}
            for record in StreamReader(file).records:
                kind = type(record).__name__
                if kind == "Channel":
                    names[record.id] = record.topic
                samples += kind == "Message" and names[record.channel_id] == "/samples"
    except (McapError, EOFError):
        pass
    check(f"killed: {samples} samples are readable", samples > 100)
    code, text = command(echelon, "replay", str(run / "log.mcap"), "--json")
    told = json.loads(text[text.index("{"):])
    check(f"killed: replay knows {told['recorded']['samples']} and finds them again", code == 0 and told["same"])
    check("killed: replay and library agree", told["recorded"]["samples"] == samples)


def rerun(run, work):
    code, text = command("rerun", "mcap", "info", str(run / "log.mcap"))
    check(f"{run.name}: rerun mcap info", code == 0 and "/tf" in text)
    out = work / f"{run.name}.rrd"
    code, _ = command("rerun", "mcap", "convert", str(run / "log.mcap"), "-o", str(out))
    check(f"{run.name}: rerun mcap convert", code == 0 and out.stat().st_size > 10_000)
    view = work / f"{run.name}-view.rrd"
    code, text = command(sys.executable, "docs/layouts/rerun_view.py", str(run / "log.mcap"), str(view))
    check(f"{run.name}: rerun_view.py", code == 0 and view.stat().st_size > out.stat().st_size)


def ros2(run, messages, work):
    from rosbags.highlevel import AnyReader

    bag = work / f"{run.name}-bag"
    subprocess.run(["rm", "-rf", str(bag)], check=True)
    code, text = command(sys.executable, "docs/layouts/to_ros2.py", str(run / "log.mcap"), str(bag))
    check(f"{run.name}: to_ros2.py", code == 0)
    if code:
        print(text)
        return
    counts, right = defaultdict(int), True
    with AnyReader([bag]) as reader:
        for connection, time, raw in reader.messages():
            message = reader.deserialize(raw, connection.msgtype)
            if connection.topic == "/robot/leader/odom":
                stamp, state = messages["/robot/leader/state"][counts[connection.topic]]
                place = message.pose.pose.position
                right &= stamp == time and (place.x, place.y) == (state.x_m, state.y_m)
                right &= message.twist.twist.linear.x == state.speed_m_s
            counts[connection.topic] += 1
    check(f"{run.name}: {counts['/robot/leader/odom']} ROS 2 messages of odometry equal the log's", right)
    check(f"{run.name}: transforms in ROS 2", counts["/tf"] == len(messages["/tf"]) > 10)


def written_anew(run, echelon, work):
    """What the Python library of MCAP writes anew, in chunks of its own, runs again and is the same bit for bit."""
    from mcap.writer import CompressionType, Writer

    copy = work / "anew.mcap"
    with open(run / "log.mcap", "rb") as source, open(copy, "wb") as target:
        reader, writer = make_reader(source), Writer(target, compression=CompressionType.ZSTD, chunk_size=10_000)
        writer.start(profile="", library="tools.py")
        schemas, channels = {}, {}
        for schema, channel, message in reader.iter_messages():
            if schema.id not in schemas:
                schemas[schema.id] = writer.register_schema(schema.name, schema.encoding, schema.data)
            if channel.id not in channels:
                channels[channel.id] = writer.register_channel(
                    channel.topic, channel.message_encoding, schemas[schema.id], channel.metadata
                )
            writer.add_message(
                channels[channel.id], message.log_time, message.data, message.publish_time, message.sequence
            )
        for item in reader.iter_attachments():
            writer.add_attachment(item.create_time, item.log_time, item.name, item.media_type, item.data)
        for item in reader.iter_metadata():
            writer.add_metadata(item.name, item.metadata)
        writer.finish()
    code, text = command(echelon, "replay", str(copy))
    right = code == 0 and "same: bit for bit" in text and "written anew by tools.py" in text
    check(f"{run.name}: written anew, it replays: {text.splitlines()[-1]}", right)


def ros2_names(run, work):
    """Topics are legal and one to one where names are neither."""
    from rosbags.highlevel import AnyReader

    bag = work / f"{run.name}-bag"
    subprocess.run(["rm", "-rf", str(bag)], check=True)
    code, text = command(sys.executable, "docs/layouts/to_ros2.py", str(run / "log.mcap"), str(bag))
    check(f"{run.name}: to_ros2.py", code == 0)
    with AnyReader([bag]) as reader:
        topics = sorted(connection.topic for connection in reader.connections)
    odometry = [topic for topic in topics if topic.endswith("/odom")]
    check(f"{run.name}: {odometry}", odometry == ["/robot/n0/odom", "/robot/r_1/odom", "/robot/r_1_2/odom"])
    legal = re.compile(r"(/[A-Za-z][A-Za-z0-9]*(_[A-Za-z0-9]+)*)+")
    check(f"{run.name}: topics are legal", all(legal.fullmatch(topic) for topic in topics))


def main():
    work, echelon = pathlib.Path(sys.argv[1]), sys.argv[2]
    logs = {name: decoded(work / name / "log.mcap") for name in ["told", "yard", "seen"]}
    for name, messages in logs.items():
        count = sum(len(found) for found in messages.values())
        check(f"{name}: {count} messages on {len(messages)} topics decode", count > 1000)
        against_tables(work / name, messages)
    check("yard: contacts were told", len(logs["yard"]["/contacts"]) > 0)
    pictures = [image for _, image in logs["seen"]["/robot/follower-1/camera/image"]]
    check(f"seen: {len(pictures)} pictures, all PNG", len(pictures) > 3 and all(p.data[1:4] == b"PNG" for p in pictures))
    layout_fits("docs/layouts/foxglove.json", logs["seen"])
    killed(work / "killed", echelon)
    rerun(work / "seen", work)
    ros2(work / "told", logs["told"], work)
    ros2(work / "seen", logs["seen"], work)
    ros2_names(work / "names", work)
    written_anew(work / "told", echelon, work)
    if failures:
        sys.exit(f"{failures} checks failed")


main()
