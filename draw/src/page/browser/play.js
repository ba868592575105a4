// The game: the person takes doors and makes claims; the page shows the map that follows, and judges it.

const data = JSON.parse(find("#data").textContent);
const { marker } = data;
const aidOfGame = AIDS[marker];
const games = data.games.map(({ world, start, ...rest }, number) => {
  const graph = Graph.of(world);
  return { ...rest, number, graph, start: graph.dart(start), picture: document.querySelectorAll(".picture")[number] };
});

/** The world to map, and the robot that is truly in it. */
let [game] = games;
let robot;
/** The walk so far, and the claims about it: each that two poses are one, as a map has them. */
let percepts, actions, claims;
/** The folded map, and the contradiction of the last percept with the claims, if there is one. */
let map, contradiction;
/** The names of the places, by the least place of the trail; a place gets one when a robot leaves it. */
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
const movesUpTo = (time) => actions.slice(0, time).filter(isMove).length;

/** The robots: the explorer, which is number 0, and the others. */
const robotNumbers = [...Array(aidOfGame.others + 1).keys()];
const poseOf = (number) => map.robots[number].at(-1);
const vertexOfRobot = (number) => map.graph.vertex(poseOf(number));
const pose = () => poseOf(0);
const current = () => vertexOfRobot(0);
const vertexOf = (number) => map.numbers.indexOf(number);

/** The vertices of the map, by their names; one that a robot has just reached has none, but is where that robot is. */
const nameOf = (vertex) => names.get(map.numbers[vertex]) ?? (vertex === current() ? "?" : `?${whoIsAt(vertex)}`);
const whoIsAt = (vertex) => robotNumbers.findIndex((number) => vertexOfRobot(number) === vertex) + 1;

/** A place in words. */
function placeText(vertex) {
  if (names.has(map.numbers[vertex])) return nameOf(vertex);
  return vertex === current() ? "this place" : `the place of robot ${whoIsAt(vertex)}`;
}

