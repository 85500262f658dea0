// Runs in the extension host: what the editor has to say of blocks, conditions and movements that are done.
const assert = require("node:assert/strict");

const vscode = require("vscode");

const { ask, at, open, until } = require("./asking.cjs");

const nested = () => open("nested.pyr");

/** The place of the movement that is done. */
const use = (document) => at(document, "do side", 3);

/** Each node with those below it: `repeat(move turn)`. */
function drawn(symbols) {
  return symbols.map(({ name, children }) => (children.length > 0 ? `${name}(${drawn(children)})` : name)).join(" ");
}

async function hovered(document, text, offset = 0) {
  const hovers = await ask("executeHoverProvider", document.uri, at(document, text, offset));
  return hovers.flatMap(({ contents }) => contents.map(({ value }) => value)).join("\n");
}

/** The texts of locations in a document. */
const texts = (document, found) => found.map(({ range, targetSelectionRange }) => document.getText(targetSelectionRange ?? range));

module.exports = {
  async "the outline has blocks"() {
    const document = await nested();
    const symbols = await until("there is an outline", () => ask("executeDocumentSymbolProvider", document.uri));
    const patrol = symbols.find(({ name }) => name === "patrol");
    assert.equal(drawn(patrol.children), "repeat(do if(turn wait wait) turn)");
  },

  async "blocks fold"() {
    const document = await nested();
    const ranges = await ask("executeFoldingRangeProvider", document.uri);
    const lines = ranges.map(({ start }) => document.lineAt(start).text.trim());
    for (const head of ["repeat 4 times {", "if { front } detect within 40 centimeters {", "} else {"]) {
      assert.ok(lines.includes(head), lines.join());
    }
  },

  async "a selection grows block by block"() {
    const document = await nested();
    const [range] = await ask("executeSelectionRangeProvider", document.uri, [at(document, "wait 2", 5)]);
    const grown = [];
    for (let step = range; step; step = step.parent) {
      grown.push(document.getText(step.range).split("\n")[0]);
    }
    for (const head of ["2", "wait 2 seconds", "if { front } detect within 40 centimeters {", "repeat 4 times {", "movement patrol of rover {"]) {
      assert.ok(grown.includes(head), grown.join(" | "));
    }
  },

  async "hints in a block are those of the first round, and after it those of all"() {
    const document = await nested();
    const whole = new vscode.Range(0, 0, document.lineCount, 0);
    const hints = await ask("executeInlayHintProvider", document.uri, whole);
    const after = (text) => {
      const line = document.positionAt(document.getText().indexOf(text)).line;
      return hints.filter(({ position }) => position.line === line).map(({ label }) => label).join(" ");
    };
    assert.match(after("do side"), /→ 1\.00, 0\.00, 90°/);
    assert.match(after("move 50 centimeters"), /→ 0\.50, 0\.00, 0°/);
    assert.match(after("}\n  turn left"), /→ 1\.00, 0\.00, 0°/);
    assert.match(after("turn left 90 with radius"), /→ 0\.50, 0\.50, 180°/);
    assert.equal(after("turn right"), "90 · 2.9 s");
  },

  async "hover explains rounds, conditions, circles and movements that are done"() {
    const document = await nested();
    assert.match(await hovered(document, "repeat 4"), /4 rounds/);
    assert.match(await hovered(document, "detect within"), /nearer than 0\.4 m[^]*`front` \| 0\.15 m ahead, facing ahead[^]*In the scene of `yard`/);
    assert.match(await hovered(document, "turn left 90 with radius"), /centre of rotation is at \(0\.5 m, 0 m\)[^]*radius of its circle/);
    assert.match(await hovered(document, "do side"), /`side` drives 1 m and turns 90°/);
  },

  async "signature help has each statement"() {
    const document = await nested();
    for (const [text, offset, shape] of [
      ["repeat 4", 7, /^repeat COUNT times/],
      ["if { front }", 3, /^if \{ SENSORS \}/],
      ["wait 2", 5, /^wait SECONDS seconds/],
      ["do side", 3, /^do MOVEMENT/],
      ["with radius 50", 12, /radius DISTANCE/],
    ]) {
      const help = await ask("executeSignatureHelpProvider", document.uri, at(document, text, offset));
      assert.match(help?.signatures[help.activeSignature]?.label ?? "", shape, text);
    }
  },

  async "a movement that is done is a reference"() {
    const document = await nested();
    const [definition] = await ask("executeDefinitionProvider", document.uri, use(document));
    assert.deepEqual((definition.targetSelectionRange ?? definition.range).start, at(document, "movement side", 9));
    assert.deepEqual(texts(document, await ask("executeReferenceProvider", document.uri, use(document))), ["side", "side"]);
    assert.deepEqual(texts(document, await ask("executeDocumentHighlights", document.uri, use(document))), ["side", "side"]);
    assert.deepEqual(texts(document, await ask("executeTypeDefinitionProvider", document.uri, use(document))), ["rover"]);
    const edit = await ask("executeDocumentRenameProvider", document.uri, use(document), "edge");
    assert.equal(edit.get(document.uri).length, 2);
  },

  async "a movement of an imported file is done: its path is a link, and its name leads there"() {
    const document = await open("away.pyr");
    const links = await until("there is a link", async () => {
      const found = await ask("executeLinkProvider", document.uri);
      return found.length > 0 && found;
    });
    const name = ({ path }) => path.split("/").at(-1);
    assert.deepEqual(links.map(({ range, target }) => [document.getText(range), name(target)]), [["parts/edge.pyr", "edge.pyr"]]);
    const place = at(document, "do edge", 3);
    const [definition] = await ask("executeDefinitionProvider", document.uri, place);
    assert.equal(name(definition.targetUri ?? definition.uri), "edge.pyr");
    const references = await ask("executeReferenceProvider", document.uri, place);
    assert.deepEqual(references.map(({ uri }) => name(uri)).sort(), ["away.pyr", "edge.pyr"]);
    // The tests that follow look at it.
    await nested();
  },

  async "the call hierarchy has movements that are done"() {
    const document = await nested();
    const [side] = await ask("prepareCallHierarchy", document.uri, use(document));
    const callers = await ask("provideIncomingCalls", side);
    assert.deepEqual(callers.map(({ from }) => from.name), ["patrol"]);
    const above = await ask("provideIncomingCalls", callers[0].from);
    assert.deepEqual(above.map(({ from }) => from.name), ["yard"]);
  },

  async "words of statements are keywords, and names in them names"() {
    const document = await nested();
    const { tokenTypes } = await ask("provideDocumentSemanticTokensLegend", document.uri);
    const { data } = await ask("provideDocumentSemanticTokens", document.uri);
    const types = new Map();
    let [line, column] = [0, 0];
    for (let index = 0; index < data.length; index += 5) {
      column = data[index] > 0 ? data[index + 1] : column + data[index + 1];
      line += data[index];
      types.set(`${line}:${column}`, tokenTypes[data[index + 3]]);
    }
    const type = (text, offset = 0) => {
      const { line: row, character } = at(document, text, offset);
      return types.get(`${row}:${character}`);
    };
    for (const word of ["repeat 4", "times {", "if {", "detect", "within", "else", "do side", "wait 2"]) {
      assert.equal(type(word), "keyword", word);
    }
    assert.notEqual(type("do side", 3), "keyword");
    assert.equal(type("do side", 3), type("movement side", 9));
  },

  async "completion after do, and of a condition"() {
    const document = await nested();
    const labels = async (text, offset) => {
      const { items } = await ask("executeCompletionItemProvider", document.uri, at(document, text, offset));
      return items.map(({ label }) => label.label ?? label);
    };
    assert.ok((await labels("do side", 3)).includes("side"));
    assert.deepEqual(await labels("if { front } detect", 15), ["detect"]);
  },

  async "statements have refactorings"() {
    const document = await nested();
    for (const [text, title] of [
      ["wait 2", "roll up into `repeat 2 times`"],
      ["repeat 4", "unroll `repeat 4 times`"],
      ["if {", "invert"],
      ["turn left 90 with", "turn in place"],
      ["turn right", "turn on a circle"],
      ["do side", "inline"],
    ]) {
      const place = at(document, text, 1);
      const actions = await ask("executeCodeActionProvider", document.uri, new vscode.Range(place, place), "refactor");
      const titles = actions.map((action) => action.title);
      assert.ok(titles.some((offered) => offered.toLowerCase().includes(title)), `${title}: ${titles.join()}`);
    }
  },
};
