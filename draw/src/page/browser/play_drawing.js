// The drawing of the person's map. Each place is a disc with its doors in clockwise order. The whole map fits its panel;
// it can be enlarged and moved. From one map to the next, places move.

/** The smallest text of a place, in its units and in pixels. */
const SMALLEST = 11;
/** Places of a large map are drawn larger, up to this factor, so that their numbers are readable. */
const LARGEST_PLACE = 2.2;
/** A unit of a small map has this many pixels. */
const MOST_PIXELS = 1.6;
/** How long places move, in milliseconds. */
const MOVING = 300;
/** How much larger the map is after a press, and at most. */
const ENLARGED = 1.5;
const MOST_ENLARGED = 8;

/** The mark on a hallway, around the origin: an arrow in a direction, or a bar across it. */
function mark(kind, turn) {
  const corner = (angle, away) => {
    const { x, y } = polar({ x: 0, y: 0 }, turn + angle, away);
    return `${x.toFixed(1)} ${y.toFixed(1)}`;
  };
  const arrow = `M${corner(0, 11)}L${corner(2.4, 9)}L${corner(-2.4, 9)}Z`;
  const bar = `M${corner(1.2, 8)}L${corner(1.94, 8)}L${corner(-1.94, 8)}L${corner(-1.2, 8)}Z`;
  return drawn("path", { class: "mark", d: kind === "arrow" ? arrow : bar });
}

class MapDrawing {
  /** `onDart(number, index)` is called with the number of a place and the index of its dart. */
  constructor(svg, onDart) {
    this.svg = svg;
    this.onDart = onDart;
    /** Where each place is: by its number. */
    this.spots = new Map();
    this.clear();
    new ResizeObserver(() => this.draw()).observe(svg.parentElement);
    this.dragged = null;
    svg.addEventListener("pointerdown", (event) => this.grab(event));
    svg.addEventListener("pointermove", (event) => this.drag(event));
    for (const end of ["pointerup", "pointercancel"]) svg.addEventListener(end, () => this.drop());
    svg.addEventListener("wheel", (event) => this.turnWheel(event), { passive: false });
  }

  clear() {
    this.spots.clear();
    this.places = [];
    this.fit();
  }

  /** Shows the whole map. */
  fit() {
    this.scale = 1;
    this.middle = null;
    this.draw();
  }

  /** Enlarges the map around a point, or makes it smaller. */
  enlarge(factor, around = this.middle ?? this.whole().middle) {
    const scale = Math.min(MOST_ENLARGED, this.scale * factor);
    if (scale <= 1) return this.fit();
    const from = this.middle ?? this.whole().middle;
    const kept = this.scale / scale;
    this.middle = { x: around.x + kept * (from.x - around.x), y: around.y + kept * (from.y - around.y) };
    this.scale = scale;
    this.draw();
  }

  /**
   * Shows a graph. `numbers` has a number for each vertex that it keeps from one graph to the next, `names` its text;
   * `pose` is the robot's dart or null; `parts` is where the marker is.
   */
  show({ graph, numbers, names, pose, parts }) {
    const isFirst = (dart) => graph.opposite(dart) !== null && graph.opposite(dart) > dart;
    const first = [...graph.far.keys()].filter(isFirst);
    const links = first.map((dart) => [graph.end(dart), graph.end(graph.opposite(dart))]);
    const known = numbers.map((number) => this.spots.get(number) ?? null);
    const spots = layOut(graph.degrees, links, known);
    this.spots = new Map(numbers.map((number, place) => [number, spots[place]]));
    // A new place comes from the one by which it was reached.
    const reached = (place) => links.flatMap(([[a], [b]]) => (a === place ? [b] : b === place ? [a] : []));
    const origin = (place) => known[place] ?? reached(place).map((other) => known[other]).find(Boolean) ?? spots[place];
    const before = numbers.map((_, place) => ({ ...origin(place), turn: known[place]?.turn ?? spots[place].turn }));
    const drawnAt = (dart, ...kinds) => parts.find((part) => part.dart === dart && kinds.includes(part.drawn))?.drawn;
    this.places = numbers.map((number, place) => ({
      number,
      name: names[place],
      here: graph.darts(place).indexOf(pose),
      rings: parts.filter(({ dart, drawn }) => graph.vertex(dart) === place && RINGS.includes(drawn)),
      robots: graph.darts(place).flatMap((dart, index) => {
        const there = parts.filter((part) => part.number !== undefined && part.dart === dart);
        return there.map((part, before) => ({ ...part, index, before: before + (dart === pose ? 1 : 0) }));
      }),
      doors: graph.darts(place).map((dart) => ({
        isOpen: graph.opposite(dart) === null,
        isPointed: drawnAt(dart, "pointing") !== undefined,
        isMarked: drawnAt(dart, "edge", "arrow") !== undefined,
      })),
    }));
    this.links = links;
    const strings = parts.filter((part) => part.drawn === "string").map((part) => Math.min(part.dart, graph.opposite(part.dart)));
    // For each link, how often string runs over it.
    this.strings = first.map((dart) => strings.filter((strung) => strung === dart).length);
    // For each link, the sign in its middle, and whether it points from the first end to the other one.
    this.signs = first.map((dart) => {
      const ends = [dart, graph.opposite(dart)].map((end) => drawnAt(end, "edge", "arrow"));
      return { kind: ends[0] ?? ends[1], isForward: ends[0] !== undefined };
    });
    this.target = spots;
    const robot = this.places.findIndex(({ here }) => here >= 0);
    if (this.scale > 1 && robot >= 0) this.middle = spots[robot];
    this.move(before, spots);
  }

