// A test extension: applies the settings in a file whenever it changes. (Tests could write the editor's settings file, but
// the editor does not always notice.)
const { readFileSync } = require("node:fs");

const vscode = require("vscode");

exports.activate = (context) => {
  let last = "{}";
  const applySettings = () => {
    const wanted = readFileSync(process.env.WANTED_SETTINGS, "utf8");
    if (wanted === last) {
      return;
    }
    last = wanted;
    for (const [name, value] of Object.entries(JSON.parse(wanted))) {
      void vscode.workspace.getConfiguration().update(name, value, vscode.ConfigurationTarget.Global);
    }
  };
  const timer = setInterval(applySettings, 50);
  context.subscriptions.push({ dispose: () => clearInterval(timer) });
};
