"""The worlds that a compass does not distinguish a second time, in another language, from the definitions alone.

Written without sight of the Rust code, as literal as possible, with no care for speed. A world has an
embedded graph and a direction for each dart: 0 to 3, clockwise from north. The darts of a vertex have
different directions, in clockwise order; those of an edge have opposite ones.

    python3 tests/oracle/compass.py multigraph 4    all worlds with directions
    python3 tests/oracle/compass.py plane 6         those that can be drawn in the plane

For each number of edges it prints `CLASS edges worlds ambiguous`, then the edges of the smallest pair, the
larger first: `CLASS smallest M K`, or `CLASS smallest none`. A world can be drawn in the plane if the turns
along each face add up to 360 degrees, but along one face to -360.
"""

import itertools
import sys

import ambiguity


def ways_around(degree):
    """All ways in which the doors of a vertex can lead, clockwise from its first dart."""
    for directions in itertools.permutations(range(4), degree):
        turns = [(after - before) % 4 for before, after in zip(directions, directions[1:])]
        if sum(turns) < 4:
            yield directions


def every_direction(graph):
    opposite, clockwise = graph
    vertices, _, _ = ambiguity.cycles(clockwise)
    for around in itertools.product(*[list(ways_around(len(vertex))) for vertex in vertices]):
        direction = [None] * len(opposite)
        for vertex, directions in zip(vertices, around):
            for dart, towards in zip(vertex, directions):
                direction[dart] = towards
        if all((direction[dart] - direction[other]) % 4 == 2 for dart, other in enumerate(opposite)):
            yield tuple(direction)


def is_plane(graph, direction):
    """A robot that always takes the next door clockwise has a face at its left side."""
    opposite, clockwise = graph
    faces, _, _ = ambiguity.cycles([clockwise[other] for other in opposite])  # the darts by which it leaves
    outer = 0
    for face in faces:
        turns = 0
        for dart in face:
            entry = opposite[dart]
            ahead, leaving = direction[dart], direction[clockwise[entry]]
            # From right to left; back through a dead end is twice to the right.
            turn = {0: 0, 1: -1, 2: -2, 3: 1}[(leaving - ahead) % 4]
            turns += turn
        if turns == -4:
            outer += 1
        elif turns != 4:
            return False
    return outer == 1


def least(graph, direction):
    """The same for isomorphic worlds."""
    copies = []
    for root in range(len(direction)):
        copy, number = ambiguity.renumbered(graph, root)
        moved = [None] * len(direction)
        for dart, towards in enumerate(direction):
            moved[number[dart]] = towards
        copies.append((copy, tuple(moved)))
    return min(copies)


def worlds_of(class_name, most_edges):
    by_edges = ambiguity.embedded_graphs("planar" if class_name == "plane" else class_name, most_edges)
    for edges, graphs in by_edges.items():
        found = set()
        for graph in graphs:
            if max(map(len, ambiguity.cycles(graph[1])[0])) <= 4:
                found |= {least(graph, direction) for direction in every_direction(graph)
                          if class_name != "plane" or is_plane(graph, direction)}
        yield edges, sorted(found)


def classes(worlds):
    """For each world the classes of its poses: first by direction and degree, then again and again by what is
    the next dart clockwise and at the other end."""
    rows, where, world_poses = [], [], []
    for (opposite, clockwise), direction in worlds:
        first = len(rows)
        vertices, which, _ = ambiguity.cycles(clockwise)
        rows += [(first + clockwise[dart], first + opposite[dart]) for dart in range(len(opposite))]
        where += [(direction[dart], len(vertices[which[dart]])) for dart in range(len(opposite))]
        world_poses.append(range(first, len(rows)))

    def split(keys):
        number = {}
        return [number.setdefault(key, len(number)) for key in keys], len(number)

    now, count = split(where)
    while True:
        now, more = split((now[pose], now[one], now[other]) for pose, (one, other) in enumerate(rows))
        if more == count:
            return [{now[pose] for pose in poses} for poses in world_poses]
        count = more


def main(class_name, most_edges):
    by_edges = dict(worlds_of(class_name, most_edges))
    worlds = [world for found in by_edges.values() for world in found]
    sharing = {}
    for world, its_classes in enumerate(classes(worlds)):
        for one in its_classes:
            sharing.setdefault(one, []).append(world)
    edges_of = [len(direction) // 2 for _, direction in worlds]
    ambiguous, smallest = set(), None
    for members in sharing.values():
        if len(members) > 1:
            ambiguous.update(members)
            less, more = sorted(edges_of[world] for world in members)[:2]
            smallest = (more, less) if smallest is None else min(smallest, (more, less))
    for edges, found in by_edges.items():
        count = sum(edges_of[world] == edges for world in ambiguous)
        print(class_name, edges, len(found), count)
    print(class_name, "smallest", *(smallest or ["none"]))


if __name__ == "__main__":
    if len(sys.argv) != 3 or not sys.argv[2].isdigit() or sys.argv[1] not in [*ambiguity.CLASSES, "plane"]:
        sys.exit(__doc__)
    main(sys.argv[1], int(sys.argv[2]))
