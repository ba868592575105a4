// Tests the walk pages in a headless Chromium. If a test fails, the exit code is 1 and there is one message.
//
//   node walk_page.mjs CHROMIUM alike=FILE apart=FILE team=FILE string=FILE ...
//
// alike: no walk distinguishes the two worlds of the page; apart: the page has one that does; team, string: figure 1 with
// two robots, and with a string as long as two edges.

import assert from "node:assert/strict";
import { DESK, assertFitsPhone, photograph, seeded, visitAll } from "./visits.mjs";

const DOORS = 50;

/** What the page shows now. */
function shown(page) {
  return page.evaluate(() => {
    const text = (element) => element?.textContent ?? null;
    const rows = [...document.querySelectorAll(".percepts tbody tr")];
    return {
      // The newest row is the first.
      rows: rows.reverse().map((row) => ({
        cells: [...row.cells].map(text),
        differs: row.classList.contains("differs"),
      })),
      states: [...document.querySelectorAll(".world .state")].map(text),
      lit: [...document.querySelectorAll(".world")].map((w) => w.classList.contains("differs")),
      doors: [...document.querySelectorAll(".world")].map((world) =>
        [...world.querySelectorAll(".own-doors [data-action]")].map((door) => door.dataset.action),
      ),
      pair: text(document.querySelector(".pairs [aria-current]")),
      current: document.querySelectorAll(".pairs [aria-current]").length,
      met: document.querySelectorAll(".pairs .met").length,
      status: text(document.querySelector(".status")),
    };
  });
}

const readData = (page) => page.evaluate(() => JSON.parse(document.querySelector("#data").textContent));

/** The poses of both robots, each a vertex and an index. */
const starts = ({ sides, pose }) => [sides[0].facing, pose];
const after = ({ sides }, poses, door) =>
  poses.map(([v, i], side) => {
    const ends = sides[side].world[v];
    return ends[(i + Number(door)) % ends.length];
  });
const text = ({ sides }, poses) => poses.map(([v, i], side) => `${sides[side].vertices[v]}:${i}`);
const degrees = ({ sides }, poses) => poses.map(([v], side) => sides[side].world[v].length);

/** The newest row is that of this step, and equal columns look equal. */
function assertShows(now, step, action) {
  const { cells, differs } = now.rows.at(-1);
  assert.deepEqual(cells.slice(0, 2), [String(step), action]);
  const isEqual = cells[2] === cells[4];
  assert.equal(cells[3], isEqual ? "=" : "≠");
  assert.equal(differs, !isEqual);
  assert.deepEqual(now.lit, [!isEqual, !isEqual]);
}

/** Random doors, clicked in the one and the other picture and by keys: always equal percepts. */
async function walkAlike(page) {
  const data = await readData(page);
  assert.equal(await page.locator(".relation").isVisible(), true);
  assert.equal(await page.locator("#distinguish").isVisible(), false);
  const random = seeded(1);
  let poses = starts(data);
  for (let step = 1; step <= DOORS; step += 1) {
    const { doors } = await shown(page);
    assert.deepEqual([...doors[0]].sort(), [...doors[1]].sort());
    const action = doors[0][random(doors[0].length)];
    if (step % 2) {
      const world = page.locator(`.world[data-side="${(step >> 1) % 2}"]`);
      await world.locator(`.own-doors [data-action="${action}"] .badge`).click();
    } else {
      await page.keyboard.press(action);
    }
    poses = after(data, poses, action);
    const now = await shown(page);
    assert.equal(now.rows.length, step + 1);
    assertShows(now, step, action);
    assert.deepEqual(now.states, text(data, poses));
    const [a, b] = degrees(data, poses);
    assert.deepEqual([now.rows.at(-1).cells[2].split(" ")[0], a], [String(a), b]);
    const equal = now.rows.every(({ cells }) => cells[2] === cells[4]);
    assert.ok(equal, `the columns of percepts are no longer equal after ${step} doors`);
    assert.equal(now.current, 1);
    assert.equal(now.pair, text(data, poses).join(" ~ "));
  }
  const walked = await shown(page);
  const pairs = await page.locator(".pairs li").count();
  assert.ok(walked.met > 10 && walked.met <= pairs, `${walked.met} of ${pairs} pairs met`);
  return { doors: DOORS, pairs: walked.met };
}

/**
 * The reader chooses a directional marker, hides the worlds, and finds the shortest walk that distinguishes those of
 * figure 1: the doors 0, 1, 1.
 */
