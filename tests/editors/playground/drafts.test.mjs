// Drafts in the playground: what is written is there again after the page was left, whatever it was opened with.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import path from "node:path";
import { after, before, test } from "node:test";

import { launch, OUT, Playground, ROOT, serve } from "./stage.mjs";

const PROGRAM = "wheel mine with radius 4.5\n";

let browser;
let site;

before(async () => {
  [browser, site] = await Promise.all([launch(), serve()]);
});

after(async () => {
  await browser?.close();
  site?.close();
});

const stored = (page) => page.evaluate(() => Object.keys(localStorage).filter((key) => key.startsWith("pydslrep.draft.")).map((key) => localStorage.getItem(key)));
const isStored = (page, text) =>
  page.waitForFunction((wanted) => Object.values({ ...localStorage }).some((value) => value.includes(wanted)), text);

/** Another tab of the same browser. */
const tab = (playground, fragment = "") => Playground.openIn(playground.page.context(), site.address, { fragment });

/** Opens the list of drafts, and returns the buttons that open one. */
async function list(page) {
  await page.getByRole("button", { name: "Drafts" }).click();
  return page.locator("#drafts-list li > button:first-child");
}

test("what is written survives a reload and comes back in a new tab", async () => {
  const playground = await Playground.open(browser, site.address);
  const { page } = playground;
  assert.deepEqual(await stored(page), [], "an example that nobody changed is no draft");
  await playground.write(PROGRAM);
  // Before the change is stored by itself.
  await page.reload();
  assert.equal(await playground.text(), PROGRAM);
  await page.close();
  const later = await tab(playground);
  assert.equal(await later.text(), PROGRAM);
  assert.equal((await stored(later.page)).length, 1);
  assert.deepEqual(playground.errors, []);
  await later.close();
});

test("opening something else leaves a draft, which the list opens, deletes and brings back", async () => {
  const playground = await Playground.open(browser, site.address);
  const { page } = playground;
  await playground.write(PROGRAM);
  await playground.choose("crossing");
  await playground.pathShown("crossing");
  await page.screenshot({ path: path.join(OUT, "drafts-before.png") });
  const drafts = await list(page);
  assert.equal(await drafts.count(), 1);
  await page.screenshot({ path: path.join(OUT, "drafts.png") });
  await page.getByRole("button", { name: "Delete square" }).click();
  assert.deepEqual(await stored(page), []);
  await page.getByRole("button", { name: "Undo" }).click();
  await drafts.first().click();
  assert.equal(await playground.text(), PROGRAM);
  assert.deepEqual(playground.errors, []);
  await playground.close();
});

test("a scene and settings are kept with their program", async () => {
  const playground = await Playground.open(browser, site.address);
  const { page } = playground;
  await playground.pathShown("yard");
  await playground.tab("Settings").click();
  await playground.write("default-speed = 21\n");
  await playground.tab("Scene").click();
  await playground.write("[[cylinder]]\nat = [3.0, 2.0]\nradius = 0.15\n");
  await isStored(page, "[3.0, 2.0]");
  await page.reload();
  await playground.pathShown("yard");
  await playground.tab("Scene").click();
  assert.match(await playground.text(), /3\.0, 2\.0/);
  await playground.tab("Settings").click();
  assert.equal(await playground.text(), "default-speed = 21\n");
  await playground.close();
});

test("two tabs never write the same draft", async () => {
  const playground = await Playground.open(browser, site.address);
  await playground.write(PROGRAM);
  await isStored(playground.page, "wheel mine");
  const other = await tab(playground);
  assert.notEqual(await other.text(), PROGRAM, "the draft is shown in the first tab");
  await (await list(other.page)).first().click();
  await other.page.getByText(/Another tab shows this draft/).waitFor();
  assert.equal(await other.text(), PROGRAM);
  await other.write(`${PROGRAM}// other\n`);
  await isStored(other.page, "// other");
  assert.equal((await stored(other.page)).length, 2);
  await playground.close();
});

test("changes to a link's program are kept, and the address no longer claims to hold them", async () => {
  const playground = await Playground.open(browser, site.address);
  const { page } = playground;
  await playground.write(PROGRAM);
  await page.getByRole("button", { name: "Share" }).click();
  await page.waitForFunction(() => location.hash.startsWith("#project="));
  const fragment = new URL(page.url()).hash;
  const other = await Playground.open(browser, site.address, { fragment });
  assert.equal(await other.text(), PROGRAM);
  await other.write(`${PROGRAM}// changed\n`);
  await other.page.waitForFunction(() => location.hash === "");
  await other.page.reload();
  assert.equal(await other.text(), `${PROGRAM}// changed\n`);
  await other.close();
  await playground.close();
});

test("a damaged link says so, and destroys nothing", async () => {
  const playground = await Playground.open(browser, site.address, { fragment: "#project=AAAA" });
  const { page } = playground;
  await page.locator("#announcement").getByText(/This link is damaged/).waitFor();
  await page.screenshot({ path: path.join(OUT, "damaged.png") });
  assert.match(await playground.text(), /environment yard/, "an example is shown");
  await playground.write(PROGRAM);
  await page.evaluate(() => (location.hash = "#project=bm90IGEgcHJvamVjdA"));
  await page.locator("#announcement").getByText(/This link is damaged/).waitFor();
  assert.equal(await playground.text(), PROGRAM);
  await playground.close();
});

test("where nothing can be stored, the page says so and asks before it is left", async () => {
  const playground = await Playground.open(browser, site.address);
  const { page } = playground;
  const asked = [];
  page.on("dialog", (dialog) => {
    asked.push(dialog.type());
    void dialog.accept();
  });
  // A browser asks only a user who has done something.
  await playground.content.click();
  await page.keyboard.type("// stored\n");
  await isStored(page, "// stored");
  await page.reload();
  assert.deepEqual(asked, [], "what is stored is not lost");
  await page.evaluate(() => {
    Storage.prototype.setItem = () => {
      throw new DOMException("full", "QuotaExceededError");
    };
  });
  await playground.content.click();
  await page.keyboard.type("// lost\n");
  await page.locator("#announcement").getByText(/does not keep your changes/).waitFor();
  await page.reload();
  assert.deepEqual(asked, ["beforeunload"]);
  await playground.close();
});

test("the links of the documentation open their programs", async () => {
  const program = 'wheel ü with radius 4.5 // "quoted" <b>\n';
  const script = "import sys; sys.path.insert(0, 'docs/site'); import build; print(build.fragment_of(sys.argv[1]))";
  const fragment = execFileSync(process.env.PYTHON, ["-c", script, program], { cwd: ROOT, encoding: "utf8" }).trim();
  const playground = await Playground.open(browser, site.address, { fragment });
  assert.equal(await playground.text(), program);
  await playground.close();
});
