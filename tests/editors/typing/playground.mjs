// Types into the playground for record.py. It has one program, which is saved into the file that was opened.
import { writeFileSync } from "node:fs";
import path from "node:path";

import { launch, OUT, Playground, serve } from "../playground/stage.mjs";
import { coverage, watch } from "./popups.mjs";
import { answer, drawn, type } from "./requests.mjs";

const PARTS = {
  host: "#editor",
  popups: {
    completion: ".cm-tooltip-autocomplete",
    "details of a completion": ".cm-completionInfo",
    "signature help": ".cm-lsp-signature",
    hover: ".cm-tooltip-hover",
  },
  cursor: ".cm-editor:not([hidden]) .cm-cursor-primary",
  line: ".cm-editor:not([hidden]) .cm-line",
};

/** Frames without a change after which the server has formatted what it will. */
const ENDED = 60;

let site;
let browser;
let playground;

const ACTIONS = {
  async start() {
    [browser, site] = await Promise.all([launch(), serve()]);
    playground = await Playground.open(browser, site.address);
    await playground.pathShown("yard");
    await playground.page.evaluate(() => {
      const { shadowRoot } = document.querySelector("#editor");
      const content = () => shadowRoot.querySelector(".cm-editor:not([hidden]) .cm-content");
      globalThis.shownText = () => content().cmTile.root.view.state.doc.toString();
    });
    await watch(playground.page, PARTS);
    return {};
  },

  async open() {
    await playground.write("");
    await playground.content.click();
    return {};
  },

  async type(details) {
    return coverage(playground.page, details.patient, () => type(playground.page, details));
  },

  async save({ file }) {
    await drawn(playground.page, ENDED);
    writeFileSync(file, await playground.text());
    return { errors: playground.errors.splice(0) };
  },
};

async function close() {
  await browser?.close();
  site?.close();
}

await answer(ACTIONS, async () => {
  await playground?.page.screenshot({ path: path.join(OUT, `typing-failed-${process.pid}.png`) });
  await close();
});
await close();
