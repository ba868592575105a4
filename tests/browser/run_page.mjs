// Follows the pages of runs.
//
//   node run_page.mjs CHROMIUM right=FILE wrong=FILE blind=FILE large=FILE
//
// right: every call conforms; wrong: one does not, and there are no images; blind: there are no images; large: the
// plan is large, and there are no images.

import assert from "node:assert/strict";
import { DESK, LAPTOP, assertFitsPhone, assertNamesReadable, assertReadable, photograph, visitAll } from "./visits.mjs";

/** What the page shows now. */
function shown(page) {
  return page.evaluate(() => {
    const text = (selector) => document.querySelector(selector).textContent;
    const visible = (selector) =>
      [...document.querySelectorAll(selector)].filter(
        (element) => element.checkVisibility({ checkVisibilityCSS: true }),
      );
    const robot = document.querySelector(".robot circle").getBoundingClientRect();
    const way = visible(".trajectory").flatMap((line) => line.getAttribute("points").split(" "));
    const stages = [...document.querySelectorAll(".stage")];
    return {
      slider: Number(document.querySelector("#round").value),
      said: document.querySelector("#round").getAttribute("aria-valuetext"),
      robot: { x: robot.x + robot.width / 2, y: robot.y + robot.height / 2 },
      way: new Set(way).size,
      calls: visible(".floor .call").length,
      time: text(".time"),
      move: text(".move"),
      state: text(".state"),
      scene: text(".scene"),
      command: text(".command"),
      called: visible(".facts .call").map((fact) => [fact.textContent, fact.classList.contains("wrong")]),
      image: visible(".camera img")[0]?.src ?? null,
      noImage: visible(".no-image").length,
      stage: stages.findIndex((stage) => stage.checkVisibility()),
      story: visible(".story li").map((line) => line.textContent),
      latest: visible(".story .latest").map((line) => line.textContent),
      button: text("#play"),
    };
  });
}

const readData = (page) => page.evaluate(() => JSON.parse(document.querySelector("#data").textContent));

/** Where an image was taken, on the screen. */
function onScreen(page, { x, y }) {
  return page.evaluate(([x, y]) => {
    const matrix = document.querySelector(".floor svg").getScreenCTM();
    const at = new DOMPoint(x, y).matrixTransform(matrix);
    return { x: at.x, y: at.y };
  }, [x, y]);
}

/** The page shows the data of this image. */
async function assertShows(page, data, at) {
  const now = await shown(page);
  const round = data.rounds[at];
  assert.equal(now.slider, at);
  const there = await onScreen(page, round);
  const off = Math.hypot(now.robot.x - there.x, now.robot.y - there.y);
  assert.ok(off < 1.5, `the robot is ${off} pixels from where frame ${at} was taken`);
  const places = data.rounds.slice(0, at + 1).map(({ x, y }) => `${x},${y}`);
  assert.equal(now.way, at === 0 ? 0 : new Set(places).size);
  assert.equal(now.calls, data.calls.filter(({ rounds }) => rounds <= at + 1).length);
  assert.equal(now.time, `${round.time} min`);
  assert.equal(now.move, `${round.moves} of ${data.rounds.at(-1).moves}`);
  assert.equal(now.state, round.state);
  assert.equal(now.scene, round.scene);
  assert.equal(now.command, round.command);
  assert.equal(now.stage, round.maps - 1);
  assert.deepEqual(now.story, data.story.slice(0, round.story));
  const before = data.rounds.slice(0, at).map(({ story }) => story).filter((lines) => lines < round.story);
  assert.deepEqual(now.latest, now.story.slice(Math.max(0, ...before)));
  assert.equal(now.image, round.image === null ? null : data.images[round.image]);
  assert.equal(now.noImage, data.images.length > 0 && round.image === null ? 1 : 0);
  const call = data.calls.find(({ rounds }) => rounds === at + 1);
  const judged = call?.conforms ? "as specified" : "not as specified";
  assert.deepEqual(now.called, call ? [[`${call.percept}: ${judged}`, !call.conforms]] : []);
  assert.match(now.said, new RegExp(`^frame ${at + 1} of ${data.rounds.length}, `));
  return now;
}

async function followBySlider(page, data) {
  const last = data.rounds.length - 1;
  let lines = -1;
  let robot = null;
  for (const at of [0, 1, Math.floor(last / 3), Math.floor(last / 2), last - 1, last]) {
    await page.locator("#round").fill(String(at));
    const now = await assertShows(page, data, at);
    assert.ok(now.story.length >= lines, "the story shrinks");
    lines = now.story.length;
    if (at > 1) assert.notDeepEqual(now.robot, robot, "the robot does not move");
    robot = now.robot;
  }
  assert.equal(lines, data.story.length, "the story is not complete");
}

