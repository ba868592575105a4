// The marking aids, as in the specification: where their parts are, what a robot senses of them, and what it can do with
// them. A place is a dart, or null for a part that the robot holds. A fixed marker has one: the dart behind the robot at the
// start.

const NOTHING = "no marker";
const PASSED = "past the mark";
const AGAINST = `${PASSED}, against its arrow`;
const ALONG = `${PASSED}, along its arrow`;

const MOVABLE = "movable";
const PICK_UP = "pick-up";
const DROP = "drop";

/** The names of markers that look different; a drawing shows each in another way. */
const LOOKS = ["first", "second", "third", "fourth"];
/** The parts of an aid that are drawn as rings. */
const RINGS = ["lying", ...LOOKS.slice(1)];
/** How these rings are drawn, in words. */
const DRAWN_AS = ["", " (dashed)", " (dotted)", " (dashed and dotted)"];

/** `1`, `1 and 2`, `1, 2 and 3`. */
const listed = (names) => (names.length > 1 ? `${names.slice(0, -1).join(", ")} and ${names.at(-1)}` : names.join());

const around = (graph, dart) => graph.darts(graph.vertex(dart));
const isAt = (graph, place, pose) => place !== null && graph.vertex(place) === graph.vertex(pose);
const ends = (graph, dart) => [dart, graph.opposite(dart)].filter((end) => end !== null);
const replaced = (places, at, place) => places.map((before, index) => (index === at ? place : before));

const lying = (count) => [NOTHING, "marker"][count] ?? `${count} markers`;
const these = (numbers) => (numbers.length === 0 ? NOTHING : `${listed(numbers.map((at) => LOOKS[at]))} marker`);
const pointing = (graph, along, pose) =>
  isAt(graph, along, pose) ? `marker along door ${graph.door(pose, along)}` : NOTHING;

/**
 * An aid, with what a fixed marker does. Its own are:
 *
 * - `sightings(graph, places, pose)`: what a robot that came in by the dart `pose` may sense; several if an open dart decides;
 * - `starts(graph, facing)`: the poses, besides the facing dart, in which the robot may begin;
 * - `parts(graph, places)`: what a drawing shows: darts, and how each is drawn;
 * - `words(places, names)`: where it is, in words;
 * - `text(places, names)`: its state, after the pose of the robot; `signs` explains it;
 * - `actions(graph, places, pose)` beside doors, and the places after one by `act`; null if a map, where two places may be
 *   one, does not show them;
 * - `leave(graph, places, dart)`: the places after the robot left by the dart, or null if it cannot;
 * - `carried`: what the robot picks up and drops, or null; and `held(places)`: what it holds, in words, or nothing;
 * - `elsewhere`: that a robot perceives it where a map does not show it.
 */
const aid = (own) => ({
  thing: "the marker",
  carried: null,
  signs: "",
  elsewhere: "The marker lies here, and on your map it lies elsewhere",
  /** The number of other robots. */
  others: 0,
  held: () => "",
  placed: (graph, facing) => [facing],
  text: () => "",
  actions: () => [],
  act: (graph, places) => places,
  leave: (graph, places) => places,
  ...own,
});

const HELD = "The robot carries the marker.";
const NO_MARKER = {
  sightings: () => [NOTHING],
  starts: (graph) => [...graph.far.keys()],
  parts: () => [],
  words: () => "There is no marker.",
};
/** One marker that lies at a vertex. */
const LYING = {
  sightings: (graph, [place], pose) => [isAt(graph, place, pose) ? "marker" : NOTHING],
  starts: around,
  parts: (graph, [place]) => [{ dart: place, drawn: "lying" }],
  words: ([place], { vertex }) => `The marker lies at ${vertex(place)}.`,
};
/** One marker that points along a dart, or is carried. */
const POINTING = {
  sightings: (graph, [along], pose) => [pointing(graph, along, pose)],
  starts: () => [],
  parts: (graph, [along]) => (along === null ? [] : [{ dart: along, drawn: "pointing" }]),
  words: ([along], { vertex, index }) =>
    along === null ? HELD : `The marker lies at ${vertex(along)}, along the small number ${index(along)}.`,
};
/** A mark on the edge of a dart. */
const ON_EDGE = {
  starts: (graph, facing) => [graph.opposite(facing)],
  elsewhere: "You passed the mark, and on your map the mark is elsewhere",
};
/** A marker at each end of the edge of a dart. */
const AT_ENDS = {
  thing: "the markers",
  parts: (graph, [dart]) => ends(graph, dart).map((end) => ({ dart: end, drawn: "lying" })),
  words: ([dart], { graph, vertex }) => `The markers lie at ${listed(ends(graph, dart).map(vertex))}.`,
};

