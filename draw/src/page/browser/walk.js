// The walk: both robots take the same actions, by hand, at random, or on the walk that distinguishes them.

const data = JSON.parse(find("#data").textContent);
const sides = data.sides.map(sideOf);

/** The times that a robot travels and then rests, in milliseconds. */
const BY_HAND = { travel: 420 };
const AT_RANDOM = { travel: 260, rest: 120 };
const TELLING = { travel: 800, rest: 450 };
const RANDOM_STEPS = 20;

const still = matchMedia("(prefers-reduced-motion: reduce)");
const worlds = [...document.querySelectorAll(".world")];
const panels = worlds.map((figure) => new Panel(figure, (action) => byHand(action)));
const percepts = new Percepts(find(".percepts"));

/** The marker; the initial states; the walk that distinguishes the worlds, or the pairs that the robots can reach. */
let marker, initial, walk, relation;
/** The two states at each step so far, and the action before it. */
const steps = [];
let isBlind = false;

const here = () => steps.at(-1).states;
const pair = (states) => states.map((state) => state.text);
const differ = ([a, b]) => a.percept !== b.percept;
const shared = (action) => here().every(({ robot }) => robot.actions().includes(action));
const startText = ({ robot, side }) => `${side.vertices[robot.graph.vertex(robot.pose)]}:${side.facings[robot.pose]}`;

/** Compares the worlds with a marker, and begins a walk. */
function choose(name) {
  marker = name;
  const ends = sides.map(({ graph, facing }) => [graph, facing]);
  const poses = name === data.marker ? [sides[1].graph.dart(data.pose)] : undefined;
  const found = compareWorlds(marker, ends, poses);
  initial = found.robots.map((robot, side) => new WalkState(sides[side], robot));
  walk = found.walk;
  const pairs = found.pairs?.map((robots) => pair(robots.map((robot, side) => new WalkState(sides[side], robot))));
  relation = pairs ? new Relation(find(".relation"), pairs, ([a, b]) => `${a} ~ ${b}`) : null;
  find(".relation").hidden = relation === null;
  find("#distinguish").hidden = !walk?.length;
  showVerdict();
  showKeys();
  restart();
}

/** What a walk can show, unless the person has to find it. */
function showVerdict() {
  const { about } = data.markers.find(({ name }) => name === marker);
  const [a, b] = initial.map(startText);
  const from = `From ${a} in A and ${b} in B`;
  const verdicts = {
    none: `${from} no walk distinguishes these worlds: whatever both robots do, they perceive the same.`,
    first: `${from} the first percepts differ.`,
    walk: `${from} the walk ${walk?.join(", ")} distinguishes these worlds.`,
    unknown: `${from} the robots can be in more than ${MOST_PAIRS.toLocaleString("en")} pairs of states, which are not listed.`,
  };
  const kind = walk === null ? (relation === null ? "unknown" : "none") : walk.length === 0 ? "first" : "walk";
  const hidden = "Does a walk distinguish the two worlds? Find one, or show the worlds.";
  find(".about").textContent = `${about[0].toUpperCase()}${about.slice(1)} ${isBlind ? hidden : verdicts[kind]}`;
}

function stepText({ action, states }) {
  const [a, b] = states.map((state) => state.percept);
  const moves = steps.length - 1;
  const when = action === null ? "At the start" : `Step ${moves}, ${called(action)}`;
  if (a === b) return `${when}: both perceive ${a}.`;
  const shortest = walk === null ? "" : ` The shortest walk that distinguishes the worlds has ${walk.length} of them.`;
  const found = isBlind ? ` You have distinguished the worlds in ${moves === 1 ? "1 step" : `${moves} steps`}.${shortest}` : "";
  return `${when}: they differ. A: ${a}; B: ${b}.${found}`;
}

/** Shows the robots' current states; with a `duration` they travel there. */
function show(duration = 0) {
  const states = here();
  for (const [side, panel] of panels.entries()) {
    panel.show(states[side], shared, still.matches ? 0 : duration);
    worlds[side].classList.toggle("differs", differ(states));
    worlds[side].querySelector(".state").textContent = states[side].text;
    worlds[side].querySelector(".marker-place").textContent = states[side].words;
    worlds[side].querySelector(".percept").textContent = states[side].percept;
  }
  relation?.show(pair(states));
  showActions();
  say(stepText(steps.at(-1)));
}

function enter(action, states) {
  steps.push({ action, states });
  percepts.add(action, states.map((state) => state.percept));
  relation?.visit(pair(states));
}

/** Both robots take this action, if both can; returns whether they did. */
function act(action, { travel } = BY_HAND) {
  const next = here().map((state) => state.actions.get(action));
  const able = next.filter(Boolean).length;
  if (able < 2) {
    const isShort = here().every(({ robot }) => Number(action) < robot.graph.degree(robot.pose));
    const door = isShort ? `The string is too short for door ${action}.` : `There is no door ${action} here.`;
    const none = isDoor(action) ? door : `Neither can ${called(action)} here.`;
    const way = isDoor(action) ? `has a door ${action}` : `can ${called(action)}`;
    say(able ? `Only ${next[0] ? "A" : "B"} ${way} here: they cannot both go on by it.` : none);
    return false;
  }
  enter(action, next);
  show(isDoor(action) ? travel : 0);
  return true;
}

