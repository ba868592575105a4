"""The explorer with markers that are carried, from docs/aids.md. See `moving.py`."""

from moving_map import Map


class Hand:
    """What a robot sees of its markers and does with them."""

    def __init__(self, world, kind):
        self.world, self.kind = world, kind

    def degree(self):
        return self.world.percept[0]

    def lying(self):
        """Which markers lie here, or how many; for a directional one, the door along which it points.
        None if there are none."""
        sighting = self.world.percept[1]
        if self.kind == "directional":
            return None if sighting in (None, "carried") else ("along", sighting)
        return sighting[0] or None

    def carried(self):
        """How many markers it carries."""
        sighting = self.world.percept[1]
        if self.kind == "directional":
            return int(sighting == "carried")
        return len(sighting[1]) if self.kind == "distinct" else sighting[1]

    def pick_up(self):
        """All that lie here."""
        while self.lying():
            self.world.act(self.degree())

    def drop(self):
        """The first that it carries: the actions are the doors, each marker here, each one carried."""
        sighting = self.world.percept[1]
        here = 0
        if self.kind != "directional":
            here = len(sighting[0]) if self.kind == "distinct" else int(sighting[0] > 0)
        self.world.act(self.degree() + here)


class Place:
    """Where the robot dropped markers in this round: the dart at the known end of the edge over which it
    came, the degree, and the markers. It may be any of the candidates, or new. Its vertex is known once
    the markers are found; its entry is the dart by which it was entered, if the marker shows it."""

    def __init__(self, dart, degree, markers, candidates):
        self.dart, self.degree, self.markers = dart, degree, markers
        self.candidates, self.vertex, self.entry = candidates, None, None


class Explorer:
    def __init__(self, world, kind):
        self.world, self.hand, self.kind = world, Hand(world, kind), kind
        self.map, self.at = Map(self.hand.degree()), (0, 0)
        self.places, self.followed = [], []  # in this round; (the known end of an edge, its place)

    def waiting(self):
        """The places of this round that are not known to be a vertex."""
        return [place for place in self.places if place.vertex is None]

    # ------------------------------------------------ moves

    def leave(self, dart):
        self.world.traverse(self.map.doors(self.at, dart))
        self.at = self.map.other_end.get(dart)

    def back(self, dart):
        """Over the edge by which it has just come from a dart."""
        self.world.traverse(0)
        self.at = dart

    def go(self, target, needed=lambda: True):
        for dart in self.map.way(self.at[0], target):
            if not needed():
                break
            self.leave(dart)
            self.look()

    def look(self):
        """At a known vertex. Markers that lie here are picked up: this is their place."""
        lying = self.hand.lying()
        for place in self.waiting():
            if not lying:
                place.candidates.discard(self.at[0])
            elif self.kind == "directional":
                place.vertex, place.entry = self.at[0], self.map.turned(self.at, lying[1])
            elif (place.degree, place.markers) == (self.hand.degree(), lying):
                place.vertex = self.at[0]
            if place.vertex is not None:
                self.close_if_certain(place.dart, place)
        self.hand.pick_up()

    # ------------------------------------------------ the algorithm

    def follow(self):
        """Steps 1 to 3 for one edge. Whether the round goes on."""
        ends = [dart for dart, _ in self.followed]
        darts = [dart for dart in self.map.unexplored() if dart not in ends]
        if not darts:
            return False
        dart = self.map.nearest(self.at[0], darts)
        self.go(dart[0])
        if dart in self.map.other_end:
            return True
        self.leave(dart)
        degree, lying = self.hand.degree(), self.hand.lying()
        if lying:
            [same] = [place for place in self.waiting() if (place.degree, place.markers) == (degree, lying)]
            self.followed.append((dart, same))
            self.back(dart)
            return True
        candidates = self.map.candidates(dart, degree, simple=self.kind != "directional")
        if not candidates:
            self.at = self.map.add(dart, degree)
            return True
        number = 1
        if self.kind is None:
            marked = [place.markers for place in self.waiting() if place.degree == degree]
            number = min(k for k in range(1, len(marked) + 2) if k not in marked)
        left = self.hand.carried() - number
        if left >= 0:
            for _ in range(number):
                self.hand.drop()
            self.places.append(Place(dart, degree, self.hand.lying(), candidates))
            self.followed.append((dart, self.places[-1]))
        self.back(dart)
        self.look()
        return left > 0

    def search(self):
        """Through all candidates of the round."""
        for vertex in self.map.preorder(self.at[0]):
            def needed():
                return any(vertex in place.candidates for place in self.waiting())
            if needed():
                self.go(vertex, needed)

    def add_new(self):
        """The places that were not found."""
        while self.waiting():
            dart = self.map.nearest(self.at[0], [place.dart for place in self.waiting()])
            [place] = [place for place in self.waiting() if place.dart == dart]
            self.go(dart[0])
            self.leave(dart)
            self.hand.pick_up()
            self.at = self.map.add(dart, place.degree)
            place.vertex = self.at[0]

    def close_if_certain(self, edge, place):
        """Whether the edge is then closed."""
        darts = self.map.unexplored(place.vertex)
        if edge not in self.map.other_end and (place.entry or len(darts) == 1):
            self.map.close(edge, place.entry or darts[0])
        return edge in self.map.other_end

    def close(self, edge, place):
        if self.close_if_certain(edge, place):
            return
        darts = self.map.unexplored(place.vertex)
        self.go(edge[0])
        self.hand.drop()
        for dart in self.map.way(self.at[0], place.vertex):
            self.leave(dart)
        for dart in darts:
            self.leave(dart)
            if self.hand.lying():
                self.hand.pick_up()
                self.map.close(edge, dart)
                self.at = edge
                return
            self.back(dart)
        raise AssertionError("no back-link")

    def explore(self):
        self.hand.pick_up()
        while self.map.unexplored():
            self.places, self.followed = [], []
            while self.follow():
                pass
            self.search()
            self.add_new()
            for edge, place in self.followed:
                self.close(edge, place)


def explore_with_markers(world, kind):
    explorer = Explorer(world, kind)
    explorer.explore()
    return explorer.map, [explorer.at]
