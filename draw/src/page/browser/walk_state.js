// The worlds of a walk, and the robots in them as pictures and texts show them.

/** A world of the data of a page, with its graph and the dart that places the marker. */
function sideOf({ world, facing, ...rest }) {
  const graph = Graph.of(world);
  return { ...rest, graph, facing: graph.dart(facing) };
}

/** A robot in one of the worlds, as its picture and its texts show it. */
class WalkState {
  constructor(side, robot) {
    Object.assign(this, { side, robot });
  }

  get dart() {
    return this.robot.pose;
  }

  get vertex() {
    return this.robot.graph.vertex(this.robot.pose);
  }

  get percept() {
    return perceptText(this.robot.percept());
  }

  /** The state after each action. */
  get actions() {
    return new Map(this.robot.actions().map((action) => [action, new WalkState(this.side, this.robot.after(action))]));
  }

  /** How places are called in the picture, whose numbers of doors are not those of the robot. */
  get names() {
    const { graph } = this.robot;
    const { vertices, edges } = this.side;
    const index = (dart) => graph.index(dart);
    const vertex = (dart) => vertices[graph.vertex(dart)];
    const edge = (dart) => edges?.[dart] ?? `${vertex(dart)} to ${vertex(graph.opposite(dart))}`;
    return { graph, index, vertex, edge, dart: (dart) => `${vertex(dart)}:${index(dart)}` };
  }

  /** The pose as vertex:door, counted from the vertex's first; and the state of an aid that moves. */
  get text() {
    const { aid, pose, placed } = this.robot;
    return this.names.dart(pose) + aid.text(placed, this.names);
  }

  /** Where the aid is, in words. */
  get words() {
    const { aid, placed } = this.robot;
    return aid.words(placed, this.names);
  }
}
