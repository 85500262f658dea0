// The path preview as used: paths from the language server, the page in a browser.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync } from "node:fs";
import path from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";

import { launch, moduleOf, Panel, ROOT } from "./panel.mjs";
import { rangeOf, Server } from "./server.mjs";

const EXAMPLES = path.join(ROOT, "examples");
const OUT = path.join(import.meta.dirname, "out");
const PICTURES = process.env.UPDATE_EXPECT ? path.join(ROOT, "docs", "images", "editors") : OUT;

const { Follower } = await moduleOf("preview/host/follower.ts");
const { PreviewHost } = await moduleOf("preview/host/host.ts");

let browser;
let server;

before(async () => {
  for (const folder of [OUT, PICTURES]) mkdirSync(folder, { recursive: true });
  browser = await launch();
  server = await Server.start(EXAMPLES);
  server.on("pydslrep/plannedPathChanged", (environment) => void current?.pathChanged(environment));
  server.on("pydslrep/drivenPathChanged", (environment) => void current?.drivenChanged(environment));
});

after(async () => {
  await browser?.close();
  await server?.stop();
});

/** The follower that is notified when paths change. */
let current;

/** A panel that follows a program, which is open in the server. */
async function follow(uri, text, options = {}) {
  const panel = await Panel.open(browser, options);
  const follower = new Follower(
    (method, params) => server.request(method, params),
    (message) => void panel.post(message),
  );
  current = follower;
  await server.open(uri, text);
  await follower.follow(uri, options.at ?? { line: 0, character: 0 });
  await panel.until("state", "ready");
  return { panel, follower };
}

function example(name) {
  const file = path.join(EXAMPLES, `${name}.pyr`);
  return { uri: pathToFileURL(file).href, text: readFileSync(file, "utf8") };
}

/** Four robots with this many actions each. */
function manyActions(count) {
  const names = ["north", "east", "south", "west"];
  const parts = names.map(
    (name) => `wheel ${name}L with radius 4.5
wheel ${name}R with radius 4.5
robot ${name} type tw with port 19997 has { ${name}L ${name}R } wheels
parallel movement go_${name} of ${name} {
${Array.from({ length: count / 2 }, (_, index) => `  move ${(0.3 + (index % 7) * 0.1).toFixed(1)} meters at 20\n  turn ${index % 3 === 0 ? "right" : "left"} ${60 + (index % 5) * 10}`).join("\n")}
}
`,
  );
  return `${parts.join("\n")}environment many has { ${names.join(" ")} } robots with { ${names.map((name) => `go_${name}`).join(" ")} } moves\n`;
}

/** The number of drawn pixels of each layer. */
function drawnPixels(panel) {
  return panel.page.evaluate(() =>
    [...document.querySelectorAll("canvas")].map((canvas) => {
      const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
      let count = 0;
      for (let index = 3; index < data.length; index += 4) if (data[index] > 0) count += 1;
      return count;
    }),
  );
}

/** The layer with the robots, for comparisons. */
function robotLayer(panel) {
  return panel.page.evaluate(() => document.querySelectorAll("canvas")[1].toDataURL());
}

/** The median and the maximum of times. */
function summary(times) {
  const sorted = times.toSorted((a, b) => a - b);
  return `${sorted[sorted.length >> 1].toFixed(1)} ms median, ${sorted.at(-1).toFixed(1)} ms maximum`;
}

/** The colour of a robot in the current theme. */
function robotColour(panel, index) {
  return panel.page.evaluate((robot) => getComputedStyle(document.body).getPropertyValue(`--robot-${robot}`).trim(), index);
}

test("all robots of a program are drawn, and only the extension's script runs", async () => {
  const { uri, text } = example("crossing");
  const { panel } = await follow(uri, text);
  const [fixed, moving] = await drawnPixels(panel);
  assert.ok(fixed > 20_000, `${fixed} pixels`);
  assert.ok(moving > 2_000, `${moving} pixels`);
  const names = await panel.page.locator(".robots .name").allTextContents();
  assert.deepEqual(names, ["north", "east", "south", "west"]);
  assert.equal(await panel.part("environment").textContent(), "crossing");
  assert.match(await panel.part("clock").textContent(), /^0\.0 s \/ 36\.\d s$/);
  assert.match(await panel.part("picture").getAttribute("aria-label"), /crossing: 4 robots, 36/);
  assert.deepEqual(panel.errors, []);
  await panel.page.evaluate(() => {
    const script = document.createElement("script");
    script.textContent = "window.ran = true";
    document.body.append(script);
  });
  assert.equal(await panel.page.evaluate(() => window.ran), undefined);
  await panel.close();
});

