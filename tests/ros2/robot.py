"""A robot with two wheels and a laser scanner in a floor plan, simulated and published by Cyclone DDS.

    robot.py PLAN [OPTIONS]

It shares no code with toposlam. Its wheels obey late and with limited acceleration, and slip; its clock begins when it
is switched on. Standard output has a line for each command, `command SECONDS SPEED TURNING GAP`: the real time, the
speeds, and the real time since the last good odometry or scan, whichever is older.

Faults are `KIND@BEGIN+SECONDS`, in the robot's time. They begin when the robot next begins to go ahead at so long after its
first motion, and has gone 2 cm. `--fault` may be repeated:

    lost         30 % of all messages
    late         messages come 0.3 s late
    doubled      each message comes twice
    reordered    each pair of messages comes in reverse order
    silent       no messages
    no-scans     no scans
    wrong-frame  scans of another frame
    nan          odometry that is not a number
    jump         odometry is 5 m ahead
    frozen       the stamp of odometry stays the same
    scan-clock   stamps of scans are 100 s late
    back         stamps are 100 s early
    forward      stamps are 100 s late
    obstacle     something 0.8 m ahead
    stuck        the wheels do not turn
"""

import argparse
import json
import math
import random
import signal
import time
import tomllib
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from messages import (
    STAYS,
    Header,
    LaserScan,
    Odometry,
    Pose,
    PoseStamped,
    PoseWithCovariance,
    Quaternion,
    TFMessage,
    Time,
    Transform,
    TransformStamped,
    Twist,
    TwistStamped,
    TwistWithCovariance,
    Vector3,
    reader,
    writer,
)

RADIUS = 0.2
TICK = 0.02
BEGINS = 1000.0
"""The robot's time when it is switched on."""
RANGE = 30.0
"""Of the scanner, in metres."""
SCANNER = (0.08, -0.03, math.pi / 2)
"""The scanner's pose on the robot: on a plate that is ahead, turned to the left."""
MARKER_SEEN = (0.2, 1.5)
MARKER_BEFORE, BEFORE = 1.2, 9.0
"""How far the marker lies before the first junction of a network of corridors, and where the robot begins."""
BEFORE_FAULT = 0.02
"""The way that the robot has gone ahead when a fault begins, in metres."""
WATCHDOG = 0.6
"""The wheels stop after this time without a command."""


def floor(plan: dict[str, Any]) -> np.ndarray:
    """The walls of a plan, as segments: x and y of the beginning, x and y of the end."""
    half = plan["floor"]["hallway_width"] / 2
    rectangles = []
    for hallway in plan["hallways"]:
        ends = np.array([plan["junctions"][hallway[end]] for end in ("from", "to")])
        rectangles.append((ends.min(axis=0) - half, ends.max(axis=0) + half))
    xs, ys = (sorted({corner[axis] for both in rectangles for corner in both}) for axis in (0, 1))

    def inside(column: int, row: int) -> bool:
        if not (0 <= column < len(xs) - 1 and 0 <= row < len(ys) - 1):
            return False
        middle = np.array([(xs[column] + xs[column + 1]) / 2, (ys[row] + ys[row + 1]) / 2])
        return any((low < middle).all() and (middle < high).all() for low, high in rectangles)

    walls = []
    for column in range(len(xs)):
        for row in range(len(ys)):
            if row + 1 < len(ys) and inside(column - 1, row) != inside(column, row):
                walls.append((xs[column], ys[row], xs[column], ys[row + 1]))
            if column + 1 < len(xs) and inside(column, row - 1) != inside(column, row):
                walls.append((xs[column], ys[row], xs[column + 1], ys[row]))
    return np.array(walls)


def ranges(walls: np.ndarray, origin: np.ndarray, bearings: np.ndarray) -> np.ndarray:
    """How far it is to the nearest wall in each direction; infinite if there is none."""
    rays = np.stack([np.cos(bearings), np.sin(bearings)], axis=1)[:, None, :]
    begin, along = walls[None, :, :2] - origin, walls[None, :, 2:] - walls[None, :, :2]
    with np.errstate(divide="ignore", invalid="ignore"):
        across = rays[..., 0] * along[..., 1] - rays[..., 1] * along[..., 0]
        far = (begin[..., 0] * along[..., 1] - begin[..., 1] * along[..., 0]) / across
        part = (begin[..., 0] * rays[..., 1] - begin[..., 1] * rays[..., 0]) / across
        hit = (far > 0) & (part >= 0) & (part <= 1)
    return np.where(hit, far, np.inf).min(axis=1)


