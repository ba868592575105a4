"""Worlds: embedded graphs, with names and perhaps a start."""

from __future__ import annotations

import itertools
import os
import re
import warnings
from collections.abc import Hashable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple, Union

from . import _core
from ._core import Robot
from ._core import World as CoreWorld
from .errors import (
    FrozenError,
    NoStartError,
    PictureError,
    RenamedVertexWarning,
    UnknownStartError,
    WorldError,
    WorldFileError,
    WorldTypeError,
)
from .limits import MAX_MOVES, check_limit
from .maps import doors_of, is_int, of_permutations, ordered, unordered
from .progress import library

if TYPE_CHECKING:
    from .markers import Marker


class Dart(NamedTuple):
    """One end of an edge: a vertex, and the index of the end in the vertex's clockwise order."""

    vertex: str
    index: int  # type: ignore[assignment]


DartLike = Union[str, "tuple[Hashable, int]", "list[Any]"]
"""A dart of a world: `"vertex:facing"` as on the command line, or `(vertex, index)`."""


class Picture:
    """A picture as SVG. A notebook shows it."""

    __slots__ = ("svg",)

    svg: str

    def __init__(self, svg: str) -> None:
        self.svg = svg

    def _repr_svg_(self) -> str:
        return self.svg

    def __repr__(self) -> str:
        return f"<Picture, {len(self.svg)} characters of SVG>"

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a .svg or .png file."""
        file = Path(path)
        if file.suffix == ".svg":
            file.write_text(self.svg, encoding="utf-8")
        elif file.suffix == ".png":
            file.write_bytes(_core.World.png(self.svg))
        else:
            raise PictureError(f"{file}: the name of a picture ends with .svg or .png")


def counted(number: int, one: str, several: str) -> str:
    """A number and its noun."""
    return f"{number} {one if number == 1 else several}"


class World:
    """A connected embedded graph: each vertex has its edges in clockwise order.

    `value` is one of

    * a dict of neighbours in clockwise order: `{"a": ["b", "c"], "b": ["a"], "c": ["a"]}`;
    * a dict of far ends, for loops and parallel edges: door `i` of vertex `v` leads to `(w, j)`, door `j` of
      `w`;
    * a list of such lists: its vertices are 0, 1, and so on;
    * a `networkx.PlanarEmbedding`, or a `networkx.MultiGraph` whose nodes have an attribute `rotation`: a
      list of `(neighbour, key)`, the edges in clockwise order; a loop is in it twice.

    `start` is the dart behind the robot at the start, along which a directional marker points. Without
    one, it is the first door of the first vertex. A vertex has the name `str(vertex)`, with `_` for what no
    name in a world file has; a `RenamedVertexWarning` says so if it is a text. Where a vertex is asked for,
    both do.

    Raises a `WorldError` of the class that is the cause.

    >>> import toposlam as ts
    >>> triangle = ts.World({"a": ["b", "c"], "b": ["a", "c"], "c": ["a", "b"]}, name="triangle")
    >>> triangle
    <World triangle: 3 vertices, 3 edges, genus 0, start a:b>
    >>> two_loops = ts.World({0: [(0, 2), (0, 3), (0, 0), (0, 1)]})
    >>> two_loops.genus
    1
    """

    __slots__ = ("_core", "_degree", "_first", "_opposite", "_places", "_vertices")

    _core: CoreWorld
    _degree: dict[str, int]
    _first: dict[str, int]
    _opposite: list[int]
    _places: list[Dart]
    _vertices: dict[Hashable, str]

    def __init__(
        self, value: object, start: DartLike | None = None, *, name: str = "world", about: str = ""
    ) -> None:
        if isinstance(value, World):
            core = value._core.with_start(value._core.start, name, about)
            vertices = value._vertices
        else:
            doors = doors_of(value)
            vertices = _names(doors.vertices)
            named = list(vertices.values())
            core = _core.World.from_doors(doors.degrees, doors.opposite, named, name, about, 0)
        self._set(core, vertices)
        if start is not None:
            self._set(core.with_start(self.number(start), name, about), vertices)

    def _set(self, core: CoreWorld, vertices: Mapping[Hashable, str]) -> None:
        degrees, opposite = core.doors
        first: dict[str, int] = {}
        places: list[Dart] = []
        for vertex, degree in zip(core.vertex_names, degrees):
            first[vertex] = len(places)
            places.extend(Dart(vertex, index) for index in range(degree))
        known = {vertex: named for vertex, named in vertices.items() if named in first}
        values = (core, dict(zip(first, degrees)), first, opposite, places, known)
        for slot, value in zip(self.__slots__, values):
            object.__setattr__(self, slot, value)

    @classmethod
    def _of(cls, core: CoreWorld, vertices: Mapping[Hashable, str] = MappingProxyType({})) -> World:
        """The world of the extension module. `vertices` are other vertices, with their names."""
        world = cls.__new__(cls)
        world._set(core, vertices)
        return world

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> World:
        """The world of a world file (TOML or JSON), or of a plantri file with one world.

        >>> import toposlam as ts
        >>> ts.World.load("worlds/figure-1a.toml")
        <World figure-1a: 5 vertices, 8 edges, genus 0, start x:a>
        """
        worlds = cls.load_all(path)
        if len(worlds) != 1:
            raise WorldFileError(f"{os.fspath(path)}: expected one world, found {len(worlds)}")
        return worlds[0]

    @classmethod
    def load_all(cls, path: str | os.PathLike[str]) -> list[World]:
        """The worlds of a plantri file, or the one of a world file."""
        try:
            data = Path(path).read_bytes()
        except OSError as cause:
            raise WorldFileError(f"{os.fspath(path)}: {cause.strerror}") from cause
        return [cls._of(core) for core in _core.World.read(Path(path), data)]

    @classmethod
    def from_permutations(
        cls, opposite: object, clockwise: object, start: int | None = None, *, name: str = "world"
    ) -> World:
        """A world from two permutations of its darts: the other end of each edge, and the next dart
        clockwise around the vertex.

        A permutation is a list of images, counted from 0 or from 1, as in GAP's `ListPerm`; a list or a text
        of cycles, `"(1,2)(3,4)"`; or an object of SageMath. Both count from the same number, the least in
        `opposite`. `start` is a dart, counted as in them.

        Raises `PermutationError`, `NoEdgeError`, `NotConnectedError` or `UnknownStartError`.

        >>> import toposlam as ts
        >>> ts.World.from_permutations("(1,2)(3,4)", "(2,3)")
        <World world: 3 vertices, 2 edges, genus 0, start v0:v1>
        """
        pairs, turns, least = of_permutations(opposite, clockwise)
        core, numbers = _core.World.from_permutations(pairs, turns, least)
        first = least if start is None else start
        if isinstance(first, bool) or not isinstance(first, int) or not 0 <= first - least < len(numbers):
            raise UnknownStartError(f"there is no dart {start!r}")
        return cls._of(core.with_start(numbers[first - least], name, ""))

    def __setattr__(self, name: str, value: object) -> None:
        raise FrozenError("a World cannot be changed; World(...) makes another one")

    def __delattr__(self, name: str) -> None:
        raise FrozenError("a World cannot be changed; World(...) makes another one")

    def __reduce__(self) -> tuple[Any, ...]:
        return _rebuilt, (self.to_json(), self.name, self._vertices)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, World):
            return NotImplemented
        return (self.name, self.to_json()) == (other.name, other.to_json())

    def __hash__(self) -> int:
        return hash((tuple(self._degree.values()), tuple(self._opposite), self._core.start))

    def __repr__(self) -> str:
        start = self._core.start
        at = "no start" if start is None else f"start {self._core.start_text(start)}"
        vertices = counted(self.vertex_count, "vertex", "vertices")
        edges = counted(self.edge_count, "edge", "edges")
        return f"<World {self.name}: {vertices}, {edges}, genus {self.genus}, {at}>"

    @property
    def name(self) -> str:
        """Its name."""
        return self._core.name

    @property
    def about(self) -> str:
        """A short description."""
        return self._core.about

    @property
    def vertices(self) -> tuple[str, ...]:
        """The names of the vertices."""
        return tuple(self._first)

    @property
    def vertex_count(self) -> int:
        """The number of vertices, n."""
        return len(self._degree)

    @property
    def edge_count(self) -> int:
        """The number of edges, m."""
        return len(self._opposite) // 2

    @property
    def genus(self) -> int:
        """The genus of the surface on which the graph lies: 0 in the plane, 1 on the torus."""
        return self._core.genus

    @property
    def is_simple(self) -> bool:
        """Whether it has neither a loop nor parallel edges."""
        return self._core.is_simple

    @property
    def start(self) -> Dart | None:
        """The dart behind the robot at the start."""
        start = self._core.start
        return None if start is None else self._places[start]

    @property
    def neighbours(self) -> Mapping[str, tuple[str, ...]]:
        """The neighbours of each vertex, in clockwise order."""
        listed = {
            vertex: tuple(self.opposite(dart).vertex for dart in self.darts(vertex)) for vertex in self._first
        }
        return MappingProxyType(listed)

    @property
    def far_ends(self) -> Mapping[str, tuple[Dart, ...]]:
        """The far end of each door of each vertex, in clockwise order: a dict from which `World` makes this
        graph again."""
        listed = {vertex: tuple(self.opposite(dart) for dart in self.darts(vertex)) for vertex in self._first}
        return MappingProxyType(listed)

    def _named(self, vertex: Hashable) -> str | None:
        """The name of a vertex."""
        try:
            if vertex in self._vertices:
                return self._vertices[vertex]
        except TypeError:  # it is not hashable
            return None
        text = str(vertex)
        return text if text in self._first else None

    def degree(self, vertex: Hashable) -> int:
        """The number of doors of a vertex. Raises `UnknownStartError` if there is none."""
        return len(self.darts(vertex))

    def darts(self, vertex: Hashable | None = None) -> list[Dart]:
        """The darts of a vertex in clockwise order, or all darts. Raises `UnknownStartError` if there is no
        such vertex."""
        if vertex is None:
            return list(self._places)
        named = self._named(vertex)
        if named is None:
            raise UnknownStartError(f"there is no vertex {vertex!r}")
        first = self._first[named]
        return self._places[first : first + self._degree[named]]

    def number(self, dart: DartLike) -> int:
        """The number of a dart, counted vertex by vertex. Raises `UnknownStartError` if there is none."""
        if isinstance(dart, str):
            return self._core.start_from_text(dart)
        if isinstance(dart, (tuple, list)) and len(dart) == 2:
            named, index = self._named(dart[0]), dart[1]
            if named is not None and is_int(index) and 0 <= index < self._degree[named]:
                return self._first[named] + int(index)
        raise UnknownStartError(
            f"{dart!r} is not a dart of {self.name}; write 'vertex:facing' or (vertex, index)"
        )

    def opposite(self, dart: DartLike) -> Dart:
        """The other end of the dart's edge."""
        return self._places[self._opposite[self.number(dart)]]

    def clockwise(self, dart: DartLike) -> Dart:
        """The next dart around the same vertex."""
        vertex, index = self._places[self.number(dart)]
        return Dart(vertex, (index + 1) % self.degree(vertex))

    def after(self, pose: DartLike, door: int) -> Dart:
        """The pose of a robot that came in by the dart `pose` and leaves by a door."""
        vertex, index = self._places[self.number(pose)]
        return self.opposite(Dart(vertex, (index + door) % self.degree(vertex)))

    def walk(self, pose: DartLike, doors: Sequence[int]) -> Dart:
        """The pose at the end of a door sequence. Raises `WorldTypeError` if it is no sequence."""
        sequence = ordered(doors)
        if sequence is None:
            raise WorldTypeError(f"the doors of a walk are a list: {unordered(doors)}")
        for door in sequence:
            pose = self.after(pose, door)
        return self._places[self.number(pose)]

    def with_start(self, start: DartLike | None) -> World:
        """The same world with another start. Raises `UnknownStartError` if there is no such dart."""
        number = None if start is None else self.number(start)
        return World._of(self._core.with_start(number, self.name, self.about), self._vertices)

    def facing(self) -> int:
        """The number of the start's dart. Raises `NoStartError` if the world has no start."""
        if self._core.start is None:
            raise NoStartError(f"{self.name} has no start; with_start('vertex:facing') gives it one")
        return self._core.start

    def is_isomorphic(self, other: World) -> bool:
        """Whether two worlds are the same start: there is a bijection of darts that keeps edges, orders
        and the start. Worlds without starts are compared as graphs.

        >>> import toposlam as ts
        >>> path = ts.World({1: [2], 2: [1, 3], 3: [2]})
        >>> path.is_isomorphic(ts.World({"c": ["b"], "b": ["c", "a"], "a": ["b"]}))
        True
        >>> path.is_isomorphic(path.with_start((2, 0)))
        False
        """
        other = world_of(other)
        if (self._core.start is None) != (other._core.start is None):
            return self.with_start(None).is_isomorphic(other.with_start(None))
        return self._core.code() == other._core.code()

    def starts(self) -> tuple[World, ...]:
        """The world with each of its starts, up to isomorphism: `2 m` divided by the number of automorphisms.
        The name of each ends with its number.

        >>> import toposlam as ts
        >>> path = ts.World({1: [2], 2: [1, 3], 3: [2]}, name="path")
        >>> path.starts()  # doctest: +NORMALIZE_WHITESPACE
        (<World path-0: 3 vertices, 2 edges, genus 0, start 1:2>,
         <World path-1: 3 vertices, 2 edges, genus 0, start 2:1>)
        """
        return tuple(
            World._of(self._core.with_start(dart, f"{self.name}-{number}", self.about), self._vertices)
            for number, dart in enumerate(self._core.start_darts())
        )

    def canonical(self) -> World:
        """A world without start and with new names that is isomorphic as a graph. It is equal for two worlds
        exactly if they are isomorphic as graphs.

        >>> import toposlam as ts
        >>> one = ts.World({"a": ["b"], "b": ["a", "c"], "c": ["b"]})
        >>> one.canonical() == ts.World({1: [2, 3], 2: [1], 3: [1]}).canonical()
        True
        """
        return World._of(self._core.canonical()).with_start(None)

    def automorphisms(self) -> tuple[dict[Dart, Dart], ...]:
        """The symmetries of the graph, without its start: bijections of darts that keep edges and clockwise
        orders. The identity comes first.

        >>> import toposlam as ts
        >>> cycle = ts.World.load("worlds/cycle-4.toml")
        >>> len(cycle.automorphisms())
        8
        """
        places = self._places
        return tuple(
            dict(zip(places, (places[image] for image in images))) for images in self._core.automorphisms()
        )

    def faces(self) -> tuple[tuple[Dart, ...], ...]:
        """The faces: the darts along which a robot goes around each, if it takes door 1 at every vertex. Each
        dart is in one face, and `vertices - edges + faces` is `2 - 2 genus`.

        >>> import toposlam as ts
        >>> [len(face) for face in ts.World.load("worlds/figure-1a.toml").faces()]
        [3, 3, 3, 3, 4]
        """
        faces = []
        seen: set[Dart] = set()
        for first in self._places:
            face: list[Dart] = []
            dart = first
            while dart not in seen:
                seen.add(dart)
                face.append(dart)
                dart = self.clockwise(self.opposite(dart))
            if face:
                faces.append(tuple(face))
        return tuple(faces)

    def to_permutations(self) -> tuple[list[int], list[int]]:
        """Two permutations of the darts, as lists of images counted from 0: the other end of each edge, and
        the next dart clockwise. A dart has the number of its place in `darts()`. The inverse of
        `from_permutations`.

        >>> import toposlam as ts
        >>> ts.World({1: [2], 2: [1, 3], 3: [2]}).to_permutations()
        ([1, 0, 3, 2], [0, 2, 1, 3])
        """
        clockwise = []
        for vertex, first in self._first.items():
            degree = self._degree[vertex]
            clockwise += [first + (index + 1) % degree for index in range(degree)]
        return list(self._opposite), clockwise

    def mirror_image(self) -> World:
        """The same graph with every order reversed."""
        return World._of(self._core.mirror_image(), self._vertices)

    def without_corners(self) -> World:
        """The same world without vertices of degree 2."""
        return World._of(self._core.smoothed(), self._vertices)

    def certificate(self) -> tuple[int, ...]:
        """A shortest walk, as doors, that proves a map of the world from its start: no correct explorer
        with a directional marker makes fewer moves. Raises `NoStartError` if the world has no start.

        >>> import toposlam as ts
        >>> len(ts.World.load("worlds/figure-1a.toml").certificate())
        12
        """
        return tuple(_core.certificate(self._core, self.facing()))

    def robot(self, marker: Marker = "directional", max_moves: int = MAX_MOVES) -> Robot:
        """A robot at the start, with a kind of marker, or with one that is a function: see `MarkerFunction`.
        It makes at most `max_moves` moves, pick-ups and drops.

        Raises `NoStartError`, `UnknownMarkerError`, `MarkerFunctionError` or `SizeError`; the robot raises
        `NoSuchDoorError`, `DoorTypeError`, `NoMarkerError`, `UnknownActionError`, `NotPossibleError` or
        `OutOfMovesError` if an action is not possible.

        >>> import toposlam as ts
        >>> robot = ts.World.load("worlds/figure-1a.toml").robot()
        >>> robot.percept
        Percept(degree=4, marker=0)
        >>> robot.go(1)
        Percept(degree=3, marker=None)
        """
        from .markers import Sightings, check_marker

        check_limit("max_moves", max_moves)
        check_marker(marker)
        sensed = marker if isinstance(marker, str) else Sightings(marker).at_start(self)
        return _core.Robot(self._core, self.facing(), sensed, max_moves)

    def draw(
        self, *, title: str | None = None, caption: str | None = None, marker: str | None = None
    ) -> Picture:
        """A picture that shows the clockwise order of the doors at each vertex."""
        kind = marker or self._core.marker or "directional"
        title = self.name if title is None else title
        caption = self.about if caption is None else caption
        return Picture(self._core.svg(title, caption, kind))

    def _repr_svg_(self) -> str:
        return self.draw().svg

    def to_toml(self) -> str:
        """The text of a world file."""
        return self._core.to_toml()

    def to_json(self) -> str:
        """The text of a world file in JSON."""
        return self._core.to_json()

    def to_dot(self) -> str:
        """The text of a Graphviz file."""
        return self._core.to_dot()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a world file: .toml, .json or .dot."""
        file = Path(path)
        texts = {".toml": self.to_toml, ".json": self.to_json, ".dot": self.to_dot}
        if file.suffix not in texts:
            raise WorldFileError(f"{file}: the name of a world file ends with .toml, .json or .dot")
        file.write_text(texts[file.suffix](), encoding="utf-8")

    def to_networkx(self) -> Any:
        """A `networkx.PlanarEmbedding` of a simple world in the plane. Of any other world, a
        `networkx.MultiGraph`: the attribute `rotation` of each node has the edges in clockwise order, as
        `(neighbour, key)`. `World(...)` reads both; the start is not in them.

        >>> import toposlam as ts
        >>> ts.World.load("worlds/two-loops-torus.toml").to_networkx().nodes(data="rotation")
        NodeDataView({'v': [('v', 0), ('v', 1), ('v', 0), ('v', 1)]}, data='rotation')
        """
        networkx = library("networkx", "to_networkx")
        if self.is_simple and self.genus == 0:
            embedding = networkx.PlanarEmbedding()
            embedding.set_data({vertex: list(listed) for vertex, listed in self.neighbours.items()})
            return embedding
        graph = networkx.MultiGraph()
        rotations: dict[str, list[tuple[str, int]]] = {vertex: [] for vertex in self._first}
        for vertex, rotation in rotations.items():
            graph.add_node(vertex, rotation=rotation)
        keys: dict[int, int] = {}
        for dart, (place, other) in enumerate(zip(self._places, self._opposite)):
            neighbour = self._places[other].vertex
            keys[dart] = keys[other] if other < dart else graph.add_edge(place.vertex, neighbour)
            rotations[place.vertex].append((neighbour, keys[dart]))
        return graph


def world_of(value: object) -> World:
    """The value, which must be a world."""
    if isinstance(value, World):
        return value
    raise WorldTypeError(
        f"a world is a World, not {value!r}; load it with World.load(...) or make one with World(...)"
    )


def other_world(world: World, marker: object, actions: tuple[int | str, ...]) -> tuple[World | None, bool]:
    """The smallest other world in which a robot that does the same senses the same, and whether it is known
    to be the smallest."""
    if not isinstance(marker, str):
        return None, False
    doors = [action for action in actions if isinstance(action, int)]
    found = _core.other_world(world._core, world.facing(), marker, doors)
    return (None, False) if found is None else (World._of(found[0]), found[1])


def _rebuilt(text: str, name: str, vertices: dict[Hashable, str]) -> World:
    """A world from a world file in JSON, for pickle."""
    (core,) = _core.World.read(Path(), text.encode())
    return World._of(core.with_start(core.start, name, core.about), vertices)


def _names(vertices: list[Hashable]) -> dict[Hashable, str]:
    """The names of the vertices: their texts, with `_` for letters that no name in a world file has. Warns of
    texts that are changed. Of names that would be equal, all but the first get a number."""
    texts = [str(vertex) for vertex in vertices]
    if len(set(texts)) < len(texts):
        twice = next(text for text in texts if texts.count(text) > 1)
        raise WorldError(f"two vertices have the name {twice}")
    taken = {text for text in texts if _core.is_name(text)}
    names: dict[Hashable, str] = {}
    for number, (vertex, text) in enumerate(zip(vertices, texts)):
        name = text
        if not _core.is_name(text):
            kept = "".join(letter if letter == " " or _core.is_name(letter) else "_" for letter in text)
            kept = re.sub("_+", "_", kept).strip("_ ") or f"v{number}"
            others = (f"{kept}_{count}" for count in itertools.count(2))
            name = next(text for text in itertools.chain([kept], others) if text not in taken)
            taken.add(name)
        names[vertex] = name
    changed = [vertex for vertex in vertices if isinstance(vertex, str) and names[vertex] != vertex]
    if changed:
        listed = ", ".join(f"{vertex!r} is {names[vertex]!r}" for vertex in changed[:3])
        more = f", and {len(changed) - 3} more" if len(changed) > 3 else ""
        text = f"no name in a world file has all of these letters: {listed}{more}"
        warnings.warn(text, RenamedVertexWarning, stacklevel=3)
    return names