async function chooseAndFind(page, file) {
  const about = () => page.locator(".about").textContent();
  assert.match(await about(), /^One undirected marker .* no walk distinguishes these worlds/);
  await page.locator("#marker").selectOption("directional");
  assert.match(await about(), /^One directional marker .* the walk 0, 1, 1 distinguishes these worlds\.$/);
  assert.equal(await page.locator(".relation").isVisible(), false);
  assert.equal((await shown(page)).rows.length, 1);
  assert.equal(await page.locator(".world .mark").count(), 2);
  await photograph(page, file, "directional");
  await page.getByRole("button", { name: "Hide the worlds" }).click();
  assert.match(await about(), /Find one, or show the worlds\.$/);
  for (const hidden of [".world svg", ".marker-place", "#distinguish", ".state"]) {
    assert.equal(await page.locator(hidden).first().isVisible(), false, hidden);
  }
  assert.equal(await page.locator(".world .percept").first().textContent(), "4 doors, marker along door 0");
  for (const door of ["0", "1", "1"]) await page.keyboard.press(door);
  assert.match((await shown(page)).status, /You have distinguished the worlds in 3 steps\. The shortest walk .* has 3 of them\.$/);
  await photograph(page, file, "blind");
  await page.keyboard.press("h");
  assert.equal(await page.locator(".world svg").first().isVisible(), true);
  assert.match((await shown(page)).status, /they differ\. A: .*; B: [^.]*\.$/);
  for (const marker of ["none", "undirected-edge", "directed-edge", "two-identical", "two-distinct", "movable"]) {
    await page.locator("#marker").selectOption(marker);
    await photograph(page, file, marker);
  }
  // The robots carry the marker from the hub to the rim.
  await page.getByRole("button", { name: "pick up" }).click();
  assert.equal(await page.locator(".world .carrying").count(), 2);
  assert.equal(await page.locator(".marker-place").first().textContent(), "The robot carries the marker.");
  await page.locator("main").click({ position: { x: 2, y: 2 } });
  await page.keyboard.press("0");
  await page.keyboard.press("d");
  assert.deepEqual((await shown(page)).states, ["a:1@a", "A:1@A"]);
  await page.locator("#marker").selectOption("undirected");
}

/** Undo, restart, a random walk, and doors by the buttons, all without a pointer. */
async function walkByKeyboard(page) {
  await page.keyboard.press("r");
  const start = await shown(page);
  assert.equal(start.rows.length, 1);
  await page.keyboard.press("0");
  await page.keyboard.press("Backspace");
  assert.deepEqual(await shown(page), { ...start, status: (await shown(page)).status });
  await page.getByRole("button", { name: "door 1", exact: true }).focus();
  await page.keyboard.press("Enter");
  assert.equal((await shown(page)).rows.at(-1).cells[1], "1");
  await page.locator("#restart").focus();
  await page.keyboard.press("Space");
  assert.equal((await shown(page)).rows.length, 1);
  await page.locator("#random").focus();
  await page.keyboard.press("Enter");
  await page.locator('#random[aria-pressed="true"]').waitFor();
  await page.locator(".percepts tbody tr").nth(4).waitFor();
  await page.keyboard.press("Enter");
  assert.equal(await page.locator("#random").getAttribute("aria-pressed"), "false");
  const stopped = (await shown(page)).rows.length;
  await page.waitForTimeout(1000);
  assert.equal((await shown(page)).rows.length, stopped);
}

/** The walk that distinguishes the worlds: equal percepts up to its end, different ones there. */
async function tellApart(page) {
  const [, listed] = (await page.locator(".about").textContent()).match(/ the walk (.*) distinguishes these worlds\.$/);
  const walk = listed.split(", ");
  await page.getByRole("button", { name: "Play the walk that distinguishes them" }).click();
  const rows = page.locator(".percepts tbody tr");
  await rows.nth(walk.length).waitFor({ timeout: 5000 + 2000 * walk.length });
  const now = await shown(page);
  assert.equal(now.rows.length, walk.length + 1);
  assert.deepEqual(now.rows.slice(1).map(({ cells }) => cells[1]), walk);
  assertShows(now, walk.length, walk.at(-1));
  for (const [step, { cells, differs }] of now.rows.entries()) {
    const last = step === walk.length;
    assert.equal(cells[2] !== cells[4], last, `step ${step}: ${cells}`);
    assert.equal(differs, last);
  }
  assert.match(now.status, /differ/);
  const alone = now.doors.flatMap((doors, side) => doors.filter((door) => !now.doors[1 - side].includes(door)));
  for (const door of alone) {
    // It is marked as disabled, and gives the reason when it is pressed.
    await page.getByRole("button", { name: `door ${door}`, exact: true }).click({ force: true });
    const after = await shown(page);
    assert.equal(after.rows.length, now.rows.length);
    assert.match(after.status, /^Only [AB] /);
  }
  return { walk: walk.join(" ") };
}

