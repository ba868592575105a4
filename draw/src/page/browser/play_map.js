// The map of the person: the trail of the walk, folded as far as the person claims. A dart is a number; the
// darts of a place of the trail follow one another clockwise, the entry first.

/** Thrown where a walk and claims contradict each other; the message is a clause. */
class Contradiction extends Error {}

class FoldedMap {
  /**
   * `percepts`: the degree and the marker's door (or null) at the start and after each move; `doors`: the door
   * of each move; `claims`: pairs of poses that are one, each a number of moves and a turn.
   */
  constructor(percepts, doors, claims) {
    this.first = [];
    this.degree = [];
    this.markers = [];
    this.place = [];
    this.parent = [];
    this.far = [];
    this.poses = [this.add(percepts[0])];
    for (const [step, door] of doors.entries()) this.step(door, percepts[step + 1]);
    for (const [one, other] of claims) this.unite(this.posed(one), this.posed(other));
  }

  /** Adds a place, and returns its entry dart. */
  add({ degree, marker }) {
    const entry = this.place.length;
    const number = this.first.length;
    this.first.push(entry);
    this.degree.push(degree);
    this.markers.push(marker === null ? null : entry + marker);
    for (let index = 0; index < degree; index += 1) {
      this.place.push(number);
      this.parent.push(entry + index);
      this.far.push(null);
    }
    return entry;
  }

  step(door, percept) {
    const from = this.turned(this.poses.at(-1), door);
    if (this.far[from] === null) {
      const entry = this.add(percept);
      this.far[from] = entry;
      this.far[entry] = from;
    }
    // Only edges that the robot goes back over are known here, and they look the same again.
    this.poses.push(this.far[from]);
  }

  /** The dart some places clockwise from another. */
  turned(dart, places) {
    const place = this.place[dart];
    const first = this.first[place];
    return first + ((dart - first + places) % this.degree[place]);
  }

  /** The pose after some moves, turned. */
  posed([moves, turn]) {
    return this.turned(this.poses[moves], turn);
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
      const [here, there] = [this.place[a], this.place[b]];
      if (this.degree[here] !== this.degree[there]) {
        throw new Contradiction(`one place has ${doorsText(this.degree[here])}, the other ${this.degree[there]}`);
      }
      for (let turn = 0; turn < this.degree[here]; turn += 1) {
        const far = this.join(this.turned(a, turn), this.turned(b, turn));
        if (far) left.push(far);
      }
      this.check(here);
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

  /** Looks at every place that is now one with a place. */
  check(place) {
    const root = this.find(this.first[place]);
    const same = this.first.flatMap((entry, other) => {
      const turns = [...Array(this.degree[other]).keys()];
      return turns.some((turn) => this.find(entry + turn) === root) ? [other] : [];
    });
    for (const other of same) {
      const roots = new Set();
      for (let turn = 0; turn < this.degree[other]; turn += 1) roots.add(this.find(this.first[other] + turn));
      if (roots.size < this.degree[other]) throw new Contradiction("two doors of one place would be the same door");
    }
    const marked = same.map((other) => this.markers[other]);
    if (marked.every((marker) => marker === null)) return;
    if (marked.includes(null)) throw new Contradiction("the marker lies at one place and not at the other");
    const along = new Set(marked.map((marker) => this.find(marker)));
    if (along.size > 1) throw new Contradiction("the marker would point along two doors");
  }

  /** The other end of a dart; null if it is not known. */
  opposite(dart) {
    const far = this.far[this.find(dart)];
    return far === null ? null : this.find(far);
  }

  /**
   * The places of the map, each by the least place of the trail that it is: its darts clockwise from its first
   * entry. Throws if a dart would be its own other end.
   */
  places() {
    const places = [];
    const known = new Set();
    for (const [number, entry] of this.first.entries()) {
      const darts = [...Array(this.degree[number]).keys()].map((turn) => this.find(entry + turn));
      if (known.has(darts[0])) continue;
      for (const dart of darts) known.add(dart);
      places.push({ number, darts, marker: this.markers[number] === null ? null : this.find(this.markers[number]) });
    }
    for (const dart of known) {
      if (this.opposite(dart) === dart) throw new Contradiction("a hallway would have only one end");
    }
    return places;
  }

  /** The map as the judge takes it: the other end of each dart of each place, and the robot's pose. */
  asLists() {
    const places = this.places();
    const ends = new Map(places.flatMap(({ darts }, v) => darts.map((dart, i) => [dart, [v, i]])));
    const end = (dart) => (this.opposite(dart) === null ? null : ends.get(this.opposite(dart)));
    return {
      map: places.map(({ darts }) => darts.map(end)),
      pose: ends.get(this.find(this.poses.at(-1))),
    };
  }
}

const doorsText = (degree) => (degree === 1 ? "1 door" : `${degree} doors`);

/** The claims that the marker proves: each sighting of it is one pose. */
function markerClaims(percepts) {
  const claims = [];
  for (const [moves, { marker }] of percepts.entries()) {
    if (marker !== null && moves > 0) claims.push([[0, percepts[0].marker], [moves, marker]]);
  }
  return claims;
}

/** Whether a walk determines its world: its folded trail has no open dart. */
function determinesWorld(percepts, doors) {
  const { map } = new FoldedMap(percepts, doors, markerClaims(percepts)).asLists();
  return map.every((ends) => ends.every((end) => end !== null));
}
