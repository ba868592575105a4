"""A participant by Cyclone DDS: another implementation of DDS than the one of toposlam.

    peer.py listen FILE          write each message of /odom, /scan and /cmd_vel as a line
    peer.py publish KIND         publish /odom and a /scan of a kind: twist-type, xcdr2, no-frame, plain
    peer.py read TWIST           read /cmd_vel as Twist, TwistStamped or both, and publish /odom and /scan
"""

import os
import sys
import time
from dataclasses import dataclass

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import array, float32, float64, int32, sequence, uint32
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration


@dataclass
class Time(IdlStruct, typename="builtin_interfaces::msg::dds_::Time_"):
    sec: int32
    nanosec: uint32


@dataclass
class Header(IdlStruct, typename="std_msgs::msg::dds_::Header_"):
    stamp: Time
    frame_id: str


@dataclass
class Vector3(IdlStruct, typename="geometry_msgs::msg::dds_::Vector3_"):
    x: float64
    y: float64
    z: float64


@dataclass
class Quaternion(IdlStruct, typename="geometry_msgs::msg::dds_::Quaternion_"):
    x: float64
    y: float64
    z: float64
    w: float64


@dataclass
class Twist(IdlStruct, typename="geometry_msgs::msg::dds_::Twist_"):
    linear: Vector3
    angular: Vector3


@dataclass
class TwistStamped(IdlStruct, typename="geometry_msgs::msg::dds_::TwistStamped_"):
    header: Header
    twist: Twist


@dataclass
class Pose(IdlStruct, typename="geometry_msgs::msg::dds_::Pose_"):
    position: Vector3
    orientation: Quaternion


@dataclass
class PoseWithCovariance(IdlStruct, typename="geometry_msgs::msg::dds_::PoseWithCovariance_"):
    pose: Pose
    covariance: array[float64, 36]


@dataclass
class TwistWithCovariance(IdlStruct, typename="geometry_msgs::msg::dds_::TwistWithCovariance_"):
    twist: Twist
    covariance: array[float64, 36]


@dataclass
class Odometry(IdlStruct, typename="nav_msgs::msg::dds_::Odometry_"):
    header: Header
    child_frame_id: str
    pose: PoseWithCovariance
    twist: TwistWithCovariance


@dataclass
class LaserScan(IdlStruct, typename="sensor_msgs::msg::dds_::LaserScan_"):
    header: Header
    angle_min: float32
    angle_max: float32
    angle_increment: float32
    time_increment: float32
    scan_time: float32
    range_min: float32
    range_max: float32
    ranges: sequence[float32]
    intensities: sequence[float32]


BEST_EFFORT = Qos(Policy.Reliability.BestEffort, Policy.Durability.Volatile, Policy.History.KeepLast(10))
RELIABLE = Qos(Policy.Reliability.Reliable(duration(seconds=1)), Policy.Durability.Volatile, Policy.History.KeepLast(10))
XCDR1 = Policy.DataRepresentation(use_cdrv0_representation=True)
XCDR2 = Policy.DataRepresentation(use_xcdrv2_representation=True)

participant = DomainParticipant(int(os.environ["ROS_DOMAIN_ID"]))


def reader(name, kind, qos=BEST_EFFORT):
    topic = Topic(participant, "rt" + name, kind, qos=Qos(XCDR1))
    return DataReader(participant, topic, qos=Qos(*qos, XCDR1))


def writer(name, kind, representation=XCDR1):
    topic = Topic(participant, "rt" + name, kind, qos=Qos(representation))
    return DataWriter(participant, topic, qos=Qos(*RELIABLE, representation))


def header(frame):
    now = time.time_ns()
    return Header(Time(now // 10**9, now % 10**9), frame)


def odometry():
    zero = Vector3(0.0, 0.0, 0.0)
    pose = PoseWithCovariance(Pose(zero, Quaternion(0.0, 0.0, 0.0, 1.0)), [0.0] * 36)
    return Odometry(header("odom"), "base_link", pose, TwistWithCovariance(Twist(zero, zero), [0.0] * 36))


def scan(frame):
    return LaserScan(header(frame), -3.14, 3.13, 0.0174, 0.0, 0.1, 0.1, 12.0, [1.0] * 360, [])


def listen(path):
    kinds = {"/odom": Odometry, "/scan": LaserScan, "/cmd_vel": Twist}
    readers = {name: reader(name, kind) for name, kind in kinds.items()}
    with open(path, "w", buffering=1) as out:
        while True:
            for name, one in readers.items():
                # The end of a writer is a sample, too.
                for found in (found for found in one.take(N=100) if isinstance(found, kinds[name])):
                    if name == "/odom":
                        at = found.pose.pose.position
                        out.write(f"/odom {at.x:.6f} {at.y:.6f}\n")
                    elif name == "/scan":
                        out.write(f"/scan {len(found.ranges)} {found.header.frame_id}\n")
                    else:
                        out.write(f"/cmd_vel {found.linear.x} {found.angular.z}\n")
            time.sleep(0.005)


def publish(kind, commands=()):
    odom = writer("/odom", Odometry)
    if kind == "twist-type":
        scans = writer("/scan", Twist)
    else:
        scans = writer("/scan", LaserScan, XCDR2 if kind == "xcdr2" else XCDR1)
    zero = Vector3(0.0, 0.0, 0.0)
    readers = [reader("/cmd_vel", one) for one in commands]
    while True:
        odom.write(odometry())
        frame = "laser" if kind == "no-frame" else "base_link"
        scans.write(Twist(zero, zero) if kind == "twist-type" else scan(frame))
        for one in readers:
            for found in one.take(N=100):
                if isinstance(found, (Twist, TwistStamped)):
                    print(type(found).__name__, flush=True)
        time.sleep(0.02)


def main(verb, what):
    if verb == "listen":
        listen(what)
    elif verb == "publish":
        publish(what)
    else:
        publish("plain", {"Twist": [Twist], "TwistStamped": [TwistStamped], "both": [Twist, TwistStamped]}[what])


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except KeyboardInterrupt:
        # The end of the test.
        pass
