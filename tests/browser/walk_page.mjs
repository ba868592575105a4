// Tests the walk pages in a headless Chromium. If a test fails, the exit code is 1 and there is one message.
//
//   node walk_page.mjs CHROMIUM alike=FILE apart=FILE ...
//
// alike: no walk distinguishes the two worlds of the page; apart: the page has one that does.

import assert from "node:assert/strict";
import { DESK, assertFitsPhone, photograph, visitAll } from "./visits.mjs";

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

function readData(page) {
  return page.evaluate(() => JSON.parse(document.querySelector("#data").textContent));
}

const starts = (data) => data.sides.map((side) => side.states[side.start]);
const after = (data, states, action) =>
  states.map(({ actions }, side) => {
    const [, to] = actions.find(([known]) => known === action);
    return data.sides[side].states[to];
  });

/** The newest row is that of the data, and equal columns look equal. */
function assertShows(now, states, step, action) {
  const [a, b] = states.map(({ percept }) => percept);
  const { cells, differs } = now.rows.at(-1);
  assert.deepEqual(cells, [String(step), action, a, a === b ? "=" : "≠", b]);
  assert.equal(differs, a !== b);
  assert.deepEqual(now.lit, [a !== b, a !== b]);
  assert.deepEqual(now.states, states.map(({ text }) => text));
}

/** Random doors, clicked in the one and the other picture and by keys: always equal percepts. */
async function walkAlike(page) {
  const data = await readData(page);
  assert.ok(data.relation, "the page has no relation");
  assert.equal(await page.locator("#distinguish").isVisible(), false);
  const random = seeded(1);
  let states = starts(data);
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
    states = after(data, states, action);
    const now = await shown(page);
    assert.equal(now.rows.length, step + 1);
    assertShows(now, states, step, action);
    const equal = now.rows.every(({ cells }) => cells[2] === cells[4]);
    assert.ok(equal, `the columns of percepts are no longer equal after ${step} doors`);
    assert.equal(now.current, 1);
    assert.equal(now.pair, states.map(({ text }) => text).join(" ~ "));
  }
  const walked = await shown(page);
  assert.ok(walked.met > 10 && walked.met <= data.relation.length, `${walked.met} pairs met`);
  return { doors: DOORS, pairs: walked.met };
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
  const data = await readData(page);
  assert.ok(data.walk, "the page has no walk that distinguishes the worlds");
  await page.getByRole("button", { name: "Play the walk that distinguishes them" }).click();
  const rows = page.locator(".percepts tbody tr");
  await rows.nth(data.walk.length).waitFor({ timeout: 5000 + 2000 * data.walk.length });
  const now = await shown(page);
  assert.equal(now.rows.length, data.walk.length + 1);
  assert.deepEqual(now.rows.slice(1).map(({ cells }) => cells[1]), data.walk);
  const states = data.walk.reduce((states, action) => after(data, states, action), starts(data));
  assertShows(now, states, data.walk.length, data.walk.at(-1) ?? "start");
  for (const [step, { cells, differs }] of now.rows.entries()) {
    const last = step === data.walk.length;
    assert.equal(cells[2] !== cells[4], last, `step ${step}: ${cells}`);
    assert.equal(differs, last);
  }
  assert.match(now.status, /differ/);
  const alone = states.flatMap(({ actions }, side) => {
    const others = states[1 - side].actions.map(([action]) => action);
    return actions.map(([action]) => action).filter((action) => !others.includes(action));
  });
  for (const action of alone) {
    const name = /^\d+$/.test(action) ? `door ${action}` : action;
    // It is marked as disabled, and gives the reason when it is pressed.
    await page.getByRole("button", { name, exact: true }).click({ force: true });
    const after = await shown(page);
    assert.equal(after.rows.length, now.rows.length);
    assert.match(after.status, /^Only [AB] /);
  }
  return { walk: data.walk.join(" ") };
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
  const found = kind === "alike" ? await walkAlike(page) : await tellApart(page);
  await photograph(page, file, "light");
  await page.emulateMedia({ colorScheme: "dark" });
  await photograph(page, file, "dark");
  await page.emulateMedia({ colorScheme: "light" });
  await holdAsPhone(page);
  await photograph(page, file, "phone");
  await page.setViewportSize(DESK);
  await page.emulateMedia({ reducedMotion: "no-preference" });
  if (kind === "alike") await walkByKeyboard(page);
  return found;
}

await visitAll(["alike", "apart"], visit);