  /** Moves the places to their spots. */
  move(before, spots) {
    const begin = performance.now();
    const isStill = matchMedia("(prefers-reduced-motion: reduce)").matches || this.places.length < 2;
    cancelAnimationFrame(this.frame);
    const step = (now) => {
      const part = isStill ? 1 : Math.min(1, Math.max(0, (now - begin) / MOVING));
      const eased = part * part * (3 - 2 * part);
      this.shown = spots.map((spot, place) => {
        const from = before[place];
        const mixed = (key) => from[key] + eased * (spot[key] - from[key]);
        return { x: mixed("x"), y: mixed("y"), turn: mixed("turn") };
      });
      this.draw();
      if (part < 1) this.frame = requestAnimationFrame(step);
    };
    step(begin);
  }

  /** The box around the map as it will be, and how large its places are drawn so that they are readable. */
  whole() {
    const panel = this.svg.getBoundingClientRect();
    const size = (places) => {
      const margin = places * (DISC + STUB + 4);
      const boxes = [
        ...this.target.map(({ x, y }) => ({ left: x - margin, right: x + margin, top: y - margin, bottom: y + margin })),
        ...this.links.map((link) => new Way(this.curve(this.target, link, places), 6)),
      ];
      const [left, top] = ["left", "top"].map((side) => Math.min(...boxes.map((box) => box[side])));
      const [right, bottom] = ["right", "bottom"].map((side) => Math.max(...boxes.map((box) => box[side])));
      // A small map is not enlarged more.
      const [width, height] = [Math.max(right - left, panel.width / MOST_PIXELS), Math.max(bottom - top, panel.height / MOST_PIXELS)];
      const pixels = Math.min(panel.width / width, panel.height / height);
      return { middle: { x: (left + right) / 2, y: (top + bottom) / 2 }, width, height, pixels };
    };
    const { pixels } = size(1);
    const places = Math.min(LARGEST_PLACE, Math.max(1, 1 / (pixels || 1)));
    return { ...size(places), places };
  }

  curve(spots, [[a, i], [b, j]], places) {
    const end = (place, index) => [spots[place], index, this.places[place].doors.length];
    return hallwayCurve(end(a, i), end(b, j), places * DISC);
  }

  draw() {
    if (this.places.length === 0) return;
    const { width, height, middle, places } = this.whole();
    const { x, y } = this.middle ?? middle;
    const size = places / Math.sqrt(this.scale);
    const box = [x - width / this.scale / 2, y - height / this.scale / 2, width / this.scale, height / this.scale];
    this.svg.setAttribute("viewBox", box.map((n) => n.toFixed(1)).join(" "));
    this.svg.classList.toggle("enlarged", this.scale > 1);
    const edges = this.links.flatMap((link, index) => this.edge(this.curve(this.shown, link, size), this.signs[index], this.strings[index], size));
    const discs = this.places.map((place, index) => this.disc(place, this.shown[index], size));
    const robots = this.places.flatMap((place, index) => [
      ...(place.here < 0 ? [] : [this.robot(place, this.shown[index], size)]),
      ...place.robots.map((other) => this.other(place, other, this.shown[index], size)),
    ]);
    const reaches = this.places.flatMap((place, index) => this.reaches(place, this.shown[index], size));
    this.svg.replaceChildren(...[edges, discs, robots, reaches].map((layer) => drawn("g", {}, ...layer)));
  }

  /** A hallway, with the mark in its middle if it has one, and the string that runs over it. */
  edge(curve, { kind, isForward }, strings, size) {
    const [from, p, q, to] = curve.map((at) => `${at.x.toFixed(1)} ${at.y.toFixed(1)}`);
    const shape = `M${from}C${p} ${q} ${to}`;
    const path = drawn("path", { d: shape });
    // Thicker where it runs once more.
    if (strings > 0) return [drawn("path", { class: "string", d: shape, style: `stroke-width: ${(3 + 3 * strings) * size}` }), path];
    if (kind === undefined) return [path];
    path.classList.add("marked");
    const [a, b, c, d] = curve;
    const middle = { x: (a.x + 3 * b.x + 3 * c.x + d.x) / 8, y: (a.y + 3 * b.y + 3 * c.y + d.y) / 8 };
    const along = between({ x: a.x + b.x, y: a.y + b.y }, { x: c.x + d.x, y: c.y + d.y });
    const turn = isForward ? along : along + Math.PI;
    return [path, this.group({ ...middle }, size, [mark(kind, turn)])];
  }

