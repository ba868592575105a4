// Tests the game in a headless Chromium. If a test fails, the exit code is 1 and there is one message.
//
//   node play_page.mjs CHROMIUM right=FILE loops=FILE guessed=FILE ...
//
// right: a game with a directional marker that takes the doors of the folding explorer and makes only true claims, and
// wins; loops: the world is an edge from the marker to a place with two loops, each between two neighbouring doors;
// guessed: figure 1(a) with an undirected marker, which no walk proves; proved: a world in which a walk through every door
// proves the map with the marker of the page; movable: the walk of the movable marker algorithm; aid: a game with an aid
// that moves, in which random actions are taken until the map is complete, and all is claimed that is true.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { DESK, LAPTOP, READER, assertFitsPhone, assertNamesReadable, assertReadable, photograph, seeded, visitAll } from "./visits.mjs";

/** What the page shows now. */
function shown(page) {
  return page.evaluate(() => {
    const text = (selector) => document.querySelector(selector).textContent;
    return {
      percept: text(".play .percept"),
      moves: text(".moves"),
      size: text(".map .size"),
      status: text(".status"),
      doors: [...document.querySelectorAll(".here .door")].map((door) => door.dataset.door),
      buttons: [...document.querySelectorAll(".doors button")].map((button) => button.textContent),
      rows: [...document.querySelectorAll(".percepts tbody tr")].map((row) => row.textContent),
      list: [...document.querySelectorAll(".listed li")].map((item) => item.textContent),
      names: [...document.querySelectorAll(".play .drawing .name")].map((name) => name.textContent),
      heading: text("#result-heading"),
      result: !document.querySelector(".result").hidden,
      worlds: document.querySelectorAll(".solution svg").length,
      claims: [...document.querySelectorAll(".claims li")].map((item) => item.firstChild.textContent),
    };
  });
}

/** The games of the page. */
const readGames = async (page) =>
  (await page.evaluate(() => JSON.parse(document.querySelector("#data").textContent))).games;

/** The true robot, and the names that the page gives to the places it discovers. */
class TrueRobot {
  constructor({ world, start }) {
    Object.assign(this, { world, start, pose: start, entries: new Map([[start[0], start[1]]]) });
  }

  go(door) {
    const [v, i] = this.pose;
    this.pose = this.world[v][(i + door) % this.world[v].length];
  }

  /** With a directional marker. */
  percept() {
    const [v, i] = this.pose;
    const degree = this.world[v].length;
    const doors = degree === 1 ? "1 door" : `${degree} doors`;
    return v === this.start[0] ? `${doors}, marker along door ${(this.start[1] - i + degree) % degree}` : doors;
  }

  /** The name of the place and the number of the door behind the robot; null if the place is new. */
  known() {
    const [v, i] = this.pose;
    if (!this.entries.has(v)) {
      this.entries.set(v, i);
      return null;
    }
    const degree = this.world[v].length;
    return { name: `v${[...this.entries.keys()].indexOf(v)}`, index: (i - this.entries.get(v) + degree) % degree };
  }
}

/** Goes through a door: by the picture, by a button or by a key. */
async function go(page, door, way) {
  if (way === 0) await page.locator(`.here .door[data-door="${door}"] .badge`).click();
  else if (way === 1) await page.locator(".doors button").nth(door).click();
  else await page.keyboard.press(String(door));
}

/** If the place is a known one and the map does not show it, claims it. Returns whether it did. */
async function claimIfKnown(page, robot) {
  const known = robot.known();
  const { status, list } = await shown(page);
  if (known === null) {
    assert.match(status, /On your map, this is a new place\.$/);
    return false;
  }
  if (status.endsWith(`On your map, this is ${known.name}.`)) {
    assert.ok(list.some((item) => item.startsWith(`${known.name} (you are here)`)));
    return false;
  }
  assert.match(status, /(new place|so claim it)\.$/);
  await claim(page, known);
  assert.equal((await shown(page)).status, `This place is ${known.name}, and you came in by its door ${known.index}.`);
  return true;
}

async function claim(page, { name, index }) {
  const options = await page.locator("#place option").allTextContents();
  const option = options.find((text) => text.startsWith(`${name},`));
  assert.ok(option, `${name} is not offered: ${options}`);
  await page.locator("#place").selectOption({ label: option });
  await page.locator("#dart").selectOption(String(index));
  await page.locator("#claim").click();
}

