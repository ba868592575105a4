"""What a walk proves about its world: the folded trail."""

from __future__ import annotations

from typing import Union

from . import _core
from .errors import ContradictionError, DoorTypeError, NoSuchDoorError, UnknownMarkerError
from .maps import is_int
from .markers import OwnPercept
from .worlds import Dart, World


class Trail:
    """What a walk proves about its world, by folding: see docs/folding.md.

    It begins with a percept, and `step` adds a move. Places that the walk proves to be one place are one
    vertex. That is exact for the markers `"directional"`, `"directed-edge"` and `"none"`.

    Raises `ContradictionError` if no world explains the walk, and `UnknownMarkerError` for a percept of a
    marker that is a function.

    >>> import toposlam as ts
    >>> world = ts.World.load("worlds/figure-1a.toml")
    >>> robot = world.robot()
    >>> trail = ts.Trail(robot.percept)
    >>> for door in world.certificate():
    ...     trail.step(door, robot.go(door))
    >>> trail.determines_world, trail.world.is_isomorphic(world)
    (True, True)
    """

    __slots__ = ("_trail",)

    _trail: _core.Trail

    def __init__(self, percept: Union[_core.Percept, OwnPercept]) -> None:
        self._trail = _core.Trail(_named(percept))

    def step(self, door: int, percept: Union[_core.Percept, OwnPercept]) -> None:
        """A move: the door taken, and the percept behind it. After a `ContradictionError`, the trail is of no
        more use."""
        if not is_int(door):
            raise DoorTypeError(f"a door is a number, not {door!r}")
        if not 0 <= door < 2**32:
            raise NoSuchDoorError(f"there is no door {door}")
        self._trail.step(door, _named(percept))

    @property
    def moves(self) -> int:
        """The number of moves."""
        return self._trail.moves

    @property
    def vertex_count(self) -> int:
        """The number of places that are not proved to be one."""
        return self._trail.vertex_count

    @property
    def unexplored(self) -> int:
        """The number of doors that are not proved to lead to a known place."""
        return self._trail.open_count

    @property
    def determines_world(self) -> bool:
        """Whether one world only, of any size, explains the walk: no door is unexplored."""
        return self._trail.open_count == 0

    @property
    def form(self) -> tuple[int, ...]:
        """The trail as it is seen from the robot. Two walks with the same form have the same future."""
        return tuple(self._trail.form)

    @property
    def world(self) -> World:
        """The trail as a world, with a dead end behind each unexplored door. Its start is where the marker
        points, if that was seen."""
        return World._of(self._closed()[0])

    @property
    def pose(self) -> Dart:
        """The robot's pose in `world`."""
        core, pose = self._closed()
        return World._of(core).darts()[pose]

    def _closed(self) -> tuple[_core.World, int]:
        closed = self._trail.closed()
        if closed is None:
            raise ContradictionError("no world explains the walk")
        return closed

    def __repr__(self) -> str:
        moves, vertices, unexplored = self.moves, self.vertex_count, self.unexplored
        return f"<Trail of {moves} moves: {vertices} vertices, {unexplored} unexplored doors>"


def _named(percept: Union[_core.Percept, OwnPercept]) -> _core.Percept:
    """The percept, which must be of a marker that has a name."""
    if isinstance(percept, _core.Percept):
        return percept
    raise UnknownMarkerError(f"a trail is folded from percepts of a marker that has a name, not {percept!r}")
