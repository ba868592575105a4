"""A participant by Cyclone DDS that reads what a run publishes, and calls its services as rmw_cyclonedds does.

services.py watch FILE       write each message of /toposlam/state, /toposlam/map, /toposlam/markers, and each list of nodes
services.py call NAME        call a service of the type Trigger, and print its response
services.py stamps FILE      write the stamp of each TwistStamped of /cmd_vel as a line
services.py publish WHAT     publish /hazard_detection with a bump, /battery_state that is low, /events/cliff of another
                             type, a /clock, or grey pixels on /camera/pixels
"""

import os
import sys
import time
from dataclasses import dataclass

from cyclonedds.core import Policy, Qos
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import array, float32, int32, int64, sequence, uint8, uint32, uint64
from cyclonedds.util import duration
from messages import RELIABLE, Header, Pose, Time, TwistStamped, Vector3, reader, writer


@dataclass
class Clock(IdlStruct, typename="rosgraph_msgs::msg::dds_::Clock_"):
    clock: Time


@dataclass
class KeyValue(IdlStruct, typename="diagnostic_msgs::msg::dds_::KeyValue_"):
    key: str
    value: str


@dataclass
class DiagnosticStatus(IdlStruct, typename="diagnostic_msgs::msg::dds_::DiagnosticStatus_"):
    level: uint8
    name: str
    message: str
    hardware_id: str
    values: sequence[KeyValue]


@dataclass
class DiagnosticArray(IdlStruct, typename="diagnostic_msgs::msg::dds_::DiagnosticArray_"):
    header: Header
    status: sequence[DiagnosticStatus]


@dataclass
class Map(IdlStruct, typename="toposlam_msgs::msg::dds_::Map_"):
    stamp: Time
    move: uint32
    degrees: sequence[uint32]
    opposite: sequence[int32]
    robot: uint32


@dataclass
class ColorRGBA(IdlStruct, typename="std_msgs::msg::dds_::ColorRGBA_"):
    r: float32
    g: float32
    b: float32
    a: float32


@dataclass
class CompressedImage(IdlStruct, typename="sensor_msgs::msg::dds_::CompressedImage_"):
    header: Header
    format: str
    data: sequence[uint8]


@dataclass
class Image(IdlStruct, typename="sensor_msgs::msg::dds_::Image_"):
    header: Header
    height: uint32
    width: uint32
    encoding: str
    is_bigendian: uint8
    step: uint32
    data: sequence[uint8]


@dataclass
class UVCoordinate(IdlStruct, typename="visualization_msgs::msg::dds_::UVCoordinate_"):
    u: float32
    v: float32


@dataclass
class MeshFile(IdlStruct, typename="visualization_msgs::msg::dds_::MeshFile_"):
    filename: str
    data: sequence[uint8]


@dataclass
class Marker(IdlStruct, typename="visualization_msgs::msg::dds_::Marker_"):
    header: Header
    ns: str
    id: int32
    type: int32
    action: int32
    pose: Pose
    scale: Vector3
    color: ColorRGBA
    lifetime: Time
    frame_locked: bool
    points: sequence[Vector3]
    colors: sequence[ColorRGBA]
    texture_resource: str
    texture: CompressedImage
    uv_coordinates: sequence[UVCoordinate]
    text: str
    mesh_resource: str
    mesh_file: MeshFile
    mesh_use_embedded_materials: bool


@dataclass
class MarkerArray(IdlStruct, typename="visualization_msgs::msg::dds_::MarkerArray_"):
    markers: sequence[Marker]


@dataclass
class HazardDetection(IdlStruct, typename="irobot_create_msgs::msg::dds_::HazardDetection_"):
    header: Header
    type: uint8


@dataclass
class HazardDetectionVector(IdlStruct, typename="irobot_create_msgs::msg::dds_::HazardDetectionVector_"):
    header: Header
    detections: sequence[HazardDetection]


@dataclass
class BatteryState(IdlStruct, typename="sensor_msgs::msg::dds_::BatteryState_"):
    header: Header
    voltage: float32
    temperature: float32
    current: float32
    charge: float32
    capacity: float32
    design_capacity: float32
    percentage: float32
    power_supply_status: uint8
    power_supply_health: uint8
    power_supply_technology: uint8
    present: bool
    cell_voltage: sequence[float32]
    cell_temperature: sequence[float32]
    location: str
    serial_number: str


def node_types(length):
    """The types of a list of nodes with identities of this length."""

    @dataclass
    class Gid(IdlStruct, typename="rmw_dds_common::msg::dds_::Gid_"):
        data: array[uint8, length]

    @dataclass
    class NodeEntitiesInfo(IdlStruct, typename="rmw_dds_common::msg::dds_::NodeEntitiesInfo_"):
        node_namespace: str
        node_name: str
        reader_gid_seq: sequence[Gid]
        writer_gid_seq: sequence[Gid]

    @dataclass
    class ParticipantEntitiesInfo(IdlStruct, typename="rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_"):
        gid: Gid
        node_entities_info_seq: sequence[NodeEntitiesInfo]

    return ParticipantEntitiesInfo


