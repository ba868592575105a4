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
    this.drawMarker();
    this.drawDoors();
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

  /** The marker: rings around vertices, an arrow at a door, or a mark in the middle of an edge. */
  drawMarker() {
    const signs = this.state.parts.map(({ dart, drawn: kind }, nth) => {
      const disc = this.discs.get(this.state.robot.graph.vertex(dart));
      const size = Math.max(this.knob + 4, 7 * this.pixel);
      if (kind === "lying" || kind === "second") {
        const radius = disc.r + Math.max(this.knob + 4, 3 * this.pixel) + 4 * nth * this.pixel;
        return drawn("circle", { class: `mark-disc ${kind}`, cx: disc.x, cy: disc.y, r: radius });
      }
      const { path, backward } = this.ways.get(dart);
      const length = path.getTotalLength();
      const at = (away) => path.getPointAtLength(backward ? away : length - away);
      const [place, before] = kind === "pointing" ? [1.7 * size, size] : [length / 2, length / 2 - 1];
      const turn = direction(at(before), at(place));
      return this.sign(at(place), turn, size, kind === "edge" ? BAR : ARROW);
    });
    this.halos.replaceChildren(...signs.filter(({ tagName }) => tagName === "circle"));
    this.marks.replaceChildren(...signs.filter(({ tagName }) => tagName !== "circle"));
  }

  /** A sign on an edge. */
  sign({ x, y }, turn, size, shape) {
    const place = `translate(${x} ${y}) rotate(${(turn * 180) / Math.PI}) scale(${size})`;
    return drawn("path", { class: "mark", d: shape, transform: place });
  }

  /** The doors of the vertex with the robot's own numbers, large enough for a finger. */
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
      door.classList.toggle("marked", state.parts.some((part) => part.dart === dart && part.drawn === "pointing"));
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
  }
}