/** Undirected markers that are carried. */
function movable(count, areAlike = true) {
  const numbers = [...Array(count).keys()];
  const here = (graph, places, pose) => numbers.filter((at) => isAt(graph, places[at], pose));
  const held = (places) => numbers.filter((at) => places[at] === null);
  const look = (at) => (areAlike ? 0 : at);
  const sorted = (places) => (areAlike ? places.sort((one, two) => (one ?? -1) - (two ?? -1)) : places);
  const handful = (carried) => {
    const some = count === 1 ? "the marker" : carried.length > 1 ? `${carried.length} markers` : "a marker";
    return areAlike ? some : `the ${these(carried)}`;
  };
  return aid({
    thing: count > 1 ? "the markers" : "the marker",
    carried: count > 1 ? "a marker" : "the marker",
    elsewhere: count > 1 ? "The markers that lie here lie elsewhere on your map" : aid({}).elsewhere,
    held: (places) => (held(places).length > 0 ? `you carry ${handful(held(places))}` : ""),
    signs: "@ is the place of a marker, +marker that it is carried.",
    placed: (graph, facing) => numbers.map(() => around(graph, facing)[0]),
    sightings(graph, places, pose) {
      const found = here(graph, places, pose);
      return [areAlike ? lying(found.length) : these(found)];
    },
    starts: around,
    parts(graph, places) {
      const drawn = (at) => ["lying", ...LOOKS.slice(1)][look(at)];
      return numbers.filter((at) => places[at] !== null).map((at) => ({ dart: places[at], drawn: drawn(at) }));
    },
    words(places, { vertex }) {
      const lie = numbers.filter((at) => places[at] !== null).map((at) => vertex(places[at]) + DRAWN_AS[look(at)]);
      const carried = held(places);
      const where = lie.length > 1 ? `The markers lie at ${listed(lie)}.` : `${count > 1 ? "A" : "The"} marker lies at ${lie}.`;
      return [...(lie.length ? [where] : []), ...(carried.length ? [`The robot carries ${handful(carried)}.`] : [])].join(" ");
    },
    text: (places, { vertex }) => places.map((place) => (place === null ? "+marker" : `@${vertex(place)}`)).join(""),
    actions(graph, places, pose) {
      const [found, carried] = [here(graph, places, pose), held(places)];
      if (areAlike) return [...(found.length ? [PICK_UP] : []), ...(carried.length ? [DROP] : [])];
      return [...found.map((at) => `${PICK_UP}-${at + 1}`), ...carried.map((at) => `${DROP}-${at + 1}`)];
    },
    act(graph, places, pose, action) {
      const isDrop = action.startsWith(DROP);
      const [first] = isDrop ? held(places) : here(graph, places, pose);
      const at = areAlike ? first ?? (count > 1 ? null : 0) : Number(action.match(/\d+$/)[0]) - 1;
      return at === null ? null : sorted(replaced(places, at, isDrop ? around(graph, pose)[0] : null));
    },
  });
}

/**
 * A string that the robot pays out, so long in edges; a page has none in a world in which it is not seen everywhere. Its
 * places: the fixed end, the darts by which it leaves vertices, the free end.
 */
