// The map of the person: the trail of the walk, folded as far as the person claims. A dart is a number; the darts of a
// place of the trail follow one another clockwise, the entry first.

/** Thrown if a walk and claims contradict each other. */
class Contradiction extends Error {
  /** `text(name)` is a clause; `name` returns the name of the place where the robot was after a number of moves. */
  constructor(text) {
    super();
    this.text = text;
  }
}

class FoldedMap {
  /**
   * `percepts`: the degree and the sighting at the start and after each action; `actions`: doors as texts, and those of
   * the aid; `claims`: pairs of poses that are one, each the number of actions before it, a turn, and which robot it is of.
   * Robot 0 is the explorer.
   */
  constructor(marker, percepts, actions, claims) {
    this.first = [];
    this.degree = [];
    /** For each place of the trail, the number of actions before a robot first came there, and which one. */
    this.reached = [];
    this.place = [];
    this.parent = [];
    this.far = [];
    const start = this.add(percepts[0].degree, [0, 0]);
    /** The poses of each robot at the start and after each action. */
    this.trail = [...Array(AIDS[marker].others + 1)].map(() => [start]);
    for (const [step, action] of actions.entries()) this.step(action, degreesOf(percepts[step + 1]), step + 1);
    for (const [one, other] of claims) this.unite(this.posed(one), this.posed(other));
    this.build();
    this.followAid(AIDS[marker], actions);
    this.checkSightings(marker, percepts);
  }

  /** Adds a place, and returns its entry dart. */
  add(degree, reached) {
    const entry = this.place.length;
    const number = this.first.length;
    this.first.push(entry);
    this.degree.push(degree);
    this.reached.push(reached);
    for (let index = 0; index < degree; index += 1) {
      this.place.push(number);
      this.parent.push(entry + index);
      this.far.push(null);
    }
    return entry;
  }

  step(action, degrees, time) {
    const { robot, door } = moverOf(action);
    for (const poses of this.trail) poses.push(poses.at(-1));
    if (door === null) return;
    const from = this.turned(this.trail[robot][time], door);
    if (this.far[from] === null) {
      const entry = this.add(degrees[robot], [time, robot]);
      this.far[from] = entry;
      this.far[entry] = from;
    }
    this.trail[robot][time] = this.far[from];
  }

  /** The dart some places clockwise from another. */
  turned(dart, places) {
    const place = this.place[dart];
    const first = this.first[place];
    return first + ((dart - first + places) % this.degree[place]);
  }

  /** The pose of a robot after some actions, turned. */
  posed([actions, turn, robot]) {
    return this.turned(this.trail[robot][actions], turn);
  }

  find(dart) {
    let root = dart;
    while (this.parent[root] !== root) root = this.parent[root];
    let at = dart;
    while (at !== root) [at, this.parent[at]] = [this.parent[at], root];
    return root;
  }

  /** Makes two darts one, and all that follows. */
  unite(one, other) {
    const left = [[one, other]];
    while (left.length > 0) {
      const [a, b] = left.pop();
      if (this.find(a) === this.find(b)) continue;
      const places = [this.place[a], this.place[b]];
      const [here, there] = places.map((place) => this.degree[place]);
      const [then, now] = places.map((place) => this.reached[place]);
      if (here !== there) {
        throw new Contradiction((name) => `${name(then)} has ${doorsText(here)}, ${name(now)} has ${there}`);
      }
      for (let turn = 0; turn < here; turn += 1) {
        const far = this.join(this.turned(a, turn), this.turned(b, turn));
        if (far) left.push(far);
      }
    }
  }

  /** Makes two darts one, and returns their two other ends, if there are two. */
  join(a, b) {
    const [one, other] = [this.find(a), this.find(b)].sort((x, y) => x - y);
    if (one === other) return null;
    this.parent[other] = one;
    const ends = [this.far[one], this.far[other]];
    this.far[one] ??= this.far[other];
    return ends.includes(null) ? null : ends;
  }

  /**
   * The map as a graph, whose dart 0 is the one behind the robot at the start; for each vertex the least place of the
   * trail that it is; and the poses in the map. The darts of a vertex begin with its first entry.
   */
  build() {
    this.graph = new Graph();
    this.numbers = [];
    const darts = new Map();
    for (const [number, entry] of this.first.entries()) {
      const roots = [...Array(this.degree[number]).keys()].map((turn) => this.find(entry + turn));
      const name = this.reached[number];
      if (new Set(roots).size < roots.length) {
        throw new Contradiction((of) => `two doors of ${of(name)} would be the same door`);
      }
      if (darts.has(roots[0])) continue;
      const first = this.graph.add(roots.length);
      this.numbers.push(number);
      for (const [index, root] of roots.entries()) darts.set(root, first + index);
    }
    for (const [root, dart] of darts) {
      const far = this.far[root] === null ? null : darts.get(this.find(this.far[root]));
      if (far === dart) throw new Contradiction(() => "a hallway would have only one end");
      this.graph.far[dart] = far;
    }
    this.robots = this.trail.map((poses) => poses.map((pose) => darts.get(this.find(pose))));
    [this.poses] = this.robots;
  }

  /** Where the parts of the aid are on the map at the start and after each action; null if it does not show them. */
  followAid(aid, actions) {
    const { graph, poses } = this;
    this.placed = [aid.placed(graph, poses[0])];
    for (const [time, action] of actions.entries()) {
      const before = this.placed[time];
      const move = isDoor(action) ? aid.leave : aid.act;
      const what = isDoor(action) ? [graph.turned(poses[time], Number(action))] : [poses[time], action];
      this.placed.push(before && move(graph, before, ...what));
    }
  }

  /** Looks for two percepts that one place, or one edge, cannot have, and for one without what lies there on the map. */
  checkSightings(marker, percepts) {
    const { graph, placed, poses } = this;
    let known = new Map();
    for (const [time, { degree, sighting }] of percepts.entries()) {
      // What is moved is in another place.
      if (placed[time] === null || String(placed[time]) !== String(placed[time - 1])) known = new Map();
      const [key, value] = shownBy(marker, graph, poses[time], sighting);
      const before = known.get(key) ?? { value, time, sighting };
      const seen = (name, at, what) => `“${what}” at ${name([at, 0])}`;
      if (before.value !== value) {
        throw new Contradiction((name) => `you perceived ${seen(name, before.time, before.sighting)} and ${seen(name, time, sighting)}`);
      }
      known.set(key, before);
      const [expected] = placed[time] === null ? [NOTHING] : AIDS[marker].sightings(graph, placed[time], poses[time]);
      const facts = factsOf({ degree, sighting });
      if (!factsOf({ degree, sighting: expected }).every(({ text, door }) => facts.some((it) => it.text === text && it.door === door))) {
        throw new Contradiction((name) => `you perceived ${seen(name, time, sighting)}, and on your map there would be “${expected}”`);
      }
    }
  }
}

/** The claims that a directional marker proves: each sighting of it is one pose. */
function markerClaims(percepts) {
  const [start, ...later] = percepts.map(({ sighting }) => pointedDoor(sighting));
  return later.flatMap((door, step) => (door === null ? [] : [[[0, start, 0], [step + 1, door, 0]]]));
}

/** The folded trail of a walk with a directional marker. The walk determines its world exactly if no dart is open. */
const foldedTrail = (percepts, actions) => new FoldedMap("directional", percepts, actions, markerClaims(percepts)).graph;
