// What tests in the extension host share: how they ask the editor, and how they report.
const assert = require("node:assert/strict");
const { writeFileSync } = require("node:fs");

const vscode = require("vscode");

const folder = vscode.workspace.workspaceFolders[0].uri;
const file = (name) => vscode.Uri.joinPath(folder, name);
const ask = (provider, ...args) => vscode.commands.executeCommand(`vscode.${provider}`, ...args);

async function until(what, check, timeout = 30_000) {
  const end = Date.now() + timeout;
  for (;;) {
    const value = await check();
    if (value) {
      return value;
    }
    assert.ok(Date.now() < end, `timed out waiting until ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

async function open(name) {
  const document = await vscode.workspace.openTextDocument(file(name));
  await vscode.window.showTextDocument(document);
  return document;
}

/** The position of a text in a document, after some of its characters. */
function at(document, text, offset = 0) {
  const start = document.getText().indexOf(text);
  assert.notEqual(start, -1, text);
  return document.positionAt(start + offset);
}

/** Runs tests, each with its name, and writes what they report. */
function running(tests) {
  return async () => {
    const results = [];
    for (const [name, test] of Object.entries(tests)) {
      try {
        await test();
        results.push({ name });
      } catch (error) {
        results.push({ name, error: String(error.stack ?? error) });
      }
    }
    writeFileSync(process.env.API_RESULTS, JSON.stringify(results));
  };
}

module.exports = { ask, at, file, open, running, until };
