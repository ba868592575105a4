// One world: its picture, the robot in it, the marker, and the doors as this robot counts them.

const direction = (from, to) => Math.atan2(to.y - from.y, to.x - from.x);
const distance = (from, to) => Math.hypot(to.x - from.x, to.y - from.y);
const beyond = (from, angle, length) => ({
  x: from.x + length * Math.cos(angle),
  y: from.y + length * Math.sin(angle),
});

/** The signs of a marker on an edge, of size 1, in the direction of x. */
const ARROW = "M1 0L-0.8 0.7L-0.8 -0.7Z";
const BAR = "M-0.3 -1H0.3V1H-0.3Z";
/** Another robot that shows where its front is. */
const FRONT = "M1.9 0L-1.1 1.4L-1.1 -1.4Z";

class Panel {
  /** `onDoor` is called with the number of a door that is clicked in the picture. */
  constructor(figure, onDoor) {
    this.figure = figure;
    this.onDoor = onDoor;
    this.svg = figure.querySelector("svg");
    label(this.svg, figure.querySelector("figcaption .name").textContent);
    crop(this.svg);
    keepReadable(this.svg);

    this.discs = new Map();
    for (const disc of this.svg.querySelectorAll("circle.vertex")) {
      const [x, y, r] = ["cx", "cy", "r"].map((name) => Number(disc.getAttribute(name)));
      this.discs.set(Number(disc.dataset.vertex), { x, y, r });
    }
    // For each entry dart, the edge along which a robot comes in.
    this.ways = new Map();
    for (const path of this.svg.querySelectorAll("path.edge")) {
      const [one, two] = path.dataset.darts.split(" ").map(Number);
      this.ways.set(two, { path, backward: false, opposite: one });
      this.ways.set(one, { path, backward: true, opposite: two });
    }
    // A large world has no knobs. Each knob is followed by its number.
    const knobs = [...this.svg.querySelectorAll("circle.door")];
    this.knob = Number(knobs[0]?.getAttribute("r") ?? 0);
    this.numbers = new Map(knobs.map((it) => [Number(it.dataset.dart), [it, it.nextElementSibling]]));

    this.halos = drawn("g");
    this.doors = drawn("g");
    this.robot = drawn("g", { class: "robot" });
    this.robot.append(
      drawn("path", { class: "tail", d: "M-1 0H-2.1" }),
      // A drop: round, with a nose ahead.
      drawn("path", { d: "M1.5 0L0.62 0.78A1 1 0 1 1 0.62 -0.78Z" }),
    );
    this.svg.querySelector("circle.vertex")?.before(this.halos);
    this.marks = drawn("g");
    const names = this.svg.querySelector(".names");
    names.before(this.marks, this.robot);
    this.svg.append(this.doors);
    new ResizeObserver(() => this.state && this.draw()).observe(this.svg);
  }

  /** How many units of the picture a pixel of the screen is. */
  get pixel() {
    return 1 / (this.svg.getScreenCTM()?.a || 1);
  }

  /**
   * Shows the robot in a state. `shared` says whether the other robot has a door too; with a
   * `duration`, in milliseconds, the robot travels from where it was.
   */
  show(state, shared, duration) {
    const before = this.state;
    this.state = state;
    this.shared = shared;
    cancelAnimationFrame(this.frame);
    this.svg.style.setProperty("--travel", `${before ? duration : 0}ms`);
    this.draw();
    if (before && duration > 0) this.travel(before.vertex, duration);
  }

  draw() {
    const { state } = this;
    this.robot.classList.toggle("carrying", state.robot.carries);
    const disc = this.discs.get(state.vertex);
    this.place(disc, direction(this.end(state.dart), disc));
    const reach = this.drawDoors();
    this.drawAid(reach);
  }

