// The game: the person takes doors and makes claims; the page shows the map that follows, and judges it.

const data = JSON.parse(find("#data").textContent);
const { world, start, walks } = data;

/** The walk so far: the robot's true pose, the percepts, the doors; and the claims about it. */
let truth, percepts, doors, claims;
/** The folded map, its places, and the contradiction of the last percept with the claims, if there is one. */
let map, places, contradiction;
/** The names of the places, by the least place of the trail; a place gets one when the robot leaves it. */
let names;
let finished = false;

const write = (selector, text) => {
  find(selector).textContent = text;
};

const here = new Here(find(".here"), go);
const drawing = new MapDrawing(find(".drawing"), choose);
const walk = new Percepts(find(".percepts"));

function percept() {
  const [v, i] = truth;
  const degree = world[v].length;
  return { degree, marker: v === start[0] ? (start[1] - i + degree) % degree : null };
}

const markerText = (marker) => (marker === null ? "no marker" : `the marker, along door ${marker}`);
const perceptText = ({ degree, marker }) => `${doorsText(degree)}, ${markerText(marker)}`;
const movesText = (count) => (count === 1 ? "1 move" : `${count} moves`);

/** The name of a place; one that the robot has just reached has none. */
const nameOf = ({ number }) => names.get(number) ?? "?";
const current = () => places.find(({ darts }) => darts.includes(map.find(map.poses.at(-1))));

/** Folds the walk with the claims. A claim that contradicts it is not made: then the error is returned. */
function fold() {
  try {
    const next = new FoldedMap(percepts, doors, claims);
    places = next.places();
    map = next;
    contradiction = null;
  } catch (error) {
    if (!(error instanceof Contradiction)) throw error;
    contradiction = error;
  }
  return contradiction;
}

function nameCurrent() {
  const { number } = current();
  if (!names.has(number)) names.set(number, `v${names.size}`);
}

/** The robot goes through a door. */
function go(door) {
  if (finished) return say("The run has ended. Restart it to try again.");
  const [v, i] = truth;
  const degree = world[v].length;
  if (door >= degree) return say(`There is no door ${door} here.`);
  if (contradiction === null) nameCurrent();
  truth = world[v][(i + door) % degree];
  percepts.push(percept());
  doors.push(door);
  fold();
  show();
  const at = `Move ${doors.length}, door ${door}: ${perceptText(percepts.at(-1))}.`;
  say(contradiction === null ? `${at} ${placeText()}` : `${at} ${wrongClaim()}`);
}

/** Where the robot is on the map. */
function placeText() {
  const place = current();
  if (names.has(place.number)) return `On your map, this is ${nameOf(place)}.`;
  if (percepts.at(-1).marker !== null) return "The marker lies here: you know this place, so claim it.";
  return "On your map, this is a new place.";
}

const wrongClaim = () => `A claim of yours is wrong: ${contradiction.message}. Withdraw it.`;

/** Claims that the robot's pose is a dart of a place of the map. */
function claim(number, index) {
  if (finished) return;
  if (contradiction !== null) return say(wrongClaim());
  const place = places.find((known) => known.number === number);
  const dart = place.darts[index];
  const name = nameOf(place);
  if (map.find(map.poses.at(-1)) === dart) return say(`On your map, the robot came in by door ${index} of ${name}.`);
  const known = map.poses.flatMap((pose, moves) => {
    const turn = [...Array(place.darts.length).keys()].find((by) => map.find(map.turned(pose, by)) === dart);
    return turn === undefined ? [] : [[moves, turn]];
  });
  const earlier = known.find(([moves]) => moves < doors.length) ?? known[0];
  claims.push([earlier, [doors.length, 0]]);
  const refused = fold();
  if (refused !== null) {
    claims.pop();
    fold();
    show();
    return say(`This cannot be door ${index} of ${name}: ${refused.message}.`);
  }
  show();
  say(`This place is ${name}, and you came in by its door ${index}.`);
}

function withdraw() {
  if (finished) return;
  if (claims.pop() === undefined) return say("There is no claim to withdraw.");
  fold();
  if (contradiction === null) nameEarlier();
  show();
  say(contradiction === null ? `The last claim is withdrawn. ${placeText()}` : wrongClaim());
}

/** Places that were one with others need names again, but for the one where the robot is. */
function nameEarlier() {
  for (const place of places) {
    if (place !== current() && !names.has(place.number)) names.set(place.number, `v${names.size}`);
  }
}

