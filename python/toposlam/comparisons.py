"""Worlds that a marker cannot distinguish."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import Any, Union

from . import _core
from .errors import SizeError
from .logs import Table
from .markers import Marker, OwnPercept, Sightings, drawn, marker_name, of_core
from .progress import bar
from .worlds import Dart, Picture, World, world_of

Action = Union[int, str]
"""What a robot does: a door, "pick-up" or "drop"."""


@dataclass(frozen=True)
class Walk:
    """A walk that distinguishes two worlds: what both robots do, and what they sense at its end."""

    actions: tuple[Action, ...]
    percepts: tuple[Union[_core.Percept, OwnPercept], Union[_core.Percept, OwnPercept]]
    """An `OwnPercept` each if the marker is a function."""


@dataclass(frozen=True)
class Comparison:
    """Two worlds, compared."""

    one: World
    other: World
    bijection: dict[Dart, Dart] | None
    """From the darts of one to those of the other, if they are isomorphic as graphs."""
    difference: str | None
    """What differs first, if they are not."""
    are_mirror_images: bool
    start_like: Dart | None
    """The start of the other world that is indistinguishable from that of the one."""
    relation: tuple[tuple[Dart, Dart], ...] | None
    """All pairs of poses in which two robots that do the same can be, if they never sense a difference. It
    proves that, and was verified. With an aid that moves, a pair of poses may occur several times."""
    walk: Walk | None
    """The shortest walk that distinguishes the worlds, if there is one. It was verified."""

    @property
    def is_isomorphic(self) -> bool:
        """Whether the worlds are isomorphic as graphs."""
        return self.bijection is not None

    @property
    def is_distinguishable(self) -> bool:
        """Whether a robot can distinguish the worlds."""
        return self.walk is not None

    def __repr__(self) -> str:
        same = "isomorphic" if self.is_isomorphic else f"not isomorphic: {self.difference}"
        if self.relation is not None:
            relation = f"indistinguishable, by a relation of {len(self.relation)} pairs"
        else:
            doors = () if self.walk is None else self.walk.actions
            relation = f"distinguished by {list(doors)}"
        return f"<Comparison of {self.one.name} and {self.other.name}: {same}; {relation}>"


def compare(one: World, other: World, marker: Marker = "directional") -> Comparison:
    """Compares two worlds, and what a robot with a marker can find out about them.

    `marker` is a name, or a function of your own: see `MarkerFunction`. The relation or the walk of the
    result was verified.

    Raises `WorldTypeError` for what is not a world, `NoStartError` if one has no start, `UnknownMarkerError`
    or `MarkerFunctionError`, and `SizeError` if the worlds or the relation are too large.

    >>> import toposlam as ts
    >>> a, b = ts.World.load("worlds/figure-1a.toml"), ts.World.load("worlds/figure-1b.toml")
    >>> found = ts.compare(a, b, marker="undirected")
    >>> found.difference, len(found.relation)
    ('genus 0 against 1', 32)
    >>> ts.compare(a, b).walk.actions
    (0, 1, 1)
    """
    one, other, kind = world_of(one), world_of(other), of_core(marker)
    if isinstance(kind, Sightings):
        # With the names of the caller, which the graphs in the extension module do not have.
        for world in (one, other):
            kind.of_world(world)
    found = _core.compare(one._core, one.facing(), other._core, other.facing(), kind)
    here, there = one.darts(), other.darts()
    images, pairs, percepts = found["bijection"], found["relation"], found["percepts"]
    walk = None
    if found["walk"] is not None and percepts is not None:
        here_sensed, there_sensed = percepts
        if isinstance(kind, str):
            walk = Walk(tuple(found["walk"]), (here_sensed, there_sensed))
        else:
            walk = Walk(tuple(found["walk"]), (kind.percept(here_sensed), kind.percept(there_sensed)))
    start = found["start_like"]
    return Comparison(
        one=one,
        other=other,
        bijection=None if images is None else dict(zip(here, (there[image] for image in images))),
        difference=found["difference"],
        are_mirror_images=found["mirror"],
        start_like=None if start is None else there[start],
        relation=None if pairs is None else tuple((here[a[0]], there[b[0]]) for a, b in pairs),
        walk=walk,
    )


@dataclass(frozen=True)
class WorldPair:
    """Two worlds that a marker cannot distinguish."""

    one: World
    other: World
    marker: Marker

    def compare(self) -> Comparison:
        """The relation that proves it."""
        return compare(self.one, self.other, self.marker)

    def draw(self) -> Picture:
        """Both worlds, side by side."""
        kind = drawn(self.marker)
        pictures = [world.draw(marker=kind).svg for world in (self.one, self.other)]
        return Picture(_core.World.side_by_side(pictures))

    def _repr_svg_(self) -> str:
        return self.draw().svg


@dataclass(frozen=True)
class SearchedSize:
    """What a search found among the worlds with one number of edges."""

    edges: int
    placed_worlds: int
    """Worlds, each with the place of its marker, up to isomorphism."""
    ambiguous: int
    """Those that are indistinguishable from another one of this or a smaller size."""


@dataclass(frozen=True)
class Counterexamples:
    """All worlds up to a size that a marker cannot distinguish."""

    marker: Marker
    cls: str
    sizes: tuple[SearchedSize, ...]
    groups: tuple[tuple[World, ...], ...]
    """Worlds that are indistinguishable from each other; the group with the smallest pair first."""

    @property
    def smallest(self) -> WorldPair | None:
        """The smallest pair, or None if there is none."""
        return next(iter(self.pairs()), None)

    def pairs(self) -> list[WorldPair]:
        """All pairs, group by group."""
        return [
            WorldPair(one, other, self.marker)
            for group in self.groups
            for one, other in combinations(group, 2)
        ]

    def pandas(self) -> Any:
        """What was found, as a `pandas.DataFrame`: a row for each number of edges.

        >>> import toposlam as ts
        >>> ts.counterexample("none", "simple", 4).pandas()["ambiguous"].tolist()
        [0, 0, 1, 1]
        """
        columns = ("edges", "placed_worlds", "ambiguous")
        return Table({name: [getattr(size, name) for size in self.sizes] for name in columns}).pandas()

    def __repr__(self) -> str:
        marker = marker_name(self.marker)
        edges = self.sizes[-1].edges if self.sizes else 0
        found = f"{sum(map(len, self.groups))} worlds in {len(self.groups)} groups"
        return f"<Counterexamples: {marker}, {self.cls}, up to {edges} edges: {found}>"


def counterexample(
    marker: Marker = "undirected",
    cls: str = "simple",
    edges: int = 6,
    *,
    progress: bool | None = None,
) -> Counterexamples:
    """Searches all worlds of a class with up to `edges` edges for those that a marker cannot distinguish.

    `marker` is a name, or a function of your own: see `MarkerFunction`. `progress` shows a bar or not;
    without it, on a terminal and in a notebook. Each pair that is found was confirmed by a verified
    relation.

    Raises `UnknownMarkerError`, `MarkerFunctionError`, `UnknownClassError` or `SizeError`.

    >>> import toposlam as ts
    >>> ts.counterexample(marker="directional", cls="simple", edges=5).smallest is None
    True
    >>> ts.counterexample(marker="none", cls="simple", edges=4).smallest.other
    <World none-2: 4 vertices, 4 edges, genus 0, start v0:v1>
    """
    if isinstance(edges, bool) or not isinstance(edges, int) or not 1 <= edges < 2**63:
        raise SizeError(f"a number of edges is at least 1, not {edges!r}")
    with bar("searching", "worlds", progress) as advance:
        sizes, groups = _core.counterexample(of_core(marker), cls, edges, advance)
    name = marker if isinstance(marker, str) else "world"
    number = 0
    named = []
    for group in groups:
        worlds = []
        for core in group:
            number += 1
            worlds.append(World._of(core.with_start(core.start, f"{name}-{number}", core.about)))
        named.append(tuple(worlds))
    return Counterexamples(marker, cls, tuple(SearchedSize(*size) for size in sizes), tuple(named))