test("every step of the slider is drawn, with 200 actions of 4 robots", async () => {
  const { panel } = await follow("file:///many.pyr", manyActions(200));
  const STEPS = 400;
  const measured = await panel.page.evaluate(async (steps) => {
    const slider = document.querySelector('[data-part="slider"]');
    const main = document.querySelector("main");
    const end = Number(slider.max);
    const costs = [];
    let shown = 0;
    for (let step = 1; step <= steps; step += 1) {
      slider.value = String((end * step) / steps);
      const begin = performance.now();
      slider.dispatchEvent(new Event("input", { bubbles: true }));
      costs.push(performance.now() - begin);
      if (Math.abs(Number(main.dataset.time) - (end * step) / steps) < 0.01) shown += 1;
      if (step % 8 === 0) await new Promise(requestAnimationFrame);
    }
    return { handled: Number(main.dataset.steps), shown, costs };
  }, STEPS);
  console.log(`one step with 4 × 200 actions: ${summary(measured.costs)}`);
  assert.deepEqual([measured.handled, measured.shown], [STEPS, STEPS]);
  await panel.close();
});

test("dragging the slider draws every input event", async () => {
  const { panel } = await follow("file:///many.pyr", manyActions(200));
  const { page } = panel;
  await page.evaluate(() => {
    window.reported = 0;
    document.querySelector('[data-part="slider"]').addEventListener("input", () => (window.reported += 1));
  });
  const box = await panel.part("slider").boundingBox();
  await page.mouse.move(box.x + 8, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width - 8, box.y + box.height / 2, { steps: 80 });
  await page.mouse.up();
  const reported = await page.evaluate(() => window.reported);
  assert.ok(reported > 20, `${reported} events`);
  assert.equal(Number(await panel.data("steps")), reported);
  assert.ok(Number(await panel.data("time")) > 0);
  await panel.close();
});

test("the picture follows the text", async () => {
  const { uri, text } = example("crossing");
  const { panel } = await follow(uri, text);
  const number = rangeOf(text, "2.1", text.indexOf("movement down"));
  let length = "2.1";
  await panel.page.exposeFunction("type", (typed) => {
    const range = { start: number.start, end: { ...number.start, character: number.start.character + length.length } };
    length = typed;
    return server.change(uri, range, typed);
  });
  const [times, inPage] = [[], []];
  for (let turn = 0; turn < 24; turn += 1) {
    const typed = `2.${turn % 2 === 0 ? 2 : 1}`;
    const [all, page] = await panel.page.evaluate(async (digits) => {
      const main = document.querySelector("main");
      const drawn = new Promise((resolve) => {
        new MutationObserver(() => resolve()).observe(main, { attributeFilter: ["data-drawn"] });
      });
      const begin = performance.now();
      window.type(digits);
      await drawn;
      const end = performance.now();
      return [end - begin, end - window.receivedAt];
    }, typed);
    times.push(all);
    inPage.push(page);
  }
  console.log(`from keystroke to picture, 4 robots: ${summary(times)}; in the page: ${summary(inPage)}`);
  const ends = await panel.page.locator(".robots small").first().textContent();
  assert.match(ends, /^→ \(0\.99, -0\.99\) m, 0°$/);
  await panel.close();
});

test("a program with errors keeps its last picture in grey and says why", async () => {
  const { uri, text } = example("crossing");
  const { panel } = await follow(uri, text);
  const before = await drawnPixels(panel);
  await server.change(uri, rangeOf(text, "move 2.1 meters"), "move meters");
  await server.leaveLine(uri);
  await panel.until("state", "stale");
  const banner = await panel.part("banner").textContent();
  assert.match(banner, /crossing has errors: .+ line \d+ — Showing the last valid path\./);
  assert.deepEqual(await drawnPixels(panel), before);
  await panel.page.waitForFunction(() => getComputedStyle(document.querySelector("canvas")).filter.includes("grayscale"));
  await panel.page.screenshot({ path: path.join(OUT, "stale.png") });
  await server.change(uri, rangeOf(text.replace("move 2.1 meters", "move meters"), "move meters"), "move 2.1 meters");
  await panel.until("state", "ready");
  assert.ok(!(await panel.part("banner").isVisible()));
  await panel.close();
});