async function followByKeysAndButtons(page, data) {
  const last = data.rounds.length - 1;
  const press = async (key, at) => {
    await page.keyboard.press(key);
    await assertShows(page, data, at);
  };
  await page.locator("h1").click();
  await press("Home", 0);
  await press("ArrowLeft", 0);
  await press("ArrowRight", 1);
  await press("ArrowRight", 2);
  await press("ArrowLeft", 1);
  const junctions = data.calls.map(({ rounds }) => rounds - 1).filter((at) => at > 1);
  await press("Shift+ArrowRight", junctions[0]);
  await press("Shift+ArrowRight", junctions[1]);
  await press("Shift+ArrowLeft", junctions[0]);
  await press("End", last);
  await press("ArrowRight", last);
  const click = async (name, at) => {
    await page.getByRole("button", { name, exact: true }).click();
    await assertShows(page, data, at);
  };
  await click("One frame back", last - 1);
  await click("One frame on", last);
  await click("To the junction before", junctions.filter((at) => at < last).at(-1));
  await click("To the next junction", junctions.filter((at) => at < last).length < junctions.length ? junctions.at(-1) : last);
  // With the focus on the slider, an arrow is still one image.
  await page.locator("#round").focus();
  await press("Home", 0);
  await press("ArrowRight", 1);
}

async function play(page, data) {
  const last = data.rounds.length - 1;
  await page.locator("#speed").selectOption("60");
  await page.locator("h1").click();
  await page.keyboard.press("Home");
  await page.keyboard.press("Space");
  assert.equal((await shown(page)).button, "Pause");
  await page.waitForFunction(() => Number(document.querySelector("#round").value) > 3);
  await page.keyboard.press("Space");
  const paused = await shown(page);
  assert.equal(paused.button, "Play");
  await page.waitForTimeout(150);
  await assertShows(page, data, paused.slider);
  await page.getByRole("button", { name: "Play" }).click();
  await page.waitForFunction(
    (last) => Number(document.querySelector("#round").value) === last,
    last,
    { timeout: 5000 + 100 * last },
  );
  const ended = await assertShows(page, data, last);
  assert.equal(ended.button, "Play");
  assert.deepEqual(ended.story, data.story);
  // From its end, a run plays from its beginning.
  await page.getByRole("button", { name: "Play" }).click();
  await page.waitForFunction((last) => Number(document.querySelector("#round").value) < last, last);
  await page.keyboard.press("End");
}

/** Floor, camera, map and story are on a screen of this size together. */
async function assertOneScreen(page, kind) {
  await page.setViewportSize(LAPTOP);
  const panels = ["floor", "camera", "map", "story-panel", "controls"];
  assert.equal(await page.locator(".camera").count(), kind === "right" ? 1 : 0);
  for (const name of panels.filter((name) => name !== "camera" || kind === "right")) {
    const box = await page.locator(`.${name}`).boundingBox();
    const inside = box.x >= 0 && box.y >= 0 && box.x + box.width <= LAPTOP.width && box.y + box.height <= LAPTOP.height;
    assert.ok(inside, `${name} is not on the screen: ${JSON.stringify(box)}`);
    assert.ok(box.height > (name === "controls" ? 40 : 150), `${name} is ${box.height} high`);
  }
  assert.equal(await page.evaluate(() => scrollY), 0);
  await page.setViewportSize(DESK);
}

/** What the panel of the trail shows now. */
function shownTrail(page) {
  return page.evaluate(() => {
    const visible = (selector) =>
      [...document.querySelectorAll(`.trail ${selector}`)].filter((element) => element.checkVisibility());
    const centre = (disc) => `${disc.getAttribute("cx")} ${disc.getAttribute("cy")}`;
    return {
      places: visible(".place").length,
      further: visible(".place.further").length,
      discs: new Set(visible(".discs circle").map(centre)).size,
      open: visible(".open").length,
      robots: visible(".robot").length,
      words: document.querySelector(".grown").textContent,
      maps: [...document.querySelectorAll(".stage")].filter((stage) => stage.checkVisibility()).length,
    };
  });
}

