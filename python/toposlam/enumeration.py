"""All starts and all worlds of a class and a size, and starts at random."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache
from typing import Union

from . import _core
from .errors import SizeError, UnknownClassError
from .worlds import World

CLASSES = ("multigraph", "simple", "corridor", "planar")
"""The names of the classes of worlds."""

Edges = Union[int, Iterable[int]]

MOST_RANDOM_EDGES = 8
"""The most edges of a random world: all starts with as many edges are counted before one is drawn."""


def sizes_of(edges: Edges) -> tuple[int, ...]:
    """The numbers of edges, in order. Raises `SizeError` if one cannot be."""
    try:
        wanted = [edges] if isinstance(edges, int) else list(edges)
    except TypeError:
        wanted = [edges]  # type: ignore[list-item]
    for number in wanted:
        if isinstance(number, bool) or not isinstance(number, int) or not 1 <= number <= 32:
            raise SizeError(f"a number of edges is from 1 to 32, not {number!r}")
    if not wanted:
        raise SizeError("no number of edges is given: an empty check never holds")
    return tuple(sorted(set(wanted)))


def check_class(cls: object) -> None:
    """Raises `UnknownClassError` if this is not the name of a class."""
    if cls not in CLASSES:
        raise UnknownClassError(f"{cls!r} is not a class of worlds; they are {', '.join(CLASSES)}")


def start_name(cls: str, start: _core.Start) -> str:
    """The name of a start as a world."""
    return f"{cls}-{start.edges}-{start.number}"


def starts(edges: Edges, cls: str = "multigraph") -> Iterator[World]:
    """All starts of a class with `edges` edges, a number or several: each embedded graph with each start in
    it, up to isomorphism. An iterator; the next one is made when it is asked for.

    They are the starts of `check`, in its order and with its names. Up to 15 edges, the first one is there at
    once; in the classes without loops, the search for it takes twice as long for each further edge. Raises
    `SizeError` or `UnknownClassError`.

    >>> import toposlam as ts
    >>> list(ts.starts(2, cls="simple"))  # doctest: +NORMALIZE_WHITESPACE
    [<World simple-2-0: 3 vertices, 2 edges, genus 0, start v0:v1>,
     <World simple-2-1: 3 vertices, 2 edges, genus 0, start v0:v1>]
    >>> next(ts.starts(20, cls="corridor")).edge_count
    20
    """
    sizes = sizes_of(edges)
    check_class(cls)
    return (
        World._of(start.world(start_name(cls, start)))
        for size in sizes
        for start in _core.Starts("start", cls, size, 0, 1)
    )


def worlds(edges: Edges, cls: str = "multigraph") -> Iterator[World]:
    """All embedded graphs of a class with `edges` edges, a number or several, up to isomorphism, without
    starts. An iterator; the next one is made when it is asked for.

    Raises `SizeError` or `UnknownClassError`.

    >>> import toposlam as ts
    >>> for world in ts.worlds([1, 2], cls="simple"):
    ...     print(world, len(world.starts()))
    <World simple-1-world-0: 2 vertices, 1 edge, genus 0, no start> 1
    <World simple-2-world-0: 3 vertices, 2 edges, genus 0, no start> 2
    """
    sizes = sizes_of(edges)
    check_class(cls)
    return (
        World._of(found.world(f"{cls}-{size}-world-{found.number}")).with_start(None)
        for size in sizes
        for found in _core.Starts("world", cls, size, 0, 1)
    )


@cache
def _count(each: str, cls: str, edges: int) -> int:
    return _core.count_starts(each, cls, edges)


def count_starts(edges: Edges, cls: str = "multigraph") -> int:
    """The number of all `starts`. They are counted one by one, and once in a process. Raises `SizeError` or
    `UnknownClassError`.

    >>> import toposlam as ts
    >>> [ts.count_starts(edges) for edges in range(1, 6)]
    [2, 10, 74, 706, 8162]
    """
    sizes = sizes_of(edges)
    check_class(cls)
    return sum(_count("start", cls, size) for size in sizes)


def count_worlds(edges: Edges, cls: str = "multigraph") -> int:
    """The number of all `worlds`, as `count_starts`.

    >>> import toposlam as ts
    >>> [ts.count_worlds(edges) for edges in range(1, 6)]
    [2, 5, 20, 107, 870]
    """
    sizes = sizes_of(edges)
    check_class(cls)
    return sum(_count("world", cls, size) for size in sizes)


def random_world(edges: int, cls: str = "multigraph", seed: int = 1) -> World:
    """A start at random, each of a class and a number of edges equally likely. The same seed gives the same
    start, and that of `toposlam play --edges N --class CLASS --seed N`.

    `edges` is from 1 to 8, and `seed` from 0 to 2^64 - 1. Raises `SizeError` or `UnknownClassError`.

    >>> import toposlam as ts
    >>> ts.random_world(5, cls="corridor", seed=7)
    <World corridor-5-seed-7: 5 vertices, 5 edges, genus 0, start v0:v1>
    """
    check_class(cls)
    check_random(edges, seed)
    core = _core.random_world(cls, edges, seed)
    return World._of(core.with_start(core.start, f"{cls}-{edges}-seed-{seed}", ""))


def check_random(edges: object, seed: object) -> None:
    """Raises `SizeError` if no random world has these."""
    if isinstance(edges, bool) or not isinstance(edges, int) or not 1 <= edges <= MOST_RANDOM_EDGES:
        raise SizeError(
            f"a random world has from 1 to {MOST_RANDOM_EDGES} edges, not {edges!r}: all starts with as many "
            "edges are counted, so that each is equally likely"
        )
    if isinstance(seed, bool) or not isinstance(seed, int) or not 0 <= seed < 2**64:
        raise SizeError(f"a seed is a number from 0 to 2^64 - 1, not {seed!r}")
