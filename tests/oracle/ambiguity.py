"""The counts of `counterexample` a second time, in another language, from the definitions alone.

Written without sight of the Rust code, as literal as possible, with little care for speed: every
embedded graph of a class, every place of the marker in it, every pose of the robot, all in one
table, which is refined until nothing changes. Needs nothing but Python's own library.

    python3 tests/oracle/ambiguity.py simple 6                  every kind of marker, up to 6 edges
    python3 tests/oracle/ambiguity.py simple 6 none movable     only these kinds
    python3 tests/oracle/ambiguity.py simple 4 string-2 team-2  more aids that move, only if named
    python3 tests/oracle/ambiguity.py --check 4                 this program against itself
    python3 tests/oracle/ambiguity.py --walks multigraph 2 string-1
                                                                lengths of distinguishing walks

For each kind and each number of edges it prints `KIND m placed_worlds ambiguous`, then
`KIND smallest M K`: the edges of the two worlds of the smallest ambiguous pair, the larger first
(or `KIND smallest none`). A placed world is ambiguous when another one, of at most N edges and of
the same class, cannot be distinguished from it: from some start pose of the one and some start pose of the
other, every sequence of actions gives the same percepts. How many embedded graphs there are goes
to stderr.

`--check N` takes the sizes up to N a second way: the embedded graphs from all ways to pair the ends
of the edges, and the ambiguous worlds by walking in two worlds at once, for every pair of them. The
aids that are only taken if named are checked up to two edges.
"""

import sys
from collections import namedtuple

KINDS = ["none", "undirected", "directional", "undirected-edge", "directed-edge",
         "two-identical", "two-distinct", "movable"]
# Aids that are only taken if named. Where they are at the start: at a vertex, or along a dart.
AIDS_AT_VERTEX = ["movable-2", "movable-3", "movable-4",
                  "movable-2-distinct", "movable-3-distinct", "movable-4-distinct",
                  "string-1", "string-2", "string-3"]
AIDS_ALONG_DART = ["movable-directional", "movable+directional",
                   "team-2", "team-2-round", "team-3", "team-3-round"]
AIDS = AIDS_AT_VERTEX + AIDS_ALONG_DART
# No markers, but what the robot sees around it; only if named, too.
SENSES = ["binoculars-1", "binoculars-2", "binoculars-3"]
CLASSES = ["multigraph", "simple", "corridor", "planar"]

# Embedded graphs with 1, 2, 3, ... edges: OEIS A170946, and A006394 (simple, planar).
PUBLISHED = {"multigraph": [2, 5, 20, 107, 870, 9436], "planar": [1, 1, 3, 5, 15, 52, 213]}
# The same with one distinguished dart: OEIS A000698.
PUBLISHED_STARTS = {"multigraph": [2, 10, 74, 706, 8162, 110410]}


# ---------------------------------------------------------------- embedded graphs
# An embedded graph is a pair of tuples: the opposite of each dart, the clockwise next of each dart.

def cycles(permutation):
    """The cycles, and for each dart the number of its cycle and its index in it."""
    found, which, index = [], [None] * len(permutation), [None] * len(permutation)
    for first in range(len(permutation)):
        if which[first] is None:
            cycle, dart = [], first
            while which[dart] is None:
                which[dart], index[dart] = len(found), len(cycle)
                cycle.append(dart)
                dart = permutation[dart]
            found.append(cycle)
    return found, which, index


def belongs(graph, class_name):
    if class_name == "multigraph":
        return True
    opposite, clockwise = graph
    vertices, vertex, _ = cycles(clockwise)
    neighbours = set()
    for dart, other in enumerate(opposite):
        pair = vertex[dart], vertex[other]
        if pair[0] == pair[1] or pair in neighbours:  # a loop, parallel edges
            return False
        neighbours.add(pair)
    if class_name == "corridor":
        return max(map(len, vertices)) <= 3
    if class_name == "planar":
        faces, _, _ = cycles([clockwise[other] for other in opposite])
        return len(vertices) - len(opposite) // 2 + len(faces) == 2
    return True


def numbering(graph, root):
    """The darts in the order in which a breadth-first search from `root` meets them, and the
    number of each; None for a dart that it does not meet."""
    opposite, clockwise = graph
    order, number = [root], [None] * len(opposite)
    number[root] = 0
    for dart in order:
        for other in (clockwise[dart], opposite[dart]):
            if number[other] is None:
                number[other] = len(order)
                order.append(other)
    return order, number


