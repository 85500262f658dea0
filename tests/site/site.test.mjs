// The documentation site in a browser, from the disk: it needs no server and no network.
import assert from "node:assert/strict";
import { mkdirSync, readdirSync } from "node:fs";
import path from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";

import { chromium } from "playwright-core";

const SITE = path.resolve(import.meta.dirname, "../../target/site/html");
const OUT = path.join(import.meta.dirname, "out");
const PHONE = { width: 400, height: 800 };
const DESK = { width: 1280, height: 900 };

// The playground needs a server: tests/editors/playground.
const PAGES = readdirSync(SITE, { recursive: true }).filter((name) => name.endsWith(".html") && name !== "toc.html" && !name.startsWith("playground/"));
const SHOTS = ["index.html", "tutorial.html", "kinematics.html", "diagnostics/planned-collision.html"];

let browser;

before(async () => {
  mkdirSync(OUT, { recursive: true });
  browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args: ["--no-sandbox"] });
});

after(() => browser?.close());

/** A page of the browser that records errors, warnings and requests that leave the disk. */
async function open({ viewport = DESK, colorScheme = "light" } = {}) {
  const context = await browser.newContext({ viewport, colorScheme });
  const page = await context.newPage();
  page.setDefaultTimeout(60_000);
  page.problems = [];
  page.on("pageerror", (error) => page.problems.push(String(error)));
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) page.problems.push(message.text());
  });
  page.on("request", (request) => {
    if (!/^(file|data):/.test(request.url())) page.problems.push(request.url());
  });
  page.show = (name) => page.goto(pathToFileURL(path.join(SITE, name)).href);
  return page;
}

test("the first page loads", async (t) => {
  const page = await open();
  await page.show("index.html");
  assert.match(await page.title(), /PyDSLRep/);
  assert.ok(await page.locator("#mdbook-sidebar a", { hasText: "Diagnostics" }).isVisible());
  const loaded = await page.evaluate(() => Math.round(performance.getEntriesByType("navigation")[0].loadEventEnd));
  t.diagnostic(`loaded in ${loaded} ms`);
  assert.deepEqual(page.problems, []);
});

test("no page has errors, reaches for the network, or is wider than a phone", async () => {
  const page = await open({ viewport: PHONE });
  for (const name of PAGES) {
    await page.show(name);
    const [content, window] = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
    assert.ok(content <= window, `${name} is ${content} pixels wide`);
    assert.deepEqual(page.problems, [], name);
  }
});

test("search finds a word of the pages", async () => {
  const page = await open();
  await page.show("index.html");
  await page.keyboard.press("s");
  await page.locator("#mdbook-searchbar").pressSequentially("odometry");
  const first = page.locator("#mdbook-searchresults a").first();
  await first.click();
  await page.locator("mark").first().waitFor();
  assert.match(await page.locator("main").innerText(), /odometry/i);
  assert.deepEqual(page.problems, []);
});

test("a reader can choose the dark theme", async () => {
  const page = await open();
  await page.show("index.html");
  const background = () => page.evaluate(() => getComputedStyle(document.documentElement).backgroundColor);
  const light = await background();
  await page.locator("#mdbook-theme-toggle").click();
  const themes = page.locator("#mdbook-theme-list button:visible");
  assert.equal(await themes.count(), 3);
  await themes.last().click();
  assert.notEqual(await background(), light);
});

test("screenshots", { skip: !process.env.LONG && "only with LONG" }, async () => {
  for (const [look, options] of Object.entries({
    light: {},
    dark: { colorScheme: "dark" },
    phone: { viewport: PHONE },
  })) {
    const page = await open(options);
    for (const name of SHOTS.filter((shot) => PAGES.includes(shot))) {
      await page.show(name);
      await page.screenshot({ path: path.join(OUT, `${path.basename(name, ".html")}-${look}.png`), fullPage: look !== "phone" });
    }
  }
});
