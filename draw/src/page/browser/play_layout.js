// The layout of the person's map: where each place lies, and how it is turned. A layout costs where a hallway passes
// a place or crosses another one, where places are near each other, and where hallways are long or bend. Random small
// changes that cost less are kept; if faults are left, layouts from other beginnings are tried. The random numbers are
// the same each time, so the same game is always drawn alike.

const DISC = 17;
const LENGTH = 92;
const STUB = 24;
/** Nearer than this, a hallway seems to enter a place that it passes. */
const CLEAR = DISC + 16;
/** The pieces of a hallway that are looked at. */
const PIECES = 8;
/** What a crossing costs; a hallway of twice the usual length costs 1.5. */
const FAULT = 6;
/** So many other layouts are tried while hallways pass places, and while hallways cross: some have to. */
const BEGINNINGS = { passages: 12, crossings: 4 };

/** For a larger map, no other layouts are tried: that would take long. */
const LARGEST = 30;

const polar = ({ x, y }, angle, away) => ({ x: x + away * Math.cos(angle), y: y + away * Math.sin(angle) });
const between = (one, other) => Math.atan2(other.y - one.y, other.x - one.x);
const distance = (one, other) => Math.hypot(other.x - one.x, other.y - one.y);

/** Random numbers from 0 to 1: the generator mulberry32. */
function randomNumbers(seed) {
  let state = seed;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let mixed = Math.imul(state ^ (state >>> 15), state | 1);
    mixed ^= mixed + Math.imul(mixed ^ (mixed >>> 7), mixed | 61);
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32;
  };
}

/** The direction of a door of a place that lies at a spot. */
const doorAngle = (spot, index, degree) => spot.turn + (index * 2 * Math.PI) / degree;

/**
 * A hallway that leaves straight through both doors: the ends and the controls of a curve. An end is a spot, the index
 * of the door and the number of doors; discs have this radius.
 */
function hallwayCurve([a, i, degree], [b, j, farDegree], disc) {
  const [out, into] = [doorAngle(a, i, degree), doorAngle(b, j, farDegree)];
  const [from, to] = [polar(a, out, disc), polar(b, into, disc)];
  if (a !== b) {
    const far = Math.max(22, 0.42 * distance(from, to));
    return [from, polar(from, out, far), polar(to, into, far), to];
  }
  const gap = Math.min(Math.abs(i - j), degree - Math.abs(i - j));
  const far = disc * (2 + 1.5 * gap);
  // Between doors on opposite sides it goes around the place.
  const sweep = Math.atan2(Math.sin(into - out), Math.cos(into - out));
  const aside = far * Math.max(0, Math.abs(sweep) / (Math.PI / 2) - 1);
  const control = (at, angle) => polar(polar(at, angle, far), out + sweep / 2, aside);
  return [from, control(from, out), control(to, into), to];
}

/** The points along a hallway, with its ends, and the box around them, with a margin. */
class Way {
  constructor([from, p, q, to], margin = 0) {
    this.x = new Float64Array(PIECES + 1);
    this.y = new Float64Array(PIECES + 1);
    for (let piece = 0; piece <= PIECES; piece += 1) {
      const [t, s] = [piece / PIECES, 1 - piece / PIECES];
      const [a, b, c, d] = [s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t];
      this.x[piece] = a * from.x + b * p.x + c * q.x + d * to.x;
      this.y[piece] = a * from.y + b * p.y + c * q.y + d * to.y;
    }
    this.left = Math.min(...this.x) - margin;
    this.right = Math.max(...this.x) + margin;
    this.top = Math.min(...this.y) - margin;
    this.bottom = Math.max(...this.y) + margin;
  }

  /** How near it comes to a point, as the sum of what its pieces are nearer than a distance, as parts of that. */
  nearness({ x, y }, limit, skipped = 0) {
    if (x < this.left - limit || x > this.right + limit || y < this.top - limit || y > this.bottom + limit) return 0;
    let sum = 0;
    for (let piece = skipped; piece < PIECES - skipped; piece += 1) {
      const [dx, dy] = [this.x[piece + 1] - this.x[piece], this.y[piece + 1] - this.y[piece]];
      const [px, py] = [x - this.x[piece], y - this.y[piece]];
      const along = Math.min(1, Math.max(0, (px * dx + py * dy) / (dx * dx + dy * dy || 1)));
      const far = Math.hypot(px - along * dx, py - along * dy);
      if (far < limit) sum += 1 - far / limit;
    }
    return sum;
  }

