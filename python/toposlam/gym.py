"""Exploration as an environment of gymnasium, for agents that learn. Needs `gymnasium`.

>>> import gymnasium, toposlam.gym
>>> env = gymnasium.make("toposlam/Exploration-v0", edges=3, cls="simple")
>>> observation, info = env.reset(seed=1)
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from . import _core
from .checks import given_starts
from .enumeration import Edges, check_class, sizes_of, start_name
from .errors import NoStartError, SizeError
from .limits import check_limit, check_unused
from .progress import library
from .trails import Trail
from .worlds import World, world_of

if TYPE_CHECKING:
    import gymnasium
    import numpy
else:
    gymnasium = library("gymnasium", "toposlam.gym")
    numpy = library("numpy", "toposlam.gym")


class ExplorationEnv(gymnasium.Env[dict[str, Any], Any]):
    """A robot with a directional marker, which is to learn what its world is.

    An observation is a percept: `degree`, and `marker`, which is 0 if the marker is not here, and `door + 1`
    if it points along a door. An action is a door; door 0 is the way back. `info["action_mask"]` has 1 for
    each door that exists. If the agent takes another one, the robot stays where it is, and `info["is_valid"]`
    is False. Each action has the reward -1.

    The agent does not draw the map. The environment folds the walk into a `Trail`, and the episode terminates
    when the walk determines the world: then the trail is the map, `info["world"]`, and it is right. No walk
    that determines the world is shorter than the certificate, so the return of such an episode is at most
    `-info["certificate"]`. The explorers of `check` are measured alike: a right map after a shorter walk is a
    guess. An episode is truncated after `max_moves` actions.

    `info["form"]` is `Trail.form`: all that the walk so far proves. The last percept alone is much less.

    An episode begins at a start at random, each equally likely: of the starts of a class with `edges` edges
    (4 of `"multigraph"` unless they are given), or of `worlds`, which are those of `check`. They are kept in
    memory. `reset(options={"world": world})` begins at the start of that world; it has at most as many doors
    at a vertex as the others.

    Raises `SizeError`, `UnknownClassError` or `WorldTypeError`.

    >>> import toposlam as ts
    >>> from toposlam.gym import ExplorationEnv
    >>> world = ts.World.load("worlds/shape-6.toml")
    >>> env = ExplorationEnv(worlds=[world])
    >>> observation, info = env.reset()
    >>> int(observation["degree"]), info["action_mask"].tolist(), info["certificate"]
    (2, [1, 1, 0], 7)
    >>> for door in world.certificate():
    ...     observation, reward, terminated, truncated, info = env.step(door)
    >>> terminated, info["moves"], info["world"].is_isomorphic(world)
    (True, 7, True)
    """

    def __init__(
        self,
        edges: Edges | None = None,
        cls: str | None = None,
        *,
        worlds: Iterable[World] | None = None,
        max_moves: int = 200,
    ) -> None:
        check_limit("max_moves", max_moves)
        self._starts: list[tuple[_core.Start, str]] = []
        if worlds is None:
            cls = "multigraph" if cls is None else cls
            check_class(cls)
            for size in sizes_of(4 if edges is None else edges):
                for start in _core.Starts("start", cls, size, 0, 1):
                    self._starts.append((start, start_name(cls, start)))
        else:
            check_unused("with worlds", edges=edges, cls=cls)
            for _, world in given_starts(worlds):
                self._starts.append(_of_world(world))
        if not self._starts:
            raise SizeError("an environment needs at least one start")
        self.max_moves = max_moves
        self.most_doors = max(max(start.world("").doors[0]) for start, _ in self._starts)
        """The most doors of a vertex."""
        doors = self.most_doors + 1
        self.action_space = gymnasium.spaces.Discrete(self.most_doors)
        self.observation_space = gymnasium.spaces.Dict(
            {"degree": gymnasium.spaces.Discrete(doors), "marker": gymnasium.spaces.Discrete(doors)}
        )

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        super().reset(seed=seed)
        world = (options or {}).get("world")
        if world is None:
            start, self.name = self._starts[self.np_random.integers(len(self._starts))]
        else:
            start, self.name = _of_world(world_of(world))
            if max(start.world("").doors[0]) > self.most_doors:
                raise SizeError(f"{self.name} has a vertex with more than {self.most_doors} doors")
        self._certificate = start.certificate
        self._robot = start.robot("directional", self.max_moves)
        self._trail = Trail(self._robot.percept)
        self._actions = 0
        return self._observation(), self._info(is_valid=True)

    def step(self, action: Any) -> tuple[dict[str, Any], float, bool, bool, dict[str, Any]]:
        door = int(action)
        is_valid = 0 <= door < self._robot.percept.degree
        self._actions += 1
        if is_valid:
            self._trail.step(door, self._robot.go(door))
        terminated = self._trail.determines_world
        truncated = not terminated and self._actions >= self.max_moves
        return self._observation(), -1.0, terminated, truncated, self._info(is_valid)

    def _observation(self) -> dict[str, Any]:
        percept = self._robot.percept
        marker = percept.marker
        return {
            "degree": numpy.int64(percept.degree),
            "marker": numpy.int64(marker + 1 if isinstance(marker, int) else 0),
        }

    def _info(self, is_valid: bool) -> dict[str, Any]:
        mask = numpy.zeros(self.most_doors, dtype=numpy.int8)
        mask[: self._robot.percept.degree] = 1
        info = {
            "action_mask": mask,
            "is_valid": is_valid,
            "moves": self._robot.moves,
            "start": self.name,
            "certificate": self._certificate,
            "form": self._trail.form,
        }
        if self._trail.determines_world:
            info["world"] = self._trail.world
        return info


def _of_world(world: World) -> tuple[_core.Start, str]:
    """The start of a world, and its name."""
    if world.start is None:
        raise NoStartError(f"{world.name} has no start; with_start('vertex:facing') gives it one")
    return _core.Start.of(world._core, world.facing(), 0), world.name


gymnasium.register("toposlam/Exploration-v0", "toposlam.gym:ExplorationEnv")