function string(length) {
  const way = (places) => places.slice(1, -1);
  const free = (places) => places.at(-1);
  const behind = (graph, places) => (places.length > 2 ? graph.opposite(places.at(-2)) : null);
  const left = (places) => length - way(places).length;
  return aid({
    thing: "the string",
    carried: "the end of the string",
    elsewhere: "The string is here, and on your map it is elsewhere",
    held(places) {
      const more = left(places) === 0 ? "all of it is laid out" : `there is string for ${left(places)} more edge${left(places) > 1 ? "s" : ""}`;
      return free(places) === null ? `you hold its end, and ${more}` : "";
    },
    signs: "~ are the darts by which the string leaves places, @ is the place of its free end, +string that the robot holds it.",
    placed: (graph, facing) => [around(graph, facing)[0], null],
    sightings(graph, places, pose) {
      const door = (dart) => graph.door(pose, dart);
      const darts = way(places).flatMap((dart) => ends(graph, dart));
      const doors = [...new Set(darts.filter((dart) => isAt(graph, dart, pose)).map(door))].sort((one, two) => one - two);
      const hand = free(places) === null ? behind(graph, places) : null;
      const seen = [
        ...(doors.length ? [`string through door${doors.length > 1 ? "s" : ""} ${listed(doors)}`] : []),
        ...(hand === null ? [] : [`from the hand through door ${door(hand)}`]),
        ...(isAt(graph, places[0], pose) ? ["fixed end"] : []),
        ...(isAt(graph, free(places), pose) ? ["free end"] : []),
      ];
      return [seen.join(", ") || NOTHING];
    },
    starts: around,
    parts(graph, places) {
      const edges = way(places).map((dart) => ({ dart, drawn: "string" }));
      const lies = free(places) === null ? [] : [{ dart: free(places), drawn: "lying" }];
      return [{ dart: places[0], drawn: "third" }, ...lies, ...edges];
    },
    words(places, { graph, vertex }) {
      const on = way(places).map((dart) => vertex(graph.opposite(dart)));
      const runs = on.length ? `, runs to ${on.join(", then ")}` : "";
      const end = free(places) === null ? "the robot holds the other end" : `its free end lies at ${vertex(free(places))}`;
      return `The string is fixed at ${vertex(places[0])} (dotted)${runs}, and ${end}.`;
    },
    text(places, { dart, vertex }) {
      const end = free(places) === null ? "+string" : `@${vertex(free(places))}`;
      return way(places).map((by) => `~${dart(by)}`).join("") + end;
    },
    actions(graph, places, pose) {
      if (free(places) === null) return [DROP];
      return isAt(graph, free(places), pose) ? [PICK_UP] : [];
    },
    act(graph, places, pose, action) {
      if (action === PICK_UP && !isAt(graph, free(places), pose)) return null;
      return replaced(places, places.length - 1, action === DROP ? around(graph, pose)[0] : null);
    },
    leave(graph, places, by) {
      if (free(places) !== null) return places;
      if (behind(graph, places) === by) return [...places.slice(0, -2), null];
      return places.length - 2 < length ? [...places.slice(0, -1), by, null] : null;
    },
  });
}

/** Other robots, each with the dart behind it. */
function team(count, showsHeading) {
  const along = (graph, from, to) => (showsHeading ? ` along door ${graph.door(from, to)}` : "");
  return aid({
    thing: count > 2 ? "the other robots" : "the other robot",
    others: count - 1,
    elsewhere: "Robots that are apart on your map are at one place",
    signs: "&2@ is where robot 2 is, and the small number of the door by which it has come in.",
    placed: (graph, facing) => Array(count - 1).fill(facing),
    sightings(graph, poses, pose) {
      const place = (other, number) => {
        if (isAt(graph, other, pose)) return `here${along(graph, pose, other)}`;
        const second = number > 0 && isAt(graph, other, poses[0]);
        return second ? `with robot 2${along(graph, poses[0], other)}` : `elsewhere at ${doorsText(graph.degree(other))}`;
      };
      return [poses.map((other, number) => `robot ${number + 2} ${place(other, number)}`).join(", ")];
    },
    starts: () => [],
    parts: (graph, poses) =>
      poses.map((dart, number) => ({ dart, drawn: showsHeading ? "robot" : "round robot", number: number + 2 })),
    words(poses, { vertex, index }) {
      const where = (dart) => `at ${vertex(dart)}, by the small number ${index(dart)}`;
      return poses.map((dart, number) => `Robot ${number + 2} is ${where(dart)}.`).join(" ");
    },
    text: (poses, { dart }) => poses.map((pose, number) => `&${number + 2}@${dart(pose)}`).join(""),
    actions(graph, poses) {
      const doors = (dart) => [...Array(graph.degree(dart)).keys()];
      return poses.flatMap((dart, number) => doors(dart).map((door) => `send-${number + 2}:${door}`));
    },
    act(graph, poses, pose, action) {
      const { robot, door } = order(action);
      return replaced(poses, robot - 2, graph.opposite(graph.turned(poses[robot - 2], door)));
    },
  });
}

