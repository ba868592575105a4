// Visits pages in a headless Chromium, each in a window of its own, and answers with exit code 1 and one
// message a page where something is not as it should be: an assertion of the visit, an error or a warning
// of the page, or a request to anywhere.
//
//   node SCRIPT CHROMIUM KIND=FILE ...
//
// With the variable PICTURES, screenshots go to that folder.

import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { readFileSync } from "node:fs";
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

const AXE = createRequire(import.meta.url).resolve("axe-core");

/**
 * Checks a page at the sizes of a computer and of a phone, in light and dark: by axe-core, which finds low contrast among
 * other faults; that no word of a table's head is broken; and that the bar that stays on the screen covers no percept
 * while the page is at its top.
 */
export async function assertReadable(page, file, when) {
  const [size, scroll] = [page.viewportSize(), await page.evaluate(() => [scrollX, scrollY])];
  if (!(await page.evaluate(() => "axe" in globalThis))) await page.evaluate(readFileSync(AXE, "utf8"));
  for (const viewport of [LAPTOP, READER]) {
    for (const colorScheme of ["light", "dark"]) {
      await page.setViewportSize(viewport);
      await page.emulateMedia({ colorScheme });
      await page.evaluate(() => scrollTo(0, 0));
      await page.waitForTimeout(100);
      const place = `at the ${when}, ${colorScheme}, ${viewport.width} wide`;
      await photograph(page, file, `${when}-${colorScheme}-${viewport.width}`);
      assert.deepEqual(await page.evaluate(faultsOfAxe), [], place);
      assert.deepEqual(await page.evaluate(brokenHeads), [], place);
      assert.deepEqual(await page.evaluate(faintButtons), [], place);
      assert.deepEqual(await page.evaluate(covered), [], place);
    }
  }
  await page.emulateMedia({ colorScheme: "light" });
  await page.setViewportSize(size);
  await page.evaluate(([x, y]) => scrollTo(x, y), scroll);
}

async function faultsOfAxe() {
  // The parts of a long table are alike: one is enough, and takes less time.
  const rest = [...document.querySelectorAll(".leaf")].slice(1).map((leaf) => [leaf, document.createComment("")]);
  for (const [leaf, place] of rest) leaf.replaceWith(place);
  const { violations } = await globalThis.axe.run(document, { resultTypes: ["violations"] });
  for (const [leaf, place] of rest) place.replaceWith(leaf);
  return violations.flatMap(({ id, nodes }) => nodes.map(({ target, any }) => `${id}: ${target} ${any[0]?.message ?? ""}`));
}

/** The words in the heads of tables that stand on several lines. */
function brokenHeads() {
  return [...document.querySelectorAll("thead th:not(.unseen *, .leaf ~ .leaf *)")].flatMap((head) => {
    const texts = document.createTreeWalker(head, NodeFilter.SHOW_TEXT);
    const broken = [];
    while (texts.nextNode()) {
      const { data, parentElement } = texts.currentNode;
      if (parentElement.closest(".unseen")) continue;
      for (const { 0: word, index } of data.matchAll(/\w+/g)) {
        const range = document.createRange();
        range.setStart(texts.currentNode, index);
        range.setEnd(texts.currentNode, index + word.length);
        if (new Set([...range.getClientRects()].map(({ top }) => Math.round(top))).size > 1) broken.push(word);
      }
    }
    return broken;
  });
}

/** The buttons whose text has a contrast below 4.5: axe-core skips those that are disabled. */
function faintButtons() {
  const luminance = (color) => {
    const parts = color.match(/[\d.]+/g).slice(0, 3).map((part) => part / 255);
    const [r, g, b] = parts.map((part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const contrast = (button) => {
    const { color, backgroundColor } = getComputedStyle(button);
    const [dark, light] = [color, backgroundColor].map(luminance).sort((one, two) => one - two);
    return (light + 0.05) / (dark + 0.05);
  };
  const faint = [...document.querySelectorAll("button")].filter((button) => contrast(button) < 4.5);
  return faint.map((button) => `${button.textContent}: ${contrast(button)}`);
}

/** The percepts, as far as they are on the screen, that the bar covers. */
function covered() {
  const bar = document.querySelector(".controls")?.getBoundingClientRect();
  const percepts = [...document.querySelectorAll("figure .percept")].filter((percept) => {
    const { top, bottom, height } = percept.getBoundingClientRect();
    return bar && height > 0 && top < bar.bottom && bottom > bar.top + 1;
  });
  return percepts.map(({ textContent }) => textContent);
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
  await assertReadable(page, file, "begin");
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