@dataclass
class TriggerRequest(IdlStruct, typename="std_srvs::srv::dds_::Trigger_Request_"):
    client: uint64
    number: int64
    structure_needs_at_least_one_member: uint8


@dataclass
class TriggerReply(IdlStruct, typename="std_srvs::srv::dds_::Trigger_Response_"):
    client: uint64
    number: int64
    success: bool
    message: str


# Late readers get the last messages, too.
LAST = Qos(
    Policy.Reliability.Reliable(duration(seconds=1)),
    Policy.Durability.TransientLocal,
    Policy.History.KeepLast(10),
)


def header():
    return Header(Time(1, 2), "base_link")


def line(found):
    """A message as a line."""
    if isinstance(found, DiagnosticArray):
        status = found.status[0]
        values = " ".join(f"{value.key}={value.value}" for value in status.values)
        return f"/state {status.level} {status.name}: {status.message} [{values}]"
    if isinstance(found, Map):
        return f"/map {found.move} {found.degrees} {found.opposite} {found.robot}"
    if isinstance(found, MarkerArray):
        shown = " ".join(
            f"{one.ns}:{one.type}:{one.action}:{len(one.points)}:{one.text}" for one in found.markers
        )
        places = [
            (round(at.x, 2), round(at.y, 2))
            for one in found.markers
            if one.ns == "vertices"
            for at in one.points
        ]
        frames = {one.header.frame_id for one in found.markers}
        return f"/markers {sorted(frames)} {shown} {places}"
    nodes = found.node_entities_info_seq
    names = " ".join(node.node_namespace + ":" + node.node_name for node in nodes)
    gid = bytes(found.gid.data)
    of_it = all(
        bytes(one.data)[:12] == gid[:12]
        for node in nodes
        for one in node.reader_gid_seq + node.writer_gid_seq
    )
    counts = " ".join(f"{len(node.reader_gid_seq)} {len(node.writer_gid_seq)}" for node in nodes)
    return f"/nodes {len(gid)} {names} {counts} {of_it}"


def watch(path):
    topics = {"/toposlam/state": DiagnosticArray, "/toposlam/map": Map, "/toposlam/markers": MarkerArray}
    readers = [(reader(name, kind, LAST), kind) for name, kind in topics.items()]
    nodes = node_types(int(os.environ.get("GID", "16")))
    readers.append((reader("ros_discovery_info", nodes, LAST, prefix=""), nodes))
    with open(path, "w", buffering=1) as out:
        while True:
            for one, kind in readers:
                # The end of a writer is a sample, too.
                for found in (found for found in one.take(N=100) if isinstance(found, kind)):
                    out.write(line(found) + "\n")
            time.sleep(0.01)


def stamps(path):
    commands = reader("/cmd_vel", TwistStamped, RELIABLE)
    with open(path, "w", buffering=1) as out:
        while True:
            for found in (found for found in commands.take(N=100) if isinstance(found, TwistStamped)):
                out.write(f"/cmd_vel {found.header.stamp.sec} {found.header.stamp.nanosec}\n")
            time.sleep(0.01)


def call(name):
    replies = reader(f"/toposlam/{name}Reply", TriggerReply, RELIABLE, prefix="rr")
    requests = writer(f"/toposlam/{name}Request", TriggerRequest, prefix="rq")
    client = 0x1122334455667788
    end = time.time() + 10
    # A client of ROS 2 waits for the service, too.
    while not (requests.get_matched_subscriptions() and replies.get_matched_publications()):
        if time.time() > end:
            sys.exit("no service")
        time.sleep(0.05)
    requests.write(TriggerRequest(client, 7, 0))
    while time.time() < end:
        for found in replies.take(N=10):
            if isinstance(found, TriggerReply) and (found.client, found.number) == (client, 7):
                print(found.success, found.message)
                return
        time.sleep(0.01)
    sys.exit("no reply")


def publish(what):
    nan = float("nan")
    bump = HazardDetectionVector(header(), [HazardDetection(header(), 5), HazardDetection(header(), 1)])
    numbers = [11.0, nan, -1.0, nan, nan, nan, 0.08]
    battery = BatteryState(header(), *numbers, 2, 1, 2, True, [], [], "", "1")
    topics = {
        "bump": ("/hazard_detection", bump),
        "battery": ("/battery_state", battery),
        "other-cliff": ("/events/cliff", Clock(Time(77, 5))),
        "clock": ("/clock", Clock(Time(77, 5))),
        "pixels": ("/camera/pixels", Image(header(), 120, 160, "mono8", 0, 164, [128] * (164 * 120))),
    }
    name, message = topics[what]
    out = writer(name, type(message))
    while True:
        if what == "pixels":
            now = time.time_ns()
            message.header.stamp = Time(now // 10**9, now % 10**9)
        out.write(message)
        time.sleep(0.05)


if __name__ == "__main__":
    try:
        {"watch": watch, "call": call, "stamps": stamps, "publish": publish}[sys.argv[1]](sys.argv[2])
    except KeyboardInterrupt:
        # The end of the test.
        pass
