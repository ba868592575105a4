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
percept. `None` is no marker. It must not depend on names."""

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
        core = _core.World.from_doors(degrees, opposite, names, "world", "", 0)
        world = World._of(core)
        poses = world.darts()
        with self._lock:
            self._thread = threading.get_ident()
        try:
            rows = []
            for placed in poses:
                at = world.with_start(placed)
                rows.append([self._number(pose, at) for pose in poses])
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


def of_core(marker: Marker) -> Union[str, Sightings]:
    """A marker as the extension module takes it. Raises `MarkerFunctionError` if it is none."""
    if isinstance(marker, str):
        return marker
    if callable(marker):
        return Sightings(marker)
    raise MarkerFunctionError(f"a marker is a name or a function of (pose, world), not {marker!r}")
