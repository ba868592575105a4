"""Writes sightings of one marker in three kinds of messages, as rosbag2 folders and as a ROS 1 bag.

Usage: write_tags.py FOLDER. The writer is PyPI's rosbags, which shares no code with toposlam. The robot is at
(1, 2) and looks along y; its camera is half a metre ahead; the marker is 2 m ahead of the camera and 1 m to its
left, turned to the left.
"""

import math
import sys
from pathlib import Path

import numpy as np
from rosbags import rosbag1, rosbag2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from rosbag_writer import write

DEFINITIONS = {
    "apriltag_msgs/msg/Point": "float64 x\nfloat64 y",
    "apriltag_msgs/msg/AprilTagDetection": (
        "string family\nint32 id\nint32 hamming\nfloat32 goodness\nfloat32 decision_margin\n"
        "apriltag_msgs/Point centre\napriltag_msgs/Point[4] corners\nfloat64[9] homography"
    ),
    "apriltag_msgs/msg/AprilTagDetectionArray": (
        "std_msgs/Header header\napriltag_msgs/AprilTagDetection[] detections"
    ),
    "vision_msgs/msg/ObjectHypothesis": "string class_id\nfloat64 score",
    "vision_msgs/msg/ObjectHypothesisWithPose": (
        "vision_msgs/ObjectHypothesis hypothesis\ngeometry_msgs/PoseWithCovariance pose"
    ),
    "vision_msgs/msg/BoundingBox3D": "geometry_msgs/Pose center\ngeometry_msgs/Vector3 size",
    "vision_msgs/msg/Detection3D": (
        "std_msgs/Header header\nvision_msgs/ObjectHypothesisWithPose[] results\n"
        "vision_msgs/BoundingBox3D bbox\nstring id"
    ),
    "vision_msgs/msg/Detection3DArray": (
        "std_msgs/Header header\nvision_msgs/Detection3D[] detections"
    ),
    "tf2_msgs/msg/TFMessage": "geometry_msgs/TransformStamped[] transforms",
}
HALF = math.sqrt(0.5)


def messages(store):
    """Time in nanoseconds, topic, type and message, in the order of time."""
    ros1 = "seq" in {field[0] for field in store.get_msgdef("std_msgs/msg/Header").fields}

    def make(name, *arguments):
        return store.types[name](*arguments)

    def header(nanoseconds, frame):
        stamp = make("builtin_interfaces/msg/Time", nanoseconds // 10**9, nanoseconds % 10**9)
        return make("std_msgs/msg/Header", *((0, stamp, frame) if ros1 else (stamp, frame)))

    def pose(x, y, turned):
        turn = (0.0, 0.0, HALF, HALF) if turned else (0.0, 0.0, 0.0, 1.0)
        position = make("geometry_msgs/msg/Point", x, y, 0.0)
        return make("geometry_msgs/msg/Pose", position, make("geometry_msgs/msg/Quaternion", *turn))

    def transforms(nanoseconds, parent, child, x, y, turned):
        turn = (0.0, 0.0, HALF, HALF) if turned else (0.0, 0.0, 0.0, 1.0)
        body = make(
            "geometry_msgs/msg/Transform",
            make("geometry_msgs/msg/Vector3", x, y, 0.0),
            make("geometry_msgs/msg/Quaternion", *turn),
        )
        one = make("geometry_msgs/msg/TransformStamped", header(nanoseconds, parent), child, body)
        return make("tf2_msgs/msg/TFMessage", [one])

    def with_covariance(pose):
        return make("geometry_msgs/msg/PoseWithCovariance", pose, np.zeros(36))

    tf = "tf2_msgs/msg/TFMessage"
    yield 10**9, "/tf_static", tf, transforms(10**9, "base_link", "camera", 0.5, 0.0, False)
    for index in range(3):
        time = (index + 2) * 10**9
        yield time, "/odom", "geometry_msgs/msg/PoseWithCovarianceStamped", make(
            "geometry_msgs/msg/PoseWithCovarianceStamped",
            header(time, "odom"),
            with_covariance(pose(1.0, 2.0, True)),
        )
        point = make("apriltag_msgs/msg/Point", 1.0, 2.0)
        tag = make(
            "apriltag_msgs/msg/AprilTagDetection",
            *("tag36h11", 3, 0, 0.0, 50.0, point, [point] * 4, np.zeros(9)),
        )
        kind = "apriltag_msgs/msg/AprilTagDetectionArray"
        yield time + 5, "/detections", kind, make(kind, header(time + 1, "camera"), [tag])
        yield time + 6, "/tf", tf, transforms(time + 1, "camera", "tag36h11:3", 2.0, 1.0, True)
        result = make(
            "vision_msgs/msg/ObjectHypothesisWithPose",
            make("vision_msgs/msg/ObjectHypothesis", "arrow", 0.9),
            with_covariance(pose(2.0, 1.0, True)),
        )
        size = make("geometry_msgs/msg/Vector3", 1.0, 1.0, 1.0)
        box = make("vision_msgs/msg/BoundingBox3D", pose(2.0, 1.0, True), size)
        found = make("vision_msgs/msg/Detection3D", header(time + 1, "camera"), [result], box, "0")
        kind = "vision_msgs/msg/Detection3DArray"
        yield time + 7, "/objects", kind, make(kind, header(time + 1, "camera"), [found])
        kind = "geometry_msgs/msg/PoseStamped"
        yield time + 8, "/tag", kind, make(kind, header(time + 1, "camera"), pose(2.0, 1.0, True))


def main(folder):
    ros2, ros1 = get_typestore(Stores.ROS2_HUMBLE), get_typestore(Stores.ROS1_NOETIC)
    for store in (ros2, ros1):
        for name, definition in DEFINITIONS.items():
            if name not in store.types:
                store.register(get_types_from_msg(definition, name))
    plugin = rosbag2.StoragePlugin
    for name, kind in (("database", plugin.SQLITE3), ("mcap", plugin.MCAP)):
        writer = rosbag2.Writer(folder / name, version=9, storage_plugin=kind)
        write(writer, messages(ros2), ros2.serialize_cdr, ros2)
    write(rosbag1.Writer(folder / "ros1.bag"), messages(ros1), ros1.serialize_ros1, ros1)


main(Path(sys.argv[1]))
