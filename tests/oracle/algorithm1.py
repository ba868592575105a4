"""Algorithm 1 a second time, in another language, from the paper and the design alone.

First written without sight of the Rust code, and tidied since; as literal as possible, with no care
for speed. `tests/oracle.rs` compares the totals of the two. Prints one JSON object for each number of edges:

    python3 tests/oracle/algorithm1.py default 5    the default choices, up to 5 edges
    python3 tests/oracle/algorithm1.py all 4        every run, one by one, up to 4 edges
"""

import json
import sys
from collections import deque


def starts(edges, fits=lambda opposite, degrees: True):
    """Every start that fits, as must all that it grew from: the opposite of each dart, and the
    degrees of the vertices, in whose order the darts stand, clockwise. Dart 0 is the facing dart.
    The first free dart meets a later free one, or the first dart of a new vertex."""

    def grow(opposite, degrees):
        if not fits(opposite, degrees):
            return
        free = [dart for dart, other in enumerate(opposite) if other is None]
        if not free:
            if len(opposite) == 2 * edges:
                yield opposite, degrees
            return
        for other in free[1:]:
            yield from grow(joined(opposite, free[0], other), degrees)
        for degree in range(1, 2 * edges - len(opposite) + 1):
            grown = opposite + [None] * degree
            yield from grow(joined(grown, free[0], len(opposite)), degrees + [degree])

    def joined(opposite, one, other):
        opposite = opposite[:]
        opposite[one], opposite[other] = other, one
        return opposite

    for degree in range(1, 2 * edges + 1):
        yield from grow([None] * degree, [degree])


class World:
    """An embedded graph with the marker along dart 0, and a robot that came in by `pose`."""

    def __init__(self, opposite, degrees):
        self.opposite, self.vertex, self.index, self.first = opposite, [], [], []
        for vertex, degree in enumerate(degrees):
            self.first.append(len(self.vertex))
            self.vertex += [vertex] * degree
            self.index += range(degree)
        self.degrees, self.pose, self.moves = degrees, 0, 0

    def behind(self, door):
        vertex = self.vertex[self.pose]
        return self.first[vertex] + (self.index[self.pose] + door) % self.degrees[vertex]

    def percept(self):
        """The degree, and the door along which the marker points if it lies here."""
        degree = self.degrees[self.vertex[self.pose]]
        return degree, -self.index[self.pose] % degree if self.vertex[self.pose] == 0 else None

    def traverse(self, door):
        assert 0 <= door < self.percept()[0]
        self.pose = self.opposite[self.behind(door)]
        self.moves += 1


class Map:
    """What is known: the degrees of the vertices in the order of discovery, and for each explored
    dart (vertex, index) its other end."""

    def __init__(self, degrees, other_end):
        self.degrees, self.other_end = degrees, other_end

    def unexplored(self):
        darts = ((v, i) for v, degree in enumerate(self.degrees) for i in range(degree))
        return [dart for dart in darts if dart not in self.other_end]

    def expected(self, dart):
        vertex, index = dart
        degree = self.degrees[vertex]
        return degree, -index % degree if vertex == 0 else None

    def tree(self, root):
        """Breadth first, darts by index, first parent kept: for each vertex its distance from the
        root, and the edge that leads to it, as (dart at the parent, dart at the vertex)."""
        distance, edge_to, queue = {root: 0}, {}, deque([root])
        while queue:
            vertex = queue.popleft()
            for index in range(self.degrees[vertex]):
                far = self.other_end.get((vertex, index))
                if far and far[0] not in distance:
                    distance[far[0]] = distance[vertex] + 1
                    edge_to[far[0]] = ((vertex, index), far)
                    queue.append(far[0])
        return distance, edge_to

    def with_edge(self, one, other):
        degrees = self.degrees[:]
        return Map(degrees, {**self.other_end, one: other, other: one})

    def with_vertex(self, edge, degree):
        grown = self.with_edge(edge, (len(self.degrees), 0))
        grown.degrees.append(degree)
        return grown

    def state(self, vertex):
        darts = ((v, i) for v, degree in enumerate(self.degrees) for i in range(degree))
        return tuple(self.degrees), tuple(self.other_end.get(dart) for dart in darts), vertex

    def is_isomorphic_to(self, world):
        """As starts: renumbered as a robot meets them, both are the same."""
        at = {(0, index): index for index in range(self.degrees[0])}
        for vertex, degree in enumerate(self.degrees[1:], 1):
            entry = world.opposite[at[self.other_end[vertex, 0]]]
            home = world.vertex[entry]
            if world.degrees[home] != degree:
                return False
            for index in range(degree):
                turned = (world.index[entry] + index) % degree
                at[vertex, index] = world.first[home] + turned
        edges = self.other_end.items()
        return (
            self.degrees[0] == world.degrees[0]
            and sorted(at.values()) == list(range(len(world.opposite)))
            and all(world.opposite[at[dart]] == at[other] for dart, other in edges)
        )