test("the banner shows the error that is there now, with its line, and offers a fix", async () => {
  const { uri, text } = example("crossing");
  const { panel } = await follow(uri, text);
  const banner = panel.part("banner");
  let typed = "move 2.1 meters";
  let shown = "";
  for (const next of ["mo", "move 1", "move 1 parsecs"]) {
    const { start } = rangeOf(text, "move 2.1 meters");
    const range = { start, end: { line: start.line, character: start.character + typed.length } };
    await server.change(uri, range, next);
    await server.leaveLine(uri);
    await panel.page.waitForFunction(([before]) => {
      const banner = document.querySelector('[data-part="banner"]');
      return !banner.hidden && banner.textContent !== before;
    }, [shown]);
    shown = await banner.textContent();
    typed = next;
  }
  assert.match(shown, /parsecs/);
  const line = text.slice(0, text.indexOf("move 2.1 meters")).split("\n").length;
  assert.equal(await panel.part("place").textContent(), `line ${line}`);
  await panel.part("place").click();
  assert.deepEqual(await panel.message("place"), { type: "place" });
  await panel.page.screenshot({ path: path.join(OUT, "banner.png") });
  await panel.close();
});

test("the panel is never empty", async () => {
  const panel = await Panel.open(browser);
  const follower = new Follower((method, params) => server.request(method, params), (message) => void panel.post(message));
  await follower.resend();
  await panel.part("banner").waitFor();
  assert.match(await panel.part("banner").textContent(), /Open a program/);
  await server.open("file:///empty.pyr", "wheel w with radius 3\n");
  await follower.follow("file:///empty.pyr", { line: 0, character: 0 });
  await panel.page.getByText("no environment yet").waitFor();
  await panel.close();
});

test("a program without an environment is shown as such, without the path of another program", async () => {
  const { text } = example("crossing");
  const uri = "file:///whole.pyr";
  const { panel, follower } = await follow(uri, text);
  await run(panel, uri, "crossing");
  await panel.page.keyboard.press("Space");
  const other = "file:///none.pyr";
  await server.open(other, text.slice(0, text.indexOf("environment ")));
  await follower.follow(other, { line: 0, character: 0 });
  await panel.page.getByText("The program has no environment yet. Add one to see the path.").waitFor();
  assert.equal(await panel.data("state"), "empty");
  assert.equal((await drawnPixels(panel))[1], 0, "no robot is drawn");
  assert.ok(!(await panel.part("legend").isVisible()));
  assert.equal(await panel.part("environment").textContent(), "Path preview");
  assert.match(await panel.part("clock").textContent(), /^0\.0 s \/ 0\.0 s$/);
  await panel.page.screenshot({ path: path.join(OUT, "no-environment.png") });
  await panel.part("suggestion").click();
  assert.deepEqual(await panel.message("accept"), { type: "accept", suggestion: "addEnvironment" });
  // A program with errors has no path, but its environment is named.
  const broken = "file:///broken.pyr";
  await server.open(broken, text.replace("move 2.1 meters", "move meters"));
  await follower.follow(broken, { line: 0, character: 0 });
  await panel.page.getByText("crossing has errors").waitFor();
  assert.equal((await drawnPixels(panel))[1], 0);
  assert.equal(await panel.part("environment").textContent(), "crossing");
  // The first program is shown again, with its run.
  await server.open(uri, text);
  await follower.follow(uri, { line: 0, character: 0 });
  await panel.until("driven", "crossing");
  assert.equal(await panel.data("time"), "0.000", "the playback was reset");
  await panel.close();
});

test("the question mark shows and hides the list of keys", async () => {
  const { uri, text } = example("crossing");
  const { panel } = await follow(uri, text, { theme: "dark" });
  assert.ok(!(await panel.part("help").isVisible()));
  await panel.page.keyboard.press("?");
  const list = await panel.part("help").innerText();
  for (const line of [/Space\s+play or pause/, /N P\s+next or previous action/, /\?\s+show or hide this list/]) assert.match(list, line);
  await panel.page.screenshot({ path: path.join(OUT, "keys.png") });
  await panel.page.keyboard.press("Escape");
  assert.ok(!(await panel.part("help").isVisible()));
  await panel.part("keys").click();
  await panel.page.keyboard.press("?");
  assert.ok(!(await panel.part("help").isVisible()));
  await panel.close();
});

