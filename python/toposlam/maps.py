"""Reads worlds and explorers' maps from what Python people have: dicts, networkx, permutations."""

from __future__ import annotations

import re
import sys
from collections.abc import Hashable, Iterable, Iterator, Mapping, MappingView, Sequence, Set
from typing import Any, NamedTuple

from .errors import (
    MissingEdgeError,
    NoEdgeError,
    NoEmbeddingError,
    PermutationError,
    RepeatedEdgeError,
    UnknownStartError,
    WorldError,
    WorldTypeError,
)


class Doors(NamedTuple):
    """A graph as its doors: vertex by vertex, each in clockwise order."""

    vertices: list[Hashable]
    degrees: list[int]
    opposite: list[int]
    """For each door, in the order of the vertices, the number of the other end of its edge."""

    def first(self, vertex: Hashable) -> int:
        """The number of the first door of a vertex."""
        try:
            index = self.vertices.index(vertex)
        except ValueError:
            raise UnknownStartError(f"there is no vertex {vertex!r}") from None
        return sum(self.degrees[:index])

    def number(self, place: object) -> int:
        """The number of a dart `(vertex, index)`."""
        if not (isinstance(place, (tuple, list)) and len(place) == 2):
            raise UnknownStartError(f"a dart is a pair (vertex, index), not {place!r}")
        vertex, index = place
        first = self.first(vertex)
        degree = self.degrees[self.vertices.index(vertex)]
        if not is_int(index):
            raise UnknownStartError(f"the index in {place!r} is not a number")
        if not 0 <= index < degree:
            raise UnknownStartError(
                f"vertex {vertex!r} has {degree} doors, from 0 to {degree - 1}, and no door {index}"
            )
        return first + int(index)

    def place(self, number: int) -> tuple[Hashable, int]:
        """The place of a door."""
        for vertex, degree in zip(self.vertices, self.degrees):
            if number < degree:
                return vertex, number
            number -= degree
        raise UnknownStartError("there is no such door")


def is_int(value: object) -> bool:
    if isinstance(value, bool):
        return False
    return isinstance(value, int) or (hasattr(value, "__index__") and not hasattr(value, "__len__"))


def ordered(value: object) -> list[Any] | None:
    """The entries of a list, a tuple or an array, or None for what has no order, or can be read only once:
    sets, dicts and their views, generators, texts."""
    if isinstance(value, (str, bytes, bytearray, Mapping)) or not hasattr(value, "__getitem__"):
        return None
    try:
        len(value)  # type: ignore[arg-type]
        return list(value)  # type: ignore[call-overload, no-any-return]
    except TypeError:
        return None


def unordered(value: object) -> str:
    """What is said of a value that is not `ordered`."""
    if isinstance(value, (Set, Mapping, MappingView)):
        return f"{_kind(value)} has no order: write a list"
    if isinstance(value, Iterator):
        return f"{_kind(value)} can be read only once: write list(...)"
    return f"{shown(value)} is not a list"


def is_networkx(value: object) -> bool:
    """Whether a value is a graph of networkx, which is not imported for this."""
    networkx = sys.modules.get("networkx")
    return networkx is not None and isinstance(value, networkx.Graph)


def doors_of(value: object) -> Doors:
    """The doors of a dict, of a list of lists, or of a networkx graph."""
    if is_networkx(value):
        return of_networkx(value)
    if isinstance(value, Mapping):
        return of_dict(value)
    listed = ordered(value)
    if listed is not None and not _is_planarity(listed):
        return of_dict(dict(enumerate(listed)))
    if value is None or listed is not None:
        raise WorldTypeError(
            f"a map is a dict, a list of lists, a networkx.PlanarEmbedding or a World, not {shown(value)}; "
            "networkx.check_planarity returns a pair, whose second is the embedding, or None if the graph is "
            "not planar: then write the clockwise order of each vertex as a dict"
        )
    raise WorldTypeError(
        f"a map is a dict, a list of lists, a networkx.PlanarEmbedding or a World, not {_kind(value)}"
    )


def _is_planarity(value: list[Any]) -> bool:
    """Whether a value is what `networkx.check_planarity` returns."""
    return len(value) == 2 and isinstance(value[0], bool)


def _kind(value: object) -> str:
    return f"a value of type {type(value).__name__}"


def shown(value: object) -> str:
    """A value in a message."""
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


