// Types into Visual Studio Code for record.py.
import { Stage } from "../vscode/stage.mjs";
import { coverage, watch } from "./popups.mjs";
import { answer, type } from "./requests.mjs";

const PARTS = {
  popups: {
    completion: ".suggest-widget.visible",
    "details of a completion": ".suggest-details-container",
    "parameter hints": ".parameter-hints-widget.visible",
    hover: ".monaco-hover:not(.hidden), .monaco-resizable-hover",
    fixes: ".action-widget",
    rename: ".rename-box",
  },
  cursor: ".monaco-editor.focused .cursors-layer .cursor",
  line: ".monaco-editor.focused .view-line",
  // At the end of the window the editor itself puts its lists above the line, in every language.
  roomBelow: 30,
};

let stage;

const ACTIONS = {
  async start({ files, settings }) {
    stage = await Stage.open({ files, open: "patrol.pyr", settings });
    // The server is running once the error is shown.
    await stage.page.locator(".squiggly-error").first().waitFor();
    await stage.page.evaluate(() => {
      globalThis.shownText = () => document.querySelector(".monaco-editor.focused .view-lines")?.textContent;
    });
    await watch(stage.page, PARTS);
    return { folder: stage.folder };
  },

  async open({ name }) {
    await stage.openFile(name);
    return {};
  },

  async type(details) {
    return coverage(stage.page, details.patient, () => type(stage.page, details));
  },

  async save() {
    await stage.page.keyboard.press("Control+S");
    return {};
  },
};

await answer(ACTIONS, async () => {
  await stage?.keepPicture();
  await stage?.close();
});
await stage?.close();