const press = (page, ...names) =>
  names.reduce((before, name) => before.then(() => page.getByRole("button", { name, exact: true }).click()), Promise.resolve());
const places = (page) => page.locator(".marker-place").allTextContents();
/** What both robots perceive. */
async function perceived(page) {
  const { cells } = (await shown(page)).rows.at(-1);
  assert.equal(cells[2], cells[4]);
  return cells[2];
}

/** Robot 2 goes ahead, the explorer follows it, and Undo brings both back. */
async function sendAhead(page) {
  assert.equal(await perceived(page), "4 doors, robot 2 here along door 0");
  assert.equal(await page.locator(".other-robot path").count(), 2);
  await press(page, "send robot 2 through door 1");
  assert.equal(await perceived(page), "4 doors, robot 2 elsewhere at 3 doors");
  assert.deepEqual((await shown(page)).states, ["x:0&2@b:1", "X:0&2@B:1"]);
  assert.deepEqual(await places(page), ["Robot 2 is at b, by the small number 1.", "Robot 2 is at B, by the small number 1."]);
  assert.match((await shown(page)).status, /^Step 1, send robot 2 through door 1: both perceive/);
  await page.keyboard.press("1");
  assert.equal(await perceived(page), "3 doors, robot 2 here along door 0");
  await press(page, "send robot 2 through door 0, back", "Undo", "Undo");
  assert.deepEqual((await shown(page)).states, ["x:0&2@b:1", "X:0&2@B:1"]);
  await page.locator("#marker").selectOption("team-3-round");
  assert.equal(await page.locator(".other-robot circle").count(), 4);
  await press(page, "send robot 3 through door 2");
  assert.equal(await perceived(page), "4 doors, robot 2 here, robot 3 elsewhere at 3 doors");
  return { walked: (await shown(page)).states };
}

/** The string is laid over two edges, its end is dropped, and taken back. */
async function layString(page, file) {
  assert.equal(await perceived(page), "4 doors, fixed end");
  await press(page, "door 1", "door 2");
  assert.equal(await page.locator(".world .string").count(), 4);
  assert.match((await places(page))[0], /^The string is fixed at x \(dotted\), runs to b, then d, and the robot holds/);
  await photograph(page, file, "laid");
  await page.keyboard.press("1");
  const short = await shown(page);
  assert.deepEqual([short.rows.length, short.status], [3, "The string is too short for door 1."]);
  await page.keyboard.press("d");
  assert.match(await perceived(page), /^3 doors, string through door 0, free end$/);
  await press(page, "door 1", "door 0, back");
  await press(page, "pick up", "door 2");
  assert.match(await perceived(page), /^3 doors, string through door \d, from the hand through door \d$/);
  assert.equal(await page.locator(".world .string").count(), 2);
  return { walked: (await shown(page)).states };
}

/** Nothing to scroll sideways on a phone, and doors that a finger hits. */
async function holdAsPhone(page) {
  await assertFitsPhone(page);
  const widths = await page.evaluate(async () => {
    // The doors are drawn again when the pictures have their new size.
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    const doors = [...document.querySelectorAll(".own-doors .reach")];
    return doors.map((door) => door.getBoundingClientRect().width);
  });
  assert.ok(widths.length > 0, "there is no door to touch");
  for (const width of widths) assert.ok(width >= 40, `a door is only ${width} pixels wide on a phone`);
}

async function visit(page, kind, file) {
  await photograph(page, file, "start");
  const found = await { alike: walkAlike, apart: tellApart, team: sendAhead, string: layString }[kind](page, file);
  await photograph(page, file, "light");
  await page.emulateMedia({ colorScheme: "dark" });
  await photograph(page, file, "dark");
  await page.emulateMedia({ colorScheme: "light" });
  await holdAsPhone(page);
  await photograph(page, file, "phone");
  await page.setViewportSize(DESK);
  await page.emulateMedia({ reducedMotion: "no-preference" });
  if (kind === "alike") {
    await chooseAndFind(page, file);
    await walkByKeyboard(page);
  }
  return found;
}

await visitAll(["alike", "apart", "team", "string"], visit);
