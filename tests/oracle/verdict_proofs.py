"""Proofs of verdicts read a second time, in another language, from docs/proofs-of-verdicts.md alone.

As literal as possible: a line that is not exactly of the format is refused, and so is a step that the steps before it do
not justify. Nothing is searched. Where the page leaves something open the strictest reading is taken.

    python3 tests/oracle/verdict_proofs.py FILE...               one line a claim, and one for what is wrong first in a file
    python3 tests/oracle/verdict_proofs.py --verdicts FILE...    one line a file: accepted or refused

A file is proved if all claims of all its proofs are; the exit code is 0 if all files are. A `dart` is one end of an edge,
and a `pose` the dart by which the robot came in. A `percept` is a pair: the degree, and the sighting as a tuple of words
and numbers, ("nothing",) or ("pointing", 2). A `clash` is two darts that cannot be one.
"""

import re
import sys
from collections import Counter

# What each kind of marker can show.
SIGHTINGS = {
    "none": {"nothing"},
    "undirected": {"nothing", "lying"},
    "directional": {"nothing", "pointing"},
    "undirected-edge": {"nothing", "passed"},
    "directed-edge": {"nothing", "along", "against"},
    "two-identical": {"nothing", "lying", "two"},
    "two-distinct": {"nothing", "first", "second", "both"},
}
AT_VERTICES, ON_EDGES = {"undirected", "two-identical", "two-distinct"}, {"undirected-edge", "directed-edge"}
WORDS = set.union(*SIGHTINGS.values()) - {"pointing"}
DIGITS = 4000  # a limit of this program: Python converts no longer numbers


class Wrong(Exception):
    """What is wrong first in a file."""


class Lines:
    """The lines of a file but for the remarks, with their numbers; `number` is that of the line taken last. A line that is
    none, as it has bytes that are not printable ASCII or does not end, is kept without words."""

    def __init__(self, data):
        *lines, rest = data.split(b"\n")
        words = [line.decode("ascii").split(" ") if re.fullmatch(rb"[ -~]*", line) else [] for line in lines]
        words += [[]] if rest else []
        self.lines = [pair for pair in enumerate(words, 1) if pair[1][:1] == [] or not pair[1][0].startswith("#")]
        self.taken, self.number = 0, 1

    def wrong(self, reason, number=None):
        self.number = number or self.number
        raise Wrong(reason)

    def left(self):
        return self.taken < len(self.lines)

    def next_is(self, *words):
        return self.left() and self.lines[self.taken][1][: len(words)] == list(words)

    def take(self):
        """The words of the next line, of any form."""
        if not self.left():
            self.wrong("the proof is not complete")
        self.number, words = self.lines[self.taken]
        self.taken += 1
        return words or self.wrong("not a line of printable ASCII that ends")

    def word(self, first, allowed):
        """The one word behind `first`."""
        words = self.take()
        if len(words) != 2 or words[0] != first or words[1] not in allowed:
            self.wrong(f"`{first}` and one of its words expected")
        return words[1]

    def numbers(self, first, count=None):
        """The numbers behind `first`: so many, or at least one."""
        words = self.take()
        if words[0] != first or (len(words) < 2 if count is None else len(words) != count + 1):
            self.wrong(f"`{first}`, numbers: {'any' if count is None else count} expected")
        return [self.read(word) for word in words[1:]]

    def read(self, word):
        if not re.fullmatch(r"0|[1-9][0-9]*", word) or len(word) > DIGITS:
            self.wrong("a number expected")
        return int(word)


