// Runs in the extension host: asks the editor what it would show.
const assert = require("node:assert/strict");

const vscode = require("vscode");

const { ask, at, file, open, until } = require("./asking.cjs");

const problems = (name) => vscode.languages.getDiagnostics(file(name));
const labels = ({ items }) => items.map(({ label }) => label.label ?? label);
const extension = () => vscode.extensions.getExtension("pydslrep.pydslrep");

module.exports = {
  async "a program activates the extension"() {
    const document = await open("square.pyr");
    assert.equal(document.languageId, "pydslrep");
    await until("it is active", () => extension()?.isActive);
  },

  async "diagnostics have codes and disappear with the error"() {
    const document = await open("broken.pyr");
    const [problem] = await until("there is a problem", () => problems("broken.pyr").length > 0 && problems("broken.pyr"));
    assert.equal(problem.source, "pydslrep");
    assert.equal(problem.code.value ?? problem.code, "invalid-radius");
    const edit = new vscode.WorkspaceEdit();
    edit.replace(document.uri, new vscode.Range(at(document, "-1"), at(document, "-1", 2)), "4");
    await vscode.workspace.applyEdit(edit);
    await until("the problem is gone", () => problems("broken.pyr").length === 0);
    await vscode.commands.executeCommand("undo");
    // On the line of the cursor, it would be held back until the line is left.
    const end = new vscode.Position(document.lineCount - 1, 0);
    vscode.window.activeTextEditor.selection = new vscode.Selection(end, end);
    await until("the problem is back", () => problems("broken.pyr").length > 0);
  },

  async "unopened files have diagnostics"() {
    await until("the unopened file has a problem", () => problems("unopened.pyr").length > 0);
  },

  async "completion offers keywords"() {
    const document = await open("square.pyr");
    const found = await ask("executeCompletionItemProvider", document.uri, at(document, "turn left", 5));
    assert.ok(labels(found).includes("left") && labels(found).includes("right"), labels(found).join());
  },

  async "hover explains"() {
    const document = await open("square.pyr");
    const [hover] = await ask("executeHoverProvider", document.uri, at(document, "robot scout", 7));
    assert.match(hover.contents.map(({ value }) => value).join("\n"), /rad\/s/);
  },

  async "the outline, folding, hints and lenses are provided"() {
    const document = await open("square.pyr");
    const symbols = await ask("executeDocumentSymbolProvider", document.uri);
    assert.ok(symbols.some(({ name }) => name === "yard"));
    assert.ok((await ask("executeFoldingRangeProvider", document.uri)).length > 0);
    const whole = new vscode.Range(0, 0, document.lineCount, 0);
    // One after each action and block, and two for what one square leaves out.
    assert.equal((await ask("executeInlayHintProvider", document.uri, whole)).length, 8);
    const lenses = await ask("executeCodeLensProvider", document.uri, 100);
    const titles = lenses.map(({ command }) => command?.title);
    for (const title of ["Generate script", "Run", "Preview"]) {
      assert.ok(titles.includes(title), titles.join());
    }
    assert.equal(titles[titles.indexOf("Run") + 1], "Preview");
    const references = lenses.find(({ command }) => /references?$/.test(command?.title ?? ""));
    assert.equal(references.command.command, "pydslrep.showReferences");
  },

  async "definition and references are found"() {
    const document = await open("square.pyr");
    const use = at(document, "of scout", 4);
    const [definition] = await ask("executeDefinitionProvider", document.uri, use);
    const { start } = definition.targetSelectionRange ?? definition.range;
    assert.deepEqual(start, at(document, "robot scout", 6));
    assert.ok((await ask("executeReferenceProvider", document.uri, use)).length >= 3);
  },

  async "rename changes every use"() {
    const document = await open("square.pyr");
    const edit = await ask("executeDocumentRenameProvider", document.uri, at(document, "of scout", 4), "ranger");
    assert.ok(edit.get(document.uri).length >= 3);
  },

  async "quick fixes are offered, and the script is a code action"() {
    const document = await open("misspelt.pyr");
    const isReference = ({ code }) => (code.value ?? code) === "unresolved-reference";
    const problem = await until("there is a problem", () => problems("misspelt.pyr").find(isReference));
    const actions = await ask("executeCodeActionProvider", document.uri, problem.range, vscode.CodeActionKind.QuickFix.value, 5);
    assert.ok(actions.some(({ title }) => title.includes("`rover`")), actions.map(({ title }) => title).join());
    const square = await open("square.pyr");
    const inside = new vscode.Range(at(square, "environment"), at(square, "environment"));
    const source = await ask("executeCodeActionProvider", square.uri, inside, "source.generateScript", 5);
    assert.ok(source.some(({ title }) => /script/i.test(title)), source.map(({ title }) => title).join());
  },

  async "formatting is provided"() {
    const document = await vscode.workspace.openTextDocument({ language: "pydslrep", content: "wheel   a with radius 4\n" });
    const edits = await until("edits", () => ask("executeFormatDocumentProvider", document.uri, { tabSize: 8, insertSpaces: false }));
    assert.ok(edits.length > 0);
  },

  async "the manifest has scopes for all types of semantic tokens"() {
    const document = await open("square.pyr");
    const legend = await ask("provideDocumentSemanticTokensLegend", document.uri);
    const [{ scopes }] = extension().packageJSON.contributes.semanticTokenScopes;
    assert.deepEqual(legend.tokenTypes.filter((type) => !(type in scopes)), []);
    assert.ok((await ask("provideDocumentSemanticTokens", document.uri)).data.length > 50);
  },

  async "a settings file wins over defaults, and the editor's settings win over the file"() {
    await open("square.pyr");
    const unused = () => problems("unused.pyr").find(({ code }) => (code.value ?? code) === "unused-declaration");
    await open("unused.pyr");
    const severity = (level) => until(`the severity is ${level}`, () => unused()?.severity === level);
    await severity(vscode.DiagnosticSeverity.Hint);
    await vscode.workspace.fs.writeFile(file("pydslrep.toml"), Buffer.from('[severity]\nunused-declaration = "warning"\n'));
    await severity(vscode.DiagnosticSeverity.Warning);
    const settings = vscode.workspace.getConfiguration("pydslrep");
    await settings.update("severity", { "unused-declaration": "error" }, vscode.ConfigurationTarget.Workspace);
    await severity(vscode.DiagnosticSeverity.Error);
    await settings.update("severity", undefined, vscode.ConfigurationTarget.Workspace);
    await severity(vscode.DiagnosticSeverity.Warning);
    await vscode.workspace.fs.delete(file("pydslrep.toml"));
    await severity(vscode.DiagnosticSeverity.Hint);
  },

  async "settings and scene files are checked"() {
    await vscode.workspace.fs.writeFile(file("inner/pydslrep.toml"), Buffer.from('tarqet = "vrep"\n'));
    await open("inner/pydslrep.toml");
    await until("the misspelt key is reported", () => problems("inner/pydslrep.toml").length > 0);
    const [problem] = problems("inner/pydslrep.toml");
    assert.match(problem.message, /tarqet/);
  },

  async "the check task does not duplicate the server's problems"() {
    await open("square.pyr");
    const tasks = await vscode.tasks.fetchTasks({ type: "pydslrep" });
    const names = tasks.map(({ name }) => name);
    assert.deepEqual(names, ["check", "build", "run square.pyr"]);
    const ended = new Promise((resolve) => {
      const listening = vscode.tasks.onDidEndTaskProcess(({ execution, exitCode }) => {
        if (execution.task.name === "check") {
          listening.dispose();
          resolve(exitCode);
        }
      });
    });
    await vscode.tasks.executeTask(tasks[0]);
    assert.equal(await ended, 1);
    const radii = () => problems("unopened.pyr").filter(({ code }) => (code.value ?? code) === "invalid-radius");
    await until("the unopened file has a problem", () => radii().length > 0);
    assert.equal(radii().length, 1);
    // What it printed would hide half of a program.
    await vscode.commands.executeCommand("workbench.action.closePanel");
  },

  async "every command of the manifest and of the server is registered"() {
    const known = await vscode.commands.getCommands(true);
    const wanted = extension().packageJSON.contributes.commands.map(({ command }) => command);
    const all = [...wanted, "pydslrep.generateScript", "pydslrep.run", "pydslrep.showKinematics", "pydslrep.previewPath", "pydslrep.pushScene", "pydslrep.checkScene", "pydslrep.removeScene"];
    assert.deepEqual(all.filter((command) => !known.includes(command)), []);
  },

  async "a comment continues on the next line"() {
    const document = await vscode.workspace.openTextDocument({ language: "pydslrep", content: "" });
    await vscode.window.showTextDocument(document);
    for (const text of ["/", "*", " a"]) {
      await vscode.commands.executeCommand("type", { text });
    }
    await vscode.commands.executeCommand("type", { text: "\n" });
    assert.match(document.getText(), /^\/\* a\r?\n \* $/, JSON.stringify(document.getText()));
  },
};
