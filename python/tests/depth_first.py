"""A depth-first explorer with one directional marker, as in docs/python.md."""


def depth_first(robot):
    far = [[None] * robot.percept.degree]  # far[v][i] is the far end (w, j) of door i of vertex v

    def looks_like(v, i):  # would the robot sense this at v, if it had come in by door i?
        n = len(far[v])
        return (robot.percept.degree, robot.percept.marker) == (n, -i % n if v == 0 else None)

    def walk_home(v, i):  # by door 0 of each vertex; None if the robot is not at v, and it returns
        entries = []
        while v > 0:
            robot.go(-i % len(far[v]))
            entries.append(i)
            v, i = far[v][0]
            if not looks_like(v, i):
                for door in [0, *entries[:0:-1]]:
                    robot.go(door)
                return None
        return i

    v, i = 0, 0  # the robot is at v, and came in by door i
    while unexplored := [(v, i) for v, ends in enumerate(far) for i, end in enumerate(ends) if not end]:
        i = walk_home(v, i)
        edge = unexplored[-1]  # the newest vertex first
        way = [edge]
        while way[-1][0] > 0:
            way.append(far[way[-1][0]][0])
        for w, j in reversed(way):
            robot.go((j - i) % len(far[w]))
            i = 0
        here, turned = 0, 0  # turned: the door by which it last came in, counted from the edge
        for v, j in unexplored:
            i = (j + turned) % len(far[v])
            if (v, j) != edge and looks_like(v, i):
                i = walk_home(v, i)
                if i is not None:
                    break
                turned = -j % len(far[v])
        else:
            far.append([None] * robot.percept.degree)
            here = v = len(far) - 1
            j, i = 0, turned
        far[v][j], far[edge[0]][edge[1]] = edge, (v, j)
        v = here
    return dict(enumerate(far)), (v, i)
