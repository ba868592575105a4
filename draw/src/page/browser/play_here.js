// The place where the robot is: its doors as the robot counts them, door 0 behind it, and what it senses of the aid.

class Here {
  constructor(svg, onDoor) {
    this.svg = svg;
    this.onDoor = onDoor;
    svg.setAttribute("viewBox", "-110 -110 220 220");
  }

  /** `held` is what the robot holds, in words. */
  show(percept, held) {
    const { degree, sighting } = percept;
    const parts = [drawn("circle", { class: "floor", r: 46 })];
    const facts = factsOf(percept);
    // Door 0 is below; clockwise, the next one is to the left.
    const angle = (door) => Math.PI / 2 + (door * 2 * Math.PI) / degree;
    for (let door = 0; door < degree; door += 1) {
      const [near, far, at] = [44, 74, 90].map((away) => polar({ x: 0, y: 0 }, angle(door), away));
      const isStrung = facts.some((fact) => fact.text === "string" && fact.door === door);
      parts.push(drawn("path", { class: isStrung ? "hallway strung" : "hallway", d: `M${near.x} ${near.y}L${far.x} ${far.y}` }));
      const size = degree > 9 ? 11 : 15;
      const group = drawn(
        "g",
        { class: "door", "data-door": door },
        drawn("circle", { class: "badge", cx: at.x, cy: at.y, r: size }),
        drawn("text", { x: at.x, y: at.y + size / 3, "font-size": size }, String(door)),
      );
      group.addEventListener("click", () => this.onDoor(String(door)));
      parts.push(group);
    }
    parts.push(...this.signs(sighting, facts));
    for (const fact of facts.filter(({ door }) => door !== null)) parts.push(...this.atDoor(fact, angle(fact.door)));
    parts.push(drawn("path", { class: held ? "robot carrying" : "robot", d: "M0 -13L10 11L0 6L-10 11Z" }));
    this.svg.replaceChildren(...parts);
    const shown = held && sighting === NOTHING ? held : sighting;
    this.svg.setAttribute("aria-label", `The robot's place: ${doorsText(degree)}, ${shown}`);
  }

  /** What points along a door or runs through it: a marker, string, or another robot with its back to the door. */
  atDoor({ text }, angle) {
    const at = (turn, away) => polar({ x: 0, y: 0 }, angle + turn, away);
    const corner = (turn, away) => `${at(turn, away).x.toFixed(1)} ${at(turn, away).y.toFixed(1)}`;
    if (text === "pointing") return [drawn("path", { class: "marker", d: `M${corner(0, 43)}L${corner(0.32, 27)}L${corner(-0.32, 27)}Z` })];
    if (text === "string") return [drawn("path", { class: "strung", d: `M${corner(0, 44)}L${corner(0, 28)}` })];
    if (text === "hand") return [drawn("path", { class: "strung", d: `M${corner(0, 28)}L${corner(0, 8)}` })];
    return this.other(text, at(0, 31), (angle * 180) / Math.PI);
  }

  /** Another robot, with its number; it faces away from a direction, in degrees, or has no front. */
  other(text, { x, y }, back = null) {
    const shape = back === null ? drawn("circle", { r: 9 }) : drawn("path", { d: "M-14 0L9 10L9 -10Z", transform: `rotate(${back})` });
    const number = drawn("text", { y: 4, "font-size": 11 }, text.match(/\d/)[0]);
    return [drawn("g", { class: "other-robot", transform: `translate(${x.toFixed(1)} ${y.toFixed(1)})` }, shape, number)];
  }

  /** What lies here, robots without a front that are here, and a mark on the hallway behind the robot. */
  signs(sighting, facts) {
    // The robot came up from below.
    const along = { [AGAINST]: Math.PI / 2, [ALONG]: -Math.PI / 2 }[sighting];
    if (along !== undefined || sighting === PASSED) {
      const sign = mark(along === undefined ? "edge" : "arrow", along ?? Math.PI / 2);
      return [drawn("g", { transform: "translate(0 60)" }, sign)];
    }
    const looks = { "fixed end": "third", "free end": "second" };
    const lookOf = (text) => (LOOKS.includes(text) ? text : looks[text] ?? (text.startsWith("marker ") ? "first" : null));
    const here = facts.filter(({ text, door }) => door === null && (lookOf(text) !== null || /^robot \d$/.test(text)));
    const spread = Math.min(22, 66 / here.length);
    return here.flatMap(({ text }, index) => {
      const x = spread * (index - (here.length - 1) / 2);
      const look = lookOf(text);
      if (look === null) return this.other(text, { x, y: -26 });
      return [drawn("circle", { class: `lying ${look}`, cx: x, cy: -26, r: Math.min(8, 0.45 * spread) })];
    });
  }
}
