"""The map that an explorer of docs/aids.md draws, and the ways in it. See `moving.py`."""


class Map:
    """The degrees of the vertices in the order of discovery, and for each explored dart (vertex, index)
    its other end. The indices count clockwise from the dart by which the vertex was first entered."""

    def __init__(self, degree):
        self.degrees, self.other_end = [degree], {}

    def unexplored(self, vertex=None):
        vertices = range(len(self.degrees)) if vertex is None else [vertex]
        darts = [(v, i) for v in vertices for i in range(self.degrees[v])]
        return [dart for dart in darts if dart not in self.other_end]

    def close(self, one, other):
        assert one != other and one not in self.other_end and other not in self.other_end
        self.other_end[one], self.other_end[other] = other, one

    def add(self, dart, degree):
        """A new vertex behind a dart; the dart by which it was entered."""
        self.degrees.append(degree)
        entry = len(self.degrees) - 1, 0
        self.close(dart, entry)
        return entry

    def turned(self, dart, doors):
        """The dart of the same vertex so many doors further clockwise."""
        return dart[0], (dart[1] + doors) % self.degrees[dart[0]]

    def doors(self, dart, other):
        """How many doors clockwise from one dart another of the same vertex is."""
        assert dart[0] == other[0]
        return (other[1] - dart[1]) % self.degrees[dart[0]]

    def tree(self, root):
        """Breadth first, darts by index: for each vertex its distance from the root, and the dart of its
        parent that leads to it."""
        distance, leading, queue = {root: 0}, {}, [root]
        for vertex in queue:
            for index in range(self.degrees[vertex]):
                far = self.other_end.get((vertex, index))
                if far and far[0] not in distance:
                    distance[far[0]] = distance[vertex] + 1
                    leading[far[0]] = vertex, index
                    queue.append(far[0])
        return distance, leading

    def way(self, start, target):
        """The darts by which a shortest way leaves its vertices."""
        _, leading = self.tree(start)
        way = []
        while target != start:
            way.append(leading[target])
            target = leading[target][0]
        return way[::-1]

    def preorder(self, root):
        _, leading = self.tree(root)

        def walk(vertex):
            yield vertex
            for index in range(self.degrees[vertex]):
                far = self.other_end.get((vertex, index))
                if far and leading.get(far[0]) == (vertex, index):
                    yield from walk(far[0])

        return list(walk(root))

    def nearest(self, vertex, darts):
        distance, _ = self.tree(vertex)
        return min(darts, key=lambda dart: (distance[dart[0]], dart))

    def candidates(self, dart, degree, simple):
        """The known vertices that may be behind a dart."""
        known_end = dart[0]
        joined = {far[0] for near, far in self.other_end.items() if near[0] == known_end}
        excluded = {known_end} | joined if simple else set()
        others = {other[0] for other in self.unexplored() if other != dart}
        return {vertex for vertex in others - excluded if self.degrees[vertex] == degree}
