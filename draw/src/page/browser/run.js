// The run: the slider, the buttons and the keys choose a frame; the page shows the run at that time.

const data = JSON.parse(find("#data").textContent);
const { rounds, calls, story, images } = data;
/** The most junctions that are marked along the slider one by one. */
const MARKS = 150;

const still = matchMedia("(prefers-reduced-motion: reduce)");
const slider = find("#round");
const last = rounds.length - 1;

const floor = new Floor(find(".floor"), rounds, data.body);
const stages = [...document.querySelectorAll(".map .stage")];
for (const [number, stage] of stages.entries()) label(stage.querySelector("svg"), `The map, ${number + 1} of ${stages.length}`);
for (const svg of document.querySelectorAll(".map svg")) {
  keepReadable(svg);
}
const trail = data.trail && new Trail(find(".trail"), data.trail);
if (trail) keepReadable(trail.svg);
find("#folding").hidden = !trail;
const called = new Map(calls.map((call) => [call.rounds - 1, call]));

const lines = story.map((line) => {
  const item = document.createElement("li");
  item.textContent = line;
  return item;
});
find(".story").append(...lines);

/** The index of the first line of the latest event. */
const latestFrom = [];
for (const [at, { story: shown }] of rounds.entries()) {
  const before = rounds[at - 1]?.story ?? 0;
  latestFrom.push(shown > before ? before : (latestFrom.at(-1) ?? 0));
}

let at = 0;
let timer = null;

const write = (selector, text) => {
  find(selector).textContent = text;
};

/** Nothing if the run has no images: then there is no camera on the page. */
function showCamera({ image: number }) {
  const image = find(".camera img");
  if (!image) return;
  const kept = number !== null;
  image.hidden = !kept;
  find(".no-image").hidden = kept;
  if (kept && image.src !== images[number]) image.src = images[number];
  image.alt = kept ? `What the camera saw at frame ${at + 1}` : "";
}

function showFacts(round) {
  write(".time", `${round.time} min`);
  write(".move", `${round.moves} of ${rounds[last].moves}`);
  // A robot that drives by scans has none of these.
  if (round.state) {
    write(".state", round.state);
    write(".scene", round.scene);
    write(".command", round.command);
  }
  const call = called.get(at);
  const judged = call?.conforms ? "as specified" : "not as specified";
  find(".called").classList.toggle("later", !call);
  find(".facts .call").classList.toggle("wrong", call?.conforms === false);
  write(".facts .call", call ? `${call.percept}: ${judged}` : "");
}

function showMap({ maps }) {
  for (const [stage, element] of stages.entries()) element.hidden = stage !== maps - 1;
  // On a phone a large map is scrolled: to its newest vertex.
  const newest = [...(stages[maps - 1]?.querySelectorAll(".name") ?? [])].at(-1);
  if (newest) reveal(stages[maps - 1], newest);
  find(".no-map").hidden = maps > 0;
}

/** The number of the latest stage of the trail. */
function folded() {
  const before = calls.filter((call) => call.rounds <= at + 1).length;
  return Math.min(Math.max(before, 1), trail.data.stages.length) - 1;
}

/** The trail in place of the map, if it was chosen. */
function showTrail(duration) {
  const shown = find(".map").classList.contains("folding");
  if (shown) trail.show(folded(), duration);
  const { maps } = rounds[at];
  write(".grown", shown ? trail.words(folded()) : `${maps} of ${stages.length}`);
}

function showStory({ story: shown }) {
  for (const [number, line] of lines.entries()) {
    line.hidden = number >= shown;
    line.classList.toggle("latest", number >= latestFrom[at] && number < shown);
  }
  const box = find(".story-panel .scroll");
  box.scrollTop = box.scrollHeight;
}

/** Shows a frame, by its number; with a `duration`, in milliseconds, the robot travels there. */
function show(number, duration = 0) {
  at = Math.min(Math.max(number, 0), last);
  const round = rounds[at];
  floor.show(at, still.matches ? 0 : duration);
  showCamera(round);
  showFacts(round);
  showMap(round);
  showTrail(still.matches ? 0 : COLLAPSE);
  showStory(round);
  const now = `frame ${at + 1} of ${rounds.length}, ${round.time} min, move ${round.moves}`;
  slider.value = at;
  slider.setAttribute("aria-valuetext", now);
  write(".now", now);
  // For screen readers: the current frame, but not while the run plays.
  if (timer === null) write("[role=status]", round.state ? `${now}, ${round.state}: ${round.scene}` : now);
}

// Playing.

function pause() {
  clearTimeout(timer);
  timer = null;
  write("#play", "Play");
}

function play() {
  if (at === last) show(0);
  write("#play", "Pause");
  const pace = 1000 / Number(find("#speed").value);
  timer = setTimeout(step, pace);
}

function step() {
  const pace = 1000 / Number(find("#speed").value);
  show(at + 1, pace);
  if (at < last) timer = setTimeout(step, pace);
  else pause();
}

function go(number) {
  pause();
  show(number);
}

/** The next frame, in a direction, at which the robot had decided a junction. */
function junction(direction) {
  const places = [0, ...called.keys(), last].filter((place) => (place - at) * direction > 0);
  return direction > 0 ? Math.min(last, ...places) : Math.max(0, ...places);
}

// Buttons and keys.

/** The floor as large as the screen allows, or as one of the panels on the screen. */
function enlarge() {
  const large = find(".run").classList.toggle("large");
  find("#larger").setAttribute("aria-pressed", String(large));
}

/** The trail as it folds, or the map of Algorithm 1. */
function choosePanel() {
  const folding = find(".map").classList.toggle("folding");
  find("#folding").setAttribute("aria-pressed", String(folding));
  showTrail(0);
}

const deeds = {
  play: () => (timer === null ? play() : pause()),
  back: () => go(at - 1),
  on: () => go(at + 1),
  "junction-back": () => go(junction(-1)),
  "junction-on": () => go(junction(1)),
};

function keyed({ key, shiftKey }) {
  if (key === " ") return deeds.play;
  if (key === "ArrowLeft") return shiftKey ? deeds["junction-back"] : deeds.back;
  if (key === "ArrowRight") return shiftKey ? deeds["junction-on"] : deeds.on;
  if (key === "Home") return () => go(0);
  if (key === "End") return () => go(last);
  return null;
}

find("#larger").addEventListener("click", enlarge);
find("#folding").addEventListener("click", choosePanel);
if (last >= 0) {
  slider.max = last;
  slider.addEventListener("input", () => go(Number(slider.value)));
  for (const [id, deed] of Object.entries(deeds)) find(`#${id}`).addEventListener("click", deed);
  onKey(keyed);

  const marks = find(".marks");
  marks.setAttribute("viewBox", `0 0 ${Math.max(last, 1)} 1`);
  for (const [place, { conforms }] of called) {
    // Too many marks would be a grey bar; the important ones stay.
    if (conforms && called.size > MARKS) continue;
    marks.append(drawn("path", { d: `M${place} 0V1`, class: conforms ? "" : "wrong" }));
  }
  show(0);
} else {
  for (const control of document.querySelectorAll(".controls button, .controls input, select")) {
    control.disabled = true;
  }
  write(".now", "the run has no frame");
}