test("everything fits into windows of 700 pixels and less", async () => {
  const { text } = example("crossing");
  const long = text.replaceAll("crossing", "crossing_of_four_robots_around_a_column");
  for (const [width, height] of [[700, 500], [350, 500], [326, 420]]) {
    const uri = `file:///narrow-${width}.pyr`;
    const second = "\nenvironment alone has { north } robots with { down } moves\n";
    const { panel } = await follow(uri, width === 700 ? long : long + second, { theme: "dark", width, height });
    await panel.part("keys").click();
    const outside = await panel.page.evaluate(() => {
      const parts = [...document.querySelectorAll("button, select, input, output, canvas, [data-part=help]")];
      const isOutside = (box) => box.left < 0 || box.right > innerWidth + 0.5 || box.top < 0;
      const visible = parts.filter((part) => part.checkVisibility());
      return visible.filter((part) => isOutside(part.getBoundingClientRect())).map(({ dataset, tagName }) => dataset.part ?? tagName);
    });
    assert.deepEqual(outside, [], `at ${width} pixels`);
    assert.ok(await panel.page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `nothing scrolls at ${width} pixels`);
    const { width: wide, height: high } = await panel.part("picture").boundingBox();
    assert.ok(wide >= Math.min(width * 0.6, 420) && high >= height * 0.4, `${wide} × ${high} for the picture at ${width} pixels`);
    for (const part of ["keys", "export", "fit", "play", "speed"]) {
      const { y, height: tall } = await panel.part(part).boundingBox();
      assert.ok(y >= 0 && y + tall <= height, `${part} is in the window at ${width} pixels`);
    }
    await panel.part("keys").click();
    await panel.page.screenshot({ path: path.join(OUT, `fits-${width}.png`) });
    await panel.close();
  }
});

