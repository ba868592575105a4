// The floor: the robot, and the part of the drawing that has happened so far.

/** The largest font size of a name, in units of the drawing, so that it covers nothing beside it. */
const LARGEST = 30;

class Floor {
  /** `rounds`: where each frame was taken. `body`: the robot's radius, in units of the drawing. */
  constructor(figure, rounds, body) {
    this.svg = figure.querySelector("svg");
    this.rounds = rounds;
    this.body = body;
    label(this.svg, "The floor plan, and the robot's way so far");
    const all = (selector) => [...this.svg.querySelectorAll(selector)];
    this.lines = all(".trajectory").map((line) => {
      const [first, last] = line.dataset.rounds.split(" ").map(Number);
      return { line, first, last, points: line.getAttribute("points").split(" ") };
    });
    this.calls = all(".call, .badge").map((sign) => [sign, Number(sign.dataset.rounds)]);
    this.passes = all("[data-moves]").map((number) => [number, Number(number.dataset.moves)]);
    // The shortest turns, so that the robot does not spin when its heading jumps by 360.
    let turn = 0;
    this.turns = rounds.map((round) => {
      turn += ((((round.turn - turn) % 360) + 540) % 360) - 180;
      return turn;
    });
    const { x, y, width, height } = this.svg.viewBox.baseVal;
    this.box = { x, y, width, height };
    this.names = all(".names text").map((name) => [name, Number(name.getAttribute("font-size"))]);
    // Where the marking aid was drawn, if it moves.
    [this.aid, this.aidAt] = [this.svg.querySelector(".aid"), rounds.find((round) => round.aid)?.aid];
    this.robot = drawn("g", { class: "robot" });
    this.robot.append(drawn("circle", { r: 1 }), drawn("path", { d: "M0 0H1" }));
    // Below the signs of calls, so that a cross at the robot's place is visible.
    this.svg.insertBefore(this.robot, this.svg.querySelector(":scope > .call"));
    new ResizeObserver(() => this.scale()).observe(this.svg);
    this.scale();
  }

  /** What has to be seen is not drawn smaller than a reader can. */
  scale() {
    this.fit(this.box);
    // Larger names need more room, in which everything is a little smaller: twice is close enough.
    for (let pass = 0; pass < 2; pass += 1) {
      for (const [name, size] of this.names) {
        const wish = Math.min(READABLE * this.pixel, LARGEST);
        name.setAttribute("font-size", Math.max(size, wish));
      }
      const { x, y, width, height } = this.box;
      const names = this.svg.querySelector(".names").getBBox();
      const [left, top] = [Math.min(x, names.x), Math.min(y, names.y)];
      const right = Math.max(x + width, names.x + names.width);
      const bottom = Math.max(y + height, names.y + names.height);
      this.fit({ x: left, y: top, width: right - left, height: bottom - top });
    }
    keepReadable(this.svg, LARGEST);
    this.place();
  }

  /** Shows this part of the drawing. */
  fit({ x, y, width, height }) {
    this.svg.setAttribute("viewBox", `${x} ${y} ${width} ${height}`);
    // Units of the drawing per pixel of the screen.
    this.pixel = 1 / (this.svg.getScreenCTM()?.a || 1);
    this.svg.style.setProperty("--pixel", this.pixel);
    this.svg.classList.toggle("small", this.pixel > 1.6);
  }

  /** Shows the run as it was at a frame; with a `duration`, in milliseconds, the robot travels there. */
  show(at, duration = 0) {
    const late = (sign, is) => sign.classList.toggle("later", is);
    this.at = at;
    this.svg.style.setProperty("--travel", `${duration}ms`);
    for (const { line, first, last, points } of this.lines) {
      late(line, first >= at);
      const there = last <= at ? points : points.slice(0, at - first + 1);
      line.setAttribute("points", there.join(" "));
    }
    for (const [sign, rounds] of this.calls) late(sign, rounds > at + 1);
    for (const [number, moves] of this.passes) late(number, moves > this.rounds[at].moves);
    this.place();
  }

  /** Shows the marking aid where it is; nothing if it stays where it was drawn, and null if the robot carries it. */
  placeAid(place) {
    if (place === undefined) return;
    this.aid.classList.toggle("later", place === null);
    if (place === null) return;
    const { x, y, turn } = this.aidAt;
    const turned = `rotate(${place.turn - turn}deg) translate(${-x}px, ${-y}px)`;
    this.aid.style.transform = `translate(${place.x}px, ${place.y}px) ${turned}`;
  }

  place() {
    if (this.at === undefined) return;
    const { x, y } = this.rounds[this.at];
    const size = Math.max(this.body, 7 * this.pixel);
    const turn = this.turns[this.at];
    this.robot.style.transform = `translate(${x}px, ${y}px) rotate(${turn}deg) scale(${size})`;
    this.placeAid(this.rounds[this.at].aid);
    reveal(this.svg.parentElement, this.robot);
  }
}