/** The rows of the comparison: name, moves and ratio. */
const compared = (page) =>
  page.evaluate(() =>
    [...document.querySelectorAll(".comparison tbody tr")].map((row) => [...row.cells].slice(0, 3).map((c) => c.textContent)),
  );

/** No button that is shown is too small for a finger. */
async function assertTouchable(page) {
  const heights = await page.evaluate(() => {
    const buttons = [...document.querySelectorAll("button, select")];
    return buttons.map((button) => button.getBoundingClientRect().height).filter((height) => height > 0);
  });
  assert.ok(heights.length > 3 && Math.min(...heights) >= 40, `buttons are ${heights} pixels high`);
}

/** The whole map is in its panel, and no hallway passes a place, so that its doors seem to be followed. */
async function assertClear(page) {
  const faults = await page.evaluate(() => {
    const svg = document.querySelector(".play .drawing");
    const panel = svg.getBoundingClientRect();
    const discs = [...svg.querySelectorAll(".disc")].map((disc) => {
      const { left, right, top, bottom } = disc.getBoundingClientRect();
      return { x: (left + right) / 2, y: (top + bottom) / 2, radius: (right - left) / 2 };
    });
    const outside = discs.filter(
      ({ x, y, radius }) =>
        x - radius < panel.left || x + radius > panel.right || y - radius < panel.top || y + radius > panel.bottom,
    );
    const passages = [...svg.querySelectorAll("path:not([class])")].flatMap((way) => {
      const toWindow = way.getScreenCTM();
      const length = way.getTotalLength();
      const points = [...Array(41).keys()].map((part) => way.getPointAtLength((part / 40) * length).matrixTransform(toWindow));
      // It ends at two doors, on the edge of their discs.
      return discs.filter(({ x, y, radius }) => points.some((at) => Math.hypot(at.x - x, at.y - y) < 0.9 * radius));
    });
    return { outside: outside.length, passages: passages.length };
  });
  assert.deepEqual(faults, { outside: 0, passages: 0 });
}

/** The map is enlarged around the robot, moved with the pointer, and fits again. */
async function enlargeAndFit(page) {
  const width = () => page.evaluate(() => document.querySelector(".play .drawing .disc.here").getBoundingClientRect().width);
  const box = () => page.locator(".play .drawing").getAttribute("viewBox");
  // The size of the window has just changed.
  await page.waitForTimeout(100);
  const [fitting, small] = [await box(), await width()];
  await page.locator("#enlarge").click();
  await page.keyboard.press("+");
  assert.ok((await width()) > 1.3 * small, "a larger map has larger places");
  const before = await box();
  const { x, y } = await page.locator(".play .drawing").boundingBox();
  await page.mouse.move(x + 60, y + 60);
  await page.mouse.down();
  await page.mouse.move(x + 100, y + 80);
  await page.mouse.up();
  const after = await box();
  const [from, to] = [before, after].map((text) => text.split(" ").map(Number));
  assert.ok(to[0] < from[0] && to[1] < from[1] && to[2] === from[2], `${before} moved to ${after}`);
  await page.keyboard.press("-");
  await page.locator("#reduce").click();
  assert.equal(await box(), fitting);
  await page.locator("#enlarge").click();
  await page.locator("#fit").click();
  assert.equal(await box(), fitting);
}

/** In the middle of a game, on a phone and in the dark. */
async function atHalf(page, file) {
  await photograph(page, file, "half");
  await assertFitsPhone(page);
  await assertTouchable(page);
  await page.setViewportSize(READER);
  await photograph(page, file, "half-phone");
  await page.emulateMedia({ colorScheme: "dark" });
  await page.setViewportSize(LAPTOP);
  await photograph(page, file, "half-dark");
  await page.emulateMedia({ colorScheme: "light" });
  await page.setViewportSize(DESK);
}

