// Embedded graphs. A dart is a number; the darts of a vertex follow one another clockwise. While a graph is built, a dart
// may be open: its other end is null.

class Graph {
  constructor() {
    /** The first dart and the degree of each vertex. */
    this.first = [];
    this.degrees = [];
    /** The vertex and the other end of each dart. */
    this.vertices = [];
    this.far = [];
  }

  /** The graph of lists: for each vertex and each dart clockwise, the vertex and the index of the other end, or null. */
  static of(lists) {
    const graph = new Graph();
    for (const ends of lists) graph.add(ends.length);
    for (const [vertex, ends] of lists.entries()) {
      for (const [index, end] of ends.entries()) {
        if (end !== null) graph.far[graph.dart([vertex, index])] = graph.dart(end);
      }
    }
    return graph;
  }

  lists() {
    const end = (dart) => (this.far[dart] === null ? null : this.end(this.far[dart]));
    return this.first.map((first, vertex) => [...Array(this.degrees[vertex]).keys()].map((index) => end(first + index)));
  }

  copy() {
    const copied = new Graph();
    for (const key of ["first", "degrees", "vertices", "far"]) copied[key] = [...this[key]];
    return copied;
  }

  /** Adds a vertex, and returns its first dart. */
  add(degree) {
    const first = this.vertices.length;
    const vertex = this.first.push(first) - 1;
    this.degrees.push(degree);
    for (let index = 0; index < degree; index += 1) {
      this.vertices.push(vertex);
      this.far.push(null);
    }
    return first;
  }

  /** Removes the last vertex, whose darts are open. */
  removeLast() {
    this.vertices.length = this.far.length = this.first.pop();
    this.degrees.pop();
  }

  join(one, other) {
    this.far[one] = other;
    this.far[other] = one;
  }

  part(one, other) {
    this.far[one] = this.far[other] = null;
  }

  get dartCount() {
    return this.far.length;
  }

  get vertexCount() {
    return this.first.length;
  }

  /** The darts that have no other end yet. */
  open() {
    return [...this.far.keys()].filter((dart) => this.far[dart] === null);
  }

  /** Whether it has neither a loop nor parallel edges. */
  isSimple() {
    const ends = (dart) => [dart, this.far[dart]].map((end) => this.vertices[end]);
    const pairs = [...this.far.keys()].map((dart) => ends(dart).join(" "));
    return new Set(pairs).size === pairs.length && pairs.every((pair) => pair.split(" ")[0] !== pair.split(" ")[1]);
  }

  darts(vertex) {
    return [...Array(this.degrees[vertex]).keys()].map((index) => this.first[vertex] + index);
  }

  /** The dart with an index at a vertex. */
  dart([vertex, index]) {
    return this.first[vertex] + index;
  }

  /** The vertex of a dart, and its index there. */
  end(dart) {
    return [this.vertices[dart], this.index(dart)];
  }

  vertex(dart) {
    return this.vertices[dart];
  }

  index(dart) {
    return dart - this.first[this.vertices[dart]];
  }

  degree(dart) {
    return this.degrees[this.vertices[dart]];
  }

  opposite(dart) {
    return this.far[dart];
  }

  /** The dart a number of doors clockwise from another. */
  turned(dart, doors) {
    return this.first[this.vertices[dart]] + ((this.index(dart) + doors) % this.degree(dart));
  }

  /** The door that leads from one dart to another one of its vertex. */
  door(from, to) {
    return (this.index(to) - this.index(from) + this.degree(from)) % this.degree(from);
  }
}
