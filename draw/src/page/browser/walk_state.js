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

  get parts() {
    return markerParts(this.robot.marker, this.robot.graph, this.robot.placed);
  }

  /** The state after each action. */
  get actions() {
    return new Map(this.robot.actions().map((action) => [action, new WalkState(this.side, this.robot.after(action))]));
  }

  /** The pose as vertex:door, counted from the vertex's first; and where a movable marker is. */
  get text() {
    const { marker, graph, pose, placed } = this.robot;
    const { vertices } = this.side;
    const at = `${vertices[this.vertex]}:${graph.index(pose)}`;
    if (marker !== MOVABLE) return at;
    return placed === null ? `${at}+marker` : `${at}@${vertices[graph.vertex(placed)]}`;
  }
}

/** Where the marker is in the picture. Doors have the numbers of the picture, which are not those of the robot. */
function markerText({ parts, robot, side }) {
  const name = (dart) => side.vertices[robot.graph.vertex(dart)];
  const edge = (dart) => side.edges?.[dart] ?? `${name(dart)} to ${name(robot.graph.opposite(dart))}`;
  if (robot.carries) return "The robot carries the marker.";
  const texts = {
    pointing: (dart) => `The marker lies at ${name(dart)}, along the small number ${robot.graph.index(dart)}.`,
    edge: (dart) => `The edge ${edge(dart)} is marked.`,
    arrow: (dart) => `The edge ${edge(dart)} is marked with an arrow away from ${name(dart)}.`,
  };
  const [first] = parts;
  if (first === undefined) return "There is no marker.";
  if (texts[first.drawn]) return texts[first.drawn](first.dart);
  const places = parts.map(({ dart, drawn }) => name(dart) + (drawn === "second" ? " (dashed)" : ""));
  return parts.length === 1 ? `The marker lies at ${places[0]}.` : `The markers lie at ${places.join(" and ")}.`;
}
