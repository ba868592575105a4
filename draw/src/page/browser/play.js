// The game: the person takes doors and makes claims; the page shows the map that follows, and judges it.

const data = JSON.parse(find("#data").textContent);
const { marker } = data;
const games = data.games.map(({ world, start, ...rest }, number) => {
  const graph = Graph.of(world);
  return { ...rest, number, graph, start: graph.dart(start), picture: document.querySelectorAll(".picture")[number] };
});

/** The world to map, and the robot that is truly in it. */
let [game] = games;
let robot;
/** The walk so far, and the claims about it: each that two poses are one. A pose is a number of actions and a turn. */
let percepts, actions, claims;
/** The folded map, and the contradiction of the last percept with the claims, if there is one. */
let map, contradiction;
/** The names of the places, by the least place of the trail; a place gets one when the robot leaves it. */
let names;
let finished = false;

const write = (selector, text) => {
  find(selector).textContent = text;
};

const here = new Here(find(".here"), act);
const drawing = new MapDrawing(find(".play .drawing"), choose);
const otherDrawing = new MapDrawing(find(".other .drawing"), () => {});
const walk = new Percepts(find(".percepts"));

const movesText = (count) => (count === 1 ? "1 move" : `${count} moves`);
const sizeText = (graph) => `${graph.vertexCount === 1 ? "1 place" : `${graph.vertexCount} places`}`;
const movesUpTo = (time) => actions.slice(0, time).filter(isDoor).length;

/** The vertices of the map, by their names; one that the robot has just reached has none. */
const nameOf = (vertex) => names.get(map.numbers[vertex]) ?? "?";
const pose = () => map.poses.at(-1);
const current = () => map.graph.vertex(pose());
const vertexOf = (number) => map.numbers.indexOf(number);

/** Where the robot was after so many actions, by the map before a contradiction. */
function placeAfter(time) {
  const name = time < map.poses.length ? nameOf(map.graph.vertex(map.poses[time])) : "?";
  return name === "?" ? "this place" : name;
}

/** Folds the walk with the claims. A claim that contradicts it is not made: then the error is returned. */
function fold() {
  try {
    map = new FoldedMap(marker, percepts, actions, claims);
    contradiction = null;
  } catch (error) {
    if (!(error instanceof Contradiction)) throw error;
    contradiction = error;
  }
  return contradiction;
}

function nameCurrent() {
  const number = map.numbers[current()];
  if (!names.has(number)) names.set(number, `v${names.size}`);
}

/** The robot goes through a door, or picks up or drops the marker. */
function act(action) {
  if (finished) return say("The run has ended. Restart it to try again.");
  if (!robot.actions().includes(action)) {
    const carrying = robot.carries ? "You carry the marker already." : "The marker is not here.";
    if (isDoor(action)) return say(`There is no door ${action} here.`);
    return say(action === DROP ? "You do not carry the marker." : carrying);
  }
  if (contradiction === null && isDoor(action)) nameCurrent();
  robot.act(action);
  percepts.push(robot.percept());
  actions.push(action);
  fold();
  show();
  const at = `Move ${movesUpTo(actions.length)}, ${called(action)}: ${perceptText(percepts.at(-1))}.`;
  say(`${at} ${contradiction === null ? placeText() : wrongClaim()}`);
}

/** Where the robot is on the map, and whether the marker shows that it is elsewhere. */
function placeText() {
  const isKnown = names.has(map.numbers[current()]);
  const text = isKnown ? `On your map, this is ${nameOf(current())}.` : "On your map, this is a new place.";
  const { sighting } = percepts.at(-1);
  const expected = AIDS[marker].sightings(map.graph, map.placed(actions), pose());
  if (sighting === NOTHING || expected.includes(sighting)) return text;
  const prompt = sighting.startsWith(PASSED)
    ? "You passed the mark, and on your map the mark is elsewhere"
    : "The marker lies here, and on your map it lies elsewhere";
  return `${text} ${prompt}: you know this place, so claim it.`;
}

const wrongClaim = () => `A claim of yours is wrong: ${contradiction.text(placeAfter)}. Withdraw it.`;

/** Claims that the robot's pose is a dart of a vertex of the map. */
function claim(vertex, index) {
  if (finished) return;
  if (contradiction !== null) return say(wrongClaim());
  const dart = map.graph.dart([vertex, index]);
  const name = nameOf(vertex);
  if (pose() === dart) return say(`On your map, the robot came in by door ${index} of ${name}.`);
  const time = map.poses.findIndex((at) => map.graph.vertex(at) === vertex);
  claims.push([[time, map.graph.door(map.poses[time], dart)], [actions.length, 0]]);
  if (fold() !== null) {
    const refused = contradiction.text(placeAfter);
    claims.pop();
    fold();
    show();
    return say(`This cannot be door ${index} of ${name}: ${refused}.`);
  }
  show();
  say(`This place is ${name}, and you came in by its door ${index}.`);
}

