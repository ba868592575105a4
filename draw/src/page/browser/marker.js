// The kinds of markers, as in the specification: what a robot senses of each, and where it is. A marker is placed by a
// dart: the one behind the robot at the start, or behind it where it dropped the marker; null while the robot carries it.

const NOTHING = "no marker";
const PASSED = "past the mark";
const AGAINST = `${PASSED}, against its arrow`;
const ALONG = `${PASSED}, along its arrow`;

const MOVABLE = "movable";
const PICK_UP = "pick-up";
const DROP = "drop";

/** What a robot that came in by the dart `pose` may sense of the marker: several if an open dart decides. */
function sightings(marker, graph, placed, pose) {
  if (placed === null || marker === "none") return [NOTHING];
  const far = graph.opposite(placed);
  const [here, there] = [placed, far].map((dart) => dart !== null && graph.vertex(dart) === graph.vertex(pose));
  switch (marker) {
    case "directional":
      return [here ? `marker along door ${graph.door(pose, placed)}` : NOTHING];
    case "undirected-edge":
      return [pose === placed || pose === far ? PASSED : NOTHING];
    case "directed-edge":
      return [pose === placed ? AGAINST : pose === far ? ALONG : NOTHING];
    case "two-identical": {
      const known = here + there;
      return (far === null ? [known, known + 1] : [known]).map((count) => [NOTHING, "marker", "2 markers"][count]);
    }
    case "two-distinct": {
      const seen = (second) => [[NOTHING, "second marker"], ["first marker", "first and second marker"]][Number(here)][Number(second)];
      return far === null ? [seen(false), seen(true)] : [seen(there)];
    }
    default:
      return [here ? "marker" : NOTHING];
  }
}

/** Where the marker is, for a drawing: a dart, and how it is drawn there. */
function markerParts(marker, graph, placed) {
  if (placed === null) return [];
  const far = graph.opposite(placed);
  const there = far === null ? [] : [far];
  switch (marker) {
    case "none":
      return [];
    case "directional":
      return [{ dart: placed, drawn: "pointing" }];
    case "undirected-edge":
      return [{ dart: placed, drawn: "edge" }];
    case "directed-edge":
      return [{ dart: placed, drawn: "arrow" }];
    case "two-identical":
      return [placed, ...there].map((dart) => ({ dart, drawn: "lying" }));
    case "two-distinct":
      return [{ dart: placed, drawn: "lying" }, ...there.map((dart) => ({ dart, drawn: "second" }))];
    default:
      return [{ dart: placed, drawn: "lying" }];
  }
}

/**
 * What a percept shows about a place or an edge: a key and a value. In one world, percepts with the same key have the
 * same value as long as nobody moves the marker.
 */
function shownBy(marker, graph, pose, sighting) {
  const vertex = `vertex ${graph.vertex(pose)}`;
  if (marker === "directional") {
    const door = pointedDoor(sighting);
    return [vertex, door === null ? sighting : graph.turned(pose, door)];
  }
  if (marker !== "undirected-edge" && marker !== "directed-edge") return [vertex, sighting];
  const far = graph.opposite(pose);
  if (far === null || pose < far) return [`edge ${pose}`, sighting];
  return [`edge ${far}`, { [AGAINST]: ALONG, [ALONG]: AGAINST }[sighting] ?? sighting];
}

/** The door along which a marker points, or null. */
function pointedDoor(sighting) {
  const door = sighting.match(/^marker along door (\d+)$/)?.[1];
  return door === undefined ? null : Number(door);
}

/** A percept in words. */
const perceptText = ({ degree, sighting }) => doorsText(degree) + (sighting === NOTHING ? "" : `, ${sighting}`);

const doorsText = (degree) => (degree === 1 ? "1 door" : `${degree} doors`);

const isDoor = (action) => /^\d+$/.test(action);

/** A robot in a world with a marker. */
class Robot {
  constructor(marker, graph, pose, placed = pose) {
    Object.assign(this, { marker, graph, pose, placed });
  }

  /** The robot after one of the actions. */
  after(action) {
    const robot = new Robot(this.marker, this.graph, this.pose, this.placed);
    robot.act(action);
    return robot;
  }

  get carries() {
    return this.placed === null;
  }

  percept() {
    const [sighting] = sightings(this.marker, this.graph, this.placed, this.pose);
    return { degree: this.graph.degree(this.pose), sighting };
  }

  /** What the robot can do: the numbers of doors as texts, and picking up or dropping the marker. */
  actions() {
    const doors = [...Array(this.graph.degree(this.pose)).keys()].map(String);
    if (this.marker !== MOVABLE) return doors;
    if (this.carries) return [...doors, DROP];
    return this.percept().sighting === NOTHING ? doors : [...doors, PICK_UP];
  }

  /** Does one of the actions. */
  act(action) {
    if (action === PICK_UP) this.placed = null;
    else if (action === DROP) this.placed = this.pose;
    else this.pose = this.graph.opposite(this.graph.turned(this.pose, Number(action)));
  }
}
