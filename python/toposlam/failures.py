"""Starts on which an explorer failed, with the whole run."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Union

from . import _core
from .errors import ExplorerError, GuessedError, LimitError, PictureError, ToposlamError
from .worlds import Dart, Picture, World


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
    marker: str
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
    def percepts(self) -> tuple[_core.Percept, ...]:
        """What the robot sensed, at the start and after each action."""
        robot = self.world.robot(self.marker, max(1, len(self.actions)))
        percepts = [robot.percept]
        for action in self.actions:
            if isinstance(action, int):
                robot.go(action)
            elif action == "pick-up":
                robot.pick_up()
            else:
                robot.drop()
            percepts.append(robot.percept)
        return tuple(percepts)

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
        return self.world.draw(title=f"{verdict} on {self.world.name}", caption=caption, marker=self.marker)

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
        actions = [str(action) for action in self.actions]
        return _core.explorer_run(self.world._core, self.marker, actions, self._beside(), str(self))

    def _repr_svg_(self) -> str:
        return self.draw().svg

    def __str__(self) -> str:
        return str(self.error)


def failure_of(
    world: World, start: str, error: ExplorerError, robot: _core.Robot, marker: str, number: int
) -> Failure:
    """The failure of a run from a start, which is completed in its error."""
    error.start, error.moves = start, robot.moves
    actions = tuple(robot.actions)
    if isinstance(error, GuessedError):
        error._walk = (world, marker, actions)
    map_, pose = _returned(error.answer)
    error.answer = None
    return Failure(world, error, actions, number, marker, map_, pose)


def _returned(answer: object) -> tuple[World | None, Dart | None]:
    """The map of an answer as a world, and the pose in it."""
    if not (isinstance(answer, (tuple, list)) and len(answer) == 2):
        return None, None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            map_ = World(answer[0], name="map")
        return map_, map_.darts()[map_.number(answer[1])]
    except ToposlamError:
        return None, None
