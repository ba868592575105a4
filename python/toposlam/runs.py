"""Runs of algorithms and explorers in one world."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Union

from . import _core
from .comparisons import Action
from .errors import SizeError
from .explorers import MAX_MOVES, SECONDS, Clock, Explorer, check_explorer, judged
from .worlds import Dart, Picture, World


@dataclass(frozen=True)
class Run:
    """A run that mapped its world."""

    world: World
    algorithm: str
    moves: int
    actions: tuple[Action, ...]
    """What the robot did: doors, and "pick-up" and "drop"."""
    map: World | None
    """The map, for an algorithm of this package."""
    pose: Dart | None
    """The robot's pose in the map."""
    story: str
    """The run, round by round; empty for an explorer of your own."""

    @cached_property
    def certificate(self) -> int:
        """The number of moves of a shortest walk that proves the map: no correct explorer makes fewer."""
        return len(self.world.certificate())

    def draw(self) -> Picture:
        """The map, or else the world."""
        drawn = self.world if self.map is None else self.map
        return drawn.draw(caption=f"mapped in {self.moves} moves")

    def _repr_svg_(self) -> str:
        return self.draw().svg

    def __repr__(self) -> str:
        return f"<Run of {self.algorithm} in {self.world.name}: {self.moves} moves>"


def explore(
    world: World,
    algorithm: Union[str, Explorer] = "algorithm1",
    *,
    max_darts: int = 1_000_000,
    max_moves: int = MAX_MOVES,
    seconds: float | None = SECONDS,
) -> Run:
    """Maps a world with `"algorithm1"`, `"folding"`, `"movable"`, or with an explorer of your own.

    An explorer that fails raises an `ExplorerError`. `max_moves` and `seconds` are for explorers, `max_darts`
    is for the algorithms.

    >>> import toposlam as ts
    >>> run = ts.explore(ts.World.load("worlds/shape-6.toml"), algorithm="folding")
    >>> run.moves, run.certificate
    (7, 7)
    >>> print(run.story.splitlines()[0])
    World shape-6. The robot starts at corner, with its back to the door to tee.
    """
    facing = world.facing()
    if not isinstance(algorithm, str):
        return _explored(world, algorithm, max_moves, seconds)
    if isinstance(max_darts, bool) or not isinstance(max_darts, int) or max_darts < 1:
        raise SizeError(f"max_darts is a number from 1, not {max_darts!r}")
    found = _core.explore(world._core, facing, algorithm, max_darts)
    map_ = World._of(found["map"])
    return Run(
        world=world,
        algorithm=algorithm,
        moves=found["moves"],
        actions=tuple(found["actions"]),
        map=map_,
        pose=map_.darts()[found["pose"]],
        story=found["story"],
    )


def _explored(world: World, explorer: Explorer, max_moves: int, seconds: float | None) -> Run:
    check_explorer(explorer)
    start = _core.Start.of(world._core, world.facing())
    robot = start.robot("directional", max_moves)
    with Clock(seconds) as clock:
        error = judged(explorer, start, robot, clock)
    if error is not None:
        error.start = f"{world.name} {world._core.start_text(world.facing())}"
        error.moves = robot.moves
        raise error
    name = getattr(explorer, "__name__", type(explorer).__name__)
    return Run(world, name, robot.moves, tuple(robot.actions), None, None, "")
