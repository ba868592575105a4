// Shared by all pages.

const find = (selector) => document.querySelector(selector);

/** An SVG element with its attributes and children. */
function drawn(name, attributes = {}, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

/** Shows and announces what happened. */
function say(text) {
  find(".status").textContent = text;
}

function textButton(text, onClick) {
  const button = Object.assign(document.createElement("button"), { type: "button", textContent: text });
  button.addEventListener("click", onClick);
  return button;
}

/** A button for an action: the number of a door, or what it does. */
function actionButton(action, onClick) {
  const door = isDoor(action) ? action : order(action)?.door;
  const isBack = Number(door) === 0;
  const text = door === undefined ? called(action) : isBack ? "0 back" : door;
  const button = textButton(text, onClick);
  button.dataset.action = action;
  if (door !== undefined) button.setAttribute("aria-label", `${called(action)}${isBack ? ", back" : ""}`);
  return button;
}

/** Rows of buttons for actions: those of the robot itself, and for each other robot the doors through which it is sent. */
function rowsOf(buttons) {
  const rows = new Map();
  for (const button of buttons) {
    const robot = order(button.dataset.action)?.robot;
    if (!rows.has(robot)) rows.set(robot, robot === undefined ? [] : [`Send robot ${robot}:`]);
    rows.get(robot).push(button);
  }
  return [...rows].sort(([one], [two]) => (one ?? 0) - (two ?? 0)).map(([, content]) => {
    const row = Object.assign(document.createElement("div"), { className: "row" });
    row.append(...content);
    return row;
  });
}

/** Does what a key means: `actionOf` returns an action for the event of the key, or nothing. */
function onKey(actionOf) {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    // Space presses a focused button, as usual, and a list has its own keys.
    if (event.target.closest("select") || (event.key === " " && event.target.closest("button"))) return;
    const act = actionOf(event);
    if (!act) return;
    act();
    event.preventDefault();
  });
}

/** The door that a key means, as a text, or null. */
const doorOfKey = ({ key }) => (/^\d$/.test(key) ? key : null);

/** The smallest font size that is readable, in pixels. */
const READABLE = 11;

/** The font size of the names of a drawing, in its units. */
const nameSize = (svg) => parseFloat(getComputedStyle(svg.querySelector(".name") ?? svg).fontSize);

/** Gives a drawing the width and height at which names of a font size, in its units, are readable. */
function keepReadable(svg, size = nameSize(svg)) {
  const { width, height } = svg.viewBox.baseVal;
  svg.style.setProperty("--readable", `${(width * READABLE) / size}px`);
  svg.style.setProperty("--readable-height", `${(height * READABLE) / size}px`);
}

/** Names a picture; its title would pop up under the pointer. */
function label(svg, text) {
  svg.querySelector("title")?.remove();
  svg.setAttribute("aria-label", text);
}

/** Crops a picture of a world to its drawing: the page has the texts, and a phone has little room. */
function crop(svg) {
  for (const element of svg.querySelectorAll(".title, .caption, .legend, .scale, .names ~ .marker")) element.remove();
  const boxes = [...svg.querySelectorAll(".vertex, .edge, .hallway, .names")].map((element) => element.getBBox());
  const [left, top] = ["x", "y"].map((side) => Math.min(...boxes.map((box) => box[side])));
  const width = Math.max(...boxes.map((box) => box.x + box.width)) - left;
  const height = Math.max(...boxes.map((box) => box.y + box.height)) - top;
  // Room around a disc for the ring of a marker and the numbers of doors.
  const room = 16;
  const box = [left - room, top - room, width + 2 * room, height + 2 * room];
  svg.setAttribute("viewBox", box.join(" "));
  svg.setAttribute("width", box[2]);
  svg.setAttribute("height", box[3]);
}

/** Scrolls a box, and nothing else, so that an element is in the middle of it. */
function reveal(box, element) {
  const [outer, inner] = [box, element].map((part) => part.getBoundingClientRect());
  box.scrollLeft += inner.x + inner.width / 2 - outer.x - outer.width / 2;
  box.scrollTop += inner.y + inner.height / 2 - outer.y - outer.height / 2;
}