/** No marker, but a robot that sees the ball of this radius. A page has none in a world in which it is not seen everywhere. */
function binoculars(radius) {
  const clockwise = (graph, dart) => [...Array(graph.degree(dart)).keys()].map((door) => graph.turned(dart, door));
  return aid({
    ...NO_MARKER,
    sightings(graph, places, pose) {
      const vertices = [{ darts: clockwise(graph, pose), distance: 0 }];
      const place = (dart) => vertices.findIndex(({ darts }) => darts.includes(dart));
      for (const { darts, distance } of vertices) {
        if (distance === radius) break;
        for (const far of darts.map((dart) => graph.opposite(dart))) {
          if (place(far) < 0) vertices.push({ darts: clockwise(graph, far), distance: distance + 1 });
        }
      }
      const behind = ({ darts }, here) => {
        const theres = darts.map((dart) => place(graph.opposite(dart)));
        const door = (there, at) => {
          const isOneOfSeveral = there === here || theres.filter((other) => other === there).length > 1;
          return isOneOfSeveral ? `${there}:${vertices[there].darts.indexOf(graph.opposite(darts[at]))}` : there;
        };
        return theres.map((there, at) => (there < 0 ? "-" : door(there, at))).join(" ");
      };
      const junctions = vertices.length === 1 ? "1 junction" : `${vertices.length} junctions`;
      return [`sees ${junctions}: ${vertices.map(behind).join(", ")}`];
    },
  });
}

/** The robot that an action sends, and the door, or null. */
function order(action) {
  const sent = action.match(/^send-(\d+):(\d+)$/)?.slice(1).map(Number);
  return sent === undefined ? null : { robot: sent[0], door: sent[1] };
}

/** Which robot an action moves, 0 for the explorer, and through which of its doors; null if it moves none. */
function moverOf(action) {
  const sent = order(action);
  if (sent !== null) return { robot: sent.robot - 1, door: sent.door };
  return { robot: 0, door: isDoor(action) ? Number(action) : null };
}

