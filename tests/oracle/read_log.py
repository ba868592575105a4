"""What a log holds, by readers that share nothing with its writer: rosbags, and mcap with
mcap-ros2-support. Both use the definitions in the log alone.

    python3 tests/oracle/read_log.py LOG
"""

import json
import sys
from pathlib import Path

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

# Those of ROS 2 itself, to compare with.
STANDARD = get_typestore(Stores.ROS2_HUMBLE)


class ByRosbags:
    """Reads with rosbags."""

    def __init__(self, path):
        self.path = path

    def messages(self):
        store = get_typestore(Stores.EMPTY)
        # A file is read as a folder is that holds it alone.
        with Reader(self.path) as reader:
            for connection in reader.connections:
                types = get_types_from_msg(connection.msgdef.data, connection.msgtype)
                store.register({name: kind for name, kind in types.items() if name not in store.fielddefs})
            for connection, time, raw in reader.messages():
                yield connection.topic, time, store.deserialize_cdr(raw, connection.msgtype)
            kinds = {connection.msgtype for connection in reader.connections}
        self.hashes = {
            kind: store.hash_rihs01(kind) == STANDARD.hash_rihs01(kind)
            for kind in sorted(kinds)
            if kind in STANDARD.fielddefs
        }


class ByMcap:
    """Reads with mcap and mcap-ros2-support."""

    def __init__(self, path):
        self.path = path

    def messages(self):
        with open(self.path, "rb") as file:
            reader = make_reader(file, decoder_factories=[DecoderFactory()], validate_crcs=True)
            assert reader.get_header().profile == "ros2"
            self.notes = {note.name: note.metadata for note in reader.iter_metadata()}
            for _, channel, message, decoded in reader.iter_decoded_messages(log_time_order=False):
                yield channel.topic, message.log_time, decoded


def stamp(time):
    return time.sec * 10**9 + time.nanosec


def summary(messages):
    """The number of messages per topic, and the content of some."""
    counts, first, last, percepts, moves, odometry = {}, {}, {}, [], [], []
    latest, order = 0, True
    for topic, time, message in messages:
        order = order and time >= latest
        latest = time
        counts[topic] = counts.get(topic, 0) + 1
        first.setdefault(topic, message)
        last[topic] = message
        if topic == "/toposlam/percept":
            percepts.append([message.move, message.degree, message.marker, [bool(d) for d in message.form]])
        if topic == "/toposlam/door":
            moves.append([message.move, message.door])
        if topic == "/odom":
            position = message.pose.pose.position
            odometry.append([stamp(message.header.stamp), position.x, position.y])
    line = {"counts": counts, "in_order": order, "percepts": percepts, "doors": moves}
    line["first_odometry"], line["last_odometry"] = odometry[0], odometry[-1]
    frames = first["/odom"].header.frame_id, first["/odom"].child_frame_id
    transform = first["/tf"].transforms[0]
    assert frames == (transform.header.frame_id, transform.child_frame_id)
    line["frames"] = list(frames)
    line["orientation"] = [getattr(last["/odom"].pose.pose.orientation, part) for part in "xyzw"]
    line["last_cmd_vel"] = [last["/cmd_vel"].linear.x, last["/cmd_vel"].angular.z]
    run, end, world = first["/toposlam/run"], last["/toposlam/end"], last["/toposlam/map"]
    line["run"] = {
        name: getattr(run, name)
        for name in ["version", "world", "world_hash", "start", "marker", "seed", "calibration", "colours", "command",
                     "algorithm"]
    }
    line["end"] = {name: getattr(end, name) for name in ["moves", "ending", "cause"]}
    line["map"] = {name: [int(n) for n in getattr(world, name)] for name in ["degrees", "opposite"]}
    line["images"] = {
        topic: [message.format, stamp(message.header.stamp), *size(bytes(message.data))]
        for topic, message in first.items()
        if topic.endswith("/compressed")
    }
    return line


def size(data):
    """Width and height of a JPEG or PNG file."""
    if data.startswith(b"\x89PNG"):
        return int.from_bytes(data[16:20], "big"), int.from_bytes(data[20:24], "big")
    at = 2
    while data[at + 1] not in (0xC0, 0xC1, 0xC2):
        at += 2 + int.from_bytes(data[at + 2 : at + 4], "big")
    return int.from_bytes(data[at + 7 : at + 9], "big"), int.from_bytes(data[at + 5 : at + 7], "big")


def main():
    path = Path(sys.argv[1])
    one, other = ByRosbags(path), ByMcap(path)
    by_rosbags, by_mcap = summary(one.messages()), summary(other.messages())
    assert by_rosbags == by_mcap, (by_rosbags, by_mcap)
    run = other.notes["toposlam"]
    assert run == {name: str(value) for name, value in by_mcap["run"].items()}, run
    print(json.dumps({**by_mcap, "standard_types_are_those_of_ros_2": one.hashes}))


main()