/** Where a robot was after so many actions, by the map before a contradiction. */
function placeAfter([time, number]) {
  const before = map.robots[number][time];
  return before === undefined ? "this place" : placeText(map.graph.vertex(before));
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

/** Names the places of robots. */
function nameWhere(numbers) {
  for (const number of numbers.map((robot) => map.numbers[vertexOfRobot(robot)])) {
    if (!names.has(number)) names.set(number, `v${names.size}`);
  }
}

/** Why an action is not possible. */
function refusal(action) {
  if (isDoor(action)) {
    const isThere = Number(action) < percepts.at(-1).degree;
    return isThere ? `The string is too short for door ${action}.` : `There is no door ${action} here.`;
  }
  const { carried } = aidOfGame;
  if (carried === null) return "Nothing is picked up or dropped in this game.";
  if (action.startsWith(DROP)) return `You do not carry ${carried}.`;
  if (carried.startsWith("a ")) return `There is no marker here.`;
  return robot.carries ? `You carry ${carried} already.` : `${carried[0].toUpperCase()}${carried.slice(1)} is not here.`;
}

/** A robot goes through a door, or the explorer does something with the aid. */
function act(action) {
  if (finished) return say("The run has ended. Restart it to try again.");
  if (!robot.actions().includes(action)) return say(refusal(action));
  const mover = moverOf(action);
  if (contradiction === null && mover.door !== null) nameWhere([mover.robot]);
  robot.act(action);
  percepts.push(robot.percept());
  actions.push(action);
  fold();
  show();
  const at = `Move ${movesUpTo(actions.length)}, ${called(action)}: ${perceptText(percepts.at(-1))}.`;
  say(`${at} ${contradiction === null ? whereText(mover.robot) : wrongClaim()}`);
}

/** Where a robot is on the map, and whether the aid shows that it is elsewhere. */
function whereText(number) {
  const vertex = vertexOfRobot(number);
  const where = names.has(map.numbers[vertex]) ? nameOf(vertex) : "a new place";
  const text = `On your map, ${number === 0 ? "this" : `robot ${number + 1}`} is ${number === 0 ? "" : "at "}${where}.`;
  const now = percepts.at(-1);
  const placed = map.placed.at(-1);
  if (placed === null) return `${text} Your map does not show where ${aidOfGame.thing} are: claim the place where you picked up what you carry.`;
  const expected = aidOfGame.sightings(map.graph, placed, pose());
  if (factsOf(now).length === 0 || expected.includes(now.sighting)) return text;
  return `${text} ${aidOfGame.elsewhere}: you know ${number === 0 ? "this place" : "the place"}, so claim it.`;
}

const wrongClaim = () => `A claim of yours is wrong: ${contradiction.text(placeAfter)}. Withdraw it.`;

/** Claims that a robot's pose is a dart of a vertex of the map. */
function claim(number, vertex, index) {
  if (finished) return;
  if (contradiction !== null) return say(wrongClaim());
  const dart = map.graph.dart([vertex, index]);
  const name = placeText(vertex);
  const who = number === 0 ? "you" : `robot ${number + 1}`;
  if (poseOf(number) === dart) return say(`On your map, ${who} came in by door ${index} of ${name}.`);
  const visitor = robotNumbers.find((other) => map.robots[other].some((at) => map.graph.vertex(at) === vertex));
  const time = map.robots[visitor].findIndex((at) => map.graph.vertex(at) === vertex);
  const turn = map.graph.door(map.robots[visitor][time], dart);
  claims.push([[time, turn, visitor], [actions.length, 0, number]]);
  if (fold() !== null) {
    const refused = contradiction.text(placeAfter);
    claims.pop();
    fold();
    show();
    return say(`This cannot be door ${index} of ${name}: ${refused}.`);
  }
  show();
  say(number === 0 ? `This place is ${name}, and you came in by its door ${index}.` : `Robot ${number + 1} is at ${name}, and came in by its door ${index}.`);
}

/** A claim in words. */
function claimText([[earlier, turn, visitor], [time, , number]]) {
  const [vertex, index] = map.graph.end(map.graph.turned(map.robots[visitor][earlier], turn));
  const who = number === 0 ? "" : `robot ${number + 1} at `;
  return `Move ${movesUpTo(time)}: ${who}${nameOf(vertex)}, by its door ${index}`;
}

function withdraw(made) {
  if (finished) return;
  if (made === undefined) return say("There is no claim to withdraw.");
  const text = claimText(made);
  claims = claims.filter((other) => other !== made);
  fold();
  if (contradiction === null) nameEarlier();
  show();
  say(contradiction === null ? `Withdrawn: ${text}. ${whereText(0)}` : wrongClaim());
}

/** Places that were one with others need names again, but for those where robots are. */
function nameEarlier() {
  const spared = robotNumbers.map(vertexOfRobot);
  for (const [vertex, number] of map.numbers.entries()) {
    if (!spared.includes(vertex) && !names.has(number)) names.set(number, `v${names.size}`);
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
    return say(`The map is not complete: a door of ${placeText(fault.vertex)} leads nowhere.`);
  }
  finished = true;
  nameEarlier();
  nameWhere(robotNumbers);
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
  const moves = ({ actions: taken }) => taken.filter(isMove).length;
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
  here.show(now, robot.held);
  write(".play .percept", perceptText(now) + (robot.held && `; ${robot.held}`));
  write(".moves", movesText(movesUpTo(actions.length)));
  document.body.classList.toggle("begun", actions.length > 0);
  const placed = contradiction === null ? map.placed.at(-1) : null;
  const parts = placed === null ? [] : aidOfGame.parts(map.graph, placed);
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

/** Where a part of the aid is, in words, if it is at a place or behind its doors. */
function partText({ dart, drawn, number }) {
  const door = map.graph.index(dart);
  const texts = {
    pointing: `the marker along door ${door}`,
    edge: `the mark behind door ${door}`,
    arrow: `the mark behind door ${door}`,
    string: `string through door ${door}`,
  };
  if (number !== undefined) return `robot ${number}, in by door ${door}`;
  if (marker.startsWith("string")) return texts[drawn] ?? (drawn === "lying" ? "the free end" : "the fixed end");
  const look = { second: "second ", third: "third ", fourth: "fourth " }[drawn];
  return texts[drawn] ?? `the ${look ?? (marker.endsWith("distinct") ? "first " : "")}marker`;
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
  const rows = find(".doors");
  const focused = [...rows.querySelectorAll("button")].indexOf(document.activeElement);
  const buttons = robot.actions().map((action) => actionButton(action, () => act(action)));
  rows.replaceChildren(...rowsOf(buttons));
  const shown = rows.querySelectorAll("button");
  if (focused >= 0) shown[Math.min(focused, shown.length - 1)].focus();
}

/** The number of the robot about which a claim is made. */
const claimed = () => Number(find("#who").value);

/** The places that the robot may be at, but for the one where it is on the map. */
function showClaim() {
  const others = contradiction === null ? [...map.numbers.keys()].filter((vertex) => vertex !== vertexOfRobot(claimed())) : [];
  const options = others.map((vertex) => {
    const text = `${nameOf(vertex)}, ${doorsText(map.graph.degrees[vertex])}`;
    return Object.assign(document.createElement("option"), { value: map.numbers[vertex], textContent: text });
  });
  const chosen = find("#place").value;
  find("#place").replaceChildren(...options);
  if (options.some(({ value }) => value === chosen)) find("#place").value = chosen;
  showDarts();
  find("#claim-way").textContent = `and ${claimed() === 0 ? "I" : "it"} came in by its door`;
  for (const id of ["#claim", "#place", "#dart", "#who"]) find(id).disabled = finished || options.length === 0;
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
  const items = claims.map((made) => {
    const button = textButton("Withdraw", () => withdraw(made));
    button.setAttribute("aria-label", `Withdraw: ${claimText(made)}`);
    button.setAttribute("aria-disabled", String(finished));
    const item = document.createElement("li");
    item.append(claimText(made), button);
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
  const name = placeText(vertexOf(number));
  const [where, who] = claimed() === 0 ? [`this place is ${name}`, "you"] : [`robot ${claimed() + 1} is at ${name}`, "it"];
  say(`Claim that ${where}, and that ${who} came in by its door ${index}?`);
  find("#claim").focus();
}

// Buttons and keys.

function submitClaim() {
  if (find("#place").value === "") return say("There is no other place on your map.");
  claim(claimed(), vertexOf(Number(find("#place").value)), Number(find("#dart").value));
}

{
  const option = (number) => {
    const textContent = number === 0 ? "I know this place: it is" : `I know where robot ${number + 1} is: at`;
    return Object.assign(document.createElement("option"), { value: number, textContent });
  };
  find("#who").append(...robotNumbers.map(option));
  find("#who").addEventListener("change", showClaim);
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
for (const text of document.querySelectorAll(".thing")) text.textContent = aidOfGame.thing;
/** The first action with a verb: of markers that look different, each has its own. */
const firstOf = (verb) => robot.actions().find((action) => action.startsWith(verb)) ?? verb;
const isCarried = aidOfGame.carried !== null;
if (isCarried) Object.assign(keys, { p: () => act(firstOf(PICK_UP)), d: () => act(firstOf(DROP)) });
const isTeam = aidOfGame.others > 0;
const uses = { ".of-another": games.length > 1, ".of-carried": isCarried, ".of-team": isTeam, "#who": isTeam, "#claim-text": !isTeam };
for (const [selector, isUsed] of Object.entries(uses)) {
  find(selector).hidden = !isUsed;
}
onKey((event) => {
  const door = doorOfKey(event);
  const action = door === null ? keys[event.key.toLowerCase()] : () => act(door);
  // A key that is held counts once: each move costs.
  return action && (event.repeat ? () => {} : action);
});

begin(game);