async function win(page, file) {
  const [game] = await readGames(page);
  const robot = new TrueRobot(game);
  assert.deepEqual(game.walks.map(({ name }) => name), ["Certificate", "Folding explorer", "Algorithm 1"]);
  const [certificate, folding, algorithm1] = game.walks.map(({ actions }) => actions.map(Number));
  let claims = 0;
  for (const [step, door] of folding.entries()) {
    await go(page, door, door < 10 ? step % 3 : 1);
    robot.go(door);
    const now = await shown(page);
    assert.equal(now.percept, robot.percept());
    assert.equal(now.moves, step === 0 ? "1 move" : `${step + 1} moves`);
    assert.equal(now.rows.length, step + 2);
    assert.equal(now.doors.length, now.buttons.length);
    assert.equal(now.worlds, 0, "the world is shown before the end");
    if (await claimIfKnown(page, robot)) claims += 1;
    await assertClear(page);
    if (step === Math.floor(folding.length / 2)) {
      await atHalf(page, file);
      await enlargeAndFit(page);
      await page.setViewportSize(READER);
      await assertClear(page);
      await page.setViewportSize(DESK);
    }
  }
  const before = await shown(page);
  assert.match(before.size, /no open doors$/);
  assert.equal(before.names.length, game.world.length);
  assert.equal(before.result, false);
  await page.getByRole("button", { name: "My map is complete" }).click();
  const now = await shown(page);
  assert.equal(now.heading, "Right, and proved");
  assert.deepEqual([now.result, now.worlds], [true, 1]);
  const ratio = (doors) => (doors.length / certificate.length).toFixed(2);
  assert.deepEqual(await compared(page), [
    ["Certificate", String(certificate.length), "1.00"],
    ["You", String(folding.length), ratio(folding)],
    ["Folding explorer", String(folding.length), ratio(folding)],
    ["Algorithm 1", String(algorithm1.length), ratio(algorithm1)],
  ]);
  return { moves: folding.length, claims };
}

/** Walks at random for so many moves an edge, and claims what is true. Returns the number of moves. */
async function walkAtRandom(page, { world, start }, movesPerEdge) {
  const robot = new TrueRobot({ world, start });
  const random = seeded(2);
  const moves = (movesPerEdge * world.flat().length) / 2;
  for (let move = 0; move < moves; move += 1) {
    const door = random(world[robot.pose[0]].length);
    await page.keyboard.press(String(door));
    robot.go(door);
    await claimIfKnown(page, robot);
  }
  return moves;
}

/** Another world looks the same on the walk, and the page draws it. */
async function guess(page, file) {
  const [game, next] = await readGames(page);
  const moves = await walkAtRandom(page, game, 8);
  await page.keyboard.press("f");
  assert.equal((await shown(page)).heading, "Right, but guessed");
  assert.match(await page.locator(".reason").textContent(), /perceives what you perceived, and your map would be wrong\.$/);
  assert.equal(await page.locator(".other .kind").textContent(), "The smallest other world");
  assert.equal(await page.locator(".other .size").textContent(), "5 places, 8 edges");
  assert.equal(await page.locator(".other .disc").count(), 5);
  assert.equal(await page.locator(".other .disc.here").count(), 1);
  // No algorithm maps with this marker.
  assert.deepEqual(await page.locator(".comparison tbody tr").allTextContents(), [`You${moves}${await page.locator(".comparison .faint").textContent()}`]);
  assert.equal(await page.locator(".comparison .ratio").isVisible(), false);
  await photograph(page, file, "guessed");
  await assertNamesReadable(page, [".other .name", ".other .index"]);
  // Another start of the same world: the marker is on the rim of the wheel, where a walk shows which wheel it is.
  await page.getByRole("button", { name: "Another world" }).click();
  const again = await shown(page);
  assert.match(again.status, /^World 2 of \d+\. You begin: /);
  assert.deepEqual([again.result, again.moves, again.doors.length], [false, "0 moves", next.world[next.start[0]].length]);
  await walkAtRandom(page, next, 8);
  await page.keyboard.press("f");
  assert.equal((await shown(page)).heading, "Right, and proved");
  return { moves };
}

/** A walk through every door proves the map. */
async function prove(page) {
  const [game] = await readGames(page);
  const moves = await walkAtRandom(page, game, 8);
  await page.keyboard.press("f");
  assert.equal((await shown(page)).heading, "Right, and proved");
  assert.equal(await page.locator(".other").isVisible(), false);
  return { moves };
}

