"""Lets a robot map its building: `ros2 launch toposlam_ros drive.launch.py config:=turtlebot4`.

The program `toposlam` is built with `cargo build --release --features ros2`; `program` is its path. Ctrl-C stops the
robot and then the program.
"""

import os

import yaml
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction
from launch.substitutions import LaunchConfiguration

ARGUMENTS = {
    "config": ("turtlebot4", "a file of options, or the name of one of this package"),
    "program": ("toposlam", "the program"),
    "namespace": ("", "the namespace of the robot's topics"),
    "corridors": ("", "true or false, instead of the file: whether the building is a network of corridors"),
    "log": ("run.mcap", "the file for the log of the run"),
    "map": ("map.toml", "the file for the map"),
}


def command(config, program, namespace, corridors, log, map_file):
    """The command with the options of a file. A list is an option that is repeated."""
    if not os.path.isfile(config):
        folder = get_package_share_directory("toposlam_ros")
        config = os.path.join(folder, "config", config + ".yaml")
    with open(config, encoding="utf-8") as text:
        options = yaml.safe_load(text)["drive"]
    if corridors:
        options["corridors"] = yaml.safe_load(corridors)
    words = [program, "drive", "--ros2", "--log", log, "--map", map_file]
    if namespace:
        words += ["--namespace", namespace]
    for name, value in options.items():
        for one in value if isinstance(value, list) else [value]:
            if one is True:
                words.append("--" + name)
            elif one is not False:
                words += ["--" + name, str(one)]
    return words


def start(context):
    values = [LaunchConfiguration(name).perform(context) for name in ARGUMENTS]
    # The robot stands before the program ends.
    return [ExecuteProcess(cmd=command(*values), output="screen", sigterm_timeout="15")]


def generate_launch_description():
    declared = [
        DeclareLaunchArgument(name, default_value=value, description=about)
        for name, (value, about) in ARGUMENTS.items()
    ]
    return LaunchDescription(declared + [OpaqueFunction(function=start)])