function restart() {
  stop();
  steps.length = 0;
  percepts.clear();
  relation?.clear();
  enter(null, initial);
  show();
}

function undo() {
  stop();
  if (steps.length === 1) return;
  const { states } = steps.pop();
  relation?.visit(pair(states), -1);
  percepts.removeLast();
  show();
}

/** Hides the worlds, so that only the percepts are left to find a walk; or shows them. */
function hide() {
  isBlind = !isBlind;
  document.body.classList.toggle("blind", isBlind);
  find("#hide").setAttribute("aria-pressed", String(isBlind));
  showVerdict();
  if (isBlind) restart();
  else show();
}

// Automatic walks.

let timer = null;

/** Takes the actions of `next` until it returns none. */
function play(next, pace) {
  const action = next();
  const went = action !== undefined && act(action, pace);
  timer = went ? setTimeout(play, pace.travel + pace.rest, next, pace) : null;
  find("#random").setAttribute("aria-pressed", String(went && pace === AT_RANDOM));
}

function stop() {
  clearTimeout(timer);
  timer = null;
  find("#random").setAttribute("aria-pressed", "false");
}

function byHand(action) {
  stop();
  act(action);
}

function randomWalk() {
  const walking = find("#random").getAttribute("aria-pressed") === "true";
  stop();
  if (walking) return;
  let left = RANDOM_STEPS;
  play(() => {
    const open = here()[0].robot.actions().filter(shared);
    return left-- > 0 ? open[Math.floor(Math.random() * open.length)] : undefined;
  }, AT_RANDOM);
}

function distinguish() {
  if (!walk?.length || isBlind) return;
  restart();
  const left = [...walk];
  timer = setTimeout(play, TELLING.rest, () => left.shift(), TELLING);
}

// Buttons and keys.

/** An action that only one of the robots can take is disabled. */
function showActions() {
  const row = find(".doors");
  const focused = document.activeElement.dataset?.action;
  const robots = here().map(({ robot }) => robot.actions());
  const [longer, other] = robots[0].length < robots[1].length ? [robots[1], robots[0]] : robots;
  const actions = [...longer, ...other.filter((action) => !longer.includes(action))];
  const buttons = actions.map((action) => {
    const button = actionButton(action, () => byHand(action));
    button.setAttribute("aria-disabled", String(!shared(action)));
    return button;
  });
  row.replaceChildren(...rowsOf(buttons));
  if (focused !== undefined) (buttons.find(({ dataset }) => dataset.action === focused) ?? buttons[0]).focus();
  find("#undo").setAttribute("aria-disabled", String(steps.length === 1));
}

/** The keys of this marker: for each its names, how it is written, what it does. */
function keys() {
  // Of markers that look different, the first one that is here or is carried.
  const firstOf = (verb) => here()[0].robot.actions().find((action) => action.startsWith(verb)) ?? verb;
  const key = (name, verb) => [[name.toLowerCase()], name, called(verb), () => byHand(firstOf(verb))];
  return [
    ...(initial[0].robot.aid.carried === null ? [] : [key("D", DROP), key("P", PICK_UP)]),
    ...(walk?.length ? [[["w"], "W", "the walk that distinguishes them", distinguish]] : []),
    [[" "], "Space", "random walk", randomWalk],
    [["Backspace", "u"], "Backspace", "undo", undo],
    [["r"], "R", "restart", restart],
    [["h"], "H", "hide or show the worlds", hide],
  ];
}

onKey((event) => {
  const meant = keys().find(([names]) => names.includes(event.key) || names.includes(event.key.toLowerCase()));
  const door = doorOfKey(event);
  return meant?.[3] ?? (door === null ? null : () => byHand(door));
});

find("#random").addEventListener("click", randomWalk);
find("#undo").addEventListener("click", undo);
find("#restart").addEventListener("click", restart);
find("#hide").addEventListener("click", hide);
find("#distinguish").addEventListener("click", distinguish);

/** The legend of the keys and the signs. */
function showKeys() {
  const { aid } = initial[0].robot;
  const key = (name) => Object.assign(document.createElement("kbd"), { textContent: name });
  const hints = keys().flatMap(([, name, meaning]) => [" · ", key(name), ` ${meaning}`]);
  find(".keys").replaceChildren("Keys: ", key("0"), " to ", key("9"), " doors", ...hints);
  const doors =
    "Blue numbers are the doors as each robot counts them, 0 is the way back; percepts have these numbers. " +
    "Small numbers count clockwise from each vertex's first.";
  const states = `${initial[0].text}: the robot has come in by the door of that small number.`;
  find(".meaning").textContent = `${doors} ${states} ${aid.signs} Red: ${aid.thing}.`;
}

{
  const options = data.markers.map(({ name }) => Object.assign(document.createElement("option"), { value: name, textContent: name }));
  find("#marker").append(...options);
  find("#marker").value = data.marker;
  find("#marker").addEventListener("change", () => choose(find("#marker").value));
}

choose(data.marker);
