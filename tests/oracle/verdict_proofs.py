"""A second reader of proofs of verdicts, written from docs/proofs-of-verdicts.md alone.

It follows the page word by word: what is not exactly of the format is refused, and so is what the lines
before it do not justify. Where the page leaves something open, the strictest reading is taken.

    python3 tests/oracle/verdict_proofs.py FILE...               each claim proved, and what is wrong first
    python3 tests/oracle/verdict_proofs.py --verdicts FILE...    each file: accepted or refused

A file is accepted if all its proofs hold; the exit code is 0 if all files are. A percept is a tuple of its
words, (2, "nothing") or (2, "pointing", 0), and a dart of a walk is a pair, of a visit and a door.
"""

import functools
import re
import sys

# What a claim needs before it.
CLAIMS = {
    "determined": "world, walk",
    "unexplained": "walk",
    "conforms": "world, walk or world, run",
    "diverges": "world, walk or world, run",
    "indistinguishable": "world, world",
    "distinguishable": "world, world",
    "isomorphic": "world, world",
    "not-isomorphic": "world, world",
    "fits": "world, visits",
    "misfits": "world, visits",
    "impossible": "visits",
}

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

# What a form has in capitals is a number, but for these.
NUMBER = "(0|[1-9][0-9]{0,17})"
FIELDS = {
    "CLAIM": "|".join(CLAIMS),
    "MARKER": "|".join(SIGHTINGS),
    "SIGHTING": "|".join(set.union(*SIGHTINGS.values()) - {"pointing"}) + f"|pointing {NUMBER}",
    "M": f"[+-]{NUMBER}",
    "N": f"[+-]{NUMBER}",
    "REASON": f"(sightings {NUMBER}|edge|percept|door) {NUMBER}|unmarked",
    "WAY": "through|back",
    "AID": "movable|movable-directional",
    "ACTION": "pick-up|drop",
    "DOOR": f"{NUMBER}|any",
}


@functools.cache
def pattern(form):
    """The regular expression for a line of this form; `D...` is one number or several."""

    def field(match):
        word = f"({FIELDS.get(match[1], NUMBER)})"
        return f"{word}( {word})*" if match[2] else word

    return re.compile(re.sub(r"([A-Z]+)(\.\.\.)?", field, form) + "\n")


class ProofError(Exception):
    """What is wrong first in a file, and in which line."""


class Lines:
    """The lines of a file with their numbers, without the remarks; then an empty one, which has no form."""

    def __init__(self, lines):
        self.lines = [pair for pair in enumerate([*lines, ""], 1) if not re.fullmatch("#[ -~]*\n", pair[1])]
        self.taken, self.number = 0, 1

    def need(self, condition, otherwise):
        if not condition:
            raise ProofError(f"{self.number}: not proved: {otherwise}")

    def left(self):
        return self.taken < len(self.lines) - 1

    def next_is(self, start):
        return self.lines[self.taken][1].startswith((start + " ", start + "\n"))

    def take(self, form):
        """The words of the next line, which has this form, behind the first one; numbers as numbers."""
        self.number, line = self.lines[self.taken]
        self.need(pattern(form).fullmatch(line), f"`{form}` expected")
        self.taken += 1
        return [int(word) if word.isdigit() else word for word in line.split()[1:]]


class World:
    """An embedded graph with its facing dart."""

    def __init__(self, lines):
        lines.take("world")
        vertices, edges = [], []
        while lines.next_is("vertex"):
            vertices.append(lines.take("vertex D..."))
        while lines.next_is("edge"):
            edges.append(lines.take("edge D E"))
        (self.facing,) = lines.take("facing D")
        self.darts = range(2 * len(edges))
        for groups in vertices, edges:
            once = sorted(dart for group in groups for dart in group) == list(self.darts)
            lines.need(once, "not each dart stands in one vertex and in one edge")
        lines.need(self.facing in self.darts, "no such dart")
        self.clockwise = {dart: vertex for vertex in vertices for dart in vertex}
        self.place = {dart: place for vertex in vertices for place, dart in enumerate(vertex)}
        self.opposite = {dart: other for edge in edges for dart, other in (edge, reversed(edge))}
        reached, ahead = set(), [0]
        while ahead:
            dart = ahead.pop()
            if dart not in reached:
                reached.add(dart)
                ahead += [self.opposite[dart], self.turned(dart, 1)]
        lines.need(len(reached) == len(self.darts), "the graph is not connected")

    def degree(self, pose):
        return len(self.clockwise[pose])

    def turned(self, dart, door):
        return self.clockwise[dart][(self.place[dart] + door) % self.degree(dart)]

    def behind(self, pose, door):
        """The pose behind a door, None if there is no such door."""
        return self.opposite[self.turned(pose, door)] if door < self.degree(pose) else None

    def percept(self, kind, pose, facing=None):
        """What a robot perceives with this marker, placed by the facing dart of the world or by another."""
        facing = self.facing if facing is None else facing
        other = self.opposite[facing]
        here = self.clockwise[pose] is self.clockwise[facing]
        there = self.clockwise[pose] is self.clockwise[other]
        if kind == "directional" and here:
            return self.degree(pose), "pointing", (self.place[facing] - self.place[pose]) % self.degree(pose)
        sighting = {
            "none": "nothing",
            "undirected": "lying" if here else "nothing",
            "directional": "nothing",
            "undirected-edge": "passed" if pose in (facing, other) else "nothing",
            "directed-edge": {facing: "against", other: "along"}.get(pose, "nothing"),
            "two-identical": ["nothing", "lying", "two"][here + there],
            "two-distinct": [["nothing", "second"], ["first", "both"]][here][there],
        }[kind]
        return self.degree(pose), sighting