def renumbered(graph, root):
    """The graph with its darts numbered from `root`, and the numbers."""
    opposite, clockwise = graph
    order, number = numbering(graph, root)
    return ((tuple(number[opposite[dart]] for dart in order),
             tuple(number[clockwise[dart]] for dart in order)), number)


def canonical(graph):
    return min(renumbered(graph, root)[0] for root in range(len(graph[0])))


def with_one_more_edge(graph):
    """Every embedded graph that is this one and one edge more: to a new vertex, or between two."""
    opposite, clockwise = graph
    one = len(opposite)
    other = one + 1
    opposite = opposite + (other, one)
    for before_one in range(one):
        grown = list(clockwise) + [clockwise[before_one], other]
        grown[before_one] = one
        yield opposite, tuple(grown)  # the other end is a vertex of its own
        for before_other in range(before_one, one + 1):  # `one` as well: just behind the first end
            both = grown[:]
            both[other], both[before_other] = both[before_other], other
            yield opposite, tuple(both)


def embedded_graphs(class_name, most_edges):
    """For each number of edges all embedded graphs of the class, each once. A connected graph of
    two edges or more has an edge that can go, with its vertex if it is a dead end, so that the
    rest is connected; and the rest is of the class too."""
    found = {canonical(graph) for graph in [((1, 0), (0, 1)), ((1, 0), (1, 0))]
             if belongs(graph, class_name)}
    by_edges = {1: sorted(found)}
    for edges in range(2, most_edges + 1):
        found = {canonical(grown) for graph in by_edges[edges - 1]
                 for grown in with_one_more_edge(graph) if belongs(grown, class_name)}
        by_edges[edges] = sorted(found)
    return by_edges


def embedded_graphs_by_pairing(class_name, edges):
    """The same another way: for all degrees that the vertices can have, all ways to pair the darts."""

    def partitions(total, most):
        if total == 0:
            yield []
        for first in range(min(total, most), 0, -1):
            for rest in partitions(total - first, first):
                yield [first] + rest

    def pairings(opposite):
        if None not in opposite:
            yield tuple(opposite)
            return
        one = opposite.index(None)
        for other in range(one + 1, len(opposite)):
            if opposite[other] is None:
                paired = opposite[:]
                paired[one], paired[other] = other, one
                yield from pairings(paired)

    found = set()
    for degrees in partitions(2 * edges, 2 * edges):
        clockwise = []
        for degree in degrees:
            first = len(clockwise)
            clockwise += [*range(first + 1, first + degree), first]
        for opposite in pairings([None] * (2 * edges)):
            graph = opposite, tuple(clockwise)
            if len(numbering(graph, 0)[0]) == 2 * edges and belongs(graph, class_name):
                found.add(canonical(graph))
    return sorted(found)


# ---------------------------------------------------------------- where the marker is
# A vertex is the sorted tuple of its darts. A place is written by darts alone, in a way that does
# not depend on how they are numbered; `moved` renumbers the darts of a place.

def vertices_by_dart(graph):
    found, which, _ = cycles(graph[1])
    return [tuple(sorted(found[vertex])) for vertex in which]


def place_of(kind, graph, facing):
    """Where the marker is when it was placed by this facing dart."""
    vertex, other = vertices_by_dart(graph), graph[0][facing]
    if kind == "none" or kind in SENSES:
        return ()
    if kind in ("undirected", "movable", *AIDS_AT_VERTEX):
        return vertex[facing]
    if kind in ("directional", "directed-edge", *AIDS_ALONG_DART):
        return facing
    if kind == "undirected-edge":
        return tuple(sorted([facing, other]))
    if kind == "two-identical":
        return tuple(sorted([vertex[facing], vertex[other]]))
    if kind == "two-distinct":
        return vertex[facing], vertex[other]
    raise ValueError(kind)


def moved(kind, place, number):
    if kind in ("directional", "directed-edge", *AIDS_ALONG_DART):
        return number[place]
    if kind in ("none", "undirected", "movable", "undirected-edge", *AIDS_AT_VERTEX, *SENSES):
        return tuple(sorted(number[dart] for dart in place))
    ends = [tuple(sorted(number[dart] for dart in end)) for end in place]
    return tuple(sorted(ends) if kind == "two-identical" else ends)


PlacedWorld = namedtuple("PlacedWorld", "graph edges facings")