class World:
    """An embedded graph with its facing dart. `clockwise` has all darts of the vertex of a dart, `place` its own among them."""

    def __init__(self, lines):
        lines.numbers("world", 0)
        first = lines.number
        vertices, edges = [], []
        while lines.next_is("vertex"):
            vertices.append(lines.numbers("vertex"))
        while lines.next_is("edge"):
            edges.append(lines.numbers("edge", 2))
        (self.facing,) = lines.numbers("facing", 1)
        self.darts = range(2 * len(edges))
        for groups in vertices, edges:
            if sorted(dart for group in groups for dart in group) != list(self.darts):
                lines.wrong("not each dart is in one vertex and in one edge", first)
        if self.facing not in self.darts:
            lines.wrong("no such dart")
        self.clockwise, self.place, self.opposite = ([None] * len(self.darts) for _ in range(3))
        for vertex in vertices:
            for place, dart in enumerate(vertex):
                self.clockwise[dart], self.place[dart] = vertex, place
        for one, other in edges:
            self.opposite[one], self.opposite[other] = other, one
        reached, ahead = {0}, [0]
        while ahead:
            dart = ahead.pop()
            for other in self.opposite[dart], self.turned(dart, 1):
                if other not in reached:
                    reached.add(other)
                    ahead.append(other)
        if len(reached) < len(self.darts):
            lines.wrong("the graph is not connected", first)

    def degree(self, pose):
        return len(self.clockwise[pose])

    def turned(self, pose, door):
        return self.clockwise[pose][(self.place[pose] + door) % self.degree(pose)]

    def behind(self, pose, door):
        """The pose behind a door, None if there is no such door."""
        return self.opposite[self.turned(pose, door)] if door < self.degree(pose) else None

    def percept(self, kind, facing, pose):
        """What the robot perceives if a marker of this kind was placed by the dart `facing`."""
        here = self.clockwise[pose] is self.clockwise[facing]
        there = self.clockwise[pose] is self.clockwise[self.opposite[facing]]
        if kind == "directional" and here:
            return self.degree(pose), ("pointing", (self.place[facing] - self.place[pose]) % self.degree(pose))
        sighting = "nothing"
        if kind == "undirected" and here:
            sighting = "lying"
        elif kind == "two-identical":
            sighting = ["nothing", "lying", "two"][here + there]
        elif kind == "two-distinct":
            sighting = {(1, 0): "first", (0, 1): "second", (1, 1): "both"}.get((here, there), "nothing")
        elif kind == "undirected-edge" and pose in (facing, self.opposite[facing]):
            sighting = "passed"
        elif kind == "directed-edge" and pose in (facing, self.opposite[facing]):
            sighting = "against" if pose == facing else "along"
        return self.degree(pose), (sighting,)


class Walk:
    """What was perceived at each visit, and the doors taken."""

    def __init__(self, lines):
        lines.numbers("walk", 0)
        self.percepts, self.doors = [self.see(lines)], []
        while lines.next_is("door"):
            self.doors += lines.numbers("door", 1)
            self.percepts.append(self.see(lines))

    def see(self, lines):
        words = lines.take()
        if words[0] == "see" and len(words) == 3 and words[2] in WORDS:
            return lines.read(words[1]), (words[2],)
        if words[0] == "see" and len(words) == 4 and words[2] == "pointing":
            return lines.read(words[1]), ("pointing", lines.read(words[3]))
        lines.wrong("`see`, a degree and a sighting expected")

    def given(self, world, kind, pose):
        """Whether the walk gives these percepts from the pose."""
        for visit, percept in enumerate(self.percepts):
            if world.percept(kind, world.facing, pose) != percept:
                return False
            if visit < len(self.doors):
                pose = world.behind(pose, self.doors[visit])
                if pose is None:
                    return False
        return True


