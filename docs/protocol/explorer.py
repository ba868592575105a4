# Maps every world with a directional marker. far[v][i] is the other end of dart i of vertex v.
import json, sys

def send(answer=None):
    if answer: print(json.dumps(answer), flush=True)
    percept = json.loads(sys.stdin.readline() or sys.exit())["percept"]
    return percept["degree"], percept["marker"]

def at(far, v, i):  # the percept of a robot that came in by dart i of vertex v
    return len(far[v]), None if v else -i % len(far[v])

def home(far, v, i, seen, way=()):  # to the marker; or back, if this is not dart i of vertex v
    if seen != at(far, v, i):
        return [send({"door": door}) for door in (0, *way, 0) if way] and None
    door = -i % len(far[v])
    return home(far, *far[v][0], send({"door": door}), (i, *way)) if v else (0, i)

def explore(seen):
    far, pose = [[None] * seen[0]], (0, 0)
    while ends := [(v, i) for v in range(len(far)) for i in range(len(far[v])) if not far[v][i]]:
        way = [edge := ends.pop()]  # the edge to follow, after the way to it from the marker
        while way[0][0]: way.insert(0, far[way[0][0]][0])
        pose = home(far, *pose, at(far, *pose))
        for v, i in way: seen, pose = send({"door": (i - pose[1]) % len(far[v])}), far[v][i]
        for end in ends:  # is the robot at a place that it knows?
            if pose := home(far, *end, seen): break
        else:
            end = pose = len(far), 0
            far.append([None] * seen[0])
        far[edge[0]][edge[1]], far[end[0]][end[1]] = end, edge
    return {"map": far, "pose": pose}

answer = None
while True: answer = explore(send(answer))