class Trail:
    """The visits of a walk, as far as the steps tell which are one vertex.

    A vertex is named by one of its visits: door i of visit k is door i + turn[k] of visit name[k], modulo the
    degree.
    """

    def __init__(self, lines, kind, percepts, doors):
        self.lines, self.kind, self.doors = lines, kind, doors
        self.degrees = [degree for degree, *_ in percepts]
        self.sightings = [sighting for _, *sighting in percepts]
        self.name = list(range(len(percepts)))
        self.turn = [0] * len(percepts)
        self.visits = [[visit] for visit in self.name]

    def visit(self, visit):
        self.lines.need(visit < len(self.degrees), "no such visit")
        return visit

    def ends(self, move):
        self.lines.need(move < len(self.doors), "no such move")
        return (move, self.doors[move]), (move + 1, 0)

    def exists(self, dart):
        return dart[1] < self.degrees[dart[0]]

    def known(self, dart):
        """The dart by the name of its vertex; darts are known to be one if these are the same."""
        visit, door = dart
        self.lines.need(self.exists(dart), f"visit {visit} has no door {door}")
        return self.name[visit], (door + self.turn[visit]) % self.degrees[visit]

    def same(self, one, other):
        return self.known(one) == self.known(other)

    def passage(self, word):
        """The dart from which a passage leaves, and that to which it leads."""
        ends = self.ends(int(word[1:]))
        return ends if word[0] == "+" else ends[::-1]

    def shown(self, before=""):
        """The two darts that the next line shows to be one: a step, with what stands before it."""
        if self.lines.next_is(before + "mark"):
            darts = []
            for visit in self.lines.take(before + "mark K L")[-2:]:
                _, *door = self.sightings[self.visit(visit)]
                self.lines.need(self.kind == "directional" and door, "no directional marker was seen")
                darts.append((visit, *door))
        else:
            leaving, darts = zip(*map(self.passage, self.lines.take(before + "beyond M N")[-2:]))
            self.lines.need(self.same(*leaving), "the passages are not known to leave from one dart")
        self.lines.need(all(map(self.exists, darts)), "no such door")
        return darts

    def clash(self, one, other):
        """Whether two darts cannot be one."""
        degrees_differ = self.degrees[one[0]] != self.degrees[other[0]]
        return degrees_differ or (self.name[one[0]] == self.name[other[0]] and not self.same(one, other))

    def step(self):
        darts = self.shown()
        self.lines.need(not self.clash(*darts), "a contradiction, and no step")
        by_visits = sorted(map(self.known, darts), key=lambda dart: len(self.visits[dart[0]]))
        (lost, lost_door), (kept, kept_door) = by_visits
        if lost != kept:
            for visit in self.visits[lost]:
                self.name[visit] = kept
                self.turn[visit] = (self.turn[visit] + kept_door - lost_door) % self.degrees[visit]
            self.visits[kept] += self.visits[lost]

    def complete(self):
        """Whether each door of each visit is known to be one with an end of some move."""
        ends = (end for move in range(len(self.doors)) for end in self.ends(move))
        ends = {self.known(end) for end in ends if self.exists(end)}
        return all((name, door) in ends for name in set(self.name) for door in range(self.degrees[name]))

    def contradiction(self):
        """Whether the next line is one that holds."""
        if self.lines.next_is("contradiction mark") or self.lines.next_is("contradiction beyond"):
            return self.clash(*self.shown("contradiction "))
        reason, *numbers = self.lines.take("contradiction REASON")
        if reason == "sightings":
            return self.differ(*map(self.visit, numbers))
        if reason == "edge":
            return self.same(*self.ends(*numbers))
        if reason == "door":
            return not self.exists(self.ends(*numbers)[0])
        if reason == "percept":
            visit = self.visit(*numbers)
            sighting, *door = self.sightings[visit]
            exist = all(self.exists((visit, door)) for door in [0, *door])
            return not exist or sighting not in SIGHTINGS[self.kind]
        nothing = all(sighting == ["nothing"] for sighting in self.sightings)
        return self.kind == "directional" and nothing and self.complete()

    def differ(self, one, other):
        """Whether two visits are one vertex, and what was seen there differs."""
        if self.name[one] != self.name[other] or self.kind == "none":
            return False
        if self.kind == "directional":
            return self.marked(one) != self.marked(other)
        comparable = not self.kind.endswith("-edge") or self.same((one, 0), (other, 0))
        return comparable and self.sightings[one] != self.sightings[other]

    def marked(self, visit):
        """The dart along which the marker was seen, if it was."""
        return [self.known((visit, door)) for door in self.sightings[visit][1:]]

    def copy(self):
        copy = Trail(self.lines, self.kind, [], list(self.doors))
        copy.degrees, copy.sightings = list(self.degrees), list(self.sightings)
        copy.name, copy.turn = list(self.name), list(self.turn)
        copy.visits = [list(visits) for visits in self.visits]
        return copy

    def add(self, door, percept):
        """One more move of the walk."""
        degree, *sighting = percept
        visit = len(self.name)
        self.doors.append(door)
        self.degrees.append(degree)
        self.sightings.append(sighting)
        self.name.append(visit)
        self.turn.append(0)
        self.visits.append([visit])

    def seen_from(self, door, percept):
        """Whether the last visit of the walk has this percept for a robot that comes in by this door."""
        degree, *sighting = percept
        if degree != self.degrees[-1]:
            return False
        seen = self.sightings[-1]
        if "pointing" in seen and "pointing" in sighting and not self.kind.endswith("-edge"):
            return (door + sighting[1] - seen[1]) % degree == 0
        return self.kind.endswith("-edge") or sighting == seen


