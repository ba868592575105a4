// The run of an explorer: the slider, the buttons, the keys and the table choose a step, and the robots go there.

const data = JSON.parse(find("#data").textContent);
const sides = data.sides.map(sideOf);

/** The times that a robot travels and then rests, in milliseconds. */
const TRAVEL = 420;
const REST = 380;

const still = matchMedia("(prefers-reduced-motion: reduce)");
const figures = [...document.querySelectorAll(".world")];
const panels = figures.map((figure) => new Panel(figure, () => {}));
/** The robots of the last step; null where an action is not possible. */
let robots = sides.map(({ graph, facing }) => Robot.start(data.marker, graph, facing));
const steps = data.steps.map(({ action, percept }) => {
  if (action !== null) {
    robots = robots.map((robot) => (robot?.actions().includes(action) ? robot.after(action) : null));
  }
  return { action, percept, states: robots.map((robot, side) => robot && new WalkState(sides[side], robot)) };
});
const differs = ({ states: [here, there] }) => there !== undefined && there?.percept !== here.percept;
const difference = steps.findIndex(differs);
const last = steps.length - 1;
const slider = find("#step");

let at = 0;
let timer = null;

const NOT_POSSIBLE = "not possible";

const rows = steps.map((step, number) => {
  const [here, ...beside] = step.states;
  const row = document.createElement("tr");
  const texts = [number, step.action ?? "start", here.text, step.percept];
  for (const text of [...texts, ...beside.map((there) => there?.percept ?? NOT_POSSIBLE)]) {
    row.insertCell().textContent = text;
  }
  row.classList.toggle("differs", number === difference);
  row.addEventListener("click", () => go(number));
  return row;
});
find(".percepts tbody").append(...rows);

/** Shows a step; with a `duration`, in milliseconds, the robots travel there. */
function show(number, duration = 0) {
  at = Math.min(Math.max(number, 0), last);
  const { action, percept, states } = steps[at];
  for (const [side, panel] of panels.entries()) {
    const state = states[side];
    figures[side].classList.toggle("differs", at === difference);
    figures[side].querySelector(".state").textContent = state?.text ?? "";
    figures[side].querySelector(".marker-place").textContent = state ? state.words : "";
    figures[side].querySelector(".percept").textContent = side === 0 ? percept : (state?.percept ?? NOT_POSSIBLE);
    if (state) panel.show(state, () => true, still.matches ? 0 : duration);
  }
  for (const [row, element] of rows.entries()) element.classList.toggle("now-row", row === at);
  reveal(find(".percepts .scroll"), rows[at]);
  const now = `step ${at} of ${last}`;
  slider.value = at;
  slider.setAttribute("aria-valuetext", now);
  find(".now").textContent = now;
  const apart = at === difference ? ` Here they differ: ${states[1]?.percept ?? NOT_POSSIBLE}.` : "";
  say(`Step ${at}, ${action === null ? "the start" : called(action)}: ${percept}.${apart}`);
}

function pause() {
  clearTimeout(timer);
  timer = null;
  find("#play").textContent = "Play";
}

function play() {
  if (at === last) show(0);
  find("#play").textContent = "Pause";
  timer = setTimeout(next, REST);
}

function next() {
  show(at + 1, TRAVEL);
  if (at < last) timer = setTimeout(next, TRAVEL + REST);
  else pause();
}

function go(number, duration = 0) {
  pause();
  show(number, duration);
}

const deeds = {
  play: () => (timer === null ? play() : pause()),
  back: () => go(at - 1),
  on: () => go(at + 1, TRAVEL),
  difference: () => go(difference),
};
const keys = { " ": deeds.play, ArrowLeft: deeds.back, ArrowRight: deeds.on, Home: () => go(0), End: () => go(last) };

slider.max = last;
slider.addEventListener("input", () => go(Number(slider.value)));
for (const [id, deed] of Object.entries(deeds)) find(`#${id}`).addEventListener("click", deed);
find("#difference").hidden = difference < 0;
onKey((event) => (event.target === slider && event.key !== " " ? null : keys[event.key]));
show(0);
