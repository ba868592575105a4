"""The movable marker algorithm a second time, in another language, from its description alone.

As literal as possible, with no care for speed. `tests/oracle.rs` compares the totals of the two.
Prints one JSON object for each number of edges:

    python3 tests/oracle/movable_marker.py 5    worlds without loops and parallel edges, up to 5 edges
"""

import json
import sys

import algorithm1


class World(algorithm1.World):
    """An embedded graph with a marker that lies at a vertex, or nowhere while the robot has it."""

    def __init__(self, opposite, degrees):
        super().__init__(opposite, degrees)
        self.marked = 0

    def percept(self):
        """The degree, and whether the marker lies here."""
        vertex = self.vertex[self.pose]
        return self.degrees[vertex], vertex == self.marked

    def pick_up(self):
        assert self.marked == self.vertex[self.pose]
        self.marked = None

    def drop(self):
        assert self.marked is None
        self.marked = self.vertex[self.pose]


def is_simple(opposite, degrees):
    """Whether there is neither a loop nor a parallel edge among those that have both ends."""
    at = [vertex for vertex, degree in enumerate(degrees) for _ in range(degree)]
    ends = [(at[one], at[two]) for one, two in enumerate(opposite) if two is not None]
    return len(set(ends)) == len(ends) and all(one != two for one, two in ends)


class Robot:
    """A robot that knows a map, and the dart (vertex, index) of it by which it has come in."""

    def __init__(self, world):
        self.world, self.at = world, (0, 0)
        self.map = algorithm1.Map([world.percept()[0]], {})

    def leave(self, index):
        """Through the dart with this index, wherever it leads."""
        self.world.traverse((index - self.at[1]) % self.map.degrees[self.at[0]])

    def go(self, target, found=lambda: False):
        """By a shortest path to a known vertex, or until something is found on the way."""
        _, edge_to = self.map.tree(self.at[0])
        path = []
        while target != self.at[0]:
            path.append(edge_to[target])
            target = edge_to[target][0][0]
        passed = []
        for (_, leave), enter in reversed(path):
            self.leave(leave)
            self.at = enter
            passed.append(enter[0])
            if found():
                break
        return passed

    def candidates(self, known_end, degree):
        """The known vertices that the unknown end may be, depth first along the shortest paths from
        the known end."""
        joined = [self.map.other_end.get((known_end, i)) for i in range(self.map.degrees[known_end])]
        out = {known_end} | {far[0] for far in joined if far}
        frontier = {vertex for vertex, _ in self.map.unexplored()} - out
        _, edge_to = self.map.tree(known_end)

        def walk(vertex):
            yield vertex
            children = [(near, far) for near, far in edge_to.values() if near[0] == vertex]
            for _, far in sorted(children):
                yield from walk(far[0])

        return [v for v in walk(known_end) if v in frontier and self.map.degrees[v] == degree]

    def explore(self, edge):
        """Follows an unexplored edge, and adds it to the map."""
        self.go(edge[0])
        self.leave(edge[1])
        degree, marked = self.world.percept()
        assert not marked
        ahead = self.candidates(edge[0], degree)
        if ahead:
            # Drop the marker here, go back, and look for it at the candidates.
            self.world.drop()
            self.world.traverse(0)
            self.at = edge
            while ahead:
                passed = self.go(ahead[0], lambda: self.world.percept()[1])
                if self.world.percept()[1]:
                    other = self.back_link(edge)
                    self.map = self.map.with_edge(edge, other)
                    return
                ahead = [vertex for vertex in ahead if vertex not in passed]
            self.go(edge[0])
            self.leave(edge[1])
            self.world.pick_up()
        self.at = (len(self.map.degrees), 0)
        self.map = self.map.with_vertex(edge, degree)

    def back_link(self, edge):
        """By which dart of the vertex where the robot and the marker are does the edge lead here?"""
        self.world.pick_up()
        here = self.at[0]
        darts = [dart for dart in self.map.unexplored() if dart[0] == here]
        if len(darts) == 1:
            return darts[0]
        self.go(edge[0])
        self.world.drop()
        self.go(here)
        for dart in darts:
            self.leave(dart[1])
            if self.world.percept()[1]:
                self.world.pick_up()
                self.at = edge
                return dart
            self.world.traverse(0)
            self.at = dart
        raise AssertionError("no back-link")


def map_by_default(world):
    robot = Robot(world)
    world.pick_up()
    while robot.map.unexplored():
        distance, _ = robot.map.tree(robot.at[0])
        edge = min(robot.map.unexplored(), key=lambda dart: (distance[dart[0]], dart))
        robot.explore(edge)
    assert robot.map.is_isomorphic_to(world)
    return world.moves


def main(up_to):
    for edges in range(1, up_to + 1):
        starts = algorithm1.starts(edges, is_simple)
        moves = [map_by_default(World(*start)) for start in starts]
        line = {"edges": edges, "starts": len(moves)}
        print(json.dumps(line | {"moves_total": sum(moves), "moves_max": max(moves)}))


main(int(sys.argv[1]))