  place(at, angle) {
    this.angle = angle;
    const size = Math.max(0.46 * this.discs.get(this.state.vertex).r, 6 * this.pixel);
    const turn = (angle * 180) / Math.PI;
    this.robot.setAttribute("transform", `translate(${at.x} ${at.y}) rotate(${turn}) scale(${size})`);
    reveal(this.svg.parentElement, this.robot);
  }

  /** Where a dart leaves its disc. */
  end(dart) {
    const { path, backward } = this.ways.get(dart);
    return path.getPointAtLength(backward ? 0 : path.getTotalLength());
  }

  /** Moves the robot from a vertex along the edge by which it has come in. */
  travel(vertex, duration) {
    const { path, backward, opposite } = this.ways.get(this.state.dart);
    const [from, to] = [this.discs.get(vertex), this.discs.get(this.state.vertex)];
    const [exit, entry] = [this.end(opposite), this.end(this.state.dart)];
    const [out, whole, into] = [distance(from, exit), path.getTotalLength(), distance(entry, to)];
    const at = (gone) => {
      if (gone < out) return beyond(from, direction(from, exit), gone);
      const along = gone - out;
      if (along > whole) return beyond(entry, direction(entry, to), along - whole);
      return path.getPointAtLength(backward ? whole - along : along);
    };
    const begun = performance.now();
    const step = (now) => {
      const time = Math.min(1, Math.max(0, (now - begun) / duration));
      const gone = (out + whole + into) * time * time * (3 - 2 * time);
      this.place(at(gone), direction(at(Math.max(0, gone - 1)), at(gone + 1)));
      if (time < 1) this.frame = requestAnimationFrame(step);
    };
    step(begun);
  }

  /**
   * The marking aid: rings around vertices, an arrow at a door, a mark in the middle of an edge, a string along edges, or
   * robots that have come in by an edge. The numbers of doors reach so far from the robot's disc.
   */
  drawAid(reach) {
    const { parts } = this.state.robot;
    const size = Math.max(this.knob + 4, 7 * this.pixel);
    const before = (part, isAlike) => parts.slice(0, parts.indexOf(part)).filter(isAlike).length;
    const rings = parts.filter(({ drawn: kind }) => RINGS.includes(kind)).map((part) => {
      const disc = this.discOf(part.dart);
      const around = before(part, (other) => RINGS.includes(other.drawn) && this.discOf(other.dart) === disc);
      const radius = disc.r + Math.max(this.knob + 4, 3 * this.pixel) + 4 * around * this.pixel;
      return drawn("circle", { class: `mark-disc ${part.drawn}`, cx: disc.x, cy: disc.y, r: radius });
    });
    const strings = parts.filter(({ drawn: kind }) => kind === "string").map((part) => {
      const { path } = this.ways.get(part.dart);
      const again = before(part, (other) => other.drawn === "string" && this.ways.get(other.dart).path === path);
      // Thicker where it runs once more.
      return drawn("path", { class: "string", d: path.getAttribute("d"), "stroke-width": 4 + 4 * again });
    });
    const marks = parts.filter(({ drawn: kind }) => kind !== "string" && !RINGS.includes(kind)).map((part) => {
      const { dart, drawn: kind } = part;
      if (part.number !== undefined) return this.other(part, before(part, (other) => other.dart === dart), reach);
      const half = this.ways.get(dart).path.getTotalLength() / 2;
      const [place, from] = kind === "pointing" ? [1.7 * size, size] : [half, half - 1];
      return this.sign(dart, place, from, size, drawn("path", { class: "mark", d: kind === "edge" ? BAR : ARROW }));
    });
    this.halos.replaceChildren(...rings, ...strings);
    this.marks.replaceChildren(...marks);
  }

  discOf(dart) {
    return this.discs.get(this.state.robot.graph.vertex(dart));
  }

  /** Puts a sign on the edge of a dart, so far from its disc, in the direction from another such place. */
  sign(dart, place, from, size, shape) {
    const { path, backward } = this.ways.get(dart);
    const at = (away) => path.getPointAtLength(backward ? away : path.getTotalLength() - away);
    const { x, y } = at(place);
    const turn = (direction(at(from), at(place)) * 180) / Math.PI;
    shape.setAttribute("transform", `translate(${x} ${y}) rotate(${turn}) scale(${size})`);
    return shape;
  }

