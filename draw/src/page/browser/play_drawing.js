// The drawing of the person's map. Each place is a disc with its doors in clockwise order; forces find places
// for the discs and turn them towards their neighbours. The same map is always drawn alike.

const DISC = 17;
const LENGTH = 92;
const STUB = 24;
const ROUNDS = 160;

const polar = ({ x, y }, angle, away) => ({ x: x + away * Math.cos(angle), y: y + away * Math.sin(angle) });
const between = (one, other) => Math.atan2(other.y - one.y, other.x - one.x);

class MapDrawing {
  /** `onDart(number, index)` is called with the number of a place and the index of its dart. */
  constructor(svg, onDart) {
    this.svg = svg;
    this.onDart = onDart;
    /** Where each place is: by its number. */
    this.spots = new Map();
  }

  clear() {
    this.spots.clear();
  }

  angle(place, index) {
    return this.spots.get(place.number).turn + (index * 2 * Math.PI) / place.darts.length;
  }

  /** Shows the places of a folded map; `name(place)` is the text on one, `pose` the robot's dart. */
  show(map, places, name, pose) {
    const owner = new Map(places.flatMap((place) => place.darts.map((dart, index) => [dart, { place, index }])));
    const end = (dart) => (map.opposite(dart) === null ? null : owner.get(map.opposite(dart)));
    this.settle(places, end);
    const layer = () => drawn("g");
    const [edges, discs, reaches] = [layer(), layer(), layer()];
    const bounds = [Infinity, Infinity, -Infinity, -Infinity];
    const include = ({ x, y }, margin) => {
      bounds[0] = Math.min(bounds[0], x - margin);
      bounds[1] = Math.min(bounds[1], y - margin);
      bounds[2] = Math.max(bounds[2], x + margin);
      bounds[3] = Math.max(bounds[3], y + margin);
    };
    for (const place of places) {
      const spot = this.spots.get(place.number);
      include(spot, DISC + STUB + 10);
      const here = place.darts.indexOf(pose);
      discs.append(drawn("circle", { class: here >= 0 ? "disc here" : "disc", cx: spot.x, cy: spot.y, r: DISC }));
      discs.append(drawn("text", { class: "name", x: spot.x, y: spot.y + 5, "font-size": 14 }, name(place)));
      for (const [index, dart] of place.darts.entries()) {
        const angle = this.angle(place, index);
        const other = end(dart);
        if (other === null) this.drawStub(edges, spot, angle);
        else if (map.opposite(dart) > dart) this.drawEdge(edges, [place, index], [other.place, other.index], include);
        const knob = polar(spot, angle, DISC);
        const marked = place.marker === dart;
        discs.append(drawn("circle", { class: marked ? "knob marker" : "knob", cx: knob.x, cy: knob.y, r: marked ? 6 : 3 }));
        if (index === here) discs.append(this.robot(spot, angle));
        const label = polar(spot, angle + 0.46, DISC + 11);
        discs.append(drawn("text", { class: "index", x: label.x, y: label.y + 4, "font-size": 11 }, String(index)));
        const reach = polar(spot, angle, DISC + 8);
        const target = drawn("circle", { class: "reach", cx: reach.x, cy: reach.y, r: 15 });
        target.addEventListener("click", () => this.onDart(place.number, index));
        reaches.append(target);
      }
    }
    const [left, top, right, bottom] = bounds;
    this.svg.setAttribute("viewBox", [left, top, right - left, bottom - top].map((n) => n.toFixed(1)).join(" "));
    this.svg.replaceChildren(edges, discs, reaches);
    keepReadable(this.svg, 11);
    this.svg.style.setProperty("--natural", `${1.6 * (right - left)}px`);
  }

  drawStub(edges, spot, angle) {
    const [from, to] = [polar(spot, angle, DISC), polar(spot, angle, DISC + STUB)];
    edges.append(drawn("path", { class: "open", d: `M${from.x} ${from.y}L${to.x} ${to.y}` }));
  }