const AIDS = {
  none: aid(NO_MARKER),
  undirected: aid(LYING),
  directional: aid(POINTING),
  "undirected-edge": aid({
    ...ON_EDGE,
    sightings: (graph, [dart], pose) => [ends(graph, dart).includes(pose) ? PASSED : NOTHING],
    parts: (graph, [dart]) => [{ dart, drawn: "edge" }],
    words: ([dart], { edge }) => `The edge ${edge(dart)} is marked.`,
  }),
  "directed-edge": aid({
    ...ON_EDGE,
    sightings: (graph, [dart], pose) => [pose === dart ? AGAINST : pose === graph.opposite(dart) ? ALONG : NOTHING],
    parts: (graph, [dart]) => [{ dart, drawn: "arrow" }],
    words: ([dart], { edge, vertex }) => `The edge ${edge(dart)} is marked with an arrow away from ${vertex(dart)}.`,
  }),
  "two-identical": aid({
    ...AT_ENDS,
    sightings(graph, [dart], pose) {
      const known = ends(graph, dart).filter((end) => isAt(graph, end, pose)).length;
      return (graph.opposite(dart) === null ? [known, known + 1] : [known]).map(lying);
    },
    starts: (graph, dart) => ends(graph, dart).flatMap((end) => around(graph, end)).sort((one, two) => one - two),
  }),
  "two-distinct": aid({
    ...AT_ENDS,
    sightings(graph, [dart], pose) {
      const known = [dart, graph.opposite(dart)].flatMap((end, at) => (isAt(graph, end, pose) ? [at] : []));
      return (graph.opposite(dart) === null ? [known, [...known, 1]] : [known]).map(these);
    },
    starts: around,
    parts: (graph, [dart]) => ends(graph, dart).map((end, at) => ({ dart: end, drawn: ["lying", "second"][at] })),
    words: ([dart], { graph, vertex }) =>
      `The markers lie at ${listed(ends(graph, dart).map((end, at) => vertex(end) + DRAWN_AS[at]))}.`,
  }),
  [MOVABLE]: movable(1),
  "movable-2": movable(2),
  "movable-3": movable(3),
  "movable-4": movable(4),
  "movable-2-distinct": movable(2, false),
  "movable-3-distinct": movable(3, false),
  "movable-4-distinct": movable(4, false),
  "movable-directional": aid({
    ...POINTING,
    signs: "@ is where the marker lies and points, +marker that it is carried.",
    text: ([along], { dart }) => (along === null ? "+marker" : `@${dart(along)}`),
    actions: (graph, [along], pose) => (along === null ? [DROP] : isAt(graph, along, pose) ? [PICK_UP] : []),
    act: (graph, places, pose, action) => [action === DROP ? pose : null],
    carried: "the marker",
    held: ([along]) => (along === null ? "you carry the marker" : ""),
  }),
  "movable+directional": aid({
    thing: "the markers",
    elsewhere: "The markers that lie here lie elsewhere on your map",
    signs: "@ is the place of the movable marker, +marker that it is carried.",
    placed: (graph, facing) => [facing, around(graph, facing)[0]],
    sightings(graph, [along, place], pose) {
      const pointer = isAt(graph, along, pose) ? [`directional ${pointing(graph, along, pose)}`] : [];
      return [[...pointer, ...(isAt(graph, place, pose) ? ["movable marker"] : [])].join(", ") || NOTHING];
    },
    starts: () => [],
    parts: (graph, [along, place]) => [{ dart: along, drawn: "pointing" }, ...(place === null ? [] : LYING.parts(graph, [place]))],
    words: ([along, place], names) =>
      `The directional marker lies at ${names.vertex(along)}, along the small number ${names.index(along)}. ` +
      (place === null ? "The robot carries the movable marker." : `The movable marker lies at ${names.vertex(place)}.`),
    text: ([, place], { vertex }) => (place === null ? "+marker" : `@${vertex(place)}`),
    actions: (graph, [, place], pose) => (place === null ? [DROP] : isAt(graph, place, pose) ? [PICK_UP] : []),
    act: (graph, [along], pose, action) => [along, action === DROP ? around(graph, pose)[0] : null],
    carried: "the movable marker",
    held: ([, place]) => (place === null ? "you carry the movable marker" : ""),
  }),
  "string-1": string(1),
  "string-2": string(2),
  "string-3": string(3),
  "team-2": team(2, true),
  "team-2-round": team(2, false),
  "team-3": team(3, true),
  "team-3-round": team(3, false),
  "binoculars-1": binoculars(1),
  "binoculars-2": binoculars(2),
  "binoculars-3": binoculars(3),
};

/**
 * What a percept shows of the aid at the robot's place, or on the edge behind it: each fact as a text, and the door that
 * it is about, or null; and which other robots are together. That one is elsewhere is no fact.
 */
function factsOf({ degree, sighting }) {
  if (sighting.startsWith(PASSED)) return [{ text: sighting, door: null }];
  const found = (pattern) => [...sighting.matchAll(pattern)];
  const fact = (text, door) => ({ text, door: door === undefined ? null : Number(door) });
  const count = sighting === "marker" ? 1 : Number(sighting.match(/^(\d+) markers$/)?.[1] ?? 0);
  const looks = sighting.endsWith(" marker") ? LOOKS.filter((look) => sighting.includes(look)) : [];
  const strings = found(/string through doors? ([\d, and]*\d)/g).flatMap(([, doors]) => doors.match(/\d+/g));
  const robots = found(/(robot \d) here(?: along door (\d+))?/g).map(([, robot, door]) => fact(robot, door));
  const [second, third] = robots;
  const turn = third?.door === null ? "" : ` along door ${(third?.door - second?.door + degree) % degree}`;
  return [
    ...[...Array(count).keys()].map((number) => fact(`marker ${number}`)),
    ...looks.map((look) => fact(look)),
    ...found(/marker along door (\d+)/g).map(([, door]) => fact("pointing", door)),
    ...found(/movable marker$/g).map(() => fact("marker 0")),
    ...strings.map((door) => fact("string", door)),
    ...found(/from the hand through door (\d+)/g).map(([, door]) => fact("hand", door)),
    ...found(/fixed end|free end/g).map(([end]) => fact(end)),
    ...robots,
    ...(third === undefined ? [] : [fact(`robot 3 with robot 2${turn}`)]),
    ...found(/robot \d with robot \d(?: along door \d+)?/g).map(([text]) => fact(text)),
  ];
}