  /** Another robot of the team, on the edge by which it has come in, beyond the explorer's own door if that is here. */
  other({ dart, drawn: kind, number }, before, reach) {
    const size = 10 * this.pixel;
    const isHere = this.state.robot.graph.vertex(dart) === this.state.vertex;
    const length = this.ways.get(dart).path.getTotalLength();
    const away = (isHere ? reach : this.knob) + 1.9 * size + 3.2 * size * before;
    const place = Math.min(away, length - 1.2 * size);
    const shape = kind === "robot" ? drawn("path", { d: FRONT }) : drawn("circle", { r: 1 });
    const group = this.sign(dart, place, place + 1, size, drawn("g", { class: "other-robot" }, shape));
    const [, turn] = group.getAttribute("transform").match(/rotate\((.*?)\)/);
    group.append(drawn("text", { y: 0.42, "font-size": 1.2, transform: `rotate(${-turn})` }, String(number)));
    return group;
  }

  /** The doors of the vertex with the robot's own numbers, large enough for a finger. Returns how far they reach. */
  drawDoors() {
    const { pixel, state } = this;
    const disc = this.discs.get(state.vertex);
    const doors = [...state.actions]
      .filter(([action]) => isDoor(action))
      .map(([action, to]) => ({ action, dart: this.ways.get(to.dart).opposite }))
      .map((door) => ({ ...door, angle: direction(disc, this.end(door.dart)) }));
    const angles = doors.map(({ angle }) => angle).sort((one, two) => one - two);
    const gaps = angles.map((angle, at) => (angles[at + 1] ?? angles[0] + 2 * Math.PI) - angle);
    const half = Math.sin(Math.min(Math.PI, ...gaps) / 2);
    // Many doors are closer together: farther out there is more room.
    const wish = Math.max(1.6 * this.knob, 9 * pixel);
    const away = Math.min(Math.max(disc.r + wish / 4, wish / half), disc.r + 30 * pixel);
    const radius = Math.min(wish, away * half);
    for (const door of doors) door.at = beyond(disc, door.angle, away);

    const reach = Math.max(radius, 22 * pixel);
    const circle = (name, { x, y }, r) => drawn("circle", { class: name, cx: x, cy: y, r });
    // A new group, so that its animation runs again.
    const group = drawn("g", { class: "own-doors" });
    group.append(...doors.map(({ at }) => circle("reach", at, reach)));
    for (const { action, dart, at } of doors) {
      const size = radius * (action.length > 1 ? 1.1 : 1.35);
      const number = drawn("text", { x: at.x, y: at.y + 0.36 * size, "font-size": size }, action);
      const door = drawn("g", { "data-action": action }, circle("badge", at, radius), number);
      door.classList.toggle("alone", !this.shared(action));
      // Its number may cover the marker that points along it.
      door.classList.toggle("marked", state.robot.parts.some((part) => part.dart === dart && part.drawn === "pointing"));
      group.append(door);
    }
    // A finger covers several doors: choose the nearest.
    group.addEventListener("click", ({ clientX, clientY }) => {
      const point = new DOMPoint(clientX, clientY).matrixTransform(this.svg.getScreenCTM().inverse());
      const far = ({ at }) => distance(at, point);
      this.onDoor(doors.reduce((one, two) => (far(two) < far(one) ? two : one)).action);
    });
    this.doors.replaceWith(group);
    this.doors = group;

    const hidden = new Set(doors.flatMap(({ dart }) => this.numbers.get(dart) ?? []));
    for (const sign of this.svg.querySelectorAll(".overruled")) sign.classList.remove("overruled");
    for (const sign of hidden) sign.classList.add("overruled");
    return away - disc.r + radius;
  }
}