def distance(walls: np.ndarray, point: np.ndarray) -> float:
    """The distance of a point to the nearest wall."""
    along = walls[:, 2:] - walls[:, :2]
    part = ((point - walls[:, :2]) * along).sum(axis=1) / (along**2).sum(axis=1)
    nearest = walls[:, :2] + along * part.clip(0, 1)[:, None]
    return float(np.hypot(*(nearest - point).T).min())


@dataclass
class Fault:
    """What goes wrong, and when."""

    kind: str
    begin: float
    seconds: float
    begun: float = math.inf

    @staticmethod
    def parse(text: str) -> "Fault":
        kind, _, when = text.partition("@")
        begin, _, seconds = when.partition("+")
        return Fault(kind, float(begin), float(seconds))


@dataclass
class Leg:
    """A way on which the robot goes ahead."""

    begun: float
    travelled: float = 0.0


@dataclass
class Link:
    """The messages of a topic, on their way."""

    send: Callable[[Any], None]
    waiting: list[tuple[float, Any]] = field(default_factory=list)
    held: Any = None

    def put(self, now: float, message: Any, faults: set[str], chance: random.Random) -> bool:
        """Returns whether the message will come."""
        if "silent" in faults or ("lost" in faults and chance.random() < 0.3):
            return False
        messages = [message] * (2 if "doubled" in faults else 1)
        if "reordered" in faults:
            if self.held is None:
                self.held = message
                return True
            messages = [message, self.held]
            self.held = None
        due = now + (0.3 if "late" in faults else 0.0)
        self.waiting += [(due, each) for each in messages]
        return True

    def deliver(self, now: float) -> None:
        while self.waiting and self.waiting[0][0] <= now:
            self.send(self.waiting.pop(0)[1])


class Robot:
    """Where the robot is, where its wheels say that it is, and what it does."""

    def __init__(self, options: argparse.Namespace) -> None:
        plan = tomllib.loads(Path(options.plan).read_text())
        self.options = options
        self.walls = floor(plan)
        self.obstacles = np.empty((0, 4))
        self.chance = random.Random(options.seed)
        self.noise = np.random.default_rng(options.seed)
        at, facing = (np.array(plan["junctions"][plan["start"][which]]) for which in ("at", "facing"))
        along = (facing - at) / np.hypot(*(facing - at))
        self.marker = (at, math.atan2(*along[::-1]))
        self.position = at.astype(float)
        self.heading = self.marker[1] + math.pi
        if options.corridors:
            self.marker = (at + MARKER_BEFORE * along, self.marker[1])
            self.position = at + BEFORE * along
        self.odometry = [0.0, 0.0, 0.0]
        self.speeds = [0.0, 0.0]
        self.wanted = [0.0, 0.0]
        self.commands: list[tuple[float, list[float]]] = []
        self.commanded = -math.inf
        self.first_motion = math.inf
        self.last_speed = 0.0
        self.leg = Leg(-math.inf)
        self.time = BEGINS
        self.travelled = 0.0
        self.nearest = math.inf
        if options.state and Path(options.state).exists():
            state = json.loads(Path(options.state).read_text())
            self.position = np.array(state["position"])
            self.heading, self.odometry = state["heading"], state["odometry"]
            self.time, self.first_motion = state["time"] + 1.0, state["first_motion"]

    def faults(self) -> set[str]:
        return {one.kind for one in self.options.fault if one.begun <= self.time < one.begun + one.seconds}

    def command(self, speed: float, turning: float) -> None:
        if (speed, turning) != (0.0, 0.0):
            self.first_motion = min(self.first_motion, self.time)
        if speed > 0.01 >= self.last_speed:
            self.leg = Leg(self.time)
        self.last_speed = speed
        self.commands.append((self.time + self.options.delay, [speed, turning]))
        self.commanded = self.time

    def advance(self) -> None:
        """One tick: the wheels follow the command, and the robot the wheels."""
        self.time += TICK
        while self.commands and self.commands[0][0] <= self.time:
            self.wanted = self.commands.pop(0)[1]
        if self.time - self.commanded > WATCHDOG or "stuck" in self.faults():
            self.wanted = [0.0, 0.0]
        for axis, (most, acceleration) in enumerate([(0.3, self.options.acceleration), (1.0, 3.0)]):
            wanted = max(-most, min(most, self.wanted[axis]))
            step = (wanted - self.speeds[axis]) * TICK / self.options.wheel_lag
            limit = acceleration * TICK
            self.speeds[axis] += max(-limit, min(limit, step))
        speed, turning = self.speeds
        if abs(speed) + abs(turning) < 1e-6:
            return
        slip, scale = self.options.slip, 1.0 + self.noise.normal(0.0, 0.02)
        x, y, heading = self.odometry
        middle = heading + turning * TICK / 2
        way = speed * TICK * scale
        self.odometry = [
            x + way * math.cos(middle),
            y + way * math.sin(middle),
            heading + turning * TICK * scale,
        ]
        turned = turning * (1.0 - slip / 2) * TICK
        way = speed * (1.0 - slip) * TICK
        middle = self.heading + turned / 2
        there = self.position + way * np.array([math.cos(middle), math.sin(middle)])
        self.heading += turned
        free = distance(np.concatenate([self.walls, self.obstacles]), there)
        self.nearest = min(self.nearest, free)
        if free >= RADIUS:
            self.position = there
            self.travelled += abs(way)
            self.leg.travelled += abs(way)
        if self.leg.travelled > BEFORE_FAULT:
            for fault in self.options.fault:
                if fault.begun == math.inf and self.leg.begun >= self.first_motion + fault.begin:
                    fault.begun = self.time

    def put_obstacle(self) -> None:
        """Something 0.8 m ahead, across the hallway."""
        ahead = np.array([math.cos(self.heading), math.sin(self.heading)])
        aside = np.array([-ahead[1], ahead[0]]) * 0.3
        middle = self.position + 0.8 * ahead
        self.obstacles = np.array([[*(middle - aside), *(middle + aside)]])

    def scan(self) -> list[float]:
        x, y, turned = SCANNER
        sine, cosine = math.sin(self.heading), math.cos(self.heading)
        origin = self.position + np.array([cosine * x - sine * y, sine * x + cosine * y])
        bearings = self.heading + turned - math.pi + np.arange(self.options.rays) * self.step()
        seen = ranges(np.concatenate([self.walls, self.obstacles]), origin, bearings)
        seen += self.noise.normal(0.0, 0.01, len(seen))
        return [float(value) for value in np.where(seen < RANGE, seen, np.inf)]

    def step(self) -> float:
        return math.tau / self.options.rays

    def seen_marker(self) -> tuple[float, float, float] | None:
        """The marker from the robot: x, y and the direction."""
        at, direction = self.marker
        east, north = at - self.position
        sine, cosine = math.sin(self.heading), math.cos(self.heading)
        x, y = cosine * east + sine * north, -sine * east + cosine * north
        if not MARKER_SEEN[0] <= math.hypot(x, y) <= MARKER_SEEN[1]:
            return None
        return x, y, direction - self.heading

    def save(self) -> None:
        state = {
            "position": list(self.position),
            "heading": self.heading,
            "odometry": self.odometry,
            "time": self.time,
            "first_motion": self.first_motion,
        }
        part = Path(self.options.state + ".part")
        part.write_text(json.dumps(state))
        part.replace(self.options.state)