class Trail:
    """The vertices of a walk, as far as the steps tell. Visit k is at the vertex `name[k]`, and its door i is the door
    i + turn[k] there, modulo the degree. Of two vertices that become one, the smaller takes the name of the other."""

    def __init__(self, lines, kind, walk):
        self.lines, self.kind, self.walk = lines, kind, walk
        self.degrees = [degree for degree, _ in walk.percepts]
        self.sightings = [sighting for _, sighting in walk.percepts]
        self.name = list(range(len(self.degrees)))
        self.turn = [0] * len(self.degrees)
        self.visits = [[visit] for visit in self.name]

    def exists(self, dart):
        return dart[1] < self.degrees[dart[0]]

    def known(self, dart):
        """The dart by the name of its vertex: two darts are known to be one if these are equal."""
        visit, door = dart
        if not self.exists(dart):
            self.lines.wrong(f"visit {visit} has no door for this")
        return self.name[visit], (door + self.turn[visit]) % self.degrees[visit]

    def below(self, number, limit):
        if number >= limit:
            self.lines.wrong("no such visit or move")
        return number

    def visit(self, word):
        return self.below(self.lines.read(word), len(self.degrees))

    def move(self, word):
        return self.below(self.lines.read(word), len(self.walk.doors))

    def ends(self, move):
        return (move, self.walk.doors[move]), (move + 1, 0)

    def passage(self, word):
        """The dart from which a passage leaves, and that to which it leads."""
        if word[:1] not in ("+", "-"):
            self.lines.wrong("a move with its sign expected")
        ends = self.ends(self.move(word[1:]))
        return ends if word[0] == "+" else ends[::-1]

    def shown(self, words):
        """The two darts that a step shows to be one."""
        if len(words) == 3 and words[0] == "mark":
            visits = [self.visit(word) for word in words[1:]]
            if self.kind != "directional" or any(self.sightings[visit][0] != "pointing" for visit in visits):
                self.lines.wrong("no directional marker was seen")
            darts = [(visit, self.sightings[visit][1]) for visit in visits]
        elif len(words) == 3 and words[0] == "beyond":
            (one, darts_one), (other, darts_other) = (self.passage(word) for word in words[1:])
            if self.known(one) != self.known(other):
                self.lines.wrong("the passages are not known to leave from one dart")
            darts = [darts_one, darts_other]
        else:
            self.lines.wrong("no step")
        for dart in darts:
            self.known(dart)  # each exists
        return darts

    def clash(self, one, other):
        same_vertex = self.name[one[0]] == self.name[other[0]]
        return self.degrees[one[0]] != self.degrees[other[0]] or same_vertex and self.known(one) != self.known(other)

    def step(self, words):
        one, other = self.shown(words)
        if self.clash(one, other):
            self.lines.wrong("a contradiction, and no step")
        (kept, door), (lost, its_door) = sorted(map(self.known, (one, other)), key=lambda known: -len(self.visits[known[0]]))
        if kept != lost:
            for visit in self.visits[lost]:
                self.name[visit] = kept
                self.turn[visit] = (self.turn[visit] + door - its_door) % self.degrees[visit]
            self.visits[kept] += self.visits[lost]

    def complete(self):
        """Whether each door of each visit is known to be one with an end of a move."""
        ends = [end for move in range(len(self.walk.doors)) for end in self.ends(move) if self.exists(end)]
        seen = Counter(name for name, _ in set(map(self.known, ends)))
        return all(seen[self.name[visit]] == degree for visit, degree in enumerate(self.degrees))

    def contradiction(self, words):
        """Whether it is one."""
        kind, rest = words[0] if words else "", words[1:]
        if kind in ("mark", "beyond"):
            return self.clash(*self.shown(words))
        if kind == "sightings" and len(rest) == 2:
            one, other = map(self.visit, rest)
            return self.name[one] == self.name[other] and self.differ(one, other)
        if kind == "edge" and len(rest) == 1:
            one, other = self.ends(self.move(rest[0]))
            return self.known(one) == self.known(other)
        if kind == "percept" and len(rest) == 1:
            visit = self.visit(rest[0])
            sighting, *door = self.sightings[visit]
            return not self.degrees[visit] > max(door, default=0) or sighting not in SIGHTINGS[self.kind]
        if kind == "door" and len(rest) == 1:
            return not self.exists(self.ends(self.move(rest[0]))[0])
        if kind == "unmarked" and not rest:
            return self.kind == "directional" and set(self.sightings) == {("nothing",)} and self.complete()
        self.lines.wrong("no contradiction of this form")

    def differ(self, one, other):
        """Whether what was seen at two visits to one vertex differs."""
        seen, seen_there = self.sightings[one], self.sightings[other]
        if self.kind == "directional":
            marked = [{self.known((visit, door)) for door in self.sightings[visit][1:]} for visit in (one, other)]
            return marked[0] != marked[1]
        if self.kind in ON_EDGES:
            return self.known((one, 0)) == self.known((other, 0)) and seen != seen_there
        return self.kind in AT_VERTICES and seen != seen_there