  /** A curve that leaves straight through both doors. */
  drawEdge(edges, [one, i], [other, j], include) {
    const [a, b] = [this.spots.get(one.number), this.spots.get(other.number)];
    const [out, into] = [this.angle(one, i), this.angle(other, j)];
    const [from, to] = [polar(a, out, DISC), polar(b, into, DISC)];
    const gap = Math.min(Math.abs(i - j), one.darts.length - Math.abs(i - j));
    const loop = 34 + 26 * gap;
    const far = one === other ? loop : Math.max(22, 0.42 * Math.hypot(to.x - from.x, to.y - from.y));
    const [p, q] = [polar(from, out, far), polar(to, into, far)];
    // A curve stays between its controls.
    for (const control of [p, q]) include(polar(control, between(control, a), 0.25 * far), 4);
    edges.append(drawn("path", { d: `M${from.x} ${from.y}C${p.x} ${p.y} ${q.x} ${q.y} ${to.x} ${to.y}` }));
  }

  /** The robot, in the door by which it came in. */
  robot(spot, angle) {
    const at = polar(spot, angle, DISC + 11);
    const corner = (turn, away) => {
      const { x, y } = polar(at, angle + turn, away);
      return `${x.toFixed(1)} ${y.toFixed(1)}`;
    };
    return drawn("path", { class: "robot", d: `M${corner(Math.PI, 9)}L${corner(0.8, 9)}L${corner(-0.8, 9)}Z` });
  }

  /** Finds a spot for each place, beginning with those of the map before. */
  settle(places, end) {
    for (const place of places) {
      if (this.spots.has(place.number)) continue;
      const links = place.darts.map((dart, index) => ({ index, far: end(dart) }));
      const from = links.find(({ far }) => far !== null && this.spots.has(far.place.number));
      if (from === undefined) {
        // The robot comes from below.
        this.spots.set(place.number, { x: 0, y: 0, turn: Math.PI / 2 });
        continue;
      }
      const way = this.angle(from.far.place, from.far.index);
      const spot = polar(this.spots.get(from.far.place.number), way, LENGTH);
      const turn = way + Math.PI - (from.index * 2 * Math.PI) / place.darts.length;
      this.spots.set(place.number, { ...spot, turn });
    }
    const shown = new Set(places.map(({ number }) => number));
    for (const number of this.spots.keys()) if (!shown.has(number)) this.spots.delete(number);
    for (let round = 0; round < ROUNDS; round += 1) this.relax(places, end, 1 - round / ROUNDS);
  }

  relax(places, end, heat) {
    const spots = places.map(({ number }) => this.spots.get(number));
    const pushes = spots.map(() => ({ x: 0, y: 0, turn: 0, links: 0 }));
    const at = new Map(places.map(({ number }, index) => [number, index]));
    for (const [a, one] of spots.entries()) {
      for (let b = a + 1; b < spots.length; b += 1) {
        const other = spots[b];
        const far = Math.max(8, Math.hypot(other.x - one.x, other.y - one.y));
        const push = Math.min(30, (1.2 * LENGTH * LENGTH) / (far * far) * 4);
        const way = far > 8 ? between(one, other) : a + b;
        pushes[a].x -= push * Math.cos(way);
        pushes[a].y -= push * Math.sin(way);
        pushes[b].x += push * Math.cos(way);
        pushes[b].y += push * Math.sin(way);
      }
    }
    for (const [a, place] of places.entries()) {
      for (const [index, dart] of place.darts.entries()) {
        const far = end(dart);
        if (far === null || far.place === place) continue;
        const b = at.get(far.place.number);
        const angle = this.angle(place, index);
        const wish = polar(spots[a], angle, LENGTH);
        // The neighbour is drawn before this door, and the door turned to the neighbour.
        pushes[b].x += 0.16 * (wish.x - spots[b].x);
        pushes[b].y += 0.16 * (wish.y - spots[b].y);
        pushes[a].x -= 0.16 * (wish.x - spots[b].x);
        pushes[a].y -= 0.16 * (wish.y - spots[b].y);
        pushes[a].turn += Math.sin(between(spots[a], spots[b]) - angle);
        pushes[a].links += 1;
      }
    }
    for (const [index, spot] of spots.entries()) {
      const { x, y, turn, links } = pushes[index];
      const size = Math.max(1, Math.hypot(x, y) / 14);
      spot.x += (heat * x) / size;
      spot.y += (heat * y) / size;
      if (links > 0) spot.turn += (0.5 * heat * turn) / links;
    }
  }
}