def quaternion(yaw: float) -> Quaternion:
    return Quaternion(0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))


def transform(stamp: Time, parent: str, child: str, x: float, y: float, yaw: float) -> TransformStamped:
    return TransformStamped(Header(stamp, parent), child, Transform(Vector3(x, y, 0.1), quaternion(yaw)))


class Topics:
    """The topics of a robot."""

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        options = robot.options
        self.twist = TwistStamped if options.twist == "TwistStamped" else Twist
        space = options.namespace
        self.odometry = Link(writer(space + "/odom", Odometry).write)
        self.scans = Link(writer(space + "/scan", LaserScan).write)
        self.markers = Link(writer(space + "/marker", PoseStamped).write)
        self.frames = writer(space + "/tf", TFMessage)
        self.fixed = writer(space + "/tf_static", TFMessage, qos=STAYS)
        self.wheels = reader(space + "/cmd_vel", self.twist)
        stamp = self.stamp(set())
        x, y, yaw = SCANNER
        links = [("base_link", "plate", x, 0.0, 0.0), ("plate", "laser", 0.0, y, yaw)]
        self.fixed.write(TFMessage([transform(stamp, *link) for link in links]))
        self.measured = stamp
        self.good = {"odometry": time.monotonic(), "scan": time.monotonic()}

    def stamp(self, faults: set[str]) -> Time:
        jump = (100.0 if "forward" in faults else 0.0) - (100.0 if "back" in faults else 0.0)
        nanoseconds = round((self.robot.time + jump) * 1e9)
        return Time(nanoseconds // 10**9, nanoseconds % 10**9)

    def obey(self) -> None:
        for found in self.wheels.take(N=100):
            # The end of a writer is a sample, too.
            if isinstance(found, self.twist):
                twist = found.twist if isinstance(found, TwistStamped) else found
                now = time.monotonic()
                gap = now - min(self.good.values())
                print(f"command {now:.4f} {twist.linear.x:.4f} {twist.angular.z:.4f} {gap:.4f}", flush=True)
                self.robot.command(twist.linear.x, twist.angular.z)

    def publish(self, tick: int) -> None:
        robot, faults = self.robot, self.robot.faults()
        if "obstacle" in faults and not len(robot.obstacles):
            robot.put_obstacle()
            print("obstacle", flush=True)
        chance, now, stamp = robot.chance, robot.time, self.stamp(faults)
        x, y, heading = robot.odometry
        pose = Pose(Vector3(x, y, 0.0), quaternion(heading))
        speed, turning = robot.speeds
        if "nan" in faults:
            pose.position.x = math.nan
        if "jump" in faults:
            pose.position.x += 5.0
        if "frozen" not in faults:
            self.measured = stamp
        twist = Twist(Vector3(speed, 0.0, 0.0), Vector3(0.0, 0.0, turning))
        message = Odometry(
            Header(self.measured, "odom"),
            "base_link",
            PoseWithCovariance(pose, [0.0] * 36),
            TwistWithCovariance(twist, [0.0] * 36),
        )
        if self.odometry.put(now, message, faults, chance) and not faults & {"nan", "back", "jump", "frozen"}:
            self.good["odometry"] = time.monotonic()
        if tick % 10 == 0:
            self.frames.write(TFMessage([transform(stamp, "odom", "base_link", x, y, heading)]))
        if tick % round(1 / (TICK * robot.options.scans)) == 0 and "no-scans" not in faults:
            self.publish_scan(stamp, faults)
        for link in (self.odometry, self.markers, self.scans):
            link.deliver(now)

    def publish_scan(self, stamp: Time, faults: set[str]) -> None:
        robot = self.robot
        chance, now = robot.chance, robot.time
        frame = "camera" if "wrong-frame" in faults else "laser"
        if "scan-clock" in faults:
            stamp = Time(stamp.sec + 100, stamp.nanosec)
        step = robot.step()
        last = -math.pi + (robot.options.rays - 1) * step
        sweep = LaserScan(Header(stamp, frame), -math.pi, last, step, 0.0, 0.1, 0.1, RANGE, robot.scan(), [])
        marker = robot.seen_marker()
        if marker is not None:
            x, y, yaw = marker
            seen = PoseStamped(Header(stamp, "base_link"), Pose(Vector3(x, y, 0.0), quaternion(yaw)))
            self.markers.put(now, seen, faults, chance)
        if self.scans.put(now, sweep, faults, chance) and not faults & {"wrong-frame", "back", "scan-clock"}:
            self.good["scan"] = time.monotonic()


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("plan")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--speed", type=float, default=1.0, help="of its time, relative to the real one")
    parser.add_argument("--twist", choices=["Twist", "TwistStamped"], default="TwistStamped")
    parser.add_argument("--namespace", default="")
    parser.add_argument("--corridors", action="store_true", help="begin in the corridor before the first junction")
    parser.add_argument("--rays", type=int, default=360)
    parser.add_argument("--scans", type=float, default=10.0, help="a second")
    parser.add_argument("--delay", type=float, default=0.04, help="of a command, in seconds")
    parser.add_argument("--wheel-lag", type=float, default=0.08, help="in seconds")
    parser.add_argument("--acceleration", type=float, default=0.5)
    parser.add_argument("--slip", type=float, default=0.01)
    parser.add_argument("--state", help="where its state is kept, so that it survives a restart")
    parser.add_argument("--fault", action="append", type=Fault.parse, default=[])
    options = parser.parse_args()
    stopped: list[int] = []
    for which in (signal.SIGINT, signal.SIGTERM):
        signal.signal(which, lambda number, _: stopped.append(number))
    robot = Robot(options)
    topics = Topics(robot)
    print("begin", flush=True)
    due = time.monotonic()
    tick = 0
    while not stopped:
        topics.obey()
        robot.advance()
        topics.publish(tick)
        if options.state and tick % 5 == 0:
            robot.save()
        tick += 1
        # Lost time is not made up for.
        due = max(due + TICK / options.speed, time.monotonic())
        time.sleep(max(0.0, due - time.monotonic()))
    print(
        f"end {robot.time - BEGINS:.2f} {robot.travelled:.3f} {robot.nearest:.3f} {robot.speeds[0]:.4f}",
        flush=True,
    )


if __name__ == "__main__":
    main()