/** Begins again. Asks before it discards a run that has not ended. */
function restart() {
  const isDiscarded = !finished && doors.length > 0;
  if (isDiscarded && !confirm(`Discard this run of ${movesText(doors.length)}?`)) return;
  begin();
}

function begin() {
  truth = start;
  percepts = [percept()];
  doors = [];
  claims = [];
  names = new Map([[0, "v0"]]);
  finished = false;
  find(".result").hidden = true;
  find(".doors").hidden = false;
  find(".solution .ground").replaceChildren();
  walk.clear();
  drawing.clear();
  fold();
  show();
  say(`You begin: ${perceptText(percepts[0])}. Choose a door.`);
}

// The end.

/** Judges the map and shows the world. */
function finish() {
  if (finished) return;
  if (contradiction !== null) return say(wrongClaim());
  const lists = map.asLists();
  const fault = faultOf(lists, world, start, truth);
  if (fault?.kind === "open") {
    const open = nameOf(places[fault.vertex]);
    return say(`The map is not complete: a door of ${open === "?" ? "this place" : open} leads nowhere.`);
  }
  finished = true;
  nameEarlier();
  if (!names.has(current().number)) nameCurrent();
  const right = fault === null;
  const proved = right && determinesWorld(percepts, doors);
  find(".verdict").className = `verdict ${!right ? "diverged" : proved ? "conforms" : "not-known"}`;
  write("#result-heading", !right ? "Wrong map" : proved ? "Right, and proved" : "Right, but guessed");
  write(".reason", right ? rightText(proved) : faultText(fault));
  compare(right);
  find(".solution .ground").replaceChildren(find(".solution template").content.cloneNode(true));
  keepReadable(find(".solution svg"));
  find(".result").hidden = false;
  find(".doors").hidden = true;
  show();
  find("#result-heading").focus();
  find(".result").scrollIntoView();
  say(`The run has ended. ${find("#result-heading").textContent}.`);
}

function rightText(proved) {
  const way = proved
    ? "Your walk fits no other world: no robot that perceives this can be anywhere else."
    : "But another world looks the same on your walk: the sightings of the marker do not prove all your claims.";
  return `Your map is the world, and the robot is where you believe it to be. ${way}`;
}

function faultText({ kind, vertex, degree, vertices }) {
  const name = (number) => nameOf(places[number]);
  if (kind === "degree") {
    return `Your map is not the world: where it has ${name(vertex)} with ${doorsText(places[vertex].darts.length)}, the world has a place with ${degree}.`;
  }
  if (kind === "several") return `Your map is not the world: its ${name(vertex)} is several places, or one that is turned.`;
  if (kind === "twice") {
    const [one, other] = vertices.map(name);
    return `Your map is not the world: its ${one} and ${other} are one place.`;
  }
  return "Your map is the world, but the robot is not where you believe it to be.";
}

/** The table of moves: the certificate, the person, and both algorithms. */
function compare(right) {
  const [{ doors: shortest }] = walks;
  const own = { name: right ? "You" : "You (wrong map)", doors };
  const rows = [walks[0], own, ...walks.slice(1)].map(({ name, doors: taken }) => {
    const row = document.createElement("tr");
    row.classList.toggle("own", taken === doors);
    const head = document.createElement("th");
    head.scope = "row";
    head.textContent = name;
    const cell = (text, style) => Object.assign(document.createElement("td"), { textContent: text, className: style });
    const ratio = (taken.length / shortest.length).toFixed(2);
    row.append(head, cell(taken.length, "right"), cell(ratio, "right"), cell(taken.join(" "), "faint"));
    return row;
  });
  find(".comparison tbody").replaceChildren(...rows);
}

// Showing.

function show() {
  const now = percepts.at(-1);
  here.show(now);
  write(".percept", perceptText(now));
  write(".moves", movesText(doors.length));
  document.body.classList.toggle("begun", doors.length > 0);
  drawing.show(map, places, nameOf, contradiction === null ? map.find(map.poses.at(-1)) : null);
  find(".map").classList.toggle("differs", contradiction !== null);
  showSize();
  showList();
  showWalk();
  showDoors(now.degree);
  showClaim();
}

function showSize() {
  const open = places.flatMap(({ darts }) => darts).filter((dart) => map.opposite(dart) === null).length;
  const count = places.length === 1 ? "1 place" : `${places.length} places`;
  write(".size", open === 0 ? `${count}, no open door` : `${count}, ${open} open door${open === 1 ? "" : "s"}`);
}