/** A claim in words. */
function claimText([[earlier, turn], [time]]) {
  const [vertex, index] = map.graph.end(map.graph.turned(map.poses[earlier], turn));
  return `Move ${movesUpTo(time)}: ${nameOf(vertex)}, by its door ${index}`;
}

function withdraw(claimed) {
  if (finished) return;
  if (claimed === undefined) return say("There is no claim to withdraw.");
  const text = claimText(claimed);
  claims = claims.filter((other) => other !== claimed);
  fold();
  if (contradiction === null) nameEarlier();
  show();
  say(contradiction === null ? `Withdrawn: ${text}. ${placeText()}` : wrongClaim());
}

/** Places that were one with others need names again, but for the one where the robot is. */
function nameEarlier() {
  for (const [vertex, number] of map.numbers.entries()) {
    if (vertex !== current() && !names.has(number)) names.set(number, `v${names.size}`);
  }
}

/** Whether the person agrees to discard a run that has not ended. */
const mayDiscard = () =>
  finished || actions.length === 0 || confirm(`Discard this run of ${movesText(movesUpTo(actions.length))}?`);

function restart() {
  if (mayDiscard()) begin(game);
}

function nextWorld() {
  if (mayDiscard()) begin(games[(game.number + 1) % games.length]);
}

function begin(chosen) {
  game = chosen;
  robot = Robot.start(marker, game.graph, game.start);
  [percepts, actions, claims] = [[robot.percept()], [], []];
  names = new Map([[0, "v0"]]);
  finished = false;
  find(".result").hidden = true;
  find(".doors").hidden = false;
  find(".solution .ground").replaceChildren();
  walk.clear();
  drawing.clear();
  fold();
  show();
  const which = games.length > 1 ? `World ${game.number + 1} of ${games.length}. ` : "";
  say(`${which}You begin: ${perceptText(percepts[0])}. Choose a door.`);
}

// The end.

/** Judges the map and shows the world. */
function finish() {
  if (finished) return;
  if (contradiction !== null) return say(wrongClaim());
  const fault = faultOf(map.graph, pose(), game.graph, game.start, robot.pose);
  if (fault?.kind === "open") {
    const open = nameOf(fault.vertex);
    return say(`The map is not complete: a door of ${open === "?" ? "this place" : open} leads nowhere.`);
  }
  finished = true;
  nameEarlier();
  nameCurrent();
  const other = fault === null ? otherWorld() : null;
  const { tone, heading, reason } = fault === null ? rightText(other) : { tone: "diverged", heading: "Wrong map", reason: faultText(fault) };
  find(".verdict").className = `verdict ${tone}`;
  write("#result-heading", heading);
  write(".reason", reason);
  compare(fault === null);
  find(".solution .ground").replaceChildren(game.picture.content.cloneNode(true));
  write(".solution .name", game.name);
  find(".result").hidden = false;
  showWorld();
  find(".doors").hidden = true;
  showOther(other);
  show();
  find("#result-heading").focus();
  find(".result").scrollIntoView();
  say(`The run has ended. ${heading}.`);
}

/** The smallest other world that explains the walk. */
function otherWorld() {
  const trail = marker === "directional" ? foldedTrail(percepts, actions) : null;
  if (trail?.open().length === 0) return { world: null, isComplete: true };
  const isTrue = (graph) => faultOf(graph, 0, game.graph, game.start, game.start) === null;
  const search = new WorldSearch(marker, percepts, actions, isTrue);
  const found = search.run();
  // Behind an open door of the folded trail, there may be anything.
  return trail !== null && found.world === null ? { world: search.closing(trail), isSmallest: false } : found;
}

function rightText({ world, isComplete }) {
  const right = "Your map is the world, and the robot is where you believe it to be.";
  if (world !== null) {
    const reason = `${right} But you guessed: in the other world below, too, a robot that takes your doors perceives what you perceived, and your map would be wrong.`;
    return { tone: "not-known", heading: "Right, but guessed", reason };
  }
  if (isComplete) {
    const reason = `${right} Your walk fits no other world: no robot that perceives this can be anywhere else.`;
    return { tone: "conforms", heading: "Right, and proved", reason };
  }
  const reason = `${right} Whether another world fits your walk is not known: the search for one reached its limit.`;
  return { tone: "not-known", heading: "Right, proof not known", reason };
}