  /** How often it crosses another way. */
  crossings(other) {
    if (this.right < other.left || other.right < this.left) return 0;
    if (this.bottom < other.top || other.bottom < this.top) return 0;
    const { x, y } = this;
    let count = 0;
    for (let i = 0; i < PIECES; i += 1) {
      const [ax, ay, bx, by] = [x[i], y[i], x[i + 1] - x[i], y[i + 1] - y[i]];
      let before = bx * (other.y[0] - ay) - by * (other.x[0] - ax);
      for (let j = 0; j < PIECES; j += 1) {
        const after = bx * (other.y[j + 1] - ay) - by * (other.x[j + 1] - ax);
        if (before * after < 0) {
          const [cx, cy] = [other.x[j], other.y[j]];
          const [dx, dy] = [other.x[j + 1] - cx, other.y[j + 1] - cy];
          const [one, two] = [dx * (ay - cy) - dy * (ax - cx), dx * (ay + by - cy) - dy * (ax + bx - cx)];
          if (one * two < 0) count += 1;
        }
        before = after;
      }
    }
    return count;
  }
}

/** A layout of some places. `links` are hallways, each with two ends: the number of a place and the index of a door. */
class Layout {
  constructor(degrees, links, spots) {
    Object.assign(this, { degrees, links, spots });
    this.linksOf = degrees.map(() => []);
    this.open = degrees.map((degree) => [...Array(degree).keys()]);
    for (const [link, ends] of links.entries()) {
      for (const [place, index] of ends) {
        if (!this.linksOf[place].includes(link)) this.linksOf[place].push(link);
        this.open[place] = this.open[place].filter((door) => door !== index);
      }
    }
    this.ways = links.map((_, link) => this.way(link));
  }

  way(link) {
    const end = ([place, index]) => [this.spots[place], index, this.degrees[place]];
    return new Way(hallwayCurve(end(this.links[link][0]), end(this.links[link][1]), DISC));
  }

  /** What costs because of a place: its hallways, and what passes it. */
  cost(place) {
    const { spots, links, ways } = this;
    const spot = spots[place];
    let cost = 0;
    for (let other = 0; other < spots.length; other += 1) {
      if (other === place) continue;
      const far = distance(spot, spots[other]) / LENGTH;
      cost += 0.1 / (far * far + 0.02) + (far < 0.9 ? 20 * (0.9 - far) ** 2 : 0);
    }
    const tips = this.open[place].map((index) => this.tip(place, index));
    for (let link = 0; link < links.length; link += 1) {
      const [[a], [b]] = links[link];
      if (a === place || b === place) {
        cost += this.linkCost(link);
      } else {
        cost += 3 * FAULT * ways[link].nearness(spot, CLEAR);
        for (const tip of tips) cost += 2 * ways[link].nearness(tip, 14);
      }
    }
    return cost;
  }

  /** The middle of a door that leads nowhere yet. */
  tip(place, index) {
    return polar(this.spots[place], doorAngle(this.spots[place], index, this.degrees[place]), DISC + 0.7 * STUB);
  }

  /** What a hallway costs: its length, its bends, what it passes and crosses. */
  linkCost(link) {
    const { spots, links, ways, degrees } = this;
    const [[a, i], [b, j]] = links[link];
    const way = ways[link];
    let cost = 0;
    if (a !== b) {
      const chord = between(spots[a], spots[b]);
      const bends = Math.cos(doorAngle(spots[a], i, degrees[a]) - chord) - Math.cos(doorAngle(spots[b], j, degrees[b]) - chord);
      cost += 1.2 * (2 - bends) + 1.5 * (distance(spots[a], spots[b]) / LENGTH - 1) ** 2;
    }
    for (let other = 0; other < spots.length; other += 1) {
      const isEnd = other === a || other === b;
      cost += 3 * FAULT * (isEnd ? way.nearness(spots[other], DISC + 6, 2) : way.nearness(spots[other], CLEAR));
    }
    for (let other = 0; other < ways.length; other += 1) if (other !== link) cost += FAULT * way.crossings(ways[other]);
    return cost;
  }

