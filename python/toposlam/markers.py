"""Kinds of markers: names, and functions of your own."""

from __future__ import annotations

import threading
from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from typing import Callable, Union

from . import _core
from .errors import MarkerFunctionError, ToposlamError, UnknownMarkerError
from .threads import raise_in
from .worlds import Dart, World

MARKERS = (
    "none",
    "undirected",
    "directional",
    "undirected-edge",
    "directed-edge",
    "two-identical",
    "two-distinct",
    "movable",
    "movable-2",
    "movable-3",
    "movable-4",
    "movable-2-distinct",
    "movable-3-distinct",
    "movable-4-distinct",
    "movable-directional",
    "movable+directional",
    "string-1",
    "string-2",
    "string-3",
    "team-2",
    "team-2-round",
    "team-3",
    "team-3-round",
    "binoculars-1",
    "binoculars-2",
    "binoculars-3",
)
"""The names of the marking aids."""

MarkerFunction = Callable[[Dart, World], Hashable]
"""A kind of marker: from a robot's pose, and the world whose start places the marker, to what it adds to the
percept. `None` is no marker. It gives the same each time, and the same for a copy of the world: a robot knows
neither the names of vertices nor which of their doors is the first."""

Marker = Union[str, MarkerFunction]


@dataclass(frozen=True)
class OwnPercept:
    """What a robot senses with a marker that is a function: the degree, and the value of the function."""

    degree: int
    marker: Hashable

    def __str__(self) -> str:
        sighting = "no marker" if self.marker is None else f"marker {self.marker!r}"
        return f"{self.degree} door{'' if self.degree == 1 else 's'}, {sighting}"


class _Interrupted(BaseException):
    """Raised in the thread that calls a marker's function, which cannot catch it by accident."""


class Sightings:
    """The sightings of a marker that is a function, as numbers. 0 is None."""

    def __init__(self, function: MarkerFunction) -> None:
        self._function = function
        self._numbers: dict[Hashable, int] = {None: 0}
        self._lock = threading.Lock()
        self._thread: int | None = None

    def __call__(self, degrees: list[int], opposite: list[int]) -> list[list[int]]:
        """For a graph, the number of the sighting at each pose, for each dart that places the marker."""
        names = [f"v{number}" for number in range(len(degrees))]
        return self.of_world(World._of(_core.World.from_doors(degrees, opposite, names, "world", "", 0)))

    def of_world(self, world: World, placed: Sequence[int] | None = None) -> list[list[int]]:
        """The same for a world, and for the darts that place the marker, by their numbers; all, unless they
        are given. Raises `MarkerFunctionError` if the function gives something else when it is called again,
        or for the same pose in a copy with other names and numbers."""
        with self._lock:
            self._thread = threading.get_ident()
        try:
            poses = world.darts()
            placed = range(len(poses)) if placed is None else placed
            rows = self._rows(world, poses, placed)
            self._compare(world, placed, (rows, self._rows(world, poses, placed)), "gives {}, and then {}")
            copy, images = _renamed(world)
            self._compare(
                world,
                placed,
                (rows, self._rows(copy, images, placed)),
                "gives {}, and {} in a copy with other names, order of vertices and first doors: "
                "a robot knows none of these",
            )
            return rows
        finally:
            with self._lock:
                self._thread = None
            # An exception that `stop` has raised by now arrives here, and not later.
            for _ in range(4):
                pass

    def stop(self) -> None:
        """Ends a call in another thread."""
        with self._lock:
            if self._thread is not None:
                raise_in(self._thread, _Interrupted)

    def percept(self, sensed: _core.Percept) -> OwnPercept:
        """A percept with the value of the function in place of its number."""
        number = sensed.marker or 0
        return OwnPercept(sensed.degree, self._values()[number] if isinstance(number, int) else None)

    def at_start(self, world: World) -> list[OwnPercept]:
        """What a robot senses at each pose of a world, whose start places the marker."""
        (row,) = self.of_world(world, [world.facing()])
        values = self._values()
        return [
            OwnPercept(world.degree(pose.vertex), values[number]) for pose, number in zip(world.darts(), row)
        ]

    def _values(self) -> dict[int, Hashable]:
        return {number: value for value, number in self._numbers.items()}

    def _rows(self, world: World, poses: list[Dart], placed: Sequence[int]) -> list[list[int]]:
        """The numbers of the sightings at poses, for each of those that place the marker."""
        worlds = [world.with_start(poses[number]) for number in placed]
        return [[self._number(pose, at) for pose in poses] for at in worlds]

    def _compare(
        self, world: World, placed: Sequence[int], rows: tuple[list[list[int]], list[list[int]]], what: str
    ) -> None:
        """Raises `MarkerFunctionError` if the sightings in a world are not those of another time or copy."""
        poses = world.darts()
        for number, row, other in zip(placed, *rows):
            for pose, one, two in zip(poses, row, other):
                if one != two:
                    values = self._values()
                    at = f"pose {pose.vertex}:{pose.index} in {world.with_start(poses[number])!r}"
                    differ = what.format(repr(values[one]), repr(values[two]))
                    raise MarkerFunctionError(f"the marker's function at {at} {differ}")

    def _number(self, pose: Dart, world: World) -> int:
        place = f"pose {pose.vertex}:{pose.index} in {world!r}"
        try:
            sighting = self._function(pose, world)
            return self._numbers.setdefault(sighting, len(self._numbers))
        except ToposlamError:
            raise
        except TypeError as cause:
            raise MarkerFunctionError(f"the marker's function at {place}: {cause}") from cause
        except Exception as cause:
            text = f"the marker's function at {place}: {type(cause).__name__}: {cause}"
            raise MarkerFunctionError(text) from cause


