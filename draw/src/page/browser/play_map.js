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
   * `percepts`: the degree and the sighting at the start and after each action; `actions`: doors as texts, and those on
   * the marker; `claims`: pairs of poses that are one, each the number of actions before it and a turn.
   */
  constructor(marker, percepts, actions, claims) {
    this.first = [];
    this.degree = [];
    /** For each place of the trail, the number of actions before the robot first came there. */
    this.time = [];
    this.place = [];
    this.parent = [];
    this.far = [];
    this.trailPoses = [this.add(percepts[0].degree, 0)];
    for (const [step, action] of actions.entries()) this.step(action, percepts[step + 1].degree, step + 1);
    for (const [one, other] of claims) this.unite(this.posed(one), this.posed(other));
    this.build();
    this.checkSightings(marker, percepts, actions);
  }

  /** Adds a place, and returns its entry dart. */
  add(degree, time) {
    const entry = this.place.length;
    const number = this.first.length;
    this.first.push(entry);
    this.degree.push(degree);
    this.time.push(time);
    for (let index = 0; index < degree; index += 1) {
      this.place.push(number);
      this.parent.push(entry + index);
      this.far.push(null);
    }
    return entry;
  }

  step(action, degree, time) {
    const at = this.trailPoses.at(-1);
    if (!isDoor(action)) return this.trailPoses.push(at);
    const from = this.turned(at, Number(action));
    if (this.far[from] === null) {
      const entry = this.add(degree, time);
      this.far[from] = entry;
      this.far[entry] = from;
    }
    return this.trailPoses.push(this.far[from]);
  }

  /** The dart some places clockwise from another. */
  turned(dart, places) {
    const place = this.place[dart];
    const first = this.first[place];
    return first + ((dart - first + places) % this.degree[place]);
  }

  /** The pose after some actions, turned. */
  posed([actions, turn]) {
    return this.turned(this.trailPoses[actions], turn);
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
      const [then, now] = places.map((place) => this.time[place]);
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
      const name = this.time[number];
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
    this.poses = this.trailPoses.map((pose) => darts.get(this.find(pose)));
  }

  /** Looks for two percepts that one place, or one edge, cannot have. */
  checkSightings(marker, percepts, actions) {
    let known = new Map();
    let carries = false;
    for (const [time, { sighting }] of percepts.entries()) {
      const action = actions[time - 1];
      // A marker that is moved is in another place.
      if (action === PICK_UP || action === DROP) [known, carries] = [new Map(), action === PICK_UP];
      if (carries) continue;
      const [key, value] = shownBy(marker, this.graph, this.poses[time], sighting);
      const before = known.get(key) ?? { value, time, sighting };
      if (before.value !== value) {
        const seen = (at, what) => `“${what}” at ${at}`;
        throw new Contradiction(
          (name) => `you perceived ${seen(name(before.time), before.sighting)} and ${seen(name(time), sighting)}`,
        );
      }
      known.set(key, before);
    }
  }

  /** The place of the marker after all actions. */
  placed(actions) {
    const moved = actions.findLastIndex((action) => action === PICK_UP || action === DROP);
    if (moved < 0) return [this.poses[0]];
    return [actions[moved] === DROP ? this.poses[moved + 1] : null];
  }
}

/** The claims that a directional marker proves: each sighting of it is one pose. */
function markerClaims(percepts) {
  const [start, ...later] = percepts.map(({ sighting }) => pointedDoor(sighting));
  return later.flatMap((door, step) => (door === null ? [] : [[[0, start], [step + 1, door]]]));
}

/** The folded trail of a walk with a directional marker. The walk determines its world exactly if no dart is open. */
const foldedTrail = (percepts, actions) => new FoldedMap("directional", percepts, actions, markerClaims(percepts)).graph;
