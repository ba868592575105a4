"""Starts on which an explorer failed, with the whole run."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Union

from . import _core
from .errors import ExplorerError, GuessedError, LimitError, PictureError, ToposlamError
from .explorers import Answer, mapped
from .markers import Marker, OwnPercept, drawn
from .worlds import Dart, Picture, World

AnyPercept = Union[_core.Percept, OwnPercept]


@dataclass(frozen=True)
class Failure:
    """A start on which an explorer failed, or reached a limit."""

    world: World
    """The world, with the start."""
    error: ExplorerError
    """What is wrong. Its class is the cause."""
    actions: tuple[Union[int, str], ...]
    """What the robot did."""
    number: int
    """The number of the start among those with as many edges."""
    marker: Marker
    """The kind of marker of the robot."""
    map: World | None = None
    """The map that the explorer returned, if it is one."""
    pose: Dart | None = None
    """The robot's pose in it, as the explorer returned it."""

    @property
    def moves(self) -> int:
        """The number of moves made."""
        return sum(isinstance(action, int) for action in self.actions)

    @cached_property
    def percepts(self) -> tuple[AnyPercept, ...]:
        """What the robot sensed, at the start and after each action."""
        return _percepts(self.world, self.marker, self.actions)

    @property
    def other(self) -> World | None:
        """The smallest other world with the same run, if the explorer guessed."""
        return self.error.other if isinstance(self.error, GuessedError) else None

    @property
    def story(self) -> str:
        """The run, step by step: what the robot did, where it was, and what it sensed. Then the map that the
        explorer returned, and the first step that contradicts it; or the other world of a guess."""
        return f"{self}\n\n{self._shown()['story']}"

    def draw(self) -> Picture:
        """The world, and beside it the map that the explorer returned, or the other world of a guess."""
        if self._beside() is not None:
            return Picture(self._shown()["picture"])
        text = self.error.message
        moves = f"after {self.moves} move{'' if self.moves == 1 else 's'}"
        caption = f"{moves}: {text if len(text) <= 90 else text[:87] + '...'}"
        verdict = "not known" if isinstance(self.error, LimitError) else "fails"
        title = f"{verdict} on {self.world.name}"
        return self.world.draw(title=title, caption=caption, marker=drawn(self.marker))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the run: a page on which it can be stepped through (.html), or a picture (.svg, .png)."""
        file = Path(path)
        if file.suffix == ".html":
            file.write_text(self._shown()["page"], encoding="utf-8")
        elif file.suffix in (".svg", ".png"):
            self.draw().save(file)
        else:
            raise PictureError(f"{file}: the name of a run ends with .html, .svg or .png")

    def _beside(self) -> tuple[_core.World, str] | None:
        if isinstance(self.error, GuessedError) and self.error.other is not None:
            return self.error.other._core, "smallest" if self.error.other_is_smallest else "other"
        return None if self.map is None else (self.map._core, "map")

    def _shown(self) -> _core._ExplorerRun:
        return run_shown(self.world, self.marker, self.actions, self._beside(), str(self))

    def _repr_svg_(self) -> str:
        return self.draw().svg

    def __str__(self) -> str:
        return str(self.error)


def place(world: World) -> str:
    """The name of a start in messages."""
    return f"{world.name} {world._core.start_text(world.facing())}"


def failure_of(
    world: World, ended: tuple[ExplorerError, Answer], robot: _core.Robot, marker: Marker, number: int
) -> Failure:
    """The failure of a run from the start of a world, which is completed in its error."""
    error, answer = ended
    error.start, error.moves = place(world), robot.moves
    actions = tuple(robot.actions)
    if isinstance(error, GuessedError):
        error._walk = (world, marker, actions)
    if robot.refusal is not None:
        # The run ended there, whatever the explorer returned.
        return Failure(world, error, actions, number, marker)
    try:
        map_, pose = mapped(answer, "map")
    except (ToposlamError, TypeError, ValueError, OverflowError):
        return Failure(world, error, actions, number, marker)
    return Failure(world, error, actions, number, marker, map_, pose)


def _percepts(world: World, marker: Marker, actions: Sequence[Union[int, str]]) -> tuple[AnyPercept, ...]:
    robot = world.robot(marker, max_moves=max(1, len(actions)))
    percepts = [robot.percept]
    for action in actions:
        if isinstance(action, int):
            robot.go(action)
        else:
            robot.act(action)
        percepts.append(robot.percept)
    return tuple(percepts)


def run_shown(
    world: World,
    marker: Marker,
    actions: Sequence[Union[int, str]],
    beside: tuple[_core.World, str] | None,
    ending: str,
) -> _core._ExplorerRun:
    """A run from the start of a world as a text, a picture and a page."""
    texts = [str(action) for action in actions]
    # What a function of a pose adds to percepts, the extension module does not know.
    own = None if isinstance(marker, str) else [str(percept) for percept in _percepts(world, marker, actions)]
    return _core.explorer_run(world._core, drawn(marker), texts, own, beside, ending)