def _renamed(world: World) -> tuple[World, list[Dart]]:
    """A copy of a world with other names, numbers of vertices and first doors, and the image of each dart."""
    order = world.vertices[::-1]
    names = {vertex: _letters(number) for number, vertex in enumerate(order)}
    degrees = {vertex: world.degree(vertex) for vertex in order}

    def image(dart: Dart) -> Dart:
        return Dart(names[dart.vertex], (dart.index + 1) % degrees[dart.vertex])

    def turned(darts: list[Dart]) -> list[Dart]:
        return darts[-1:] + darts[:-1]

    ends = {
        names[vertex]: [image(world.opposite(dart)) for dart in turned(world.darts(vertex))]
        for vertex in order
    }
    return World(ends), [image(dart) for dart in world.darts()]


def _letters(number: int) -> str:
    """A name of letters: a to z, ba, bb, and so on."""
    rest, last = divmod(number, 26)
    return (_letters(rest) if rest else "") + chr(ord("a") + last)


def of_core(marker: Marker) -> Union[str, Sightings]:
    """A marker as the extension module takes it. Raises `MarkerFunctionError` if it is none."""
    if isinstance(marker, str):
        return marker
    if callable(marker):
        return Sightings(marker)
    raise MarkerFunctionError(f"a marker is a name or a function of (pose, world), not {marker!r}")


def check_marker(marker: object) -> None:
    """Raises an exception if this is neither the name of a marker nor a function."""
    if not callable(marker) and marker not in MARKERS:
        raise UnknownMarkerError(
            f"{marker!r} is not a marker; they are {', '.join(MARKERS)}, and functions of (pose, world)"
        )


def sensed(marker: Marker, start: _core.Start, world: World | None) -> Union[str, list[OwnPercept]]:
    """A marker as a robot at a start takes it: its name, or what the robot senses at each pose of the start.
    The start is that of `world`, if that is given."""
    if isinstance(marker, str):
        return marker
    if world is None:
        return Sightings(marker).at_start(World._of(start.world("world")))
    percepts = Sightings(marker).at_start(world)
    return [percepts[dart] for dart in world._core.discovery_order(world.facing())]


def drawn(marker: Marker) -> str:
    """A marker in a picture: what a function of a pose adds to percepts lies nowhere. At the start a string
    as long as it takes looks like any other."""
    if marker == "string":
        return "string-1"
    return marker if isinstance(marker, str) else "none"


def marker_name(marker: Marker) -> str:
    """The name of a marker in a message."""
    return marker if isinstance(marker, str) else getattr(marker, "__name__", "own")