/** The trail grows and folds: what is shown is the data. */
async function followTrail(page, data, file) {
  const button = page.getByRole("button", { name: "Trail" });
  await page.locator("#round").fill("0");
  await button.click();
  assert.equal(await button.getAttribute("aria-pressed"), "true");
  const { stages } = data.trail;
  assert.equal(stages.length, data.calls.length);
  const most = Math.max(...stages.map(({ layers }) => Math.max(...layers)));
  let pictured = false;
  for (const [number, stage] of stages.entries()) {
    await page.locator("#round").fill(String(data.calls[number].rounds - 1));
    const now = await shownTrail(page);
    const keys = new Set(stage.layers.map((layer, vertex) => `${data.trail.vertices[vertex].place} ${layer}`));
    assert.deepEqual(
      [now.places, now.discs, now.open, now.robots, now.maps],
      [stage.places, keys.size, stage.open.length, 1, 0],
    );
    assert.equal(stage.places, keys.size);
    const folded = number === 0 ? 1 : stages[number - 1].places + 1 - stage.places;
    assert.equal(now.words.endsWith(`, ${folded} folded`), folded > 1);
    if (!pictured && Math.max(...stage.layers) === most) {
      pictured = true;
      await page.setViewportSize(LAPTOP);
      await photograph(page, file, "trail-light");
      await page.emulateMedia({ colorScheme: "dark" });
      await photograph(page, file, "trail-dark");
      await page.emulateMedia({ colorScheme: "light" });
      await page.setViewportSize(DESK);
      await assertNamesReadable(page, [".trail .name:not([hidden])"]);
    }
  }
  const end = await shownTrail(page);
  assert.deepEqual([end.open, end.further], [0, 0], "the trail is the map");
  await button.click();
  assert.equal((await shownTrail(page)).maps, 1);
  assert.equal((await shownTrail(page)).places, 0);
}

async function enlarge(page) {
  const wide = () => page.locator(".floor svg").evaluate((svg) => svg.getBoundingClientRect().height);
  const before = await wide();
  const button = page.getByRole("button", { name: "Larger" });
  await button.click();
  assert.ok((await wide()) > 1.2 * before, "the floor is not larger");
  assert.equal(await button.getAttribute("aria-pressed"), "true");
  await button.click();
  assert.equal(await wide(), before);
}

/** Calls that are not as specified have a cross, and are named. */
async function visitWrong(page, file) {
  const data = await readData(page);
  const wrong = data.calls.filter(({ conforms }) => !conforms);
  assert.ok(wrong.length > 0);
  assert.equal(await page.locator(".floor .call.wrong").count(), wrong.length);
  assert.equal(await page.locator(".marks .wrong").count(), wrong.length);
  const at = wrong[0].rounds - 1;
  await page.locator("#round").fill(String(at));
  await assertShows(page, data, at);
  await photograph(page, file, "light");
  return { wrong: wrong.length };
}

/** A large plan: its names are readable on a phone, and the robot is on the screen. */
async function visitLarge(page, file) {
  await assertOneScreen(page, "large");
  const data = await readData(page);
  const mapped = data.rounds.findIndex(({ maps }) => maps > 0);
  for (const at of [mapped, Math.floor(data.rounds.length / 2), data.rounds.length - 1]) {
    await page.locator("#round").fill(String(at));
    await assertNamesReadable(page, [".floor .name", ".map .stage:not([hidden]) .name"]);
    const [box, robot] = await page.evaluate(() =>
      [".ground", ".robot circle"].map((it) => document.querySelector(it).getBoundingClientRect().toJSON()),
    );
    assert.ok(robot.left >= box.left - 1 && robot.right <= box.right + 1, `the robot is hidden at ${at}`);
  }
  await assertFitsPhone(page);
  await photograph(page, file, "phone");
  return { frames: data.rounds.length };
}

async function visit(page, kind, file) {
  if (kind === "wrong") return visitWrong(page, file);
  if (kind === "large") return visitLarge(page, file);
  const data = await readData(page);
  await assertShows(page, data, 0);
  await followBySlider(page, data);
  await followByKeysAndButtons(page, data);
  assert.equal(await page.locator(".floor .call.wrong").count(), 0);
  const middle = data.calls[3].rounds - 1;
  await page.locator("#round").fill(String(middle));
  await assertReadable(page, file, "middle");
  await assertOneScreen(page, kind);
  await followTrail(page, data, file);
  await enlarge(page);
  await assertNamesReadable(page, [".floor .name", ".map .stage:not([hidden]) .name"]);
  await assertFitsPhone(page);
  const buttons = await page.locator(".controls button").all();
  for (const button of buttons) {
    const { width, height } = await button.boundingBox();
    assert.ok(width >= 40 && height >= 40, `a button is ${width} by ${height} pixels on a phone`);
  }
  await photograph(page, file, "phone");
  await page.setViewportSize(DESK);
  await play(page, data);
  await page.emulateMedia({ reducedMotion: "no-preference" });
  await page.keyboard.press("Home");
  await page.locator("#speed").selectOption("25");
  await page.locator("h1").click();
  await page.keyboard.press("Space");
  await page.waitForFunction(() => Number(document.querySelector("#round").value) > 5);
  await page.keyboard.press("Space");
  return { pictures: data.rounds.length, story: data.story.length };
}

await visitAll(["right", "wrong", "blind", "large"], visit);
