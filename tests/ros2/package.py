"""Prints the commands that the launch file makes of each configuration, as JSON lines: as it is, and with corridors:=false.
It checks that the manifests parse.

The modules of ROS 2 that it imports are stand-ins.
"""

import importlib.util
import json
import sys
import types
import xml.etree.ElementTree
from pathlib import Path

try:
    import yaml  # noqa: F401
except ImportError:
    sys.exit("no yaml")

folder = Path(sys.argv[1])


class Stand:
    """A class of launch that keeps its arguments."""

    def __init__(self, *words, **named):
        self.words, self.named = words, named

    def perform(self, context):
        return context[self.words[0]]


modules = {
    "ament_index_python": {},
    "ament_index_python.packages": {"get_package_share_directory": lambda name: str(folder / name)},
    "launch": {"LaunchDescription": Stand},
    "launch.actions": {"DeclareLaunchArgument": Stand, "ExecuteProcess": Stand, "OpaqueFunction": Stand},
    "launch.substitutions": {"LaunchConfiguration": Stand},
}
for name, members in modules.items():
    sys.modules[name] = types.ModuleType(name)
    vars(sys.modules[name]).update(members)

for manifest in sorted(folder.glob("*/package.xml")):
    package = xml.etree.ElementTree.parse(manifest).getroot()
    assert package.tag == "package" and package.get("format") == "3", manifest
    assert package.findtext("name") == manifest.parent.name, manifest

path = folder / "toposlam_ros/launch/drive.launch.py"
spec = importlib.util.spec_from_file_location("drive_launch", path)
launch = importlib.util.module_from_spec(spec)
spec.loader.exec_module(launch)
*declared, start = launch.generate_launch_description().words[0]
defaults = {one.words[0]: one.named["default_value"] for one in declared}
for config in sorted((folder / "toposlam_ros/config").glob("*.yaml")):
    for corridors in ("", "false"):
        given = {"config": config.stem, "namespace": "robot1", "corridors": corridors}
        (process,) = start.named["function"]({**defaults, **given})
        print(json.dumps(process.named["cmd"]))