/** The numbers of doors of the places of all robots, the explorer first. */
function degreesOf({ degree, sighting }) {
  const degrees = [degree];
  for (const [, place, far] of sighting.matchAll(/robot \d (here|with robot 2|elsewhere at (\d+) door)/g)) {
    degrees.push({ here: degree, "with robot 2": degrees[1] }[place] ?? Number(far));
  }
  return degrees;
}

/**
 * What a percept shows about a place or an edge: a key and a value. In one world, percepts with the same key have the
 * same value as long as nothing of the aid moves.
 */
function shownBy(marker, graph, pose, sighting) {
  if (marker === "undirected-edge" || marker === "directed-edge") {
    const far = graph.opposite(pose);
    if (far === null || pose < far) return [`edge ${pose}`, sighting];
    return [`edge ${far}`, { [AGAINST]: ALONG, [ALONG]: AGAINST }[sighting] ?? sighting];
  }
  const facts = factsOf({ degree: graph.degree(pose), sighting }).map(({ text, door }) => (door === null ? text : `${text} ${graph.turned(pose, door)}`));
  return [`vertex ${graph.vertex(pose)}`, facts.sort().join()];
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
/** Whether a robot traverses an edge. */
const isMove = (action) => moverOf(action).door !== null;

/** An action in words. */
function called(action) {
  if (isDoor(action)) return `door ${action}`;
  const sent = order(action);
  if (sent !== null) return `send robot ${sent.robot} through door ${sent.door}`;
  const [, verb, number] = action.match(/^(pick-up|drop)-?(\d*)$/);
  return verb.replace("-", " ") + (number && ` the ${LOOKS[number - 1]} marker`);
}

/** A robot in a world with an aid. */
class Robot {
  constructor(aid, graph, pose, placed) {
    Object.assign(this, { aid, graph, pose, placed });
  }

  /** The robot at a start, with the aid of this name. */
  static start(name, graph, pose, facing = pose) {
    return new Robot(AIDS[name], graph, pose, AIDS[name].placed(graph, facing));
  }

  /** The robot after one of the actions. */
  after(action) {
    const robot = new Robot(this.aid, this.graph, this.pose, this.placed);
    robot.act(action);
    return robot;
  }

  get carries() {
    return this.placed.includes(null);
  }

  /** What it holds, in words, or nothing. */
  get held() {
    return this.aid.held(this.placed);
  }

  get parts() {
    return this.aid.parts(this.graph, this.placed);
  }

  percept() {
    const [sighting] = this.aid.sightings(this.graph, this.placed, this.pose);
    return { degree: this.graph.degree(this.pose), sighting };
  }

  /** What the robot can do: the numbers of doors as texts, and the actions of the aid. */
  actions() {
    const { aid, graph, placed, pose } = this;
    const canLeave = (door) => aid.leave(graph, placed, graph.turned(pose, door)) !== null;
    const doors = [...Array(graph.degree(pose)).keys()].filter(canLeave).map(String);
    return [...doors, ...aid.actions(graph, placed, pose)];
  }

  /** Does one of the actions. */
  act(action) {
    const { aid, graph, placed, pose } = this;
    if (isDoor(action)) {
      const by = graph.turned(pose, Number(action));
      this.placed = aid.leave(graph, placed, by);
      this.pose = graph.opposite(by);
    } else {
      this.placed = aid.act(graph, placed, pose, action);
    }
  }
}
