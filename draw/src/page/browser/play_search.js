// The smallest world, other than the true one, in which a robot on the same walk perceives the same. Wherever the robot
// comes to the end of a new edge, it may have come in by any open dart of a known place, or be at a new place: the search
// tries all (depth-first), in worlds with one edge, with two edges, and so on (iterative deepening).

/** The most darts that the search joins: about a second's work. */
const SEARCH_STEPS = 400_000;
/** The most new edges of a walk, for the stack. */
const SEARCH_DEPTH = 1000;

class WorldSearch {
  /** `isTrue(graph)` says whether a complete graph, in which dart 0 is facing, is the true world. */
  constructor(marker, percepts, actions, isTrue, steps = SEARCH_STEPS) {
    Object.assign(this, { marker, percepts, actions, isTrue, steps });
  }

  /**
   * The other world; `isSmallest` if no smaller one explains the walk. The world is null if none explains it
   * (`isComplete`), or if the search reached its limit before it found one.
   */
  run() {
    const all = this.steps;
    // A first world of any size: new places are tried first.
    this.steps = all / 2;
    this.prefersSimple = false;
    const any = this.find(Infinity);
    if (any === null && !this.isOver()) return { world: null, isComplete: true };
    this.steps = all;
    this.prefersSimple = true;
    for (let most = 1; any === null || 2 * most <= any.dartCount; most += 1) {
      const world = this.find(most);
      if (world !== null) return { world, isSmallest: true };
      if (this.isOver()) return { world: any, isSmallest: false };
      if (!this.isCut) return { world: null, isComplete: true };
    }
    return { world: any, isSmallest: true };
  }

  /** A world of any size that a graph with open darts becomes. */
  closing(graph) {
    Object.assign(this, { graph, most: Infinity, steps: SEARCH_STEPS, prefersSimple: false });
    return this.close();
  }

  isOver() {
    return this.steps <= 0;
  }

  /** A world with at most so many edges, if none has fewer, and a simple one if there is one; or null. */
  find(most) {
    this.most = most;
    /** Whether a larger world may explain the walk. */
    this.isCut = false;
    this.depth = 0;
    /** The first world that is found, while a simple one is searched. */
    this.found = null;
    this.graph = new Graph();
    /** What the robot sensed at each vertex when it first came there. */
    this.sensed = [];
    if (!this.fitsSize(this.percepts[0].degree)) return null;
    const pose = this.add(0, 0);
    const placed = AIDS[this.marker].placed(this.graph, pose);
    return (this.fits(0, pose, placed) ? this.replay(0, pose, placed) : null) ?? this.found;
  }

  /** Adds the place where a robot is after so many actions, and returns its first dart. */
  add(time, robot) {
    this.sensed.push(this.percepts[time].sighting);
    return this.graph.add(degreesOf(this.percepts[time])[robot]);
  }

  /** Whether one more place with so many doors is possible. */
  fitsSize(degree) {
    const fits = this.graph.dartCount + degree <= 2 * this.most;
    this.isCut ||= !fits;
    return fits;
  }

  /** Whether the robot perceives in this state what it perceived. */
  fits(time, pose, placed) {
    const { degree, sighting } = this.percepts[time];
    const { graph, marker } = this;
    const fits = graph.degree(pose) === degree && AIDS[marker].sightings(graph, placed, pose).includes(sighting);
    return fits && (!["two-identical", "two-distinct"].includes(marker) || this.fitsTwo(placed, pose, sighting));
  }

  /** The second of two markers may lie behind a door that is open yet: all that was sensed is to fit one place of it. */
  fitsTwo(placed, pose, sighting) {
    const { graph, marker, sensed } = this;
    if (sensed[graph.vertex(pose)] !== sighting) return false;
    const others = sensed.filter((text, vertex) => text !== NOTHING && vertex !== graph.vertex(placed[0]));
    if (others.length > 1) return false;
    if (graph.opposite(placed[0]) === null) return true;
    return graph.first.every((dart, vertex) => AIDS[marker].sightings(graph, placed, dart).includes(sensed[vertex]));
  }

