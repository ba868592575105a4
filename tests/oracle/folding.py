"""Folded trails and certificates a second time, in another language, from their description alone.

Written without sight of the Rust code, as literal as possible, with no care for speed.
`tests/oracle.rs` compares the two. Prints one JSON object a line:

    python3 tests/oracle/folding.py walks 500          random walks, a third of them with a wrong percept
    python3 tests/oracle/folding.py shortest 3         every start with up to 3 edges, and the length of
                                                       its shortest certificate walk, by trying all walks
    python3 tests/oracle/folding.py certificates 5     the lengths by the formula: total and maximum
"""

import json
import random
import sys
from collections import deque

import algorithm1


class Contradiction(Exception):
    """No world explains the walk."""


class Trail:
    """What a walk has seen: a percept at each vertex, one new vertex a move. Dart (i, k) is the k-th
    clockwise from the dart by which the walk entered its i-th vertex."""

    def __init__(self, percept):
        self.percepts, self.edges = [percept], []

    def move(self, door, percept):
        self.edges.append(((len(self.percepts) - 1, door), (len(self.percepts), 0)))
        self.percepts.append(percept)


class Folded:
    """A partial embedded graph: its darts are numbered breadth first from where the walk began, those
    of a vertex clockwise from the one by which it was first reached. An open dart has no opposite."""

    def __init__(self, degrees, opposite, marker, pose):
        self.degrees, self.opposite, self.marker, self.pose = degrees, opposite, marker, pose

    def open(self):
        return self.opposite.count(None)

    def state(self):
        return tuple(self.degrees), tuple(self.opposite), self.marker, self.pose


def fold(percepts, edges, root, pose):
    """The trail with all sightings of the marker identified, and what follows from that."""
    darts = [(vertex, index) for vertex, (degree, _) in enumerate(percepts) for index in range(degree)]
    class_of = {dart: {dart} for dart in darts}

    def clockwise(dart):
        return dart[0], (dart[1] + 1) % percepts[dart[0]][0]

    sightings = [(vertex, door) for vertex, (_, door) in enumerate(percepts) if door is not None]
    for one in sightings:
        unite(class_of, one, sightings[0])
    opposite = {}
    for one, other in edges:
        opposite.setdefault(one, []).append(other)
        opposite.setdefault(other, []).append(one)
    changed = True
    while changed:
        changed = False
        for members in {id(members): members for members in class_of.values()}.values():
            following = [clockwise(dart) for dart in members]
            far = [other for dart in members for other in opposite.get(dart, [])]
            for same in (following, far):
                for dart in same[1:]:
                    changed |= unite(class_of, same[0], dart)

    for dart in darts:
        degree, door = percepts[dart[0]]
        for other in class_of[dart]:
            if percepts[other[0]][0] != degree:
                raise Contradiction("degree")
            if other[0] == dart[0] and other != dart:
                raise Contradiction("a vertex is rotated onto itself")
            other_door = percepts[other[0]][1]
            if (door is None) != (other_door is None):
                raise Contradiction("marker")
            if door is not None and (door - dart[1]) % degree != (other_door - other[1]) % degree:
                raise Contradiction("marker")
        if any(other in class_of[dart] for other in opposite.get(dart, [])):
            raise Contradiction("a dart is its own opposite")

    # The classes in breadth-first order.
    number, order, degrees, queue = {}, [], [], deque()

    def reach(dart):
        if id(class_of[dart]) in number:
            return
        degrees.append(percepts[dart[0]][0])
        for _ in range(percepts[dart[0]][0]):
            number[id(class_of[dart])] = len(order)
            order.append(class_of[dart])
            queue.append(class_of[dart])
            dart = clockwise(dart)

    def far_end(members):
        return next((other for dart in members for other in opposite.get(dart, [])), None)

    reach(root)
    while queue:
        far = far_end(queue.popleft())
        if far is not None:
            reach(far)
    ends = [far_end(members) for members in order]
    return Folded(
        degrees,
        [None if end is None else number[id(class_of[end])] for end in ends],
        number[id(class_of[sightings[0]])] if sightings else None,
        number[id(class_of[pose])],
    )


def unite(class_of, one, other):
    """Whether the two darts were not yet the same."""
    if class_of[one] is class_of[other]:
        return False
    class_of[one] |= class_of[other]
    for dart in class_of[other]:
        class_of[dart] = class_of[one]
    return True


def folded(trail):
    return fold(trail.percepts, trail.edges, (0, 0), (len(trail.percepts) - 1, 0))


# ---------------------------------------------------------------- random walks


def random_start(source):
    """A connected embedded graph with up to 8 edges, as the opposites of its darts and its degrees."""
    while True:
        darts = list(range(2 * source.randint(1, 8)))
        degrees = []
        while sum(degrees) < len(darts):
            degrees.append(min(source.randint(1, 4), len(darts) - sum(degrees)))
        source.shuffle(darts)
        opposite = [0] * len(darts)
        for one, other in zip(darts[::2], darts[1::2]):
            opposite[one], opposite[other] = other, one
        world = algorithm1.World(opposite, degrees)
        reached, waiting = {0}, [0]
        while waiting:
            vertex = waiting.pop()
            for dart, other in enumerate(opposite):
                if world.vertex[dart] == vertex and world.vertex[other] not in reached:
                    reached.add(world.vertex[other])
                    waiting.append(world.vertex[other])
        if len(reached) == len(degrees):
            return world