def follow(world, known, robot, edge):
    """Line 6: from the robot's dart through the map to the vertex of `edge`, and along it."""
    _, edge_to = known.tree(robot[0])
    path, vertex = [], edge[0]
    while vertex != robot[0]:
        path.append(edge_to[vertex])
        vertex = edge_to[vertex][0][0]
    for (_, leave), enter in reversed(path):
        world.traverse((leave - robot[1]) % known.degrees[robot[0]])
        robot = enter
        assert world.percept() == known.expected(robot)
    world.traverse((edge[1] - robot[1]) % known.degrees[edge[0]])


def confirmed(world, known, hypothesis):
    """Lines 10 to 17: the robot's dart at the marker, or None when it is back where it was."""
    _, edge_to = known.tree(0)
    here, robot, back = world.pose, hypothesis, []
    while robot[0] != 0:
        enter, leave = edge_to[robot[0]]
        door = (leave[1] - robot[1]) % known.degrees[robot[0]]
        back.append((door, world.percept()[0]))
        world.traverse(door)
        robot = enter
        if world.percept() != known.expected(robot):
            turn = 0
            for door, degree in reversed(back):
                world.traverse(turn)
                turn = -door % degree
            # It came back by the dart by which it left; turning on the spot is no move.
            world.pose = world.behind(turn)
            assert world.pose == here
            return None
    return robot


def map_by_default(world):
    """Algorithm 1 with the default choices."""
    known, robot = Map([world.percept()[0]], {}), (0, 0)
    while known.unexplored():
        distance, _ = known.tree(robot[0])
        edge = min(known.unexplored(), key=lambda dart: (distance[dart[0]], dart))
        follow(world, known, robot, edge)
        arrival = world.percept()
        from_marker, _ = known.tree(0)
        hypotheses = [dart for dart in known.unexplored() if dart != edge]
        for hypothesis in sorted(hypotheses, key=lambda dart: (from_marker[dart[0]], dart)):
            if known.expected(hypothesis) == arrival:
                robot = confirmed(world, known, hypothesis)
                if robot:
                    known = known.with_edge(edge, hypothesis)
                    break
        else:
            robot = (len(known.degrees), 0)
            known = known.with_vertex(edge, arrival[0])
    assert known.is_isomorphic_to(world)
    return world.moves


def every_run(world):
    """All choices, one run after the other: the states at line 4, and the moves of each run."""
    states, costs = set(), []

    def line_4(known, robot, pose, moves):
        states.add(known.state(robot[0]))
        if not known.unexplored():
            assert known.is_isomorphic_to(world)
            costs.append(moves)
        for edge in known.unexplored():
            world.pose, world.moves = pose, moves
            follow(world, known, robot, edge)
            arrival = world.percept()
            fitting = [
                dart
                for dart in known.unexplored()
                if dart != edge and known.expected(dart) == arrival
            ]
            line_8(known, edge, arrival, fitting, world.pose, world.moves)

    def line_8(known, edge, arrival, hypotheses, pose, moves):
        if not hypotheses:
            new = (len(known.degrees), 0)
            line_4(known.with_vertex(edge, arrival[0]), new, pose, moves)
        for hypothesis in hypotheses:
            world.pose, world.moves = pose, moves
            robot = confirmed(world, known, hypothesis)
            if robot:
                line_4(known.with_edge(edge, hypothesis), robot, world.pose, world.moves)
            else:
                left = [other for other in hypotheses if other != hypothesis]
                line_8(known, edge, arrival, left, pose, world.moves)

    line_4(Map([world.percept()[0]], {}), (0, 0), 0, 0)
    return len(states), costs


def main(choices, up_to):
    for edges in range(1, up_to + 1):
        worlds = [World(*start) for start in starts(edges)]
        line = {"edges": edges, "starts": len(worlds)}
        if choices == "default":
            moves = [map_by_default(world) for world in worlds]
            line |= {"moves_total": sum(moves), "moves_max": max(moves)}
        else:
            runs = [every_run(world) for world in worlds]
            costs = [cost for _, costs in runs for cost in costs]
            line |= {
                "states": sum(states for states, _ in runs),
                "runs": len(costs),
                "moves_least": min(costs),
                "moves_most": max(costs),
            }
        print(json.dumps(line))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
