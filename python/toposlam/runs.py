"""Runs of algorithms and explorers in one world."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Union

from . import _core
from .comparisons import Action
from .explorers import Clock, Explorer, check_explorer, judged, mapped
from .failures import failure_of, run_shown
from .limits import MAX_MOVES, SECONDS, check_limit, check_run_limits, check_unused
from .markers import Marker, check_marker, drawn, sensed
from .worlds import Dart, Picture, World, world_of


@dataclass(frozen=True)
class Run:
    """A run that mapped its world."""

    world: World
    algorithm: str
    marker: Marker
    """The kind of marker that the robot used."""
    moves: int
    actions: tuple[Action, ...]
    """What the robot did: doors, and "pick-up" and "drop"."""
    map: World
    """The map, with its start."""
    pose: Dart
    """The robot's pose in the map."""
    story: str
    """The run, round by round, or move by move for an explorer of your own."""

    @cached_property
    def certificate(self) -> int | None:
        """The number of moves of a shortest walk that proves the map: with the directional marker, no correct
        explorer makes fewer. None with another marker."""
        return len(self.world.certificate()) if self.marker == "directional" else None

    def draw(self) -> Picture:
        """The map."""
        return self.map.draw(caption=f"mapped in {self.moves} moves", marker=drawn(self.marker))

    def _repr_svg_(self) -> str:
        return self.draw().svg

    def __repr__(self) -> str:
        return f"<Run of {self.algorithm} in {self.world.name}: {self.moves} moves>"


def explore(
    world: World,
    algorithm: Union[str, Explorer] = "algorithm1",
    *,
    max_darts: int | None = None,
    marker: Marker | None = None,
    max_moves: int | None = None,
    seconds: float | None = None,
) -> Run:
    """Maps a world with `"algorithm1"`, `"folding"`, the explorer of a marking aid that moves (`"movable"`,
    `"string"`, `"team-2"` and so on; `"string"` is as long as it takes), or with an explorer of your own.

    `marker`, the kind of marker of the robot (`"directional"`) or a function (see `MarkerFunction`),
    `max_moves` (100,000 moves, pick-ups and drops) and `seconds` (10; `math.inf` is no limit) are for
    explorers. `max_darts` (1,000,000), the most darts of the map, is for the algorithms.

    Raises an `ExplorerError` of the class that is the cause if an explorer fails or reaches a limit;
    `MapTooLargeError` or `NotSimpleError` for an algorithm; `WorldTypeError` or `NoStartError`;
    `UnknownAlgorithmError`, `UnknownMarkerError`, `MarkerFunctionError`, `SizeError`, or `UnusedOptionError`
    for an option that is not for this explorer or algorithm.

    >>> import toposlam as ts
    >>> run = ts.explore(ts.World.load("worlds/shape-6.toml"), algorithm="folding")
    >>> run.moves, run.certificate
    (7, 7)
    >>> print(run.story.splitlines()[0])
    World shape-6. The robot starts at corner, with its back to the door to tee.
    """
    world = world_of(world)
    facing = world.facing()
    if not isinstance(algorithm, str):
        check_explorer(algorithm)
        check_unused("with an explorer of your own", max_darts=max_darts)
        max_moves = MAX_MOVES if max_moves is None else max_moves
        seconds = SECONDS if seconds is None else seconds
        kind = "directional" if marker is None else marker
        return _explored(world, algorithm, kind, max_moves, seconds)
    check_unused("with an algorithm", marker=marker, max_moves=max_moves, seconds=seconds)
    max_darts = 1_000_000 if max_darts is None else max_darts
    check_limit("max_darts", max_darts)
    found = _core.explore(world._core, facing, algorithm, max_darts)
    map_ = World._of(found["map"])
    return Run(
        world=world,
        algorithm=algorithm,
        marker="directional" if algorithm in ("algorithm1", "folding") else algorithm,
        moves=found["moves"],
        actions=tuple(found["actions"]),
        map=map_,
        pose=map_.darts()[found["pose"]],
        story=found["story"],
    )


def _explored(world: World, explorer: Explorer, marker: Marker, max_moves: int, seconds: float) -> Run:
    check_marker(marker)
    check_run_limits(max_moves, seconds)
    start = _core.Start.of(world._core, world.facing(), 0)
    robot = start.robot(sensed(marker, start, world), max_moves)
    with Clock(seconds) as clock:
        error, answer = judged(explorer, start, robot, clock)
    if error is not None:
        error.failure = failure_of(world, (error, answer), robot, marker, 0)
        raise error
    name = getattr(explorer, "__name__", type(explorer).__name__)
    map_, pose = mapped(answer, f"{world.name}-map")
    actions = tuple(robot.actions)
    shown = run_shown(world, marker, actions, (map_._core, "map"), "The map and the pose are right")
    return Run(world, name, marker, robot.moves, actions, map_, pose, shown["story"])
