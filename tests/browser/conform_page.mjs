// Tests the pages of conformance reports.
//
//   node conform_page.mjs CHROMIUM conforms=FILE diverged=FILE open=FILE several=FILE
//
// conforms, diverged, open: of one log; several: of three. In the logs of diverged and open, some
// doors were never followed.

import assert from "node:assert/strict";
import { DESK, PHONE, assertFitsPhone, photograph, visitAll } from "./visits.mjs";

const VERDICTS = {
  conforms: ["Conforms"],
  diverged: ["Diverged"],
  open: ["Not known"],
  several: ["3 logs: 1 diverged, 1 not known, 1 conforms", "Conforms", "Diverged", "Not known"],
};

/** Follows a link within the page; what it leads to is then on the screen. */
async function follow(page, link) {
  await link.click();
  const seen = await page.waitForFunction(() => {
    const named = document.getElementById(location.hash.slice(1));
    const { top } = named.getBoundingClientRect();
    return named.checkVisibility() && top >= 0 && top < innerHeight && named.textContent;
  });
  return seen.jsonValue();
}

async function photographAll(page, file) {
  await page.evaluate(() => scrollTo(0, 0));
  await photograph(page, file, "light");
  await page.emulateMedia({ colorScheme: "dark" });
  await photograph(page, file, "dark");
  await page.emulateMedia({ colorScheme: "light" });
  await assertFitsPhone(page);
  await photograph(page, file, "phone");
  await page.setViewportSize(DESK);
}

/** On a phone, a drawing of a world is scrolled, not made small. */
async function assertWorldReadable(page) {
  await page.setViewportSize(PHONE);
  for (const image of await page.locator("img.world").all()) {
    const [shown, own] = await image.evaluate((it) => [it.getBoundingClientRect().width, it.naturalWidth]);
    assert.ok(shown >= 0.9 * own, `a drawing ${own} wide is ${shown} wide`);
  }
  await page.setViewportSize(DESK);
}

async function visit(page, kind, file) {
  await assertWorldReadable(page);
  assert.match(await page.locator(".origin").textContent(), /Made by toposlam 0\.1\.0 .*toposlam conform/s);
  assert.deepEqual(await page.locator(".verdict strong").allTextContents(), VERDICTS[kind]);
  assert.equal(await page.locator("h1").count(), 1);
  for (const image of await page.locator("img").all()) {
    const wide = await image.evaluate((element) => element.decode().then(() => element.naturalWidth));
    assert.ok(wide > 0, "an image is not shown");
  }
  await photographAll(page, file);
  // A log that diverges has its open doors, and no drawing of what it proves.
  const [drawn, open] = { conforms: [0, 0], diverged: [0, 1], open: [1, 1], several: [1, 2] }[kind];
  assert.equal(await page.locator(".folded img.world").count(), drawn);
  assert.equal(await page.locator(".folded .open-door").count(), open);
  if (kind === "conforms" || kind === "open") return {};
  if (kind === "several") {
    const logs = await page.locator(".logs a").allTextContents();
    for (const log of logs) {
      const section = await follow(page, page.getByRole("link", { name: log, exact: true }));
      assert.ok(section.includes(log));
    }
  }
  const row = await follow(page, page.getByRole("link", { name: "Event 7,003 of 10,000" }));
  assert.match(row, /^7,?003.*does not fit/s);
  // The command for the shorter log of one log.
  if (kind === "several") return {};
  const copy = page.locator("section .copy").first();
  await copy.click();
  await page.getByRole("button", { name: /Copied|Marked/ }).waitFor();
  assert.equal(
    await page.evaluate(() => getSelection().toString()),
    await page.locator("section .command code").first().textContent(),
  );
  return { events: await page.locator(".leaf tbody tr").count() };
}

await visitAll(["conforms", "diverged", "open", "several"], visit);