function faultText({ kind, vertex, degree, vertices }) {
  const yours = (number) => `your ${nameOf(number)}`;
  if (kind === "degree") {
    return `Your map is not the world: ${yours(vertex)} has ${doorsText(map.graph.degrees[vertex])}, and the place of the world that it stands for has ${degree}.`;
  }
  if (kind === "several") {
    return `Your map is not the world: ${yours(vertex)} stands for several places of the world, or for one that is turned.`;
  }
  if (kind === "twice") {
    const [one, other] = vertices.map(yours);
    return `Your map is not the world: ${one} and ${other} are one place of the world.`;
  }
  return "Your map is the world, but the robot is not where you believe it to be.";
}

/** Crops the picture of the world, so that the numbers of its doors are readable. */
function showWorld() {
  const svg = find(".solution svg");
  crop(svg);
  label(svg, `The world ${game.name}`);
  const sizes = [...svg.querySelectorAll("text")].map((text) => parseFloat(getComputedStyle(text).fontSize));
  keepReadable(svg, Math.min(...sizes));
}

/** Draws the other world, with the robot and the marker as they are at the end of the walk. */
function showOther(other) {
  const graph = other?.world ?? null;
  find(".other").hidden = graph === null;
  if (graph === null) return;
  const ghost = Robot.start(marker, graph, 0);
  for (const action of actions) ghost.act(action);
  const numbers = [...graph.first.keys()];
  write(".other .kind", other.isSmallest ? "The smallest other world" : "Another world");
  write(".other .size", `${sizeText(graph)}, ${graph.dartCount / 2} edges`);
  otherDrawing.clear();
  otherDrawing.show({
    graph,
    numbers,
    names: numbers.map((number) => `w${number}`),
    pose: ghost.pose,
    parts: ghost.parts,
  });
}

/** The table of moves: the certificate, the person, and the algorithms of this marker. */
function compare(right) {
  const own = { name: right ? "You" : "You (wrong map)", actions };
  const [shortest] = game.walks.filter(({ isShortest }) => isShortest);
  const rows = [...(shortest ? [shortest] : []), own, ...game.walks.filter(({ isShortest }) => !isShortest)];
  const moves = ({ actions: taken }) => taken.filter(isDoor).length;
  const cell = (text, style) => Object.assign(document.createElement("td"), { textContent: text, className: style });
  const drawnRows = rows.map((taken) => {
    const row = document.createElement("tr");
    row.classList.toggle("own", taken === own);
    const head = Object.assign(document.createElement("th"), { scope: "row", textContent: taken.name });
    const ratio = shortest ? [cell((moves(taken) / moves(shortest)).toFixed(2), "right")] : [];
    row.append(head, cell(moves(taken), "right"), ...ratio, cell(taken.actions.join(" "), "faint"));
    return row;
  });
  find(".comparison .ratio").hidden = !shortest;
  find(".comparison tbody").replaceChildren(...drawnRows);
}

// Showing.

function show() {
  const now = percepts.at(-1);
  here.show(now, robot.carries);
  write(".play .percept", perceptText(now) + (robot.carries ? "; you carry the marker" : ""));
  write(".moves", movesText(movesUpTo(actions.length)));
  document.body.classList.toggle("begun", actions.length > 0);
  const parts = contradiction === null ? AIDS[marker].parts(map.graph, map.placed(actions)) : [];
  const { graph, numbers } = map;
  drawing.show({ graph, numbers, names: numbers.map((_, vertex) => nameOf(vertex)), pose: contradiction === null ? pose() : null, parts });
  find(".map").classList.toggle("differs", contradiction !== null);
  showSize();
  showList(parts);
  showWalk();
  showActions();
  showClaim();
  showClaims();
}

function showSize() {
  const open = map.graph.open().length;
  write(".map .size", `${sizeText(map.graph)}, ${open === 0 ? "no" : open} open door${open === 1 ? "" : "s"}`);
}

/** Where a dart of the map leads, in words. */
function leadsTo(dart) {
  const far = map.graph.opposite(dart);
  return far === null ? "open" : `to door ${map.graph.index(far)} of ${nameOf(map.graph.vertex(far))}`;
}

/** Where a part of the marker is, in words, if it is at a place or behind its doors. */
function partText({ dart, drawn }) {
  const door = map.graph.index(dart);
  const texts = { pointing: `the marker along door ${door}`, edge: `the mark behind door ${door}`, arrow: `the mark behind door ${door}` };
  return texts[drawn] ?? (drawn === "second" ? "the second marker" : "the marker");
}

