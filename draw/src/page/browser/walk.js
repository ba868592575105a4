// The walk: both robots take the same actions, by hand, at random, or on the walk that distinguishes them.

const data = JSON.parse(find("#data").textContent);
for (const { states } of data.sides) {
  for (const state of states) {
    state.actions = new Map(state.actions.map(([action, to]) => [action, states[to]]));
  }
}

/** The times that a robot travels and then rests, in milliseconds. */
const BY_HAND = { travel: 420 };
const AT_RANDOM = { travel: 260, rest: 120 };
const TELLING = { travel: 800, rest: 450 };
const RANDOM_STEPS = 20;

const still = matchMedia("(prefers-reduced-motion: reduce)");
const worlds = [...document.querySelectorAll(".world")];
const panels = worlds.map((figure) => new Panel(figure, (action) => byHand(action)));
const percepts = new Percepts(find(".percepts"));
const pairText = ([a, b]) => `${data.sides[0].states[a].text} ~ ${data.sides[1].states[b].text}`;
const relation = data.relation && new Relation(find(".relation"), data.relation, pairText);
const indices = data.sides.map(({ states }) => new Map(states.map((state, at) => [state, at])));

/** The two states at each step so far, and the action before it. */
const steps = [];
const here = () => steps.at(-1).states;
const pair = (states) => states.map((state, side) => indices[side].get(state));
const differ = ([a, b]) => a.percept !== b.percept;
const shared = (action) => here().every((state) => state.actions.has(action));
const called = (action) => (isDoor(action) ? `door ${action}` : action);

function stepText({ action, states }) {
  const [a, b] = states.map((state) => state.percept);
  const when = action === null ? "At the start" : `Step ${steps.length - 1}, ${called(action)}`;
  return a === b ? `${when}: both perceive ${a}.` : `${when}: they differ. A: ${a}; B: ${b}.`;
}

/** Shows the robots' current states; with a `duration` they travel there. */
function show(duration = 0) {
  const states = here();
  for (const [side, panel] of panels.entries()) {
    panel.show(states[side], shared, still.matches ? 0 : duration);
    worlds[side].classList.toggle("differs", differ(states));
    worlds[side].querySelector(".state").textContent = states[side].text;
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
    const none = isDoor(action) ? `There is no door ${action} here.` : `Neither can ${action} here.`;
    const way = isDoor(action) ? `has a door ${action}` : `can ${action}`;
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
  enter(null, data.sides.map(({ states, start }) => states[start]));
  show();
}

function undo() {
  stop();
  if (steps.length === 1) return;
  relation?.visit(pair(steps.pop().states), -1);
  percepts.removeLast();
  show();
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
    const open = [...here()[0].actions.keys()].filter(shared);
    return left-- > 0 ? open[Math.floor(Math.random() * open.length)] : undefined;
  }, AT_RANDOM);
}

function distinguish() {
  restart();
  const left = [...data.walk];
  timer = setTimeout(play, TELLING.rest, () => left.shift(), TELLING);
}

// Buttons and keys.

const order = (action) => (isDoor(action) ? Number(action) : Infinity);
const buttons = new Map();
{
  const actions = new Set(data.sides.flatMap(({ states }) => states.flatMap((s) => [...s.actions.keys()])));
  for (const action of [...actions].sort((one, two) => order(one) - order(two) || (one < two ? 1 : -1))) {
    buttons.set(action, actionButton(action, () => byHand(action)));
  }
  find(".doors").append(...buttons.values());
}

/** An action that neither robot can take is hidden; one that only one of them can take is disabled. */
function showActions() {
  for (const [action, button] of buttons) {
    const focused = document.activeElement === button;
    button.hidden = !here().some((state) => state.actions.has(action));
    button.setAttribute("aria-disabled", String(!shared(action)));
    if (focused && button.hidden) buttons.get("0")?.focus();
  }
  find("#undo").setAttribute("aria-disabled", String(steps.length === 1));
}

const keys = [
  [[" "], "Space", "random walk", randomWalk],
  [["Backspace", "u"], "Backspace", "undo", undo],
  [["r"], "R", "restart", restart],
];
if (data.walk?.length) keys.unshift([["w"], "W", "the walk that distinguishes them", distinguish]);
for (const [action, key] of [["drop", "d"], ["pick-up", "p"]]) {
  if (buttons.has(action)) keys.unshift([[key], key.toUpperCase(), action, () => byHand(action)]);
}

onKey((event) => {
  const meant = keys.find(([names]) => names.includes(event.key) || names.includes(event.key.toLowerCase()));
  const door = doorOfKey(event);
  return meant?.[3] ?? (door === null ? null : () => byHand(door));
});

find("#random").addEventListener("click", randomWalk);
find("#undo").addEventListener("click", undo);
find("#restart").addEventListener("click", restart);
find("#distinguish").hidden = !data.walk?.length;
find("#distinguish").addEventListener("click", distinguish);

// The legend of the keys and the signs.

{
  const key = (name) => Object.assign(document.createElement("kbd"), { textContent: name });
  const hints = keys.flatMap(([, name, meaning]) => [" · ", key(name), ` ${meaning}`]);
  find(".keys").append("Keys: ", key("0"), " to ", key("9"), " doors", ...hints);

  const doors =
    "Blue numbers are the doors as each robot counts them, 0 is the way back; " +
    "small ones count clockwise from each vertex's first.";
  const [first] = data.sides[0].states;
  const carried = first.marker === null ? "" : " @ is the place of the marker, +marker that it is carried.";
  const states = `${first.text} is a robot that has come in by the door of that small number.${carried}`;
  find(".meaning").textContent = `${doors} ${states}`;
}

restart();