/** The movable marker is picked up and dropped by buttons and by keys, and the moves are compared with the algorithm's. */
async function carry(page, file) {
  const [game] = await readGames(page);
  assert.deepEqual(game.walks.map(({ name }) => name), ["Place and back-link validation"]);
  const [{ actions }] = game.walks;
  const robot = new TrueRobot(game);
  await press(page, ["d"]);
  assert.equal((await shown(page)).status, "You do not carry the marker.");
  for (const [step, action] of actions.entries()) {
    if (/^\d+$/.test(action)) {
      await go(page, Number(action), step % 2);
      robot.go(Number(action));
      await claimIfKnown(page, robot);
    } else {
      if (step % 2) await page.keyboard.press(action[0]);
      else await page.getByRole("button", { name: action.replace("-", " "), exact: true }).click();
      assert.match((await shown(page)).percept, action === "drop" ? /, marker$/ : /; you carry the marker$/);
    }
    assert.equal(await page.locator(".here .carrying").count(), (await shown(page)).percept.endsWith("carry the marker") ? 1 : 0);
    if (step === actions.length >> 1) await photograph(page, file, "carrying");
  }
  await page.keyboard.press("f");
  assert.match((await shown(page)).heading, /^Right, /);
  const moves = String(actions.filter((action) => /^\d+$/.test(action)).length);
  const rows = await page.evaluate(() => [...document.querySelectorAll(".comparison tbody tr")].map((row) => [...row.cells].slice(0, 2).map((cell) => cell.textContent)));
  assert.deepEqual(rows, [["You", moves], ["Place and back-link validation", moves]]);
  return { moves };
}

/** The robots of the specification, as the pages have them. */
const read = (name) => readFileSync(new URL(`../../draw/src/page/browser/${name}`, import.meta.url), "utf8");
const { Graph, Robot } = new Function(`${read("graph.js")}\n${read("marker.js")}\nreturn { Graph, Robot };`)();

/** The places that robots have discovered: as the page calls them, and the dart by which each was first entered. */
class Discovered {
  constructor(truth) {
    this.names = new Map([[truth.graph.vertex(truth.pose), "v0"]]);
    this.entries = new Map([[truth.graph.vertex(truth.pose), truth.pose]]);
  }

  /** The pose of a robot; the explorer is number 0. */
  static pose(truth, number) {
    return number === 0 ? truth.pose : truth.placed[number - 1];
  }

  /** A robot goes away: its place gets a name, if it has none. */
  leave({ graph }, pose) {
    if (!this.names.has(graph.vertex(pose))) this.names.set(graph.vertex(pose), `v${this.names.size}`);
  }

  /** What can be claimed of a robot that has come in: the place and the door; null if the place is new. */
  arrive(truth, number) {
    const { graph } = truth;
    const pose = Discovered.pose(truth, number);
    const vertex = graph.vertex(pose);
    const first = this.entries.get(vertex);
    if (first === undefined) {
      this.entries.set(vertex, pose);
      return null;
    }
    const robots = [...Array(truth.aid.others + 1).keys()].filter((other) => other !== number);
    const there = robots.filter((other) => graph.vertex(Discovered.pose(truth, other)) === vertex);
    const name = this.names.get(vertex) ?? (there[0] === 0 ? "?" : `?${there[0] + 1}`);
    return { name, index: graph.door(first, pose) };
  }
}

/** A game with an aid that moves, by the buttons of its actions. */
async function playAid(page, file) {
  const { marker, games } = await page.evaluate(() => JSON.parse(document.querySelector("#data").textContent));
  const [{ world, start }] = games;
  const graph = Graph.of(world);
  const truth = Robot.start(marker, graph, graph.dart(start));
  const discovered = new Discovered(truth);
  const random = seeded(5);
  const isOpen = async () => !/no open doors$/.test((await shown(page)).size);
  let [moves, steps, claims] = [0, 0, 0];
  for (; steps < 600 && (await isOpen()); steps += 1) {
    const possible = truth.actions();
    assert.deepEqual(await page.locator(".doors button").evaluateAll((all) => all.map((it) => it.dataset.action)), possible);
    const action = possible[random(possible.length)];
    const sent = action.match(/^send-(\d):/);
    const isMove = sent !== null || /^\d+$/.test(action);
    const number = sent === null ? 0 : Number(sent[1]) - 1;
    if (isMove) discovered.leave(truth, Discovered.pose(truth, number));
    await page.locator(`.doors button[data-action="${action}"]`).click();
    truth.act(action);
    const { percept, status } = await shown(page);
    const { sighting, degree } = truth.percept();
    const sensed = (degree === 1 ? "1 door" : `${degree} doors`) + (sighting === "no marker" ? "" : `, ${sighting}`);
    assert.equal(percept, sensed + (truth.held && `; ${truth.held}`));
    assert.doesNotMatch(status, /wrong|undefined|NaN/);
    if (isMove) {
      moves += 1;
      const known = discovered.arrive(truth, number);
      if (known !== null && (await claimOf(page, number, known))) claims += 1;
    }
    if (steps === 12) {
      await atHalf(page, file);
      await assertReadable(page, file, "half");
    }
  }
  await page.locator("#finish").click();
  assert.match((await shown(page)).heading, /^Right, (and proved|but guessed|proof not known)$/);
  const rows = await page.evaluate(() => [...document.querySelectorAll(".comparison tbody tr")].map((row) => [...row.cells].slice(0, 2).map((cell) => cell.textContent)));
  assert.deepEqual(rows[0], ["You", String(moves)]);
  return { marker, heading: (await shown(page)).heading, steps, moves, claims, rows: rows.length };
}