  /** How many hallways pass a place, and how often hallways cross. */
  faults() {
    let [passages, crossings] = [0, 0];
    for (const [link, way] of this.ways.entries()) {
      const ends = this.links[link].map(([place]) => place);
      for (const [place, spot] of this.spots.entries()) {
        const near = ends.includes(place) ? way.nearness(spot, DISC + 1, 2) : way.nearness(spot, DISC + 8);
        passages += near > 0 ? 1 : 0;
      }
      for (const crossed of this.ways.slice(link + 1)) crossings += way.crossings(crossed);
    }
    return { passages, crossings };
  }

  /** Moves and turns places at random, one at a time, and keeps what costs less, or little more while it is warm. */
  improve(rounds, warm, random) {
    const { spots } = this;
    for (let round = 0; round < rounds; round += 1) {
      const left = 1 - round / rounds;
      const place = Math.floor(random() * spots.length);
      const { x, y, turn } = spots[place];
      const cost = this.cost(place);
      const step = (20 * left + 1.5) * (random() < 0.1 ? 5 : 1);
      const kind = random();
      if (kind < 0.6) {
        spots[place].x += step * (2 * random() - 1);
        spots[place].y += step * (2 * random() - 1);
      }
      if (kind > 0.4) spots[place].turn += (random() < 0.15 ? Math.PI : 0.9 * left + 0.08) * (2 * random() - 1);
      const ways = this.linksOf[place].map((link) => this.ways[link]);
      for (const link of this.linksOf[place]) this.ways[link] = this.way(link);
      const more = this.cost(place) - cost;
      if (more > 0 && random() >= Math.exp(-more / (warm * left * left + 1e-9))) {
        spots[place] = { x, y, turn };
        for (const [nth, link] of this.linksOf[place].entries()) this.ways[link] = ways[nth];
      }
    }
    return this;
  }
}

/**
 * The spots of places, beginning with those that are known: for each place a spot or null. `degrees` has the number of
 * doors of each place, `links` the hallways between them.
 */
function layOut(degrees, links, known) {
  const random = randomNumbers(degrees.length);
  const rounds = Math.min(80 * degrees.length + 200, 2000);
  const begun = new Layout(degrees, links, placed(degrees, links, known)).improve(rounds, 0.02, random);
  let best = { layout: begun, ...begun.faults() };
  const isDone = (tried) =>
    degrees.length > LARGEST ||
    ((best.passages === 0 || tried >= BEGINNINGS.passages) && (best.crossings === 0 || tried >= BEGINNINGS.crossings));
  for (let tried = 0; !isDone(tried); tried += 1) {
    const size = LENGTH * Math.sqrt(degrees.length);
    const spot = () => ({ x: size * (random() - 0.5), y: size * (random() - 0.5), turn: 2 * Math.PI * random() });
    // Some begin as the map is, and become warmer.
    const from = tried % 2 === 0 ? begun.spots.map((at) => ({ ...at })) : degrees.map(spot);
    const layout = new Layout(degrees, links, from).improve(2 * rounds, 3, random).improve(rounds, 0.02, random);
    const { passages, crossings } = layout.faults();
    if (3 * (passages - best.passages) + crossings - best.crossings < 0) best = { layout, passages, crossings };
  }
  return best.layout.spots;
}

/** A first spot for each place: before the door by which it was reached. */
function placed(degrees, links, known) {
  const spots = known.map((spot) => spot && { ...spot });
  // The robot comes from below.
  if (spots.every((spot) => spot === null)) spots[0] = { x: 0, y: 0, turn: Math.PI / 2 };
  while (spots.includes(null)) {
    const ways = links.flatMap(([one, other]) => [[one, other], [other, one]]);
    const [[from, i], [to, j]] = ways.find(([[from], [to]]) => spots[from] !== null && spots[to] === null);
    const way = doorAngle(spots[from], i, degrees[from]);
    const turn = way + Math.PI - (j * 2 * Math.PI) / degrees[to];
    spots[to] = { ...polar(spots[from], way, LENGTH), turn };
  }
  return spots;
}
