"""Folded trails of robots with lengths and a compass a second time, in another language, from the description alone.

As literal as possible, with no care for speed. The trail is folded without senses; then each edge has all lengths that were
measured on it, and each vertex all directions that were seen there.
Prints one JSON object a line:

    python3 tests/oracle/senses.py 500      random walks, some of them with a wrong measurement or a wrong view

`sensed` has for each percept the measured length in millimetres of the edge just traversed, which is wrong by at most 10 %
of the true one, and the direction of each door, 0 to 3 clockwise from north, or null where the compass shows nothing. `lengths` and
`directions` are those of the darts of the folded trail, numbered breadth first: the least and the greatest length that an edge can
have, and null for what was not sensed. They are null if an edge has two lengths, or a vertex two views.
"""

import json
import random
import sys

import folding

ERROR = 100  # thousandths


def bounds(measured):
    """The lengths t with |measured - t| <= t / 10, rounded outwards."""
    return 1000 * measured // (1000 + ERROR), -(-1000 * measured // (1000 - ERROR))


def true_walk(source):
    """A walk in a world whose edges have lengths and whose doors have directions: percepts, doors and what is sensed."""
    world = folding.random_start(source)
    lengths = [source.randint(1000, 2000) for _ in world.opposite]
    turns = [source.randint(0, 3) for _ in world.degrees]
    first = [sum(world.degrees[:vertex]) for vertex in range(len(world.degrees))]

    def sensed(pose):
        length = lengths[min(pose, world.opposite[pose])]
        measured = source.randint(-(-length * 9 // 10), length * 11 // 10)
        vertex = world.vertex[pose]
        degree, index = world.degrees[vertex], pose - first[vertex]
        view = [(index + door) % degree + turns[vertex] for door in range(degree)]
        shown = degree <= 4 and source.random() < 0.7
        return [measured, [direction % 4 for direction in view] if shown else None]

    percepts, doors, senses = [world.percept()], [], [sensed(world.pose)]
    for _ in range(source.randint(0, 30)):
        doors.append(source.randrange(percepts[-1][0]))
        world.traverse(doors[-1])
        percepts.append(world.percept())
        senses.append(sensed(world.pose))
    wrong = source.randrange(len(senses))
    kind = source.random()
    if kind < 0.2:
        senses[wrong][0] = senses[wrong][0] * 3 // 2
    elif kind < 0.4 and senses[wrong][1]:
        senses[wrong][1] = [(direction + 1) % 4 for direction in senses[wrong][1]]
    return percepts, doors, senses


def sensed_of_each(percepts, doors, senses):
    """The lengths and the directions of the darts of the folded trail; None if one edge or vertex has two."""
    trail = folding.Trail(percepts[0])
    for door, percept in zip(doors, percepts[1:]):
        trail.move(door, percept)
    graph = folding.folded(trail)
    lengths, directions = [None] * len(graph.opposite), [None] * len(graph.opposite)
    pose = 0
    for move, (measured, view) in enumerate(senses):
        vertex = folding.home(graph, pose)
        first, degree = sum(graph.degrees[:vertex]), graph.degrees[vertex]
        around = [first + (pose - first + door) % degree for door in range(degree)]
        for dart, direction in zip(around, view or []):
            if directions[dart] not in (None, direction):
                return None
            directions[dart] = direction
        if move > 0:
            least, greatest = bounds(measured)
            for dart in (pose, graph.opposite[pose]):
                known = lengths[dart] or (0, greatest)
                lengths[dart] = max(least, known[0]), min(greatest, known[1])
                if lengths[dart][0] > lengths[dart][1]:
                    return None
        if move < len(doors):
            pose = graph.opposite[around[doors[move]]]
    return {"lengths": lengths, "directions": directions}


def main(count):
    source = random.Random(21)
    for _ in range(count):
        percepts, doors, senses = true_walk(source)
        found = sensed_of_each(percepts, doors, senses)
        print(json.dumps({"percepts": percepts, "doors": doors, "sensed": senses, "folded": found}))


if __name__ == "__main__":
    main(int(sys.argv[1]))