/** Claims where a robot is, if the map does not show it. Returns whether it did. */
async function claimOf(page, number, { name, index }) {
  if (await page.locator("#who").isVisible()) await page.locator("#who").selectOption(String(number));
  const options = await page.locator("#place option").allTextContents();
  const option = options.find((text) => text.startsWith(`${name},`));
  // Where the robot is on the map is not offered.
  if (option === undefined) return false;
  await page.locator("#place").selectOption({ label: option });
  await page.locator("#dart").selectOption(String(index));
  await page.locator("#claim").click();
  assert.match((await shown(page)).status, number === 0 ? /^This place is / : /^Robot \d is at /);
  return true;
}

/** Answers the next question of the page. */
function answerNext(page, answer) {
  page.once("dialog", (dialog) => (answer ? dialog.accept() : dialog.dismiss()));
}

const press = async (page, keys) => {
  for (const key of keys) await page.keyboard.press(key);
};

/** A claim by keys alone: the place and the door are chosen, and Enter presses the button. */
async function claimByKeys(page, index) {
  await page.keyboard.press("c");
  assert.equal(await page.evaluate(() => document.activeElement.id), "place");
  await page.locator("#place").selectOption({ label: "v1, 5 doors" });
  await page.locator("#dart").selectOption(String(index));
  // A digit in a list is no door.
  await page.locator("#place").press("0");
  await page.locator("#claim").focus();
  await page.keyboard.press("Enter");
}

/** Two claims, then the end. Returns the heading and the reason. */
async function finishWith(page, [first, doors, second]) {
  await page.keyboard.press("r");
  await press(page, ["0", "1"]);
  assert.match((await shown(page)).status, /5 doors\. On your map, this is a new place\.$/);
  await claimByKeys(page, first);
  await press(page, doors);
  await claimByKeys(page, second);
  await page.keyboard.press("f");
  const now = await shown(page);
  assert.equal(await page.evaluate(() => document.activeElement.id), "result-heading");
  return [now.heading, await page.locator(".reason").textContent(), now.moves];
}

