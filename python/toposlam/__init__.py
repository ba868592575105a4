"""Deterministic topological SLAM: explore worlds, check explorers, and compare markers.

>>> import toposlam as ts
>>> w = ts.World.load("worlds/figure-1a.toml")
>>> run = ts.explore(w, algorithm="folding")
>>> run.moves, run.certificate
(14, 12)
"""

from . import errors
from ._core import Percept, Robot
from .checks import CheckReport, SizeReport, check, check_shard, merge, shards
from .comparisons import (
    Comparison,
    Counterexamples,
    SearchedSize,
    Walk,
    WorldPair,
    compare,
    counterexample,
)
from .enumeration import CLASSES, count_starts, count_worlds, random_world, starts, worlds
from .errors import ExplorerError, ToposlamError, WorldError
from .failures import Failure
from .logs import ConformReport, Divergence, Log, LogEvent, Table, conform, read_log
from .markers import MARKERS, OwnPercept
from .play import Page, play
from .plots import plot_costs, plot_visits, plot_way
from .runs import Run, explore
from .trails import Trail
from .worlds import Dart, Picture, World

__all__ = [
    "CLASSES",
    "MARKERS",
    "CheckReport",
    "Comparison",
    "ConformReport",
    "Counterexamples",
    "Dart",
    "Divergence",
    "ExplorerError",
    "Failure",
    "Log",
    "LogEvent",
    "OwnPercept",
    "Page",
    "Percept",
    "Picture",
    "Robot",
    "Run",
    "SearchedSize",
    "SizeReport",
    "Table",
    "ToposlamError",
    "Trail",
    "Walk",
    "World",
    "WorldError",
    "WorldPair",
    "check",
    "check_shard",
    "compare",
    "conform",
    "count_starts",
    "count_worlds",
    "counterexample",
    "errors",
    "explore",
    "merge",
    "play",
    "plot_costs",
    "plot_visits",
    "plot_way",
    "random_world",
    "read_log",
    "shards",
    "starts",
    "worlds",
]
