// The percepts of both robots: a row for each step, the newest first.

class Percepts {
  constructor(section) {
    this.body = section.querySelector("tbody");
    this.box = section.querySelector(".scroll");
  }

  add(action, percepts) {
    const row = document.createElement("tr");
    const equal = percepts[0] === percepts[1];
    const step = this.body.childElementCount;
    for (const text of [step, action ?? "start", percepts[0], equal ? "=" : "≠", percepts[1]]) {
      row.insertCell().textContent = text;
    }
    row.classList.toggle("differs", !equal);
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