def random_walk(source):
    world = random_start(source)
    if source.random() < 0.3:
        world.pose = source.randrange(len(world.opposite))
    doors, percepts = [], [world.percept()]
    for _ in range(source.randint(0, 30)):
        doors.append(source.randrange(percepts[-1][0]))
        world.traverse(doors[-1])
        percepts.append(world.percept())
    if source.random() < 0.33:
        place = source.randrange(len(percepts))
        least = doors[place] + 1 if place < len(doors) else 1
        degree = source.randint(least, least + 2)
        percepts[place] = degree, source.choice([None, source.randrange(degree)])
    trail = Trail(percepts[0])
    for door, percept in zip(doors, percepts[1:]):
        trail.move(door, percept)
    return doors, trail


def print_walks(count):
    source = random.Random(20)
    for _ in range(count):
        doors, trail = random_walk(source)
        try:
            graph = folded(trail)
            found = {
                "degrees": graph.degrees,
                "opposite": graph.opposite,
                "marker": graph.marker,
                "pose": graph.pose,
                "open": graph.open(),
            }
        except Contradiction:
            found = None
        print(json.dumps({"percepts": trail.percepts, "doors": doors, "folded": found}))


# ---------------------------------------------------------------- certificates


def shortest_certificate(world):
    """The least number of moves after which the folded trail is complete: breadth first over what is
    folded and the robot's pose in it."""
    start = folded(Trail(world.percept()))
    seen, queue = {start.state()}, deque([(start, 0, 0)])
    while True:
        graph, pose, moves = queue.popleft()
        if graph.open() == 0:
            return moves
        for door in range(graph.degrees[home(graph, graph.pose)]):
            world.pose = pose
            world.traverse(door)
            grown = step(graph, door, world.percept())
            if grown.state() not in seen:
                seen.add(grown.state())
                queue.append((grown, world.pose, moves + 1))


def home(graph, dart):
    """The vertex of a dart."""
    vertex = 0
    while dart >= graph.degrees[vertex]:
        dart -= graph.degrees[vertex]
        vertex += 1
    return vertex


def step(graph, door, percept):
    """What is folded after one more move: a trail of its own, with a vertex for each of its vertices."""
    first = [sum(graph.degrees[:vertex]) for vertex in range(len(graph.degrees))]
    named = [(vertex, index) for vertex, degree in enumerate(graph.degrees) for index in range(degree)]
    assert graph.marker == 0, "certificate walks begin at the marker"
    percepts = [(degree, 0 if vertex == 0 else None) for vertex, degree in enumerate(graph.degrees)]
    edges = [
        (named[one], named[other]) for one, other in enumerate(graph.opposite) if other is not None and one < other
    ]
    vertex, index = named[graph.pose]
    leave = first[vertex] + (index + door) % graph.degrees[vertex]
    if graph.opposite[leave] is not None:
        return Folded(graph.degrees, graph.opposite, graph.marker, graph.opposite[leave])
    entered = len(percepts), 0
    return fold(percepts + [percept], edges + [(named[leave], entered)], (0, 0), entered)


def certificate(world):
    """The length of a shortest certificate walk by the formula."""
    count = len(world.degrees)
    edges = [(one, other) for one, other in enumerate(world.opposite) if one < other]
    ends = [(world.vertex[one], world.vertex[other]) for one, other in edges]

    # Breadth first from the marker: the distances, and the edge to the parent.
    distance, parent, queue = {0: 0}, {}, deque([0])
    while queue:
        vertex = queue.popleft()
        for edge, pair in enumerate(ends):
            if vertex in pair:
                other = pair[0] + pair[1] - vertex
                if other not in distance:
                    distance[other], parent[other] = distance[vertex] + 1, edge
                    queue.append(other)
    tree = set(parent.values())
    length = sum(distance[u] + distance[v] + 1 for edge, (u, v) in enumerate(ends) if edge not in tree)

    # A hanging edge: without it, the side away from the marker is a tree.
    hanging = set()
    for edge in tree:
        near, waiting = {0}, [0]
        while waiting:
            vertex = waiting.pop()
            for other_edge, pair in enumerate(ends):
                if other_edge != edge and vertex in pair and sum(pair) - vertex not in near:
                    near.add(sum(pair) - vertex)
                    waiting.append(sum(pair) - vertex)
        far = set(range(count)) - near
        if far and sum(pair[0] in far and pair[1] in far for pair in ends) == len(far) - 1:
            hanging.add(edge)

    def above(vertex):
        """The edges from a vertex to the marker."""
        way = []
        while vertex != 0:
            way.append(parent[vertex])
            vertex = sum(ends[parent[vertex]]) - vertex
        return way

    saved = [0]
    for leaf in range(1, count):
        if world.degrees[leaf] == 1 and parent[leaf] in hanging:
            saved.append(distance[leaf] - 2 * len(hanging.intersection(above(leaf))))
    return length + 2 * len(hanging) + min(saved)


def main(what, size):
    if what == "walks":
        print_walks(size)
        return
    for edges in range(1, size + 1):
        starts = algorithm1.starts(edges)
        if what == "shortest":
            for opposite, degrees in starts:
                moves = shortest_certificate(algorithm1.World(opposite, degrees))
                print(json.dumps({"degrees": degrees, "opposite": opposite, "certificate": moves}))
        else:
            lengths = [certificate(algorithm1.World(*start)) for start in starts]
            line = {"edges": edges, "starts": len(lengths)}
            print(json.dumps(line | {"certificate_total": sum(lengths), "certificate_max": max(lengths)}))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
