// The percepts of one robot, or of two: a row for each step, the newest first.

class Percepts {
  constructor(section) {
    this.body = section.querySelector("tbody");
    this.box = section.querySelector(".scroll");
  }

  /** The number of rows. */
  get length() {
    return this.body.childElementCount;
  }

  add(action, [first, ...others]) {
    const row = document.createElement("tr");
    const compared = others.flatMap((other) => [other === first ? "=" : "≠", other]);
    for (const text of [this.length, action ?? "start", first, ...compared]) {
      row.insertCell().textContent = text;
    }
    row.classList.toggle("differs", others.some((other) => other !== first));
    this.body.prepend(row);
    this.box.scrollTop = 0;
  }

  removeLast() {
    this.body.firstElementChild.remove();
  }

  clear() {
    this.body.replaceChildren();
  }
}

