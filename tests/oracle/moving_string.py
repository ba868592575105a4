"""The explorer with a string as long as it takes, from docs/aids.md. See `moving.py`."""

from copy import deepcopy

from moving_map import Map


class Hypothesis:
    """The map with the edge closed, the robot in it, and the string: the ends of the edges over which it
    runs, and the vertex where its free end lies, or None while the robot holds it."""

    def __init__(self, known, at, way, dropped):
        self.map, self.at, self.way, self.dropped = known, at, way, dropped

    def sighting(self):
        """The degree, the doors through which string runs, and which ends of it are here."""
        here = {dart for ends in self.way for dart in ends if dart[0] == self.at[0]}
        doors = tuple(sorted(self.map.doors(self.at, dart) for dart in here))
        return self.map.degrees[self.at[0]], doors, self.at[0] == 0, self.at[0] == self.dropped

    def leave(self, door):
        self.at = self.map.other_end[self.map.turned(self.at, door)]


class Explorer:
    def __init__(self, world):
        self.world, self.map, self.at = world, Map(world.percept[0]), (0, 0)
        self.way = []  # the ends of the edges over which the string runs, from the start on

    def sighting(self):
        degree, (through, fixed, free, _, _, _) = self.world.percept
        return degree, through, fixed, free

    def pick_up_or_drop(self):
        self.world.act(self.world.percept[0])

    def explore(self):
        while self.map.unexplored():
            darts = self.map.unexplored(self.at[0])
            if darts:
                self.follow(darts[0])
            else:
                near, far = self.way.pop()
                self.world.traverse(self.map.doors(self.at, far))
                self.at = near

    def follow(self, dart):
        self.world.traverse(self.map.doors(self.at, dart))
        degree, through, fixed, _ = self.sighting()
        if through == (0,) and not fixed:
            self.at = self.map.add(dart, degree)
            self.way.append((dart, self.at))
            return
        places = {0} | {far[0] for _, far in self.way}
        hypotheses = []
        for other in self.map.unexplored():
            if other != dart and other[0] in places:
                known = deepcopy(self.map)
                known.close(dart, other)
                hypothesis = Hypothesis(known, other, self.way + [(dart, other)], None)
                if hypothesis.sighting() == self.sighting():
                    hypotheses.append(hypothesis)
        walks = len(hypotheses) > 1
        if walks:
            hypotheses = self.distinguished(hypotheses)
        [hypothesis] = hypotheses
        self.map, self.at = hypothesis.map, hypothesis.at
        if not self.map.unexplored():
            return
        if walks:
            for leaving in self.map.way(self.at[0], hypothesis.dropped):
                self.world.traverse(self.map.doors(self.at, leaving))
                self.at = self.map.other_end[leaving]
            self.pick_up_or_drop()
        other = self.map.other_end[dart]
        self.world.traverse(self.map.doors(self.at, other))
        self.at = dart

    def distinguished(self, hypotheses):
        """Those that are left after a walk along the string; the end is dropped first."""
        self.pick_up_or_drop()
        for hypothesis in hypotheses:
            hypothesis.dropped = hypothesis.at[0]
        while len(hypotheses) > 1:
            door = next(door for door in self.world.percept[1][0] if door != 0)
            self.world.traverse(door)
            for hypothesis in hypotheses:
                hypothesis.leave(door)
            hypotheses = [hypothesis for hypothesis in hypotheses
                          if hypothesis.sighting() == self.sighting()]
        return hypotheses


def explore_with_string(world, _variant):
    explorer = Explorer(world)
    explorer.explore()
    return explorer.map, [explorer.at]
