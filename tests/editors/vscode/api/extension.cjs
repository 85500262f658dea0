// An extension for tests only: changes settings as the settings editor does, whenever a file says so. (The tests could
// write the editor's own file, but a change of that is not always noticed.)
const { readFileSync } = require("node:fs");

const vscode = require("vscode");

exports.activate = (context) => {
  let last = "{}";
  const look = () => {
    const wanted = readFileSync(process.env.WANTED_SETTINGS, "utf8");
    if (wanted === last) {
      return;
    }
    last = wanted;
    for (const [name, value] of Object.entries(JSON.parse(wanted))) {
      void vscode.workspace.getConfiguration().update(name, value, vscode.ConfigurationTarget.Global);
    }
  };
  const timer = setInterval(look, 50);
  context.subscriptions.push({ dispose: () => clearInterval(timer) });
};
