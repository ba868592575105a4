"""The explorer with scouts, from docs/aids.md. See `moving.py`. Robot 0 is the explorer itself."""

from moving_map import Map


class Edge:
    """The edge over which a scout stands at an unknown end: its dart at the known end, and where it may
    lead. Its place is a vertex once that is known."""

    def __init__(self, dart):
        self.dart, self.candidates, self.place = dart, set(), None


class Team:
    def __init__(self, world, headings):
        self.world, self.headings = world, headings
        self.map = Map(world.percept[0])
        self.scouts = range(1, len(world.percept))
        # The dart of each robot, or None; and the edge over which a scout stands.
        self.at, self.edge = [(0, 0) for _ in world.percept], [None for _ in world.percept]
        self.followed = []

    # ------------------------------------------------ what the robots perceive

    def group(self, robot):
        """The first robot of those that are where this one is; and, with headings, how many doors
        clockwise from the entry of that one the entry of this one is."""
        seen = self.world.percept[robot] if robot else None
        return (seen[1], seen[2]) if robot and seen[0] == "with" else (robot, 0)

    def together(self, one, other):
        return self.group(one)[0] == self.group(other)[0]

    def degree(self, robot):
        first, _ = self.group(robot)
        return self.world.percept[0] if first == 0 else self.world.percept[first][1]

    def place(self, robot):
        """The vertex where a robot is, if that is known."""
        if self.at[robot]:
            return self.at[robot][0]
        return self.edge[robot].place if self.edge[robot] else None

    def notice(self):
        """What follows from who is with whom, until nothing new does."""
        while any([self.noticed(scout) for scout in self.scouts if self.edge[scout]]):
            pass

    def noticed(self, scout):
        """Whether something new about the edge of a scout was found."""
        edge, robots = self.edge[scout], range(len(self.at))
        if edge.dart not in self.map.other_end:
            was_known = edge.place is not None
            entry = None
            for robot in robots:
                if robot != scout and self.place(robot) is not None:
                    if not self.together(robot, scout):
                        edge.candidates.discard(self.place(robot))
                        continue
                    edge.place = self.place(robot)
                    if self.headings and self.at[robot]:
                        doors = self.group(scout)[1] - self.group(robot)[1]
                        entry = self.map.turned(self.at[robot], doors)
            if edge.place is not None and not entry:
                darts = self.map.unexplored(edge.place)
                entry = darts[0] if len(darts) == 1 else None
            if not entry:
                return not was_known and edge.place is not None
            self.map.close(edge.dart, entry)
        self.at[scout], self.edge[scout] = self.map.other_end[edge.dart], None
        return True

    # ------------------------------------------------ moves

    def traverse(self, robot, door):
        self.world.traverse(sum(self.degree(earlier) for earlier in range(robot)) + door)

    def leave(self, robot, dart):
        self.traverse(robot, self.map.doors(self.at[robot], dart))
        self.at[robot] = self.map.other_end.get(dart)

    def go(self, robot, target, needed=lambda: True):
        for dart in self.map.way(self.at[robot][0], target):
            if not needed():
                break
            self.leave(robot, dart)
            self.notice()

    # ------------------------------------------------ the algorithm

    def scout(self, robot):
        """Sends a scout over the nearest unexplored dart. Whether there was one."""
        while True:
            ends = [edge.dart for edge in self.edge if edge]
            darts = [dart for dart in self.map.unexplored() if dart not in ends]
            if not darts:
                return False
            dart = self.map.nearest(self.at[robot][0], darts)
            self.go(robot, dart[0])
            if dart not in self.map.other_end:
                break
        self.leave(robot, dart)
        edge = self.edge[robot] = Edge(dart)
        self.followed.append(edge)
        others = [other for other in range(len(self.at)) if other != robot]
        if not any(self.together(robot, other) for other in others):
            edge.candidates = self.map.candidates(dart, self.degree(robot), simple=not self.headings)
            edge.candidates -= {self.place(other) for other in others}
            if not edge.candidates:
                self.add(robot)
        self.notice()
        return True

    def add(self, robot):
        self.at[robot] = self.map.add(self.edge[robot].dart, self.degree(robot))
        self.edge[robot] = None
        self.notice()

    def send_scouts(self):
        going = True
        while going:
            going = False
            for robot in self.scouts:
                if self.at[robot] and self.scout(robot):
                    going = True

    def search(self):
        """The explorer goes through all candidates; then the places of scouts it has not met are new."""
        def waiting():
            return [edge for edge in self.edge if edge and edge.place is None]

        for vertex in self.map.preorder(self.at[0][0]):
            def needed():
                return any(vertex in edge.candidates for edge in waiting())
            if needed():
                self.go(0, vertex, needed)
        for robot in self.scouts:
            if self.edge[robot] in waiting():
                self.add(robot)

    def find_entry(self, robot):
        """Without headings: the scout goes back over its edge, and the explorer looks for it."""
        edge = self.edge[robot]
        self.traverse(robot, 0)
        self.at[robot], self.edge[robot] = edge.dart, None
        self.go(0, edge.place)
        for dart in self.map.unexplored(edge.place):
            self.leave(0, dart)
            if self.together(0, robot):
                self.map.close(edge.dart, dart)
                self.at[0] = edge.dart
                self.notice()
                return
            self.traverse(0, 0)
            self.at[0] = dart
        raise AssertionError("no back-link")

    def explore(self):
        while self.map.unexplored():
            self.followed = []
            self.send_scouts()
            self.search()
            for edge in self.followed:
                if edge in self.edge:
                    self.find_entry(self.edge.index(edge))


def explore_with_team(world, variant):
    team = Team(world, headings=variant != "round")
    team.explore()
    return team.map, team.at
