// Tests the pages of runs of explorers in a headless Chromium. If a test fails, the exit code is 1 and there is one
// message.
//
//   node explorer_page.mjs CHROMIUM wrong=FILE guessed=FILE alone=FILE
//
// wrong: the percepts contradict the map that was returned; guessed: in the other world the run is the same; alone: no
// map was returned.

import assert from "node:assert/strict";
import { assertFitsPhone, assertReadable, visitAll } from "./visits.mjs";

/** What the page shows now. */
function shown(page) {
  return page.evaluate(() => {
    const texts = (selector) => [...document.querySelectorAll(selector)].map(({ textContent }) => textContent);
    const rows = [...document.querySelectorAll(".percepts tbody tr")];
    return {
      rows: rows.map((row) => [...row.cells].map(({ textContent }) => textContent)),
      current: rows.findIndex((row) => row.classList.contains("now-row")),
      differing: rows.findIndex((row) => row.classList.contains("differs")),
      percepts: texts(".world .percept"),
      states: texts(".world .state"),
      lit: [...document.querySelectorAll(".world")].map((world) => world.classList.contains("differs")),
      now: texts(".now")[0],
    };
  });
}

async function visit(page, kind, file) {
  const first = await shown(page);
  const last = first.rows.length - 1;
  const percepts = (step) => first.rows[step].slice(3);
  const difference = first.rows.findIndex((_, step) => new Set(percepts(step)).size > 1);
  // Each explorer goes in by three doors of a chain; the last one of the map is then not possible.
  assert.deepEqual(first.rows.map(([, action]) => action), ["start", "0", "1", "1"]);
  assert.deepEqual(first.rows.map(([, , dart]) => dart), ["v0:0", "v1:0", "v2:0", "v3:0"]);
  const second = { wrong: ["1 door", "not possible"], guessed: ["2 doors", "2 doors"], alone: [] }[kind];
  assert.deepEqual([percepts(2)[1], percepts(3)[1]].filter(Boolean), second);
  assert.deepEqual([first.current, first.now], [0, `step 0 of ${last}`]);
  assert.equal(first.differing, difference);
  assert.equal(difference >= 0, kind === "wrong");
  assert.equal(await page.locator("#difference").isVisible(), kind === "wrong");

  for (let step = 1; step <= last; step += 1) {
    await page.keyboard.press("ArrowRight");
    const now = await shown(page);
    assert.equal(now.current, step);
    assert.deepEqual(now.percepts, percepts(step));
    assert.ok(now.lit.every((lit) => lit === (step === difference)));
  }
  // It ends there.
  await page.keyboard.press("ArrowRight");
  assert.equal((await shown(page)).current, last);
  await page.keyboard.press("Home");
  assert.equal((await shown(page)).current, 0);
  await page.locator(".percepts tbody tr").last().click();
  assert.equal((await shown(page)).current, last);
  if (kind === "wrong") {
    await page.locator("#difference").click();
    assert.equal((await shown(page)).current, difference);
  }
  // It plays from the beginning to the end.
  await page.keyboard.press("End");
  await page.locator("#play").click();
  await page.waitForFunction((end) => document.querySelector(".now").textContent === end, `step ${last} of ${last}`);
  await page.waitForFunction(() => document.querySelector("#play").textContent === "Play");

  await assertReadable(page, file, "end");
  await assertFitsPhone(page);
}

await visitAll(["wrong", "guessed", "alone"], visit);
