"""Kinds of markers: names, and functions of your own."""

from __future__ import annotations

from collections.abc import Hashable
from typing import Callable, Union

from . import _core
from .errors import MarkerFunctionError, ToposlamError
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


def sightings(function: MarkerFunction) -> Callable[[list[int], list[int]], list[list[int]]]:
    """For a graph, the number of the sighting at each pose, for each dart that places the marker."""
    numbers: dict[Hashable, int] = {None: 0}

    def table(degrees: list[int], opposite: list[int]) -> list[list[int]]:
        names = [f"v{number}" for number in range(len(degrees))]
        core = _core.World.from_doors(degrees, opposite, names, None, "world", "", 0)
        world = World._of(core)
        poses = world.darts()
        rows = []
        for placed in poses:
            at = world.with_start(placed)
            rows.append([_number(function, pose, at, numbers) for pose in poses])
        return rows

    return table


def _number(function: MarkerFunction, pose: Dart, world: World, numbers: dict[Hashable, int]) -> int:
    place = f"pose {pose.vertex}:{pose.index} in {world!r}"
    try:
        sighting = function(pose, world)
        return numbers.setdefault(sighting, len(numbers))
    except ToposlamError:
        raise
    except TypeError as cause:
        raise MarkerFunctionError(f"the marker's function at {place}: {cause}") from cause
    except Exception as cause:
        text = f"the marker's function at {place}: {type(cause).__name__}: {cause}"
        raise MarkerFunctionError(text) from cause


def of_core(marker: Marker) -> object:
    """A marker as the Rust half takes it."""
    if isinstance(marker, str):
        return marker
    if callable(marker):
        return sightings(marker)
    raise MarkerFunctionError(f"a marker is a name or a function of (pose, world), not {marker!r}")