async function playLoops(page, file) {
  const right = await finishWith(page, ["2", ["1"], "4"]);
  assert.deepEqual([right[0], right[2]], ["Right, but guessed", "3 moves"]);
  assert.match(right[1], /your map would be wrong\.$/);
  // Of the four open doors of the place with five, two are known to be one hallway, and two others too: without the sight
  // of the marker, the smallest other world has its loops elsewhere.
  assert.equal(await page.locator(".other .size").textContent(), "2 places, 3 edges");
  await photograph(page, file, "guessed");
  const wrong = await finishWith(page, ["3", ["4"], "4"]);
  assert.equal(wrong[0], "Wrong map");
  assert.match(wrong[1], /^Your map is not the world: your v1 stands for several places of the world, or for one that is turned\.$/);
  assert.equal((await compared(page))[1][0], "You (wrong map)");
  // After the end nothing moves, and the page says so.
  await page.keyboard.press("0");
  assert.equal((await shown(page)).moves, "3 moves");
  assert.equal((await shown(page)).status, "The run has ended. Restart it to try again.");
  assert.ok(await page.locator(".status").isVisible());
  assert.equal(await page.locator(".doors").isVisible(), false);
  await page.keyboard.press("r");
  const again = await shown(page);
  assert.deepEqual([again.result, again.worlds, again.moves], [false, 0, "0 moves"]);
  // A key that is held counts once.
  await page.keyboard.down("0");
  await page.keyboard.down("0");
  await page.keyboard.up("0");
  assert.equal((await shown(page)).moves, "1 move");
  // A run is discarded only if the person agrees.
  answerNext(page, false);
  await page.keyboard.press("r");
  assert.equal((await shown(page)).moves, "1 move");
  answerNext(page, true);
  await page.keyboard.press("r");
  assert.equal((await shown(page)).moves, "0 moves");
  // What the percepts contradict is refused.
  await press(page, ["f"]);
  assert.match((await shown(page)).status, /not complete: a door of v0 leads nowhere/);
  await press(page, ["7"]);
  assert.match((await shown(page)).status, /There is no door 7 here/);
  await press(page, ["0", "1"]);
  await claim(page, { name: "v0", index: 0 });
  assert.equal((await shown(page)).status, "This cannot be door 0 of v0: v0 has 1 door, this place has 5.");
  await claim(page, { name: "v1", index: 1 });
  assert.match((await shown(page)).status, /^This cannot be door 1 of v1: a hallway would have only one end/);
  assert.match((await shown(page)).size, /^3 places/);
  // A wrong claim is found by a later percept: behind the door that it names is the marker.
  await page.evaluate(() => {
    const dart = [...document.querySelectorAll(".play .drawing .reach")][1 + 2];
    dart.dispatchEvent(new MouseEvent("click", { bubbles: true }));
  });
  assert.match((await shown(page)).status, /^Claim that this place is v1, and that you came in by its door 2\?/);
  await claim(page, { name: "v1", index: 3 });
  assert.match((await shown(page)).status, /^This place is v1/);
  await press(page, ["2"]);
  const found = await shown(page);
  assert.match(found.status, /A claim of yours is wrong: .* Withdraw it\.$/);
  await press(page, ["f"]);
  assert.match((await shown(page)).status, /^A claim of yours is wrong/);
  await photograph(page, file, "contradiction");
  await press(page, ["w"]);
  assert.match((await shown(page)).status, /^Withdrawn: Move 2: v1, by its door 3\. /);
  await press(page, ["w"]);
  assert.equal((await shown(page)).status, "There is no claim to withdraw.");
  // Any claim can be withdrawn.
  answerNext(page, true);
  await press(page, ["r", "0", "1"]);
  await claim(page, { name: "v1", index: 2 });
  await press(page, ["1"]);
  await claim(page, { name: "v1", index: 4 });
  assert.deepEqual((await shown(page)).claims, ["Move 2: v1, by its door 2", "Move 3: v1, by its door 4"]);
  await page.locator(".claims button").first().click();
  const left = await shown(page);
  assert.match(left.status, /^Withdrawn: Move 2: v1, by its door 2\. /);
  assert.equal(left.claims.length, 1);
  // The marker is seen again, at a place that is not claimed: at each arrival the page asks for the claim.
  answerNext(page, true);
  await press(page, ["r", "0", "1", "3"]);
  const prompt = /The marker lies here, and on your map it lies elsewhere: you know this place, so claim it\.$/;
  assert.match((await shown(page)).status, prompt);
  await press(page, ["0", "0"]);
  assert.match((await shown(page)).status, prompt);
  return { walks: 3 };
}

async function visit(page, kind, file) {
  await photograph(page, file, "start");
  const games = { right: win, loops: playLoops, guessed: guess, proved: prove, movable: carry, aid: playAid };
  const found = await games[kind](page, file);
  await assertReadable(page, file, "end");
  for (const [name, size] of [["desk", DESK], ["laptop", LAPTOP]]) {
    await page.setViewportSize(size);
    await page.evaluate(() => scrollTo(0, 0));
    await photograph(page, file, name);
  }
  await page.emulateMedia({ colorScheme: "dark" });
  await photograph(page, file, "dark");
  await page.emulateMedia({ colorScheme: "light" });
  await assertFitsPhone(page);
  await assertNamesReadable(page, [".play .drawing .name", ".play .drawing .index", ".here .door text"]);
  await assertTouchable(page);
  await photograph(page, file, "phone");
  return found;
}

await visitAll(["right", "loops", "guessed", "proved", "movable", "aid"], visit);
