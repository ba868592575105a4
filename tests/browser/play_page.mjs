// Tests the game in a headless Chromium. If a test fails, the exit code is 1 and there is one message.
//
//   node play_page.mjs CHROMIUM right=FILE loops=FILE ...
//
// right: a game that takes the doors of the folding explorer and makes only true claims, and wins; loops: the
// world is an edge from the marker to a place with two loops, each between two neighbouring doors.

import assert from "node:assert/strict";
import { DESK, LAPTOP, READER, assertFitsPhone, assertNamesReadable, photograph, visitAll } from "./visits.mjs";

/** What the page shows now. */
function shown(page) {
  return page.evaluate(() => {
    const text = (selector) => document.querySelector(selector).textContent;
    return {
      percept: text(".percept"),
      moves: text(".moves"),
      size: text(".map .size"),
      status: text(".status"),
      doors: [...document.querySelectorAll(".here .door")].map((door) => door.dataset.door),
      buttons: [...document.querySelectorAll(".doors button")].map((button) => button.textContent),
      rows: [...document.querySelectorAll(".percepts tbody tr")].map((row) => row.textContent),
      list: [...document.querySelectorAll(".listed li")].map((item) => item.textContent),
      names: [...document.querySelectorAll(".drawing .name")].map((name) => name.textContent),
      heading: text("#result-heading"),
      result: !document.querySelector(".result").hidden,
      worlds: document.querySelectorAll(".solution svg").length,
    };
  });
}

const readData = (page) => page.evaluate(() => JSON.parse(document.querySelector("#data").textContent));

/** The true robot, and the names that the page gives to the places it discovers. */
class TrueRobot {
  constructor({ world, start }) {
    Object.assign(this, { world, start, pose: start, entries: new Map([[start[0], start[1]]]) });
  }

  go(door) {
    const [v, i] = this.pose;
    this.pose = this.world[v][(i + door) % this.world[v].length];
  }

  percept() {
    const [v, i] = this.pose;
    const degree = this.world[v].length;
    const doors = degree === 1 ? "1 door" : `${degree} doors`;
    if (v !== this.start[0]) return `${doors}, no marker`;
    return `${doors}, the marker, along door ${(this.start[1] - i + degree) % degree}`;
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
    const svg = document.querySelector(".drawing");
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
  const width = () => page.evaluate(() => document.querySelector(".drawing .disc.here").getBoundingClientRect().width);
  const box = () => page.locator(".drawing").getAttribute("viewBox");
  // The size of the window has just changed.
  await page.waitForTimeout(100);
  const [fitting, small] = [await box(), await width()];
  await page.locator("#enlarge").click();
  await page.keyboard.press("+");
  assert.ok((await width()) > 1.3 * small, "a larger map has larger places");
  const before = await box();
  const { x, y } = await page.locator(".drawing").boundingBox();
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
  const data = await readData(page);
  const robot = new TrueRobot(data);
  assert.deepEqual(data.walks.map(({ name }) => name), ["Certificate", "Folding explorer", "Algorithm 1"]);
  const [certificate, folding, algorithm1] = data.walks.map(({ doors }) => doors);
  let claims = 0;
  for (const [step, door] of folding.entries()) {
    await go(page, door, door < 10 ? step % 3 : 1);
    robot.go(door);
    let now = await shown(page);
    assert.equal(now.percept, robot.percept());
    assert.equal(now.moves, step === 0 ? "1 move" : `${step + 1} moves`);
    assert.equal(now.rows.length, step + 2);
    assert.equal(now.doors.length, now.buttons.length);
    assert.equal(now.worlds, 0, "the world is shown before the end");
    const known = robot.known();
    if (known === null) {
      assert.match(now.status, /On your map, this is a new place\.$/);
    } else if (now.status.endsWith(`On your map, this is ${known.name}.`)) {
      assert.ok(now.list.some((item) => item.startsWith(`${known.name} (you are here)`)));
    } else {
      assert.match(now.status, /(new place|so claim it)\.$/);
      await claim(page, known);
      claims += 1;
      now = await shown(page);
      assert.equal(now.status, `This place is ${known.name}, and you came in by its door ${known.index}.`);
    }
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
  assert.match(before.size, /no open door$/);
  assert.equal(before.names.length, data.world.length);
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
  assert.match((await shown(page)).status, /5 doors, no marker\. On your map, this is a new place\.$/);
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
  assert.match(right[1], /another world looks the same on your walk/);
  await photograph(page, file, "guessed");
  const wrong = await finishWith(page, ["3", ["4"], "4"]);
  assert.equal(wrong[0], "Wrong map");
  assert.match(wrong[1], /^Your map is not the world: its v1 is several places, or one that is turned\.$/);
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
  assert.match((await shown(page)).status, /^This cannot be door 0 of v0: one place has/);
  await claim(page, { name: "v1", index: 1 });
  assert.match((await shown(page)).status, /^This cannot be door 1 of v1: a hallway would have only one end/);
  assert.match((await shown(page)).size, /^3 places/);
  // A wrong claim is found by a later percept: behind the door that it names is the marker.
  await page.evaluate(() => {
    const dart = [...document.querySelectorAll(".drawing .reach")][1 + 2];
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
  assert.match((await shown(page)).status, /^The last claim is withdrawn/);
  await press(page, ["w"]);
  assert.equal((await shown(page)).status, "There is no claim to withdraw.");
  return { walks: 3 };
}

async function visit(page, kind, file) {
  await photograph(page, file, "start");
  const found = kind === "right" ? await win(page, file) : await playLoops(page, file);
  for (const [name, size] of [["desk", DESK], ["laptop", LAPTOP]]) {
    await page.setViewportSize(size);
    await page.evaluate(() => scrollTo(0, 0));
    await photograph(page, file, name);
  }
  await page.emulateMedia({ colorScheme: "dark" });
  await photograph(page, file, "dark");
  await page.emulateMedia({ colorScheme: "light" });
  await assertFitsPhone(page);
  await assertNamesReadable(page, [".drawing .name", ".drawing .index", ".here .door text"]);
  await assertTouchable(page);
  await photograph(page, file, "phone");
  return found;
}

await visitAll(["right", "loops"], visit);
