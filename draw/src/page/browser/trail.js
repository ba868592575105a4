// The trail: the places that the robot has visited, folded as far as is proved.

/** How long a trail takes to collapse, in milliseconds. */
const COLLAPSE = 450;

class Trail {
  /** `data`: see folding.rs. */
  constructor(svg, data) {
    this.data = data;
    this.stage = -1;
    this.svg = svg;
    svg.setAttribute("viewBox", data.box.join(" "));
    const layer = (name) => svg.appendChild(drawn("g", { class: name }));
    const [edges, stubs, discs, names] = ["edges", "stubs", "discs", "names"].map(layer);
    this.edges = data.vertices.map(() => edges.appendChild(drawn("path")));
    this.stubs = stubs;
    this.discs = data.vertices.map(() => discs.appendChild(drawn("circle", { r: data.radius })));
    this.names = data.vertices.map(({ place }) => {
      const name = drawn("text", { class: "name", "font-size": 0.8 * data.radius, dy: "0.35em" });
      name.textContent = `v${place}`;
      return names.appendChild(name);
    });
    this.marker = svg.appendChild(drawn("circle", { class: "marker", r: 0.28 * data.radius }));
    this.layers = [];
  }

  /** Shows a stage; it takes `duration` milliseconds to get there from the one before. */
  show(number, duration) {
    if (number === this.stage) return;
    const next = this.data.stages[number];
    const before = next.layers.map((layer, vertex) => this.layers[vertex] ?? layer);
    const folds = before.some((layer, vertex) => layer !== next.layers[vertex]);
    this.stage = number;
    cancelAnimationFrame(this.request);
    this.mark(next);
    if (!folds || duration === 0) return this.place(next.layers);
    const begun = performance.now();
    const move = (now) => {
      const share = Math.min(1, Math.max(0, (now - begun) / duration));
      const eased = share * share * (3 - 2 * share);
      this.place(next.layers.map((layer, vertex) => before[vertex] + (layer - before[vertex]) * eased));
      if (share < 1) this.request = requestAnimationFrame(move);
    };
    this.place(before);
    this.request = requestAnimationFrame(move);
  }

  /** Shows what belongs to a stage, wherever it is. */
  mark({ count, layers, open, robot }) {
    const seen = new Set();
    for (const [vertex, disc] of this.discs.entries()) {
      const shown = vertex < count;
      const { place, from } = this.data.vertices[vertex];
      const first = shown && !seen.has(`${place} ${layers[vertex]}`);
      seen.add(`${place} ${layers[vertex]}`);
      disc.toggleAttribute("hidden", !shown);
      // Of those that are one place, the first one counts.
      disc.setAttribute("class", `${first ? "place" : "same"}${layers[vertex] > 0 ? " further" : ""}`);
      this.names[vertex].toggleAttribute("hidden", !first || layers[vertex] > 0);
      this.edges[vertex].toggleAttribute("hidden", !shown || from === null);
      const further = shown && from !== null && layers[vertex] + layers[from] > 0;
      this.edges[vertex].setAttribute("class", further ? "further" : "");
    }
    const { place } = this.data.vertices[robot];
    const here = layers.findIndex((layer, vertex) => layer === layers[robot] && this.data.vertices[vertex].place === place);
    this.discs[here].classList.add("robot");
    this.stubs.replaceChildren();
    this.open = open.map(([vertex, dart]) => {
      const line = drawn("path");
      const end = drawn("circle", { class: "open", r: this.data.open });
      this.stubs.append(line, end);
      return { vertex, dart, line, end };
    });
    const marked = this.data.marker;
    this.marker.toggleAttribute("hidden", marked === null || marked[0] >= count);
  }

  /** Moves everything to these layers, one for each vertex of the trail. */
  place(layers) {
    this.layers = layers;
    const { places, curves, stubs, aside, vertices, marker } = this.data;
    const moved = ([x, y], layer) => [x + layer * aside[0], y + layer * aside[1]];
    for (const [vertex, layer] of layers.entries()) {
      const { place, from, edge } = vertices[vertex];
      const [x, y] = moved(places[place], layer);
      this.discs[vertex].setAttribute("cx", x);
      this.discs[vertex].setAttribute("cy", y);
      this.names[vertex].setAttribute("x", x);
      this.names[vertex].setAttribute("y", y);
      if (from === null) continue;
      const way = curves[edge];
      const along = (point, step) => moved(point, layers[from] + ((layer - layers[from]) * step) / (way.length - 1));
      this.edges[vertex].setAttribute("d", `M${way.map(along).map((point) => point.join(" ")).join("L")}`);
    }
    for (const { vertex, dart, line, end } of this.open) {
      const [near, far] = stubs[dart].map((point) => moved(point, layers[vertex]));
      line.setAttribute("d", `M${near.join(" ")}L${far.join(" ")}`);
      const long = Math.hypot(far[0] - near[0], far[1] - near[1]) || 1;
      end.setAttribute("cx", far[0] + ((far[0] - near[0]) / long) * this.data.open);
      end.setAttribute("cy", far[1] + ((far[1] - near[1]) / long) * this.data.open);
    }
    if (marker === null || marker[0] >= layers.length) return;
    const [x, y] = moved(curves[marker[1]][0], layers[marker[0]]);
    this.marker.setAttribute("cx", x);
    this.marker.setAttribute("cy", y);
  }

  /** What a stage is, in words. */
  words(number) {
    const { places, open } = this.data.stages[number];
    const merged = number === 0 ? 0 : this.data.stages[number - 1].places + 1 - places;
    const counted = (count, one, more) => `${count} ${count === 1 ? one : more}`;
    const last = number === this.data.stages.length - 1;
    const contradicted = last && this.data.contradicted ? ", then a contradiction" : "";
    const fold = merged > 1 ? `, ${merged} folded` : contradicted;
    return `${counted(places, "place", "places")}, ${counted(open.length, "open door", "open doors")}${fold}`;
  }
}
