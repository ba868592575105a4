"""A participant by Cyclone DDS: another implementation of DDS than the one of toposlam.

peer.py listen FILE [NAMESPACE TWIST]   write each message of /odom, /scan and /cmd_vel (Twist or TwistStamped) as a line
peer.py publish KIND                    publish /odom, a /scan of a kind: twist-type, xcdr2, no-frame, plain, and announce
                                        /marker; other-marker: of another type
peer.py read TWIST                      read /cmd_vel as Twist, TwistStamped or both, and publish the same
"""

import sys
import time

from messages import (
    XCDR1,
    XCDR2,
    Header,
    LaserScan,
    Odometry,
    Pose,
    PoseStamped,
    PoseWithCovariance,
    Quaternion,
    Time,
    Twist,
    TwistStamped,
    TwistWithCovariance,
    Vector3,
    reader,
    writer,
)


def header(frame):
    now = time.time_ns()
    return Header(Time(now // 10**9, now % 10**9), frame)


def odometry():
    zero = Vector3(0.0, 0.0, 0.0)
    pose = PoseWithCovariance(Pose(zero, Quaternion(0.0, 0.0, 0.0, 1.0)), [0.0] * 36)
    return Odometry(header("odom"), "base_link", pose, TwistWithCovariance(Twist(zero, zero), [0.0] * 36))


def scan(frame):
    return LaserScan(header(frame), -3.14, 3.13, 0.0174, 0.0, 0.1, 0.1, 12.0, [1.0] * 360, [])


def listen(path, space="", twist="Twist"):
    commands = {"Twist": Twist, "TwistStamped": TwistStamped}[twist]
    kinds = {"/odom": Odometry, "/scan": LaserScan, "/cmd_vel": commands}
    readers = {name: reader(space + name, kind) for name, kind in kinds.items()}
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
                        speeds = found.twist if isinstance(found, TwistStamped) else found
                        out.write(f"/cmd_vel {speeds.linear.x} {speeds.angular.z}\n")
            time.sleep(0.005)


def publish(kind, commands=()):
    odom = writer("/odom", Odometry)
    if kind == "twist-type":
        scans = writer("/scan", Twist)
    else:
        scans = writer("/scan", LaserScan, XCDR2 if kind == "xcdr2" else XCDR1)
    # Nothing is seen of the marker.
    _markers = writer("/marker", Twist if kind == "other-marker" else PoseStamped)
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


def main(verb, what, *more):
    if verb == "listen":
        listen(what, *more)
    elif verb == "publish":
        publish(what)
    else:
        publish(
            "plain", {"Twist": [Twist], "TwistStamped": [TwistStamped], "both": [Twist, TwistStamped]}[what]
        )


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except KeyboardInterrupt:
        # The end of the test.
        pass
