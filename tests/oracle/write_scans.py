"""Writes the same scans as a rosbag2 folder with a database, with MCAP, compressed, and as a ROS 1 bag.

Usage: write_scans.py FOLDER. The writer is PyPI's rosbags, which shares no code with toposlam.
"""

import math
import sys
from pathlib import Path

import numpy as np
from rosbags import rosbag1, rosbag2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from rosbag_writer import write

SCANS = 7
MODE, FORMAT, PLUGIN = rosbag2.CompressionMode, rosbag2.CompressionFormat, rosbag2.StoragePlugin


def messages(store):
    """Time in nanoseconds, topic, type and message, in the order of time."""
    types = store.types
    ros1 = "seq" in {field[0] for field in store.get_msgdef("std_msgs/msg/Header").fields}

    def header(nanoseconds, frame):
        stamp = types["builtin_interfaces/msg/Time"](nanoseconds // 10**9, nanoseconds % 10**9)
        arguments = (0, stamp, frame) if ros1 else (stamp, frame)
        return types["std_msgs/msg/Header"](*arguments)

    def transform(nanoseconds, parent, child, x, y, yaw):
        vector = types["geometry_msgs/msg/Vector3"](x, y, 0.25)
        turn = types["geometry_msgs/msg/Quaternion"](0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))
        body = types["geometry_msgs/msg/Transform"](vector, turn)
        head = header(nanoseconds, parent)
        return types["geometry_msgs/msg/TransformStamped"](head, child, body)

    def transforms(*all):
        return types["tf2_msgs/msg/TFMessage"](list(all))

    for index in range(SCANS):
        time = (index + 1) * 10**9
        place = transform(time, "odom", "base_footprint", index / 2, -index / 4, index / 8)
        yield time, "/tf", "tf2_msgs/msg/TFMessage", transforms(place)
        ranges = np.array([1.5 + index, 0.0625, np.inf, np.nan, 30.0], dtype=np.float32)
        strengths = np.array([], dtype=np.float32)
        angles = (-1.0, 1.0, 0.5, 0.0, 0.1, 0.125, 30.0)
        scan = types["sensor_msgs/msg/LaserScan"](header(time + 5, "laser"), *angles, ranges, strengths)
        yield time + 10, "/scan", "sensor_msgs/msg/LaserScan", scan
        if index == 2:
            # Late, and in two steps.
            yield (
                time + 20,
                "/tf_static",
                "tf2_msgs/msg/TFMessage",
                transforms(
                    transform(time, "base_link", "laser", 0.5, 0.0, math.pi / 2),
                    transform(time, "base_footprint", "base_link", 0.0, 0.0, 0.0),
                ),
            )


def main(folder):
    ros2, ros1 = get_typestore(Stores.ROS2_HUMBLE), get_typestore(Stores.ROS1_NOETIC)
    definition = "geometry_msgs/TransformStamped[] transforms"
    ros1.register(get_types_from_msg(definition, "tf2_msgs/msg/TFMessage"))
    for name, plugin, compression in (
        ("database", PLUGIN.SQLITE3, None),
        ("mcap", PLUGIN.MCAP, None),
        ("file-compressed", PLUGIN.SQLITE3, MODE.FILE),
        ("message-compressed", PLUGIN.SQLITE3, MODE.MESSAGE),
        ("mcap-file-compressed", PLUGIN.MCAP, MODE.FILE),
    ):
        writer = rosbag2.Writer(folder / name, version=9, storage_plugin=plugin)
        if compression:
            writer.set_compression(compression, FORMAT.ZSTD)
        write(writer, messages(ros2), ros2.serialize_cdr, ros2)
    write(rosbag1.Writer(folder / "ros1.bag"), messages(ros1), ros1.serialize_ros1, ros1)


main(Path(sys.argv[1]))