/** Where a dart of the map leads, in words. */
function leadsTo(dart) {
  const far = map.opposite(dart);
  if (far === null) return "open";
  const place = places.find(({ darts }) => darts.includes(far));
  return `to door ${place.darts.indexOf(far)} of ${nameOf(place)}`;
}

function showList() {
  const items = places.map((place) => {
    const marker = place.marker === null ? "" : `, the marker along door ${place.darts.indexOf(place.marker)}`;
    const at = contradiction === null && place === current() ? " (you are here)" : "";
    const ways = place.darts.map((dart, index) => `${index} ${leadsTo(dart)}`).join(", ");
    return Object.assign(document.createElement("li"), { textContent: `${nameOf(place)}${at}${marker}: ${ways}` });
  });
  find(".listed ul").replaceChildren(...items);
}

function showWalk() {
  for (let step = walk.length; step < percepts.length; step += 1) {
    walk.add(doors[step - 1], [perceptText(percepts[step])]);
  }
}

/** A button for each door of the place. */
function showDoors(degree) {
  const row = find(".doors");
  const focused = [...row.children].indexOf(document.activeElement);
  const buttons = [...Array(degree).keys()].map((door) => actionButton(String(door), () => go(door)));
  row.replaceChildren(...buttons);
  if (focused >= 0) buttons[Math.min(focused, degree - 1)].focus();
}

/** The places that the robot may be at, but for the one where it is on the map. */
function showClaim() {
  const others = contradiction === null ? places.filter((place) => place !== current()) : [];
  const options = others.map((place) => {
    const text = `${nameOf(place)}, ${doorsText(place.darts.length)}${place.marker === null ? "" : ", marker"}`;
    return Object.assign(document.createElement("option"), { value: place.number, textContent: text });
  });
  const chosen = find("#place").value;
  find("#place").replaceChildren(...options);
  if (others.some(({ number }) => String(number) === chosen)) find("#place").value = chosen;
  showDarts();
  for (const id of ["#claim", "#place", "#dart"]) find(id).disabled = finished || options.length === 0;
  find("#withdraw").setAttribute("aria-disabled", String(finished || claims.length === 0));
  find("#finish").setAttribute("aria-disabled", String(finished));
}

function showDarts() {
  const place = places.find(({ number }) => String(number) === find("#place").value);
  const options = (place?.darts ?? []).map((dart, index) => {
    const text = `${index}, ${leadsTo(dart)}`;
    return Object.assign(document.createElement("option"), { value: index, textContent: text });
  });
  const open = (place?.darts ?? []).findIndex((dart) => map.opposite(dart) === null);
  find("#dart").replaceChildren(...options);
  if (open >= 0) find("#dart").value = open;
}

/** A dart was pressed on the map: it is chosen for a claim. */
function choose(number, index) {
  const option = [...find("#place").options].find(({ value }) => value === String(number));
  if (finished || !option) return;
  find("#place").value = number;
  showDarts();
  find("#dart").value = index;
  const place = places.find((known) => known.number === number);
  say(`Claim that this place is ${nameOf(place)}, and that you came in by its door ${index}?`);
  find("#claim").focus();
}

// Buttons and keys.

function submitClaim() {
  if (find("#place").value === "") return say("There is no other place on your map.");
  claim(Number(find("#place").value), Number(find("#dart").value));
}

find("#place").addEventListener("change", showDarts);
find(".claim").addEventListener("submit", (event) => {
  event.preventDefault();
  submitClaim();
});
find("#withdraw").addEventListener("click", withdraw);
find("#finish").addEventListener("click", finish);
find("#restart").addEventListener("click", restart);

const enlarge = () => drawing.enlarge(ENLARGED);
const reduce = () => drawing.enlarge(1 / ENLARGED);
find("#enlarge").addEventListener("click", enlarge);
find("#reduce").addEventListener("click", reduce);
find("#fit").addEventListener("click", () => drawing.fit());

const keys = { "+": enlarge, "-": reduce, c: () => find("#place").focus(), w: withdraw, f: finish, r: restart };
onKey((event) => {
  const door = doorOfKey(event);
  const act = door === null ? keys[event.key.toLowerCase()] : () => go(Number(door));
  // A key that is held counts once: each move costs.
  return act && (event.repeat ? () => {} : act);
});

begin();
