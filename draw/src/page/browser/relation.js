// The pairs of states that the robots can reach together: the current one, and the visited ones.

class Relation {
  /** More pairs than this are not shown one by one. */
  static SHOWN = 600;

  constructor(section, pairs, text) {
    this.pairs = pairs;
    this.text = text;
    this.count = section.querySelector(".count");
    this.list = section.querySelector(".pairs");
    this.index = new Map(pairs.map(([a, b], at) => [`${a} ${b}`, at]));
    this.visits = new Map();
    this.current = undefined;
    this.items = pairs.slice(0, Relation.SHOWN).map((pair) => {
      const item = document.createElement("li");
      item.textContent = text(pair);
      return item;
    });
    this.list.replaceChildren(...this.items);
    const leftOut = section.querySelector(".left-out");
    leftOut.hidden = pairs.length <= Relation.SHOWN;
    leftOut.textContent = `The first ${Relation.SHOWN} of ${pairs.length} pairs are shown.`;
    section.hidden = false;
  }

  at([a, b]) {
    return this.index.get(`${a} ${b}`);
  }

  /** Counts a visit, or with -1 takes one back. */
  visit(pair, times = 1) {
    const at = this.at(pair);
    if (at === undefined) return;
    const visits = (this.visits.get(at) ?? 0) + times;
    if (visits > 0) this.visits.set(at, visits);
    else this.visits.delete(at);
    this.items[at]?.classList.toggle("met", visits > 0);
  }

  clear() {
    for (const at of this.visits.keys()) this.items[at]?.classList.remove("met");
    this.visits.clear();
  }

  show(pair) {
    this.current?.removeAttribute("aria-current");
    const at = this.at(pair);
    const item = this.items[at];
    this.current = item;
    const now = document.createElement("b");
    now.textContent = this.text(pair);
    const met = `, ${this.visits.size} of ${this.pairs.length} pairs met on this walk.`;
    this.count.replaceChildren("Now ", now, at === undefined ? ", which is not among them!" : met);
    if (!item) return;
    item.setAttribute("aria-current", "true");
    // Scrolls only the list, never the page.
    const [box, here] = [this.list.getBoundingClientRect(), item.getBoundingClientRect()];
    if (here.top < box.top) this.list.scrollTop -= box.top - here.top + 8;
    if (here.bottom > box.bottom) this.list.scrollTop += here.bottom - box.bottom + 8;
  }
}

