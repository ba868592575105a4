"""Kinds of markers: names, and functions of your own."""

from __future__ import annotations

import threading
from collections.abc import Hashable
from dataclasses import dataclass
from typing import Callable, Union

from . import _core
from .errors import MarkerFunctionError, ToposlamError
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
)
"""The names of the kinds of markers."""

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

    def of_world(self, world: World) -> list[list[int]]:
        """The same for a world. Raises `MarkerFunctionError` if the function gives something else when it is
        called again, or for the same pose in a copy with other names and numbers."""
        with self._lock:
            self._thread = threading.get_ident()
        try:
            rows = self._rows(world, world.darts())
            self._compare(world, rows, self._rows(world, world.darts()), "gives {}, and then {}")
            copy, images = _renamed(world)
            self._compare(
                world,
                rows,
                self._rows(copy, images),
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
        values = {number: value for value, number in self._numbers.items()}
        number = sensed.marker or 0
        return OwnPercept(sensed.degree, values[number] if isinstance(number, int) else None)

    def _rows(self, world: World, poses: list[Dart]) -> list[list[int]]:
        """The numbers of the sightings at poses, for each of them as the start."""
        return [[self._number(pose, at) for pose in poses] for at in map(world.with_start, poses)]

    def _compare(self, world: World, rows: list[list[int]], others: list[list[int]], what: str) -> None:
        """Raises `MarkerFunctionError` if the sightings in a world are not those of another time or copy."""
        poses = world.darts()
        for placed, row, other in zip(poses, rows, others):
            for pose, one, two in zip(poses, row, other):
                if one != two:
                    values = {number: value for value, number in self._numbers.items()}
                    at = f"pose {pose.vertex}:{pose.index} in {world.with_start(placed)!r}"
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
