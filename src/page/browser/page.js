// Shared by all pages.

const find = (selector) => document.querySelector(selector);

/** An SVG element with its attributes and children. */
function drawn(name, attributes = {}, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}


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

/** Scrolls a box, and nothing else, so that an element is in the middle of it. */
function reveal(box, element) {
  const [outer, inner] = [box, element].map((part) => part.getBoundingClientRect());
  box.scrollLeft += inner.x + inner.width / 2 - outer.x - outer.width / 2;
  box.scrollTop += inner.y + inner.height / 2 - outer.y - outer.height / 2;
}