function showList(parts) {
  const items = map.numbers.map((_, vertex) => {
    const marked = parts.filter(({ dart }) => map.graph.vertex(dart) === vertex).map((part) => `, ${partText(part)}`);
    const at = contradiction === null && vertex === current() ? " (you are here)" : "";
    const ways = map.graph.darts(vertex).map((dart, index) => `${index} ${leadsTo(dart)}`).join(", ");
    return Object.assign(document.createElement("li"), { textContent: `${nameOf(vertex)}${at}${marked.join("")}: ${ways}` });
  });
  find(".listed ul").replaceChildren(...items);
}

function showWalk() {
  for (let step = walk.length; step < percepts.length; step += 1) {
    walk.add(actions[step - 1], [perceptText(percepts[step])]);
  }
}

/** A button for each action. */
function showActions() {
  const row = find(".doors");
  const focused = [...row.children].indexOf(document.activeElement);
  const buttons = robot.actions().map((action) => actionButton(action, () => act(action)));
  row.replaceChildren(...buttons);
  if (focused >= 0) buttons[Math.min(focused, buttons.length - 1)].focus();
}

/** The places that the robot may be at, but for the one where it is on the map. */
function showClaim() {
  const others = contradiction === null ? [...map.numbers.keys()].filter((vertex) => vertex !== current()) : [];
  const options = others.map((vertex) => {
    const text = `${nameOf(vertex)}, ${doorsText(map.graph.degrees[vertex])}`;
    return Object.assign(document.createElement("option"), { value: map.numbers[vertex], textContent: text });
  });
  const chosen = find("#place").value;
  find("#place").replaceChildren(...options);
  if (options.some(({ value }) => value === chosen)) find("#place").value = chosen;
  showDarts();
  for (const id of ["#claim", "#place", "#dart"]) find(id).disabled = finished || options.length === 0;
  find("#finish").setAttribute("aria-disabled", String(finished));
}

function showDarts() {
  const vertex = vertexOf(Number(find("#place").value || NaN));
  const darts = vertex < 0 ? [] : map.graph.darts(vertex);
  const options = darts.map((dart, index) => {
    const text = `${index}, ${leadsTo(dart)}`;
    return Object.assign(document.createElement("option"), { value: index, textContent: text });
  });
  const open = darts.findIndex((dart) => map.graph.opposite(dart) === null);
  find("#dart").replaceChildren(...options);
  if (open >= 0) find("#dart").value = open;
}

/** The claims, each with a button that withdraws it. */
function showClaims() {
  find(".claims").hidden = claims.length === 0;
  const items = claims.map((claimed) => {
    const button = textButton("Withdraw", () => withdraw(claimed));
    button.setAttribute("aria-label", `Withdraw: ${claimText(claimed)}`);
    button.setAttribute("aria-disabled", String(finished));
    const item = document.createElement("li");
    item.append(claimText(claimed), button);
    return item;
  });
  find(".claims ul").replaceChildren(...items);
}

/** A dart was pressed on the map: it is chosen for a claim. */
function choose(number, index) {
  const option = [...find("#place").options].find(({ value }) => value === String(number));
  if (finished || !option) return;
  find("#place").value = number;
  showDarts();
  find("#dart").value = index;
  say(`Claim that this place is ${nameOf(vertexOf(number))}, and that you came in by its door ${index}?`);
  find("#claim").focus();
}

// Buttons and keys.

function submitClaim() {
  if (find("#place").value === "") return say("There is no other place on your map.");
  claim(vertexOf(Number(find("#place").value)), Number(find("#dart").value));
}

find("#place").addEventListener("change", showDarts);
find(".claim").addEventListener("submit", (event) => {
  event.preventDefault();
  submitClaim();
});
find("#finish").addEventListener("click", finish);
find("#restart").addEventListener("click", restart);
find("#another").addEventListener("click", nextWorld);
find("#another").hidden = games.length === 1;

const enlarge = () => drawing.enlarge(ENLARGED);
const reduce = () => drawing.enlarge(1 / ENLARGED);
find("#enlarge").addEventListener("click", enlarge);
find("#reduce").addEventListener("click", reduce);
find("#fit").addEventListener("click", () => drawing.fit());

const keys = {
  "+": enlarge,
  "-": reduce,
  c: () => find("#place").focus(),
  w: () => withdraw(claims.at(-1)),
  f: finish,
  r: restart,
};
if (games.length > 1) keys.n = nextWorld;
if (marker === MOVABLE) Object.assign(keys, { p: () => act(PICK_UP), d: () => act(DROP) });
for (const [selector, isUsed] of [[".of-another", games.length > 1], [".of-movable", marker === MOVABLE]]) {
  find(selector).hidden = !isUsed;
}
onKey((event) => {
  const door = doorOfKey(event);
  const action = door === null ? keys[event.key.toLowerCase()] : () => act(door);
  // A key that is held counts once: each move costs.
  return action && (event.repeat ? () => {} : action);
});

begin(game);
