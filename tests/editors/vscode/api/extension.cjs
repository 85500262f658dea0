// A test extension: applies the settings in a file whenever it changes. (Tests could write the editor's settings file, but
// the editor does not always notice.)
const { readFileSync } = require("node:fs");

const vscode = require("vscode");

exports.activate = (context) => {
  let applied = "{}";
  let isApplying = false;
  const applySettings = async () => {
    const wanted = readFileSync(process.env.WANTED_SETTINGS, "utf8");
    if (wanted === applied || isApplying) {
      return;
    }
    // One after the other, and again where the editor refuses: it does while it has not read its own last change.
    isApplying = true;
    try {
      for (const [name, value] of Object.entries(JSON.parse(wanted))) {
        await vscode.workspace.getConfiguration().update(name, value, vscode.ConfigurationTarget.Global);
      }
      applied = wanted;
    } catch (error) {
      console.error(`settings are applied again: ${error}`);
    } finally {
      isApplying = false;
    }
  };
  const timer = setInterval(() => void applySettings(), 50);
  context.subscriptions.push({ dispose: () => clearInterval(timer) });
};