class Proof:
    """One proof: made by its parts, then checked claim by claim."""

    def __init__(self, lines):
        self.lines = lines
        if lines.take() != ["toposlam-proof", "1"]:
            lines.wrong("`toposlam-proof 1` expected")
        self.worlds = []
        while lines.next_is("world") and len(self.worlds) < 2:
            self.worlds.append(World(lines))
        self.marker = lines.word("marker", SIGHTINGS)
        self.walk = Walk(lines) if lines.next_is("walk") else None

    def claims(self):
        """Checks each claim, and gives its kind."""
        claims = {
            "determined": (self.determined, 1, True), "unexplained": (self.unexplained, 0, True),
            "conforms": (self.conforms, 1, True), "diverges": (self.diverges, 1, True),
            "indistinguishable": (self.indistinguishable, 2, False), "distinguishable": (self.distinguishable, 2, False),
            "isomorphic": (self.isomorphic, 2, False), "not-isomorphic": (self.not_isomorphic, 2, False),
        }  # fmt: skip
        more = True
        while more:
            kind = self.lines.word("claim", claims)
            check, worlds, walk = claims[kind]
            if len(self.worlds) != worlds or (self.walk is not None) != walk:
                self.lines.wrong(f"`{kind}` is not about these worlds and this walk")
            check()
            self.lines.numbers("end", 0)
            yield kind
            more = self.lines.next_is("claim")

    def pose(self, pose, world=0):
        if pose not in self.worlds[world].darts:
            self.lines.wrong("no such dart")
        return pose

    def pair(self, word):
        return tuple(self.pose(pose, world) for world, pose in enumerate(self.lines.numbers(word, 2)))

    def percepts(self, pair):
        return [world.percept(self.marker, world.facing, pose) for world, pose in zip(self.worlds, pair)]

    def behind(self, pair, door):
        return tuple(world.behind(pose, door) for world, pose in zip(self.worlds, pair))

    def determined(self):
        if self.marker != "directional":
            self.lines.wrong("not a directional marker")
        self.conforms()
        trail = Trail(self.lines, self.marker, self.walk)
        while not self.lines.next_is("end"):
            trail.step(self.lines.take())
        if not any(sighting[0] == "pointing" for sighting in trail.sightings):
            self.lines.wrong("the marker was not seen")
        if not trail.complete():
            self.lines.wrong("the trail is not complete")

    def unexplained(self):
        trail = Trail(self.lines, self.marker, self.walk)
        while not self.lines.next_is("contradiction"):
            trail.step(self.lines.take())
        if not trail.contradiction(self.lines.take()[1:]):
            self.lines.wrong("no contradiction")

    def conforms(self):
        (pose,) = self.lines.numbers("from", 1)
        if not self.walk.given(self.worlds[0], self.marker, self.pose(pose)):
            self.lines.wrong("the walk does not give these percepts")

    def diverges(self):
        if self.lines.next_is("from", "any"):
            self.lines.word("from", ["any"])
            poses = self.worlds[0].darts
        else:
            poses = [self.pose(pose) for pose in self.lines.numbers("from")]
        for pose in poses:
            if self.walk.given(self.worlds[0], self.marker, pose):
                self.lines.wrong(f"the walk gives these percepts from {pose}")

    def indistinguishable(self):
        pairs = {}
        while self.lines.next_is("pair") or not pairs:
            pairs[self.pair("pair")] = self.lines.number
        for pair, number in pairs.items():
            one, other = self.percepts(pair)
            if one != other:
                self.lines.wrong("the percepts differ", number)
            for door in range(one[0]):
                if self.behind(pair, door) not in pairs:
                    self.lines.wrong(f"the poses behind door {door} are no pair", number)

    def walked(self):
        """A pair and, through doors that exist from both of its poses, that to which they lead."""
        first = pair = self.pair("from")
        while self.lines.next_is("door"):
            (door,) = self.lines.numbers("door", 1)
            pair = self.behind(pair, door)
            if None in pair:
                self.lines.wrong("no such door")
        return first, pair

    def distinguishable(self):
        walks = 0
        while self.lines.next_is("from") or not walks:
            _, pair = self.walked()
            one, other = self.percepts(pair)
            if one == other:
                self.lines.wrong("the percepts do not differ")
            walks += 1

    def isomorphic(self):
        first, second = self.worlds
        image = {}
        while self.lines.next_is("image"):
            dart, other = self.pair("image")
            if dart in image:
                self.lines.wrong("a second image of one dart")
            image[dart] = other
        if len(image) != len(first.darts) or sorted(image.values()) != list(second.darts):
            self.lines.wrong("no bijection")
        for dart in first.darts:
            if image[first.opposite[dart]] != second.opposite[image[dart]]:
                self.lines.wrong(f"the edge of {dart} is not kept")
            if image[first.turned(dart, 1)] != second.turned(image[dart], 1):
                self.lines.wrong(f"the clockwise order behind {dart} is not kept")

    def not_isomorphic(self):
        covered, always = set(), None
        while self.lines.next_is("from"):
            start, pair = self.walked()
            always = start[0] if always is None else always
            if start[0] != always or start[1] in covered:
                self.lines.wrong("another dart of the first world, or a dart of the second one again")
            covered.add(start[1])
            one, other = (world.percept("directional", *darts) for world, *darts in zip(self.worlds, start, pair))
            if one == other:
                self.lines.wrong("the percepts do not differ")
        if len(covered) != len(self.worlds[1].darts):
            self.lines.wrong("not each dart of the second world is covered")


def main(arguments):
    verdicts = arguments[:1] == ["--verdicts"]
    files = arguments[verdicts:]
    if not files:
        sys.exit(__doc__)
    accepted = True
    for file in files:
        lines = Lines(b"")
        try:
            with open(file, "rb") as opened:
                lines = Lines(opened.read())
            proofs = 0
            while not proofs or lines.left():
                for kind in Proof(lines).claims():
                    if not verdicts:
                        print(f"proved: {kind}")
                proofs += 1
            if verdicts:
                print(f"accepted {file}")
        except (Wrong, OSError) as error:
            accepted = False
            print(f"refused {file}" if verdicts else f"{file}:{lines.number}: not proved: {error}")
    return 0 if accepted else 1


if __name__ == "__main__":
    sys.stdout.reconfigure(errors="backslashreplace")
    sys.exit(main(sys.argv[1:]))