  /** Goes on with the walk after so many actions. */
  replay(before, from, aidBefore) {
    const aid = AIDS[this.marker];
    let [time, pose, placed] = [before, from, aidBefore];
    while (time < this.actions.length) {
      const action = this.actions[time];
      const { robot, door } = moverOf(action);
      if (door === null) {
        if (!aid.actions(this.graph, placed, pose).includes(action)) return null;
        placed = aid.act(this.graph, placed, pose, action);
      } else {
        const out = this.graph.turned(robot === 0 ? pose : placed[robot - 1], door);
        const left = robot === 0 ? aid.leave(this.graph, placed, out) : placed;
        if (left === null) return null;
        const [stays, others] = [pose, left];
        const after = (dart) => (robot === 0 ? [dart, others] : [stays, replaced(others, robot - 1, dart)]);
        const far = this.graph.opposite(out);
        if (far === null) return this.arrive(time + 1, robot, out, after);
        [pose, placed] = after(far);
      }
      time += 1;
      if (!this.fits(time, pose, placed)) return null;
    }
    return this.close();
  }

  /** A robot leaves by an open dart. Where it comes in by a dart, `after` has the explorer's pose and the places of the aid. */
  arrive(time, robot, out, after) {
    const degree = degreesOf(this.percepts[time])[robot];
    if (this.depth === SEARCH_DEPTH) this.steps = 0;
    const known = this.graph.open().filter((dart) => dart !== out && this.graph.degree(dart) === degree);
    const visit = (dart) => {
      if (this.isOver()) return null;
      this.steps -= 1;
      this.depth += 1;
      this.graph.join(out, dart);
      const [pose, placed] = after(dart);
      const found = this.fits(time, pose, placed) ? this.replay(time, pose, placed) : null;
      this.graph.part(out, dart);
      this.depth -= 1;
      return found;
    };
    const visitNew = () => {
      if (!this.fitsSize(degree)) return null;
      const found = visit(this.add(time, robot));
      this.graph.removeLast();
      this.sensed.pop();
      return found;
    };
    const first = this.most === Infinity ? visitNew() : null;
    const found = known.reduce((world, dart) => world ?? visit(dart), first);
    return found ?? (this.most === Infinity ? null : visitNew());
  }

  /**
   * Closes the open darts. With a number of pairs, each other open dart leads to a dead end. If that is the true world,
   * two of them may lead to one place; or one leads over a place with two doors to a dead end.
   */
  close() {
    const open = this.graph.open();
    if (open.length > 0) this.isCut = true;
    const base = (this.graph.dartCount - open.length) / 2 + open.length;
    const exact = this.most === Infinity ? [...Array(open.length + 2).keys()].map((more) => base + 1 - more).reverse() : [this.most];
    for (const edges of exact) {
      for (const end of ["dead ends", "chain"]) {
        const pairs = base - edges + (end === "chain" ? 1 : 0);
        if (pairs < 0 || 2 * pairs > open.length) continue;
        const found = this.joinPairs(open, pairs, (left) => this.closed(left, end));
        if (found !== null) return found;
      }
    }
    return null;
  }

  /** Joins so many pairs of open darts in every way, until `end(left)` returns a world for the darts that are left. */
  joinPairs(open, pairs, end, left = []) {
    if (pairs === 0) return end([...left, ...open]);
    if (this.isOver() || open.length < 2 * pairs) return null;
    const [first, ...others] = open;
    for (const other of others) {
      this.steps -= 1;
      this.graph.join(first, other);
      const rest = others.filter((dart) => dart !== other);
      const found = this.joinPairs(rest, pairs - 1, end, left);
      this.graph.part(first, other);
      if (found !== null) return found;
    }
    return this.joinPairs(others, pairs, end, [...left, first]);
  }

  /** The world in which the open darts lead to dead ends, or one of them over a chain, if it explains the walk. */
  closed(left, end) {
    const ways = end === "chain" ? [1] : left.length > 1 ? [0, 2] : [0];
    for (const way of ways) {
      if (left.length < way) continue;
      const world = this.graph.copy();
      if (way > 0) {
        const place = world.add(2);
        world.join(left[0], place);
        world.join(way === 2 ? left[1] : world.add(1), place + 1);
      }
      for (const dart of left.slice(way)) world.join(dart, world.add(1));
      if (this.isTrue(world) || !this.explains(world)) continue;
      if (!this.prefersSimple || world.isSimple()) return world;
      this.found ??= world;
    }
    return null;
  }

  /** Whether a robot in a complete world perceives what it perceived. */
  explains(world) {
    const robot = Robot.start(this.marker, world, 0);
    return this.percepts.every(({ degree, sighting }, time) => {
      if (time > 0 && !robot.actions().includes(this.actions[time - 1])) return false;
      if (time > 0) robot.act(this.actions[time - 1]);
      const now = robot.percept();
      return now.degree === degree && now.sighting === sighting;
    });
  }
}