class Proof:
    """One proof: made by reading its parts, then checked claim by claim."""

    def __init__(self, lines):
        self.lines, self.worlds = lines, []
        lines.take("toposlam-proof 1")
        while lines.next_is("world") and len(self.worlds) < 2:
            self.worlds.append(World(lines))
        parts = ["world"] * len(self.worlds)
        if lines.next_is("aid"):
            self.read_run()
            parts.append("run")
        else:
            (self.marker,) = lines.take("marker MARKER")
            for part, read in ("walk", self.read_walk), ("visits", self.read_visits):
                if lines.next_is(part):
                    read()
                    parts.append(part)
        self.parts = ", ".join(parts)

    def read_walk(self):
        self.lines.take("walk")
        self.percepts, self.doors = [tuple(self.lines.take("see DEGREE SIGHTING"))], []
        while self.lines.next_is("door"):
            self.doors += self.lines.take("door I")
            self.percepts.append(tuple(self.lines.take("see DEGREE SIGHTING")))

    def read_run(self):
        """A run is a list of what was done, at first nothing, each with what was then perceived, or None."""
        (self.aid,) = self.lines.take("aid AID")
        self.lines.take("run")
        self.run = [(None, tuple(self.lines.take("see DEGREE SIGHTING")))]
        while self.lines.next_is("door") or self.lines.next_is("do"):
            form = "door I" if self.lines.next_is("door") else "do ACTION"
            (done,) = self.lines.take(form)
            seen = tuple(self.lines.take("see DEGREE SIGHTING")) if self.lines.next_is("see") else None
            self.run.append((done, seen))

    def read_visits(self):
        """A visit is its way and its alternatives: pairs of a percept and a door, or None for no vertex."""
        self.lines.take("visits")
        self.visits = []
        while self.lines.next_is("visit") or not self.visits:
            (way,) = self.lines.take("visit WAY")
            alternatives = []
            while self.lines.next_is("none") or self.lines.next_is("junction"):
                if self.lines.next_is("none"):
                    self.lines.take("none")
                    alternatives.append(None)
                else:
                    degree, door, *sighting = self.lines.take("junction DEGREE DOOR SIGHTING")
                    self.lines.need(door == "any" or door < degree, "a door below the degree expected")
                    alternatives.append(((degree, *sighting), door))
            self.visits.append((way, alternatives))

    def claims(self):
        """Checks each claim, and gives its kind."""
        more = True
        while more:
            (kind,) = self.lines.take("claim CLAIM")
            self.lines.need(self.parts in CLAIMS[kind].split(" or "), f"`{kind}` needs: {CLAIMS[kind]}")
            getattr(self, kind.replace("-", "_"))()
            self.lines.take("end")
            yield kind
            more = self.lines.next_is("claim")

    def pose(self, pose, world=0):
        self.lines.need(pose in self.worlds[world].darts, "no such dart")
        return pose

    def poses(self):
        """The poses behind `from`."""
        if self.lines.next_is("from any"):
            self.lines.take("from any")
            return self.worlds[0].darts
        return [self.pose(pose) for pose in self.lines.take("from D...")]

    def pair(self, form):
        one, other = self.lines.take(form)
        return self.pose(one), self.pose(other, 1)

    def behind(self, pair, door):
        return tuple(world.behind(pose, door) for world, pose in zip(self.worlds, pair))

    def alike(self, pair):
        one, other = (world.percept(self.marker, pose) for world, pose in zip(self.worlds, pair))
        return one == other

    def ran(self, pose):
        """Whether all that was done in the run is possible from this pose, and perceived so."""
        (world,) = self.worlds
        lies = world.facing  # None if the robot carries the marker
        for done, seen in self.run:
            here = lies is not None and world.clockwise[lies] is world.clockwise[pose]
            if done == "pick-up" and here:
                lies = None
            elif done == "drop" and lies is None:
                lies = pose
            elif isinstance(done, int) and done < world.degree(pose):
                pose = world.behind(pose, done)
            elif done is not None:
                return False
            kind = "none" if lies is None else "undirected" if self.aid == "movable" else "directional"
            if seen not in (None, world.percept(kind, pose, lies)):
                return False
        return True

    def given(self, pose):
        """Whether the walk gives its percepts from this pose, or the run."""
        if self.parts.endswith("run"):
            return self.ran(pose)
        (world,) = self.worlds
        for percept, door in zip(self.percepts, [*self.doors, 0]):  # the last door is of no account
            if pose is None or world.percept(self.marker, pose) != percept:
                return False
            pose = world.behind(pose, door)
        return True

    def conforms(self):
        pose = self.pose(*self.lines.take("from D"))
        self.lines.need(self.given(pose), "the walk does not give these percepts")

    def diverges(self):
        for pose in self.poses():
            self.lines.need(not self.given(pose), f"the walk gives these percepts from {pose}")

    def determined(self):
        self.lines.need(self.marker == "directional", "not a directional marker")
        self.conforms()
        trail = Trail(self.lines, self.marker, self.percepts, self.doors)
        while not self.lines.next_is("end"):
            trail.step()
        self.lines.need(any("pointing" in percept for percept in self.percepts), "the marker was not seen")
        self.lines.need(trail.complete(), "the trail is not complete")

    def unexplained(self):
        trail = Trail(self.lines, self.marker, self.percepts, self.doors)
        while not self.lines.next_is("contradiction"):
            trail.step()
        self.lines.need(trail.contradiction(), "no contradiction")

    def indistinguishable(self):
        pairs = set()
        while self.lines.next_is("pair") or not pairs:
            pairs.add(self.pair("pair P Q"))
        for pair in pairs:
            self.lines.need(self.alike(pair), f"the percepts of {pair} differ")
            for door in range(self.worlds[0].degree(pair[0])):
                self.lines.need(self.behind(pair, door) in pairs, f"behind door {door} of {pair} is no pair")

    def walked(self):
        """The pair from which a walk begins, and that at its end."""
        start = pair = self.pair("from P Q")
        while self.lines.next_is("door"):
            (door,) = self.lines.take("door I")
            pair = self.behind(pair, door)
            self.lines.need(None not in pair, "no such door")
        return start, pair

    def distinguishable(self):
        more = True
        while more:
            _, pair = self.walked()
            self.lines.need(not self.alike(pair), "the percepts do not differ")
            more = self.lines.next_is("from")

    def isomorphic(self):
        (first, second), image = self.worlds, {}
        while self.lines.next_is("image"):
            dart, other = self.pair("image P Q")
            self.lines.need(dart not in image, "a second image of one dart")
            image[dart] = other
        bijection = len(image) == len(first.darts) and sorted(image.values()) == list(second.darts)
        self.lines.need(bijection, "no bijection")
        for dart, other in image.items():
            edge, order = image[first.opposite[dart]], image[first.turned(dart, 1)]
            self.lines.need(edge == second.opposite[other], f"the edge of {dart} is not kept")
            self.lines.need(order == second.turned(other, 1), f"the order behind {dart} is not kept")

    def not_isomorphic(self):
        covered = set()
        while len(covered) < len(self.worlds[1].darts):
            start, pair = self.walked()
            self.lines.need(start not in covered, "a second walk from these poses")
            covered.add(start)
            markers = zip(self.worlds, pair, start)
            one, other = (world.percept("directional", pose, facing) for world, pose, facing in markers)
            self.lines.need(one != other, "the percepts do not differ")
        always = len({dart for dart, _ in covered}) == 1
        self.lines.need(always, "not always the same dart of the first world")

    def onward(self, visit, alternative, pose):
        """The poses with which a robot that has this alternative can come to the next vertex.

        Each stands behind what has to be chosen for it: a door, (I,), or nothing, ().
        """
        (world,) = self.worlds
        if alternative is None:
            return {(): world.opposite[pose] if self.visits[visit][0] == "back" else pose}
        percept, door = alternative
        if percept != world.percept(self.marker, pose):
            return {}
        if door != "any":
            return {(): world.behind(pose, door)}
        if visit == len(self.visits) - 1:
            return {(): pose}
        return {(door,): world.behind(pose, door) for door in range(world.degree(pose))}

    def fits(self):
        pose = self.pose(*self.lines.take("from D"))
        for visit, (_, alternatives) in enumerate(self.visits):
            number, *door = self.lines.take("choose K...")
            self.lines.need(number < len(alternatives), "no such alternative")
            poses = self.onward(visit, alternatives[number], pose)
            self.lines.need(tuple(door) in poses, "the robot does not make this visit so")
            pose = poses[tuple(door)]

    def misfits(self):
        poses = set(self.poses())
        for visit, (_, alternatives) in enumerate(self.visits):
            onward = [self.onward(visit, alternative, pose) for alternative in alternatives for pose in poses]
            poses = {pose for behind in onward for pose in behind.values()}
        self.lines.need(not poses, "a robot makes these visits")

    def choices(self, visit):
        """What can be chosen of a visit: the words behind `choose`, with the percept and the door, or None."""
        _, alternatives = self.visits[visit]
        for number, alternative in enumerate(alternatives):
            if alternative is None or alternative[1] != "any":
                yield [number], alternative
            elif visit == len(self.visits) - 1:
                yield [number], (alternative[0], 0)  # this door is of no account
            else:
                for door in range(alternative[0][0]):
                    yield [number, door], (alternative[0], door)

    def impossible(self):
        # For each visit that is chosen, and the next: the choices left, with the trail before it, the door by which
        # the robot left the trail, and whether it has turned round since.
        chosen = [(self.choices(0), None, None, False)]
        while chosen:
            choices, trail, left_by, turned = chosen[-1]
            words, alternative = next(choices, (None, None))
            if words is None:
                chosen.pop()
                continue
            self.lines.need(self.lines.take("choose K...") == words, f"not `choose {words}`")
            trail = trail and trail.copy()
            if alternative is None:
                turned ^= self.visits[len(chosen) - 1][0] == "back"
            else:
                percept, door = alternative
                if trail is None:
                    trail = Trail(self.lines, self.marker, [percept], [])
                elif not turned:
                    trail.add(left_by, percept)
                elif trail.seen_from(left_by, percept):
                    door = (left_by + door) % percept[0]
                else:
                    self.lines.take("contradiction back")
                    continue
                left_by, turned = door, False
            if trail is not None:
                while self.lines.next_is("mark") or self.lines.next_is("beyond"):
                    trail.step()
                if self.lines.next_is("contradiction"):
                    self.lines.need(trail.contradiction(), "no contradiction")
                    continue
            self.lines.need(len(chosen) < len(self.visits), "no contradiction at the last visit")
            chosen.append((self.choices(len(chosen)), trail, left_by, turned))


def proved(file):
    """The kind of each claim of a file, once it is proved."""
    with open(file, encoding="latin-1", newline="\n") as opened:
        lines = Lines(opened)
    more = True
    while more:
        yield from Proof(lines).claims()
        more = lines.left()


def main(arguments):
    verdicts = arguments[:1] == ["--verdicts"]
    files = arguments[verdicts:]
    if not files:
        sys.exit(__doc__)
    accepted = True
    for file in files:
        try:
            for kind in proved(file):
                if not verdicts:
                    print(f"proved: {kind}")
            if verdicts:
                print(f"accepted {file}")
        except (ProofError, OSError) as error:
            accepted = False
            print(f"refused {file}" if verdicts else f"{file}:{error}")
    return 0 if accepted else 1


if __name__ == "__main__":
    sys.stdout.reconfigure(errors="backslashreplace")
    sys.exit(main(sys.argv[1:]))