  /** A place around the origin, enlarged. */
  group(spot, size, parts) {
    const place = `translate(${spot.x.toFixed(1)} ${spot.y.toFixed(1)}) scale(${size.toFixed(3)})`;
    return drawn("g", { transform: place }, ...parts);
  }

  disc({ name, here, rings, doors }, spot, size) {
    const center = { x: 0, y: 0 };
    const parts = [
      ...rings.map((ring, index) => drawn("circle", { class: `ring ${ring.drawn}`, r: DISC + 5 + 3.2 * index })),
      drawn("circle", { class: here >= 0 ? "disc here" : "disc", r: DISC }),
      drawn("text", { class: "name", y: 5, "font-size": 14 }, name),
    ];
    for (const [index, { isOpen, isPointed, isMarked }] of doors.entries()) {
      const angle = doorAngle(spot, index, doors.length);
      const [knob, end, label] = [polar(center, angle, DISC), polar(center, angle, DISC + STUB), polar(center, angle + 0.46, DISC + 11)];
      if (isOpen) parts.push(drawn("path", { class: isMarked ? "open marked" : "open", d: `M${knob.x} ${knob.y}L${end.x} ${end.y}` }));
      parts.push(drawn("circle", { class: isPointed ? "knob marker" : "knob", cx: knob.x, cy: knob.y, r: isPointed ? 6 : 3 }));
      parts.push(drawn("text", { class: "index", x: label.x, y: label.y + 4, "font-size": SMALLEST }, String(index)));
    }
    return this.group(spot, size, parts);
  }

  /** The robot, in the door by which it came in. */
  robot({ here, doors }, spot, size) {
    const angle = doorAngle(spot, here, doors.length);
    const at = polar({ x: 0, y: 0 }, angle, DISC + 11);
    const corner = (turn, away) => {
      const { x, y } = polar(at, angle + turn, away);
      return `${x.toFixed(1)} ${y.toFixed(1)}`;
    };
    const shape = `M${corner(Math.PI, 9)}L${corner(0.8, 9)}L${corner(-0.8, 9)}Z`;
    return this.group(spot, size, [drawn("path", { class: "robot", d: shape })]);
  }

  /** Another robot, with its number, beyond those in the same door. */
  other({ doors }, { index, before, drawn: kind, number }, spot, size) {
    const angle = doorAngle(spot, index, doors.length);
    const { x, y } = polar({ x: 0, y: 0 }, angle, DISC + 12 + 17 * before);
    const turn = `rotate(${((angle * 180) / Math.PI).toFixed(1)})`;
    const shape = kind === "robot" ? drawn("path", { d: "M-13 0L8 9L8 -9Z", transform: turn }) : drawn("circle", { r: 8 });
    const text = drawn("text", { y: 3.6, "font-size": SMALLEST }, String(number));
    return this.group(spot, size, [drawn("g", { class: "other-robot", transform: `translate(${x.toFixed(1)} ${y.toFixed(1)})` }, shape, text)]);
  }

  /** Where doors can be pressed. */
  reaches({ number, doors }, spot, size) {
    const parts = doors.map((_, index) => {
      const at = polar({ x: 0, y: 0 }, doorAngle(spot, index, doors.length), DISC + 8);
      const target = drawn("circle", { class: "reach", cx: at.x, cy: at.y, r: 15 });
      target.addEventListener("click", () => this.onDart(number, index));
      return target;
    });
    return [this.group(spot, size, parts)];
  }

  // The pointer.

  /** A point of the window on the map. */
  pointed({ clientX, clientY }) {
    return new DOMPoint(clientX, clientY).matrixTransform(this.svg.getScreenCTM().inverse());
  }

  grab(event) {
    if (this.scale > 1) this.dragged = this.pointed(event);
  }

  drag(event) {
    // The button may have been released elsewhere.
    if (event.buttons === 0) this.drop();
    if (this.dragged === null) return;
    const at = this.pointed(event);
    this.middle = { x: this.middle.x + this.dragged.x - at.x, y: this.middle.y + this.dragged.y - at.y };
    this.draw();
  }

  drop() {
    this.dragged = null;
  }

  /** With the control key, as browsers do, or where the map is enlarged. */
  turnWheel(event) {
    if (!event.ctrlKey && this.scale === 1) return;
    event.preventDefault();
    this.enlarge(event.deltaY < 0 ? ENLARGED : 1 / ENLARGED, this.pointed(event));
  }
}
