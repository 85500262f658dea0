// Measures the playground, as docs/playground.md has it: `CHROMIUM=… node figures.mjs`.
import { gzipSync } from "node:zlib";
import { readFileSync } from "node:fs";
import path from "node:path";

import { DIST, launch, Playground, serve } from "./stage.mjs";

const browser = await launch();
const site = await serve();
const median = (values) => values.toSorted((a, b) => a - b)[Math.floor(values.length / 2)];

async function firstLoad() {
  const playground = await Playground.open(browser, site.address);
  await playground.pathShown();
  const names = [...new Set(playground.requests)].filter((address) => address.startsWith(site.address)).map((address) => new URL(address).pathname.slice(1) || "index.html");
  const bytes = names.map((name) => gzipSync(readFileSync(path.join(DIST, name)), { level: 9 }).length);
  await playground.close();
  return bytes.reduce((sum, size) => sum + size) / 1e6;
}

/** Milliseconds from the start of the page to the first squiggle, in a new tab. */
async function firstDiagnostics(fragment) {
  const playground = await Playground.open(browser, site.address, { fragment });
  const { page } = playground;
  const time = await page.evaluate(
    () =>
      new Promise((resolve) => {
        const look = () => (document.querySelector("#editor")?.shadowRoot?.querySelector(".cm-lintRange") ? resolve(performance.now()) : requestAnimationFrame(look));
        look();
      }),
  );
  await playground.close();
  return time;
}

/**
 * Milliseconds from a keystroke to the squiggle that it causes, at 1 000 lines. The cursor is on the line below: what is wrong
 * on its own line is shown when it leaves.
 */
async function keystrokes() {
  const playground = await Playground.open(browser, site.address);
  const { page } = playground;
  await playground.pathShown();
  const lines = Array.from({ length: 993 }, () => "  move 1 meters\n").join("");
  await playground.write(
    `wheel l with radius 4.5\nwheel r with radius 4.5\nrobot a type tw with port 23000 has { l r } wheels\n\nmovement m of a {\n${lines}}\nenvironment area has { a } robots with { m } moves\n`,
  );
  await page.waitForTimeout(3000);
  const times = await playground.content.evaluate(async (content) => {
    const { view } = content.cmTile.root;
    const at = view.state.doc.line(10).to;
    view.dispatch({ selection: { anchor: view.state.doc.line(11).from }, scrollIntoView: true });
    const found = [];
    for (let index = 0; index < 41; index += 1) {
      const isWrong = index % 2 === 0;
      const start = performance.now();
      const done = new Promise((resolve) => {
        const observer = new MutationObserver(() => {
          if ((view.contentDOM.querySelector(".cm-lintRange-error") !== null) === isWrong) {
            observer.disconnect();
            resolve(performance.now() - start);
          }
        });
        observer.observe(view.contentDOM, { subtree: true, childList: true, attributes: true });
      });
      view.dispatch({ changes: isWrong ? { from: at, insert: "x" } : { from: at, to: at + 1 }, userEvent: "input.type" });
      const time = await done;
      if (isWrong) found.push(time);
      await new Promise((resolve) => setTimeout(resolve, 150));
    }
    return found;
  });
  await playground.close();
  return times;
}

console.log(`first load: ${(await firstLoad()).toFixed(2)} MB with gzip`);
const broken = await Playground.open(browser, site.address);
await broken.write("wheel l with raduis 4.5\n");
await broken.page.getByRole("button", { name: "Share" }).click();
await broken.page.waitForFunction(() => location.hash !== "");
const fragment = new URL(broken.page.url()).hash;
await broken.close();
const first = [];
for (let index = 0; index < 7; index += 1) first.push(await firstDiagnostics(fragment));
console.log(`first diagnostics: ${median(first).toFixed(0)} ms (${Math.min(...first).toFixed(0)} to ${Math.max(...first).toFixed(0)})`);
const times = await keystrokes();
console.log(`keystroke to squiggle at 1000 lines: ${median(times).toFixed(1)} ms (${Math.min(...times).toFixed(1)} to ${Math.max(...times).toFixed(1)})`);
await browser.close();
site.close();
