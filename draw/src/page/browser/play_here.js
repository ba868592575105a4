// The place where the robot is: its doors as the robot counts them, door 0 behind it, and the marker.

class Here {
  constructor(svg, onDoor) {
    this.svg = svg;
    this.onDoor = onDoor;
    svg.setAttribute("viewBox", "-110 -110 220 220");
  }

  show({ degree, sighting }, carries) {
    const parts = [drawn("circle", { class: "floor", r: 46 })];
    const pointed = pointedDoor(sighting);
    for (let door = 0; door < degree; door += 1) {
      // Door 0 is below; clockwise, the next one is to the left.
      const angle = Math.PI / 2 + (door * 2 * Math.PI) / degree;
      const [near, far, at] = [44, 74, 90].map((away) => polar({ x: 0, y: 0 }, angle, away));
      parts.push(drawn("path", { class: "hallway", d: `M${near.x} ${near.y}L${far.x} ${far.y}` }));
      if (door === pointed) parts.push(this.arrow(angle));
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
    parts.push(...this.signs(sighting));
    parts.push(drawn("path", { class: carries ? "robot carrying" : "robot", d: "M0 -13L10 11L0 6L-10 11Z" }));
    this.svg.replaceChildren(...parts);
    const marker = carries ? "you carry the marker" : sighting;
    this.svg.setAttribute("aria-label", `The robot's place: ${doorsText(degree)}, ${marker}`);
  }

  /** A directional marker: an arrow on the floor along its door. */
  arrow(angle) {
    const corner = (turn, away) => {
      const { x, y } = polar({ x: 0, y: 0 }, angle + turn, away);
      return `${x.toFixed(1)} ${y.toFixed(1)}`;
    };
    return drawn("path", { class: "marker", d: `M${corner(0, 43)}L${corner(0.32, 27)}L${corner(-0.32, 27)}Z` });
  }

  /** Markers that lie here, and a mark on the hallway behind the robot. */
  signs(sighting) {
    // The robot came up from below.
    const along = { [AGAINST]: Math.PI / 2, [ALONG]: -Math.PI / 2 }[sighting];
    if (along !== undefined || sighting === PASSED) {
      const sign = mark(along === undefined ? "edge" : "arrow", along ?? Math.PI / 2);
      return [drawn("g", { transform: "translate(0 60)" }, sign)];
    }
    const lying = (x, look) => drawn("circle", { class: `lying ${look}`, cx: x, cy: -26, r: 8 });
    const looks = {
      marker: ["first"],
      "first marker": ["first"],
      "second marker": ["second"],
      "2 markers": ["first", "first"],
      "first and second marker": ["first", "second"],
    };
    const here = looks[sighting] ?? [];
    return here.map((look, index) => lying(22 * (index - (here.length - 1) / 2), look));
  }
}