def placed_worlds(kind, graph):
    """The placed worlds on a graph, each once: all facing darts that give the same placed world
    (the same place, or one that an isomorphism takes there), of which any one will do."""
    numberings = [renumbered(graph, root) for root in range(len(graph[0]))]
    found = {}
    for facing in range(len(graph[0])):
        place = place_of(kind, graph, facing)
        code = min((copy, moved(kind, place, number)) for copy, number in numberings)
        found.setdefault(code, []).append(facing)
    return [PlacedWorld(graph, len(graph[0]) // 2, facings) for _, facings in sorted(found.items())]


# ---------------------------------------------------------------- the robot in a placed world

def start_poses(kind, graph, facing):
    vertex, other = vertices_by_dart(graph), graph[0][facing]
    if kind == "none" or kind in SENSES:
        return set(range(len(vertex)))
    if kind in ("undirected", "movable", "two-distinct", *AIDS_AT_VERTEX):
        return set(vertex[facing])
    if kind in ("directional", *AIDS_ALONG_DART):
        return {facing}
    if kind in ("undirected-edge", "directed-edge"):
        return {facing, other}
    if kind == "two-identical":
        return set(vertex[facing]) | set(vertex[other])
    raise ValueError(kind)


def start_states(kind, world):
    """Poses; with an aid that moves, poses and the state of the aid."""
    graph, facing = world.graph, world.facings[0]
    poses, here = start_poses(kind, graph, facing), vertices_by_dart(graph)[facing]
    if kind == "movable":
        return {(pose, here) for pose in poses}
    if kind not in AIDS:
        return poses
    name, number, _ = aid_parts(kind)
    if name == "movable":
        return {(pose, (here,) * number) for pose in poses}
    if name == "movable-directional":
        return {(pose, facing) for pose in poses}
    if name == "movable+directional":
        return {(pose, facing, here) for pose in poses}
    if name == "string":
        return {(pose, here, (), True) for pose in poses}
    return {(pose,) * number for pose in poses}  # a team


def ball(graph, pose, radius):
    """What lies within so many edges of a pose: the darts of the vertices that are near, numbered from
    the pose; of each its clockwise next, and its opposite if that is one of them."""
    opposite, clockwise = graph
    vertex = vertices_by_dart(graph)
    near = {vertex[pose]}
    for _ in range(radius):
        near |= {vertex[opposite[dart]] for here in near for dart in here}
    inside = [other if vertex[other] in near else None for other in opposite]
    order, number = [pose], {pose: 0}
    for dart in order:
        for other in (clockwise[dart], inside[dart]):
            if other is not None and other not in number:
                number[other] = len(order)
                order.append(other)
    return tuple((number[clockwise[dart]], number.get(inside[dart])) for dart in order)


def states(kind, world):
    """The table of a placed world: for each state its percept and the states to which the actions
    lead, the doors first; and the start states."""
    if kind in AIDS:
        return reachable_states(kind, world)
    graph, facing = world.graph, world.facings[0]
    opposite, clockwise = graph
    vertex = vertices_by_dart(graph)
    first, second = vertex[facing], vertex[opposite[facing]]

    def behind_doors(pose):
        """The poses behind door 0, door 1, ... of a robot that came in by `pose`."""
        poses, dart = [], pose
        for _ in vertex[pose]:
            poses.append(opposite[dart])
            dart = clockwise[dart]
        return poses

    def sighting(pose):
        here = vertex[pose]
        if kind == "none":
            return None
        if kind in SENSES:
            return ball(graph, pose, int(kind[-1]))
        if kind == "undirected":
            return here == first
        if kind == "directional":
            if here != first:
                return None
            door, dart = 0, pose
            while dart != facing:
                door, dart = door + 1, clockwise[dart]
            return door
        if kind == "undirected-edge":
            return pose in (facing, opposite[facing])
        if kind == "directed-edge":
            return "along" if pose == facing else "against" if pose == opposite[facing] else None
        if kind == "two-identical":
            return (here == first) + (here == second)
        if kind == "two-distinct":
            return here == first, here == second
        raise ValueError(kind)

    poses = range(len(opposite))
    if kind != "movable":
        table = {pose: ((len(vertex[pose]), sighting(pose)), behind_doors(pose)) for pose in poses}
        return table, start_states(kind, world)

    table = {}
    for pose in poses:
        here, behind = vertex[pose], behind_doors(pose)
        carrying = [(next_pose, "carried") for next_pose in behind]
        table[pose, "carried"] = (len(here), "carried"), carrying + [(pose, here)]  # drop
        for place in set(vertex):
            walking = [(next_pose, place) for next_pose in behind]
            if place == here:
                table[pose, place] = (len(here), "lies here"), walking + [(pose, "carried")]  # pick up
            else:
                table[pose, place] = (len(here), "nothing"), walking
    return table, start_states(kind, world)


# ---------------------------------------------------------------- the aids that move
# For each a function from a state to its percept and to the states to which the actions lead, always
# in the same order. A percept shows which actions there are, so equal percepts have the same list.
# `doors[pose]` are the darts at door 0, door 1, ... of a robot that came in by `pose`.

def aid_parts(kind):
    """The name of the aid; how many markers, edges' lengths of string, or robots; and its variant."""
    if kind in ("movable-directional", "movable+directional"):
        return kind, 1, None
    name, number, *variant = kind.split("-")
    return name, int(number), variant[0] if variant else None


def all_doors(graph):
    vertices, which, index = cycles(graph[1])
    return [vertices[which[pose]][index[pose]:] + vertices[which[pose]][:index[pose]]
            for pose in range(len(graph[0]))]


CARRIED = ()  # the place of a marker that the robot carries: no dart


def with_markers(state, opposite, doors, distinct):
    """The robot's pose and the place of each marker. Of markers that are alike only the number at
    each place matters, so their places are sorted."""
    pose, places = state
    here = tuple(sorted(doors[pose]))

    def with_place(marker, place):
        changed = places[:marker] + (place,) + places[marker + 1:]
        return pose, changed if distinct else tuple(sorted(changed))

    lying = [marker for marker, place in enumerate(places) if place == here]
    carried = [marker for marker, place in enumerate(places) if place == CARRIED]
    next_states = [(opposite[dart], places) for dart in doors[pose]]
    if distinct:
        sighting = tuple(lying), tuple(carried)
        next_states += [with_place(marker, CARRIED) for marker in lying]
        next_states += [with_place(marker, here) for marker in carried]
    else:  # any one of them
        sighting = len(lying), len(carried)
        next_states += [with_place(marker, CARRIED) for marker in lying[:1]]
        next_states += [with_place(marker, here) for marker in carried[:1]]
    return (len(here), sighting), next_states


def with_directional_marker(state, opposite, doors):
    """The robot's pose and the dart along which the marker points, or "carried"."""
    pose, along = state
    next_states = [(opposite[dart], along) for dart in doors[pose]]
    if along == "carried":
        return (len(doors[pose]), "carried"), next_states + [(pose, pose)]  # drop
    if along in doors[pose]:
        return (len(doors[pose]), doors[pose].index(along)), next_states + [(pose, "carried")]  # pick up
    return (len(doors[pose]), None), next_states


def with_two_markers(state, opposite, doors):
    """The robot's pose, the dart along which the directional marker points, and the place of the one
    that is carried."""
    pose, along, place = state
    here = tuple(sorted(doors[pose]))
    door = doors[pose].index(along) if along in here else None
    next_states = [(opposite[dart], along, place) for dart in doors[pose]]
    if place in (here, CARRIED):
        next_states.append((pose, along, here if place == CARRIED else CARRIED))
    return (len(here), door, place == here, place == CARRIED), next_states


def with_string(state, opposite, doors, length):
    """The robot's pose; the vertex of the fixed end; the string's way from there, as the darts by
    which the robot left when it laid it; and whether the robot holds the free end."""
    pose, fixed, laid, held = state
    here = tuple(sorted(doors[pose]))
    far_end = opposite[laid[-1]] if laid else None  # the dart by which the last laid edge comes in
    free = tuple(sorted(doors[far_end])) if laid else fixed
    next_states = []
    for dart in doors[pose]:
        if not held:
            next_states.append((opposite[dart], fixed, laid, held))
        elif dart == far_end:
            next_states.append((opposite[dart], fixed, laid[:-1], held))  # wound in
        elif len(laid) < length:
            next_states.append((opposite[dart], fixed, laid + (dart,), held))
    if held or here == free:
        next_states.append((pose, fixed, laid, not held))  # drop, or pick up
    through = tuple(door for door, dart in enumerate(doors[pose])
                    if dart in laid or opposite[dart] in laid)
    from_hand = doors[pose].index(far_end) if held and laid else None
    sighting = (through, here == fixed, not held and here == free, from_hand,
                held, length - len(laid))
    return (len(here), sighting), next_states


def with_team(state, opposite, doors, headings):
    """The poses of all robots, the first robot's first."""
    def seen(robot):
        """Together with which robot that comes earlier, and with headings along which of its
        doors; or else the number of doors."""
        for earlier in range(robot):
            if state[robot] in doors[state[earlier]]:
                door = doors[state[earlier]].index(state[robot]) if headings else None
                return "with", earlier, door
        return "elsewhere", len(doors[state[robot]])

    next_states = [state[:robot] + (opposite[dart],) + state[robot + 1:]
                   for robot, pose in enumerate(state) for dart in doors[pose]]
    return (len(doors[state[0]]), *map(seen, range(1, len(state)))), next_states


def reachable_states(kind, world):
    name, number, variant = aid_parts(kind)
    look, more = {"movable": (with_markers, [variant == "distinct"]),
                  "movable-directional": (with_directional_marker, []),
                  "movable+directional": (with_two_markers, []),
                  "string": (with_string, [number]),
                  "team": (with_team, [variant != "round"])}[name]
    starts, doors = start_states(kind, world), all_doors(world.graph)
    table, waiting = {}, list(starts)
    for state in waiting:
        if state not in table:
            table[state] = look(state, world.graph[0], doors, *more)
            waiting += table[state][1]
    return table, starts


# ---------------------------------------------------------------- indistinguishable worlds

def classes_of_starts(kind, worlds):
    """One table of all states of all placed worlds: first split by percept, then again and again
    by the classes to which the actions lead, until there are no more classes than before. Two
    states of one class give the same percepts by every sequence of actions. Answers for each
    placed world the classes of its start states."""
    percepts, following, starts = [], [], []
    row, row_graph = {}, None
    for world in worlds:
        # What happens after a state of an aid that moves depends on it and on the graph alone. So a
        # placed world whose start states are in the last table, of the same graph, has all of its
        # states there. A string's fixed end stays, so there each placed world has its own states.
        world_starts = start_states(kind, world)
        if not ((kind == "movable" or kind in AIDS) and row_graph == world.graph
                and all(state in row for state in world_starts)):
            table, _ = states(kind, world)
            row, row_graph = {state: len(percepts) + i for i, state in enumerate(table)}, world.graph
            for percept, next_states in table.values():
                percepts.append(percept)
                following.append([row[state] for state in next_states])
        starts.append([row[state] for state in world_starts])

    def split(keys):
        number = {}
        return [number.setdefault(key, len(number)) for key in keys], len(number)

    # The number of actions is part of the first split: only states with the same actions compare.
    now, count = split((percept, len(row)) for percept, row in zip(percepts, following))
    while True:
        now, more = split((now[i], *[now[j] for j in row]) for i, row in enumerate(following))
        if more == count:
            return [{now[state] for state in world_starts} for world_starts in starts]
        count = more


def ambiguous(kind, worlds):
    """For each placed world whether another one cannot be distinguished from it, and the edges of the
    smallest such pair."""
    sharing = {}
    for i, classes in enumerate(classes_of_starts(kind, worlds)):
        for one in classes:
            sharing.setdefault(one, []).append(i)
    confused, smallest = set(), None
    for members in sharing.values():
        if len(members) > 1:
            confused.update(members)
            less, more = sorted(worlds[i].edges for i in members)[:2]
            smallest = (more, less) if smallest is None else min(smallest, (more, less))
    return confused, smallest


def shortest_walk(one, other, start_one, start_other):
    """The number of actions after which walking in both tables at once comes to percepts that
    differ; None if it never does."""
    actions, waiting = {(start_one, start_other): 0}, [(start_one, start_other)]
    for here, there in waiting:
        (percept_here, next_here), (percept_there, next_there) = one[here], other[there]
        if percept_here != percept_there or len(next_here) != len(next_there):
            return actions[here, there]
        for pair in zip(next_here, next_there):
            if pair not in actions:
                actions[pair] = actions[here, there] + 1
                waiting.append(pair)
    return None


def distinguishable(one, other, start_one, start_other):
    return shortest_walk(one, other, start_one, start_other) is not None


def ambiguous_by_walking(kind, worlds):
    """The same as `ambiguous`, pair by pair."""
    tables = [states(kind, world) for world in worlds]
    confused, smallest = set(), None
    for i, (one, starts_one) in enumerate(tables):
        for j, (other, starts_other) in enumerate(tables[:i]):
            if not all(distinguishable(one, other, a, b) for a in starts_one for b in starts_other):
                confused.update([i, j])
                less, more = sorted([worlds[i].edges, worlds[j].edges])
                smallest = (more, less) if smallest is None else min(smallest, (more, less))
    return confused, smallest


# ---------------------------------------------------------------- the command line

def graphs_checked(class_name, most_edges):
    """All embedded graphs of a class, their numbers held against the published ones."""
    by_edges = embedded_graphs(class_name, most_edges)
    for edges, graphs in by_edges.items():
        starts = sum(len({renumbered(graph, root)[0] for root in range(2 * edges)}) for graph in graphs)
        print(f"{class_name} {edges}: {len(graphs)} embedded graphs, {starts} starts", file=sys.stderr, flush=True)
        for count, published in [(len(graphs), PUBLISHED), (starts, PUBLISHED_STARTS)]:
            known = published.get(class_name, [])
            assert edges > len(known) or count == known[edges - 1], (class_name, edges, count)
    return by_edges


def report(class_name, most_edges, kinds):
    by_edges = graphs_checked(class_name, most_edges)
    for kind in kinds:
        worlds = [world for graphs in by_edges.values() for graph in graphs
                  for world in placed_worlds(kind, graph)]
        confused, smallest = ambiguous(kind, worlds)
        for edges in by_edges:
            of_size = [i for i, world in enumerate(worlds) if world.edges == edges]
            print(kind, edges, len(of_size), sum(i in confused for i in of_size))
        print(kind, "smallest", *(smallest or ["none"]), flush=True)


def walks(class_name, most_edges, kinds):
    """How many pairs of starts have a shortest walk of each length that distinguishes them."""
    roots = [(graph, root) for graphs in embedded_graphs(class_name, most_edges).values()
             for graph in graphs for root in range(len(graph[0]))]
    graphs = sorted({renumbered(graph, root)[0] for graph, root in roots})
    for kind in kinds:
        tables = []
        for graph in graphs:
            table, starts = states(kind, PlacedWorld(graph, len(graph[0]) // 2, [0]))
            # A pose, or a pose and the state of the aid.
            [start] = [state for state in starts if state == 0 or isinstance(state, tuple) and state[0] == 0]
            tables.append((table, start))
        lengths = [shortest_walk(one, other, a, b) for i, (one, a) in enumerate(tables)
                   for other, b in tables[:i]]
        for length in sorted(set(lengths), key=lambda length: (length is None, length)):
            print(kind, "never" if length is None else length, lengths.count(length), flush=True)


def check(most_edges):
    for class_name in CLASSES:
        by_edges = graphs_checked(class_name, most_edges)
        for edges, graphs in by_edges.items():
            assert graphs == embedded_graphs_by_pairing(class_name, edges), (class_name, edges)
        for kind in KINDS + AIDS + SENSES:
            worlds = []
            for edges, graphs in by_edges.items():
                if kind in AIDS and edges > 2:
                    continue
                for graph in graphs:
                    on_graph = placed_worlds(kind, graph)
                    for world in on_graph:
                        # Isomorphic markings look the same, whichever facing dart stands for them.
                        again = [world._replace(facings=[facing]) for facing in world.facings]
                        classes = classes_of_starts(kind, again)
                        assert all(one & classes[0] for one in classes), (kind, world)
                    worlds += on_graph
            assert ambiguous(kind, worlds) == ambiguous_by_walking(kind, worlds), (class_name, kind)
            print(class_name, kind, len(worlds), "placed worlds: both ways agree", flush=True)


def main(arguments):
    if len(arguments) == 2 and arguments[0] == "--check" and arguments[1].isdigit():
        check(int(arguments[1]))
    elif len(arguments) > 3 and arguments[0] == "--walks":
        walks(arguments[1], int(arguments[2]), arguments[3:])
    elif (len(arguments) >= 2 and arguments[0] in CLASSES and arguments[1].isdigit()
            and int(arguments[1]) >= 1 and all(kind in KINDS + AIDS + SENSES for kind in arguments[2:])):
        report(arguments[0], int(arguments[1]), arguments[2:] or KINDS)
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main(sys.argv[1:])