test("the page asks to export, and captures the picture as shown", async () => {
  const { uri, text } = example("crossing");
  const { panel } = await follow(uri, text);
  await panel.part("export").click();
  assert.deepEqual(await panel.message("export"), { type: "export" });
  panel.received.length = 0;
  await panel.page.keyboard.press("e");
  assert.deepEqual(await panel.message("export"), { type: "export" });
  await panel.post({ type: "capture" });
  const { png } = await panel.message("captured");
  const [colours, size] = await panel.page.evaluate(async (address) => {
    // The page's policy forbids showing the image, not decoding it.
    const bytes = Uint8Array.from(atob(address.split(",")[1]), (letter) => letter.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const canvas = Object.assign(document.createElement("canvas"), { width: image.width, height: image.height });
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    const seen = new Set();
    for (let index = 0; index < data.length; index += 4) seen.add(`${data.slice(index, index + 4)}`);
    return [[...seen], [image.width, image.height]];
  }, png);
  const { width, height } = await panel.part("picture").boundingBox();
  assert.deepEqual(size, [Math.round(width * 2), Math.round(height * 2)]);
  assert.ok(colours.includes("0,114,178,255"), "the first robot's colour");
  assert.ok(!colours.some((colour) => colour.endsWith(",0")), "it has a background");
  await panel.close();
});

test("a run resets the playback of the previous one", async () => {
  const { text } = example("crossing");
  const uri = "file:///twice.pyr";
  const { panel } = await follow(uri, text);
  await run(panel, uri, "crossing");
  await panel.part("speed").selectOption("0.5");
  await panel.page.keyboard.press("Space");
  await panel.page.waitForFunction(() => Number(document.querySelector("main").dataset.time) > 0);
  assert.equal(await panel.part("play").getAttribute("aria-label"), "Pause (space)");
  await server.request("workspace/executeCommand", { command: "pydslrep.run", arguments: [{ uri, environment: "crossing" }] });
  await panel.page.locator('[data-part="play"][aria-label="Play (space)"]').waitFor();
  assert.equal(await panel.data("time"), "0.000");
  await panel.close();
});

test("hovering over an action describes it, clicking reveals it in the text", async () => {
  const { uri, text } = example("crossing");
  const { panel, follower } = await follow(uri, text);
  const { page } = panel;
  // A robot crosses the centre line of the picture: search for it from the top.
  const box = await panel.part("picture").boundingBox();
  let found;
  for (let y = 10; y < box.height - 30 && !found; y += 4) {
    await page.mouse.move(box.x + box.width / 2, box.y + y);
    if (await panel.part("tooltip").isVisible()) found = y;
  }
  assert.ok(found, "an action is under the pointer");
  const tooltip = await panel.part("tooltip").innerText();
  assert.match(tooltip, /^(?:move|turn) .+\n\w+ · \w+, action \d\ntakes .+, from .+ to .+\nends at \(.+\) m, .+°$/);
  assert.match(await panel.data("highlighted"), /^\w+ \d$/);
  const [robotLine] = tooltip.split("\n").slice(1);
  const [, movement, number] = /· (\w+), action (\d)/.exec(robotLine);
  await page.mouse.click(box.x + box.width / 2, box.y + found);
  const { action } = await panel.message("reveal");
  assert.deepEqual(action, { movement, index: Number(number) - 1 });
  const location = await follower.locate(action);
  assert.equal(location.uri, uri);
  const line = text.split("\n")[location.range.start.line];
  assert.equal(line.slice(location.range.start.character, location.range.end.character), tooltip.split("\n")[0]);
  await page.screenshot({ path: path.join(OUT, "tooltip.png") });
  await panel.close();
});

test("the action at the cursor is highlighted", async () => {
  const { uri, text } = example("crossing");
  const { panel, follower } = await follow(uri, text);
  const before = await robotLayer(panel);
  const at = rangeOf(text, "move 1.4", text.indexOf("movement across")).start;
  await follower.update(at, true);
  await panel.until("highlighted", "across 2");
  assert.notEqual(await robotLayer(panel), before);
  await follower.update({ line: 0, character: 0 }, true);
  await panel.until("highlighted", "");
  assert.equal(await robotLayer(panel), before);
  await panel.close();
});

test("the cursor at a loop highlights the legs of its block", async () => {
  const { uri, text } = example("square");
  const { panel, follower } = await follow(uri, text);
  const legs = async () => (await panel.data("highlighted")).split(", ").filter(Boolean);
  await follower.update(rangeOf(text, "repeat").start, true);
  await panel.page.waitForFunction(() => document.querySelector("main").dataset.highlighted.includes(", "));
  assert.equal((await legs()).length, 8);
  await follower.update(rangeOf(text, "turn left").start, true);
  await panel.page.waitForFunction(() => document.querySelector("main").dataset.highlighted.split(", ").length === 4);
  assert.equal(new Set(await legs()).size, 1, "one statement in four rounds");
  await panel.close();
});

test("a leg of a loop says its round, and a click keeps it", async () => {
  const square = example("square");
  const [uri, text] = [square.uri, square.text.replace("{ left_square right_square }", "{ left_square }")];
  const { panel, follower } = await follow(uri, text);
  panel.onMessage = ({ type, action }) => {
    if (type === "reveal") void follower.locate(action).then(({ range }) => follower.update(range.start, true));
  };
  const { page } = panel;
  const box = await panel.part("picture").boundingBox();
  const tooltip = panel.part("tooltip");
  const found = [];
  for (let y = 10; y < box.height - 30; y += 4) {
    await page.mouse.move(box.x + box.width / 2, box.y + y);
    if (!(await tooltip.isVisible())) continue;
    const [, movement, round] = /· (\w+), action 2 in (round \d of 4)/.exec(await tooltip.innerText());
    if (found.includes(round)) continue;
    found.push(round);
    await page.mouse.click(box.x + box.width / 2, box.y + y);
    assert.deepEqual(await panel.message("reveal"), { type: "reveal", action: { movement, index: 1 } });
    assert.equal(await panel.data("round"), round);
    assert.equal(await panel.data("highlighted"), `${movement} 1, ${movement} 1`, "the clicked round, and what is under the pointer: the same");
    panel.received.length = 0;
  }
  assert.deepEqual(found, ["round 3 of 4", "round 1 of 4"], "the sides that cross the middle, from the top");
  // The cursor has moved to the clicked action, which keeps its round; elsewhere it shows what is there.
  await follower.update(rangeOf(text, "move 1 meters").start, true);
  await page.mouse.move(box.x + 2, box.y + 2);
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
  assert.deepEqual([await panel.data("round"), await panel.data("highlighted")], ["round 1 of 4", "left_square 1"]);
  await page.screenshot({ path: path.join(OUT, "round.png") });
  await follower.update(rangeOf(text, "turn left").start, true);
  await panel.until("round", "");
  await panel.close();
});

test("what sensors decide is dashed, and obstacles are where they are at the time", async () => {
  const { uri, text } = example("museum");
  const { panel } = await follow(uri, text.replace("  repeat 6 times {\n    wait", "  move 1 meters\n  repeat 6 times {\n    move 2 meters until { eye } detect\n    wait"));
  const key = () => panel.page.locator(".key li").allTextContents();
  assert.deepEqual((await key()).filter((meaning) => /possible|path of/.test(meaning)), ["possible, sensors decide", "path of an obstacle"]);
  assert.match(await panel.part("clock").textContent(), /^0\.0 s \/ 1 min 56\.0 s …$/, "until all obstacles have gone their way");
  const before = await robotLayer(panel);
  const [fixed] = await drawnPixels(panel);
  await panel.part("slider").fill("60");
  const after = await robotLayer(panel);
  await panel.part("slider").fill("100");
  assert.notEqual(before, after);
  assert.equal(await robotLayer(panel), after, "guide and guard stand still from 60 s to 110 s");
  assert.equal((await drawnPixels(panel))[0], fixed);
  assert.deepEqual(panel.errors, []);
  await panel.page.screenshot({ path: path.join(OUT, "museum.png") });
  await panel.close();
});

test("keys play, step, jump, zoom and select actions", async () => {
  const { uri, text } = example("crossing");
  const { panel } = await follow(uri, text);
  const { page } = panel;
  const time = async () => Number(await panel.data("time"));
  await page.keyboard.press("End");
  const end = await time();
  assert.ok(end > 36);
  await page.keyboard.press("Home");
  assert.equal(await time(), 0);
  await page.keyboard.press("ArrowRight");
  assert.ok((await time()) > 0 && (await time()) < 1);
  await page.keyboard.press("ArrowLeft");
  assert.equal(await time(), 0);
  await page.keyboard.press("Space");
  await page.waitForFunction(() => Number(document.querySelector("main").dataset.time) > 0.2);
  await page.keyboard.press("Space");
  const paused = await time();
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
  assert.equal(await time(), paused);
  await page.keyboard.press("n");
  await page.keyboard.press("n");
  assert.equal(await panel.data("highlighted"), "down 1");
  assert.match(await panel.part("announcement").textContent(), /^turn left 45, north · down, action 2/);
  await page.keyboard.press("Enter");
  assert.deepEqual(await panel.message("reveal"), { type: "reveal", action: { movement: "down", index: 1 } });
  const [before] = await drawnPixels(panel);
  await page.keyboard.press("+");
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
  assert.notEqual((await drawnPixels(panel))[0], before);
  // Every control is reached by Tab and shows its focus.
  const reached = new Set();
  for (let turn = 0; turn < 16; turn += 1) {
    await page.keyboard.press("Tab");
    const focus = await page.evaluate(() => {
      const { activeElement } = document;
      return [activeElement.dataset.part ?? activeElement.dataset.key ?? "", getComputedStyle(activeElement).outlineStyle];
    });
    if (focus[0]) {
      reached.add(focus[0]);
      assert.equal(focus[1], "solid", focus[0]);
    }
  }
  for (const part of ["zoom-in", "zoom-out", "fit", "export", "keys", "picture", "robot north", "robot west", "play", "slider", "speed"]) {
    assert.ok(reached.has(part), `${part} is reached by Tab`);
  }
  await panel.close();
});

test("with reduced motion, time advances in steps", async () => {
  const { uri, text } = example("crossing");
  const { panel } = await follow(uri, text, { reducedMotion: "reduce" });
  await panel.part("speed").selectOption("1");
  const times = await panel.page.evaluate(async () => {
    const main = document.querySelector("main");
    const seen = new Set([main.dataset.time]);
    document.querySelector('[data-part="play"]').click();
    while (seen.size < 4) {
      await new Promise(requestAnimationFrame);
      seen.add(main.dataset.time);
    }
    return [...seen].map(Number);
  });
  const steps = times.slice(1).map((time, index) => time - times[index]);
  // A frame more often than that would be motion.
  assert.ok(steps.every((step) => step >= 0.499), `${times}`);
  await panel.close();
});

test("robots hidden in the legend stay hidden after a reload", async () => {
  const { uri, text } = example("crossing");
  const { panel } = await follow(uri, text);
  const [, before] = await drawnPixels(panel);
  await panel.page.locator('[data-robot="east"]').uncheck();
  const [, without] = await drawnPixels(panel);
  assert.ok(without < before * 0.9, `${before} → ${without}`);
  await panel.page.locator('[data-part="slider"]').fill("10");
  const state = await panel.page.evaluate(() => window.savedState);
  assert.deepEqual({ ...state, time: Math.round(state.time) }, { uri, environment: "crossing", hidden: ["east"], time: 10 });
  await panel.close();
  const again = await follow(uri, text, { state });
  assert.equal(await again.panel.page.locator('[data-robot="east"]').isChecked(), false);
  assert.equal(Math.round(Number(await again.panel.data("time"))), 10);
  assert.deepEqual(again.panel.received[0], { type: "ready" });
  await again.panel.close();
});

test("one of several environments can be selected", async () => {
  const { text } = example("crossing");
  const uri = "file:///two.pyr";
  const { panel, follower } = await follow(uri, `${text}\nenvironment alone has { north } robots with { down } moves\n`);
  panel.onMessage = (message) => {
    if (message.type === "select") void follower.select(message.environment);
  };
  await panel.until("environment", "crossing");
  await panel.part("picker").selectOption("alone");
  await panel.until("environment", "alone");
  assert.deepEqual(await panel.page.locator(".robots .name").allTextContents(), ["north"]);
  // Only a cursor in something that the shown environment does not use switches to the other.
  await follower.update(rangeOf(text, "turn left", text.indexOf("movement down")).start, true);
  assert.equal(await panel.data("environment"), "alone");
  await follower.update(rangeOf(text, "turn left", text.indexOf("movement across")).start, true);
  await panel.until("environment", "crossing");
  await panel.close();
});

test("collisions are marked and listed with their time and obstacle", async () => {
  const { uri, text } = example("crossing");
  const { panel } = await follow(uri, text.replace("turn left 45\n  move 1.4", "turn left 85\n  move 1.4"));
  const collision = panel.page.locator("[data-collision]").first();
  assert.match(await collision.textContent(), /^north runs into \w+ after \d+\.\d s$/);
  assert.ok((await panel.page.locator(".marks i").count()) > 0);
  await collision.click();
  assert.ok(Number(await panel.data("time")) > 1);
  assert.equal((await panel.message("reveal")).action.movement, "down");
  await panel.page.screenshot({ path: path.join(OUT, "collision.png") });
  await panel.close();
});

test("a plan of unknown duration says so", async () => {
  const { uri, text } = example("horseshoe");
  const { panel } = await follow(uri, text);
  assert.match(await panel.page.locator(".robots li").textContent(), /planned up to “turn right until \{ fSensorLeft, fSensor, fSensorRight \}”/);
  assert.match(await panel.part("clock").textContent(), /…$/);
  await panel.page.screenshot({ path: path.join(OUT, "horseshoe.png") });
  await panel.close();
});

/** Runs the shown program and waits until its path is drawn. */
async function run(panel, uri, environment) {
  await server.request("workspace/executeCommand", { command: "pydslrep.run", arguments: [{ uri, environment }] });
  await panel.page.locator(`main[data-driven="${environment}"]`).waitFor({ state: "attached" });
}

test("after a run the driven path is drawn with the planned one", async () => {
  const { uri, text } = example("horseshoe");
  const { panel } = await follow(uri, text, { theme: "dark" });
  const [before] = await drawnPixels(panel);
  await run(panel, uri, "horseshoe");
  assert.ok((await drawnPixels(panel))[0] > before + 3000);
  assert.match(await panel.page.locator(".robots li").textContent(), /driven → \(.+\) m, .+°$/);
  // The duration is known only after the run: the slider extends to its end.
  await panel.page.keyboard.press("End");
  assert.ok(Number(await panel.data("time")) > 30);
  await panel.page.screenshot({ path: path.join(OUT, "driven.png") });
  await panel.part("show-run").uncheck();
  await panel.part("fit").click();
  assert.equal((await drawnPixels(panel))[0], before);
  await panel.close();
});

test("after an edit, the result of a run is not shown as one of the present program", async () => {
  const { uri, text } = example("square");
  const yard = { uri, environment: "yard" };
  const panel = await Panel.open(browser);
  const host = new PreviewHost((method, params) => server.request(method, params), (message) => void panel.post(message), {});
  current = host.follower;
  await server.open(uri, text);
  await host.follower.follow(uri, { line: 0, character: 0 });
  await panel.until("state", "ready");
  host.clearResult(yard);
  await run(panel, uri, "yard");
  host.setResult(yard, "yard: 40.0 s simulated in 0.5 s", false, [{ label: "Show Table", press: () => undefined }]);
  const [result, legend] = [panel.part("result"), panel.part("legend")];
  await result.waitFor();
  assert.equal(await result.innerText(), "yard: 40.0 s simulated in 0.5 s. Show Table");
  assert.match(await legend.innerText(), /driven path ends [^]*Latest run\n/);

  const before = /move \d+ meters/.exec(text)[0];
  const change = (from, to) => server.change(uri, rangeOf(text.replace(before, from), from), to);
  await change(before, "move 2 meters");
  await result.getByText("The program has changed since.").waitFor();
  await panel.page.screenshot({ path: path.join(OUT, "earlier.png") });
  assert.doesNotMatch(await legend.innerText(), /driven path ends/);
  assert.match(await legend.innerText(), /driven → \([^]*Latest run, before the program changed/);
  await change("move 2 meters", "move 2 parsecs");
  await server.leaveLine(uri);
  await panel.until("state", "stale");
  assert.match(await result.innerText(), /The program has changed since\./);
  await panel.part("banner").waitFor();
  await panel.page.screenshot({ path: path.join(OUT, "earlier-stale.png") });
  await change("move 2 parsecs", before);
  await result.getByText("The program has changed since.").waitFor({ state: "detached" });
  assert.match(await legend.innerText(), /driven path ends [^]*Latest run\n/);
  // A run that failed at once has no path.
  const driven = { environment: "yard", robots: [{ name: "scout", poses: [{ t: 0, x: 0, y: 0, theta: 0 }], map: { nodes: [], edges: [] } }], planned: null };
  await panel.post({ type: "driven", ...yard, driven: { ...driven, robots: [] }, isNew: true });
  await panel.part("show-run").waitFor({ state: "detached" });
  await panel.close();
});

/** A truck that drives around twice, and then on one of two ways. */
function undecided(text) {
  const [parts] = text.split("movement dock");
  return `sensor front\n${parts.replace("{ wheelL wheelR } wheels", "$& with sensors { front }")}movement dock of truck {
  repeat 2 times {
    move 1.2 meters at 20
    turn left 180 with radius 30 centimeters at 20
  }
  move 1.5 meters at 20
  if { front } detect within 80 centimeters {
    turn left 90 with radius 60 centimeters at 10
    move 60 centimeters
  } else {
    move 1 meters
    turn right
    move 1 meters until { front } detect within 40 centimeters
  }
}

environment dock has { truck } robots with { dock } moves
`;
}

test("pictures", async () => {
  const colours = { light: "#0072b2", dark: "#56b4e9", "high-contrast": "#4cc2ff", "high-contrast-light": "#00538a" };
  const crashing = (text) => text.replace("turn left 45\n  move 1.4", "turn left 85\n  move 1.4");
  const scenes = [
    { file: "preview-light", name: "crossing", theme: "light", time: 0.4, at: "move 1.4" },
    { file: "preview-high-contrast", name: "crossing", theme: "high-contrast", time: 0.45, change: crashing },
    { file: "preview-possible", name: "dock", theme: "light", time: 0.3, change: undecided, at: "if {" },
    { file: "possible-dark", name: "dock", theme: "dark", time: 0.3, change: undecided, at: "if {" },
    { file: "crossing-dark", name: "crossing", theme: "dark", time: 0.4 },
    { file: "crossing-high-contrast-light", name: "crossing", theme: "high-contrast-light", time: 0.4, at: "turn left" },
    { file: "convoy-light", name: "convoy", theme: "light", time: 0.5 },
    { file: "narrow", name: "crossing", theme: "dark", time: 0.6, size: { width: 420, height: 640 } },
    { file: "square-dark", name: "square", theme: "dark", time: 0.7 },
  ];
  // Exploring takes a while.
  if (process.env.UPDATE_EXPECT) scenes.push({ file: "preview-dark", name: "rooms", theme: "dark", time: 0.93, run: "rooms" });
  for (const { file, name, theme, time, at, run: ranEnvironment, size = {}, change = (text) => text } of scenes) {
    const { uri, text } = example(name);
    const { panel, follower } = await follow(uri, change(text), { theme, ...size });
    if (ranEnvironment) await run(panel, uri, ranEnvironment);
    if (at) await follower.update(rangeOf(change(text), at).start, true);
    await panel.part("slider").evaluate((input, share) => {
      input.value = String(Number(input.max) * share);
      input.dispatchEvent(new Event("input"));
    }, time);
    assert.equal(await robotColour(panel, 0), colours[theme]);
    await panel.page.screenshot({ path: path.join(file.startsWith("preview-") ? PICTURES : OUT, `${file}.png`) });
    assert.deepEqual(panel.errors, []);
    await panel.close();
  }
});
