# Maps every world with a directional marker. far[v][i] is the other end of dart i of vertex v.
import json, sys

def go(door):
    print(json.dumps({"door": door}), flush=True)
    return json.loads(sys.stdin.readline())["percept"]

def home(v, i, seen, way=()):  # to the marker; or back, if the robot did not come in by dart i of v
    if seen != {"degree": len(far[v]), "marker": None if v else -i % len(far[v])}:
        return [go(door) for door in (0, *way, 0) if way] and None
    return home(*far[v][0], go(-i % len(far[v])), (i, *way)) if v else (0, i, seen)

while line := sys.stdin.readline():
    at = 0, 0, json.loads(line)["percept"]  # the robot came in by dart 0 of vertex 0, and perceives this
    far = [[None] * at[2]["degree"]]
    while ends := [(v, i) for v in range(len(far)) for i in range(len(far[v])) if not far[v][i]]:
        way = [edge := ends.pop()]  # the edge to follow, after the way to it from the marker
        while way[0][0]: way.insert(0, far[way[0][0]][0])
        pose = home(*at)
        for v, i in way: seen, pose = go((i - pose[1]) % len(far[v])), far[v][i]
        for end in ends:  # is the robot at a place that it knows?
            if at := home(*end, seen): break
        else:
            end, at = (len(far), 0), (len(far), 0, seen)
            far.append([None] * seen["degree"])
        far[edge[0]][edge[1]], far[end[0]][end[1]] = end, edge
    print(json.dumps({"map": far, "pose": at[:2]}), flush=True)
