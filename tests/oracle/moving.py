"""The explorers of the aids that move a second time, in another language, from docs/aids.md alone.

Written without sight of the Rust code, as literal as possible, with no care for speed. The worlds and
what an aid shows in them are those of `ambiguity.py`; an explorer gets percepts and nothing else.

    python3 tests/oracle/moving.py simple 6                     every aid, up to 6 edges
    python3 tests/oracle/moving.py multigraph 4 string team-2   only these aids

For each aid and each number of edges it runs the explorer on every start of every world, and prints
`AID CLASS edges starts moves_total moves_max`. Moves of a team are those of all robots together. Each
map is checked by a bijection with the world, and each run by the bounds on its moves and its string.
"""

import sys

import ambiguity
from moving_markers import explore_with_markers
from moving_string import explore_with_string
from moving_team import explore_with_team

SIMPLE_ONLY = ["movable", "movable-2", "movable-3", "movable-4", "movable-2-distinct",
               "movable-3-distinct", "movable-4-distinct", "team-2-round", "team-3-round"]
ANY_CLASS = ["movable-directional", "string", "team-2", "team-3"]


def parts(aid):
    """The name of the aid; how many markers or robots; and its variant."""
    if aid == "movable-directional":
        return aid, 1, "directional"
    return ambiguity.aid_parts({"movable": "movable-1", "string": "string-0"}.get(aid, aid))


class World:
    """An embedded graph, and an aid that is where the robot starts: at dart 0. An explorer may read
    `percept`, and call `traverse` for a door and `act` for the other actions, which are numbered as in
    `ambiguity.py`, the doors first."""

    def __init__(self, graph, aid):
        opposite, doors = graph[0], ambiguity.all_doors(graph)
        name, number, variant = parts(aid)
        self.is_string = name == "string"
        here = tuple(sorted(doors[0]))
        endless = 4 * len(opposite)  # a string's length, in edges
        look, more, self.state = {
            "movable": (ambiguity.with_markers, [variant == "distinct"], (0, (here,) * number)),
            "movable-directional": (ambiguity.with_directional_marker, [], (0, 0)),
            "string": (ambiguity.with_string, [endless], (0, here, (), True)),
            "team": (ambiguity.with_team, [variant != "round"], (0,) * number),
        }[name]
        self.look = lambda state: look(state, opposite, doors, *more)
        self.vertices = len(ambiguity.cycles(graph[1])[0])
        self.bound = bound(aid, self.vertices, len(opposite) // 2)
        self.moves = 0
        self.percept, self.following = self.look(self.state)

    def act(self, action):
        self.state = self.following[action]
        self.percept, self.following = self.look(self.state)
        if self.is_string:
            _, _, laid, _ = self.state
            assert len(laid) <= self.vertices, "the string is too long"

    def traverse(self, action):
        self.moves += 1
        assert self.moves <= self.bound, "too many moves"
        self.act(action)


EXPLORERS = {"movable": explore_with_markers, "movable-directional": explore_with_markers,
             "string": explore_with_string, "team": explore_with_team}


def bound(aid, vertices, edges):
    """The most moves that docs/aids.md allows."""
    name, number, variant = parts(aid)
    n, loops = vertices, edges - vertices + 1
    if name == "string":
        return 2 * (n - 1) + 2 * n * loops
    places = 3 * n * (n - 1) // 2
    if name == "team":
        most = places - 2 * (n - 1) + loops * (6 * n - 7 if variant == "round" else 3 * n - 2)
        return most + loops * n * (number - 2)
    if name == "movable-directional":
        return places + loops * (3 * n - 1)
    most = places + loops * (6 * n - 7)
    if number > 1:
        most += loops * (n + 1)
        if variant != "distinct":
            most += edges * (n + 1)
    return most


def bijection(graph, known):
    """The dart of the world for each dart of the map, from the start on."""
    opposite, clockwise = graph
    to_world, waiting = {(0, 0): 0}, [(0, 0)]
    for vertex, index in waiting:
        dart = to_world[vertex, index]
        next_index = (index + 1) % known.degrees[vertex]
        for near, far in [((vertex, next_index), clockwise[dart]),
                          (known.other_end[vertex, index], opposite[dart])]:
            if near not in to_world:
                to_world[near] = far
                waiting.append(near)
            assert to_world[near] == far, "the map is not the world's"
    assert sorted(to_world.values()) == list(range(len(opposite))), "the map is not all of the world"
    return to_world


def moves(aid, graph):
    """Those of the explorer on one start, its map and poses checked."""
    world = World(graph, aid)
    name, number, variant = parts(aid)
    known, poses = EXPLORERS[name](world, variant)
    to_world = bijection(graph, known)
    true_poses = world.state if name == "team" else world.state[:1]
    assert tuple(to_world[pose] for pose in poses) == true_poses
    return world.moves


def main(class_name, most_edges, aids):
    by_edges = ambiguity.graphs_checked(class_name, most_edges)
    for edges, graphs in by_edges.items():
        by_edges[edges] = sorted({ambiguity.renumbered(graph, root)[0]
                                  for graph in graphs for root in range(2 * edges)})
    for aid in aids:
        for edges, starts in by_edges.items():
            costs = [moves(aid, graph) for graph in starts]
            print(aid, class_name, edges, len(starts), sum(costs), max(costs, default=0), flush=True)


if __name__ == "__main__":
    arguments = sys.argv[1:]
    if len(arguments) < 2 or arguments[0] not in ambiguity.CLASSES or not arguments[1].isdigit():
        sys.exit(__doc__)
    possible = ANY_CLASS if arguments[0] == "multigraph" else SIMPLE_ONLY + ANY_CLASS
    if int(arguments[1]) < 1 or any(aid not in possible for aid in arguments[2:]):
        sys.exit(__doc__)
    main(arguments[0], int(arguments[1]), arguments[2:] or possible)
