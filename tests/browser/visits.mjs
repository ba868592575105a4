// Visits pages in a headless Chromium, each in a window of its own, and answers with exit code 1 and one
// message a page where something is not as it should be: an assertion of the visit, an error or a warning
// of the page, or a request to anywhere.
//
//   node SCRIPT CHROMIUM KIND=FILE ...
//
// With the variable PICTURES, screenshots go to that folder.

import assert from "node:assert/strict";
import { basename, join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

export const PHONE = { width: 360, height: 740 };
export const DESK = { width: 1280, height: 900 };
/** A small screen of a computer. */
export const LAPTOP = { width: 1280, height: 800 };
/** A phone on which names have to be readable, and the smallest font, in pixels. */
export const READER = { width: 390, height: 844 };
const READABLE = 10;

/** Numbers below `bound` that are the same in every run. */
export function seeded(seed) {
  let state = seed;
  return (bound) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor((state / 2 ** 32) * bound);
  };
}

/** Makes the window as small as a phone, and sees that there is nothing to scroll sideways. */
export async function assertFitsPhone(page) {
  await page.setViewportSize(PHONE);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= PHONE.width, `the page is ${wide} wide on a phone of ${PHONE.width}`);
}

/** On a phone, no text of these drawings is smaller than a reader can read. */
export async function assertNamesReadable(page, selectors) {
  const before = page.viewportSize();
  await page.setViewportSize(READER);
  await page.waitForTimeout(100);
  for (const selector of selectors) {
    const sizes = await page.locator(selector).evaluateAll((names) =>
      names.map((name) => Number(name.getAttribute("font-size")) * name.getScreenCTM().a),
    );
    assert.ok(sizes.length > 0, `there is no ${selector}`);
    const least = Math.min(...sizes);
    assert.ok(least >= READABLE, `${selector} is ${least} pixels high on a phone`);
  }
  await page.setViewportSize(before);
}

export async function photograph(page, file, name) {
  if (!process.env.PICTURES) return;
  const path = join(process.env.PICTURES, `${basename(file, ".html")}-${name}.png`);
  await page.screenshot({ path });
}

async function inItsOwnWindow(browser, kind, file, visit) {
  const context = await browser.newContext({ viewport: DESK, reducedMotion: "reduce" });
  const page = await context.newPage();
  const faults = [];
  const url = pathToFileURL(file).href;
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) faults.push(`console: ${message.text()}`);
  });
  page.on("pageerror", (error) => faults.push(`script: ${error.message}`));
  page.on("request", (request) => {
    if (request.url() !== url && !request.url().startsWith("data:")) {
      faults.push(`request: ${request.url()}`);
    }
  });
  await page.goto(url);
  const found = await visit(page, kind, file);
  assert.deepEqual(faults, []);
  await context.close();
  return found;
}

/** Calls `visit(page, kind, file)` for each page that the command line names; says what it answers. */
export async function visitAll(kinds, visit) {
  const [executablePath, ...pages] = process.argv.slice(2);
  const browser = await chromium.launch({
    executablePath,
    args: ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-sync"],
  });
  try {
    for (const argument of pages) {
      const [, kind, file] = argument.match(/^(\w+)=(.+)$/) ?? assert.fail(argument);
      try {
        assert.ok(kinds.includes(kind), `a page of kind ${kind}`);
        console.log(`${argument}: ${JSON.stringify(await inItsOwnWindow(browser, kind, file, visit))}`);
      } catch (error) {
        console.error(`${argument}: ${error.stack}`);
        process.exitCode = 1;
      }
    }
  } finally {
    await browser.close();
  }
}