def of_dict(lists: Mapping[Any, Any]) -> Doors:
    """The doors of a dict of neighbours, or of a dict of far ends `(vertex, index)`."""
    if not lists:
        raise NoEdgeError("there is no vertex; a world has at least one edge")
    entries: dict[Hashable, list[Any]] = {}
    for vertex, listed in lists.items():
        order = ordered(listed)
        if order is None:
            why = unordered(listed)
            raise WorldTypeError(f"vertex {vertex!r} needs a list of its neighbours, clockwise: {why}")
        entries[vertex] = order
    if not any(entries.values()):
        raise NoEdgeError("there is no edge; a world has at least one")
    if all(_is_vertex(entry, lists) for listed in entries.values() for entry in listed):
        return _of_neighbours(entries)
    if all(_is_far_end(entry, lists) for listed in entries.values() for entry in listed):
        return _of_far_ends(entries)
    for vertex, listed in entries.items():
        for entry in listed:
            if entry is None:
                raise MissingEdgeError(f"vertex {vertex!r} has a door that leads nowhere: None")
            if not _is_vertex(entry, lists) and not _is_far_end(entry, lists):
                raise MissingEdgeError(
                    f"vertex {vertex!r} lists {entry!r}, which is neither a vertex nor (vertex, index)"
                )
    raise WorldError("some vertices list neighbours, and others far ends (vertex, index)")


def _is_vertex(entry: object, lists: Mapping[Any, Any]) -> bool:
    try:
        return entry in lists
    except TypeError:
        return False


def _is_far_end(entry: object, lists: Mapping[Any, Any]) -> bool:
    return (
        isinstance(entry, (tuple, list))
        and len(entry) == 2
        and _is_vertex(entry[0], lists)
        and is_int(entry[1])
    )


def _of_neighbours(lists: Mapping[Hashable, list[Hashable]]) -> Doors:
    number: dict[tuple[Hashable, Hashable], int] = {}
    for vertex, neighbours in lists.items():
        for neighbour in neighbours:
            if neighbour == vertex:
                raise RepeatedEdgeError(
                    f"vertex {vertex!r} lists itself; a loop needs far ends: (vertex, index)"
                )
            if (vertex, neighbour) in number:
                raise RepeatedEdgeError(
                    f"vertex {vertex!r} lists the neighbour {neighbour!r} twice; "
                    "parallel edges need far ends: (vertex, index)"
                )
            number[vertex, neighbour] = len(number)
    opposite = []
    for vertex, neighbour in number:
        other = number.get((neighbour, vertex))
        if other is None:
            raise MissingEdgeError(
                f"vertex {vertex!r} lists the neighbour {neighbour!r}, which does not list {vertex!r} back"
            )
        opposite.append(other)
    return Doors(list(lists), [len(listed) for listed in lists.values()], opposite)


def _of_far_ends(lists: Mapping[Hashable, list[Any]]) -> Doors:
    first: dict[Hashable, int] = {}
    doors = 0
    for vertex, ends in lists.items():
        first[vertex] = doors
        doors += len(ends)
    opposite = []
    for vertex, ends in lists.items():
        for index, (neighbour, at) in enumerate(ends):
            back = lists[neighbour][at] if 0 <= at < len(lists[neighbour]) else None
            if back is None or tuple(back) != (vertex, index):
                leads = "does not exist" if back is None else f"leads to {tuple(back)!r}"
                raise MissingEdgeError(
                    f"door {index} of vertex {vertex!r} leads to {(neighbour, at)!r}, which {leads}"
                )
            opposite.append(first[neighbour] + at)
    if any(number == other for number, other in enumerate(opposite)):
        raise MissingEdgeError("a door leads to itself; an edge has two ends")
    return Doors(list(lists), [len(ends) for ends in lists.values()], opposite)


def of_networkx(graph: Any) -> Doors:
    """The doors of a `networkx.PlanarEmbedding`, or of a `networkx.MultiGraph` with rotations."""
    import networkx

    if isinstance(graph, networkx.PlanarEmbedding):
        try:
            graph.check_structure()
        except networkx.NetworkXException as cause:
            raise NoEmbeddingError(f"the PlanarEmbedding is not valid: {cause}") from None
        return of_dict({vertex: list(graph.neighbors_cw_order(vertex)) for vertex in graph})
    has_rotations = all("rotation" in attributes for _, attributes in graph.nodes(data=True))
    if graph.is_multigraph() and not graph.is_directed() and graph and has_rotations:
        return _of_rotations(graph)
    raise NoEmbeddingError(
        f"a networkx.{type(graph).__name__} has no clockwise order; "
        "is_planar, embedding = networkx.check_planarity(graph) makes one of a planar graph, "
        "and a MultiGraph has one if each node has the attribute `rotation`: a list of (neighbour, key)"
    )


