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

/** Gives a drawing the width `--readable`, at which names of a font size, in its units, are readable. */
function keepReadable(svg, size) {
  svg.style.setProperty("--readable", `${(svg.viewBox.baseVal.width * READABLE) / size}px`);
}

/** Scrolls a box, and nothing else, so that an element is in the middle of it. */
function reveal(box, element) {
  const [outer, inner] = [box, element].map((part) => part.getBoundingClientRect());
  box.scrollLeft += inner.x + inner.width / 2 - outer.x - outer.width / 2;
  box.scrollTop += inner.y + inner.height / 2 - outer.y - outer.height / 2;
}