def _of_rotations(graph: Any) -> Doors:
    """The doors of a `networkx.MultiGraph` whose nodes have rotations."""
    degrees: list[int] = []
    ends: dict[tuple[frozenset[Hashable], Hashable], list[tuple[Hashable, int]]] = {}
    for vertex, rotation in graph.nodes(data="rotation"):
        order = ordered(rotation)
        if order is None:
            raise WorldTypeError(f"the rotation of node {vertex!r} is a list: {unordered(rotation)}")
        for number, entry in enumerate(order, start=sum(degrees)):
            try:
                neighbour, key = entry
                is_edge = graph.has_edge(vertex, neighbour, key)
            except (TypeError, ValueError):
                is_edge = False
            if not is_edge:
                text = f"{shown(entry)} in the rotation of node {vertex!r} is not (neighbour, key)"
                raise MissingEdgeError(f"{text} of an edge there")
            ends.setdefault((frozenset((vertex, neighbour)), key), []).append((vertex, number))
        degrees.append(len(order))
    opposite = [0] * sum(degrees)
    for one, other, key in graph.edges(keys=True):
        found = ends.get((frozenset((one, other)), key), [])
        if sorted((vertex == one, vertex == other) for vertex, _ in found) != sorted(
            [(True, one == other), (one == other, True)]
        ):
            raise MissingEdgeError(
                f"the edge {(one, other, key)!r} is not once in the rotation of each end (a loop: twice)"
            )
        (_, here), (_, there) = found
        opposite[here], opposite[there] = there, here
    if not opposite:
        raise NoEdgeError("there is no edge; a world has at least one")
    return Doors(list(graph), degrees, opposite)


# Permutations

_CYCLES = re.compile(r"\s*(\(\s*\d*(\s*,\s*\d+)*\s*\)\s*)*")


def of_permutations(opposite: object, clockwise: object) -> tuple[list[int], list[int], int]:
    """The images of two permutations, counted from 0, and the least dart: 0 or 1.

    A permutation is given as cycles, as a text of cycles, as a list of images, or as an object of Sage. Each
    dart occurs in `opposite`, so the least one there is the least one in both.
    """
    pairs, turns = _read("opposite", opposite), _read("clockwise", clockwise)
    least = min(pairs.darts(), default=0)
    if least not in (0, 1):
        raise PermutationError(f"opposite: the darts are numbered from 0 or from 1, not from {least}")
    images = pairs.images(least, len(pairs.darts()))
    return images, turns.images(least, len(images)), least


class _Permutation(NamedTuple):
    """A permutation as it is given: its cycles, or else the image of each dart."""

    name: str
    cycles: list[list[int]] | None
    listed: list[int]

    def darts(self) -> list[int]:
        return self.listed if self.cycles is None else [dart for cycle in self.cycles for dart in cycle]

    def images(self, least: int, count: int) -> list[int]:
        """The images of `count` darts, counted from 0; `least` is the least dart."""
        darts = range(least, least + count)
        if self.cycles is None:
            if sorted(self.listed) != list(darts):
                raise PermutationError(
                    f"{self.name}: the images are not those of a permutation of darts {_range(darts)}"
                )
            return [image - least for image in self.listed]
        moved = self.darts()
        if len(set(moved)) < len(moved):
            raise PermutationError(f"{self.name}: a number is in two cycles")
        if any(dart not in darts for dart in moved):
            raise PermutationError(f"{self.name}: the darts are not numbered {_range(darts)}")
        images = list(range(count))
        for cycle in self.cycles:
            for here, there in zip(cycle, cycle[1:] + cycle[:1]):
                images[here - least] = there - least
        return images


def _range(darts: range) -> str:
    return f"from {darts.start} to {darts.stop - 1}" if darts else "at all"


def _read(name: str, permutation: object) -> _Permutation:
    if isinstance(permutation, str):
        if not _CYCLES.fullmatch(permutation):
            raise PermutationError(f"{name}: {permutation!r} is not a product of cycles: (1,2)(3,4)")
        cycles = [part.split(",") for part in re.findall(r"\(([^)]*)\)", permutation)]
        return _of_cycles(name, [[x for x in cycle if x.strip()] for cycle in cycles])
    cycle_tuples = getattr(permutation, "cycle_tuples", None)
    if callable(cycle_tuples):
        return _of_cycles(name, cycle_tuples())
    if isinstance(permutation, Mapping):
        darts = [*permutation, *permutation.values()]
        if not all(is_int(dart) for dart in darts) or set(permutation) != set(permutation.values()):
            raise PermutationError(f"{name}: the images are not the darts")
        permutation = [permutation[dart] for dart in sorted(permutation)]
    listed = ordered(permutation)
    if listed is None:
        raise PermutationError(f"{name} needs a list of images or of cycles: {unordered(permutation)}")
    if listed and all(isinstance(cycle, (tuple, list)) for cycle in listed):
        return _of_cycles(name, listed)
    if not all(is_int(image) for image in listed):
        raise PermutationError(f"{name}: the images of a permutation are numbers")
    return _Permutation(name, None, [int(image) for image in listed])


def _of_cycles(name: str, cycles: Iterable[Sequence[Any]]) -> _Permutation:
    try:
        return _Permutation(name, [[int(dart) for dart in cycle] for cycle in cycles], [])
    except (TypeError, ValueError, OverflowError):
        raise PermutationError(f"{name}: the entries of a cycle are numbers") from None
