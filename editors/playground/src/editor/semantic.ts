// Colours by the server's semantic tokens. Until new ones arrive, the old ones move with the text.
import { LSPPlugin, type LSPClientExtension } from "@codemirror/lsp-client";
import { RangeSetBuilder, StateEffect, StateField } from "@codemirror/state";
import { Decoration, EditorView, ViewPlugin, type DecorationSet, type ViewUpdate } from "@codemirror/view";
import type { SemanticTokens, SemanticTokensLegend } from "vscode-languageserver-protocol";

/** After the latest keystroke, milliseconds: colours may lag behind, diagnostics should not wait for them. */
const DELAY = 30;

const setTokens = StateEffect.define<DecorationSet>();

const tokens = StateField.define<DecorationSet>({
  create: () => Decoration.none,
  update: (shown, transaction) => {
    const changed = transaction.effects.find((effect) => effect.is(setTokens));
    return changed ? changed.value : shown.map(transaction.changes);
  },
  provide: (field) => EditorView.decorations.from(field),
});

class Colours {
  private timer = 0;
  private requested = 0;

  constructor(private readonly view: EditorView) {
    this.schedule(0);
  }

  update({ docChanged }: ViewUpdate): void {
    if (docChanged) this.schedule(DELAY);
  }

  destroy(): void {
    clearTimeout(this.timer);
    this.requested = -1;
  }

  private schedule(delay: number): void {
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.request(), delay);
  }

  private async request(): Promise<void> {
    const plugin = LSPPlugin.get(this.view);
    if (!plugin) return;
    const { client, uri } = plugin;
    const id = ++this.requested;
    await client.initializing;
    client.sync();
    const text = this.view.state.doc;
    const params = { textDocument: { uri } };
    const found = (await client.request("textDocument/semanticTokens/full", params).catch(() => null)) as SemanticTokens | null;
    // Newer tokens are on their way if the text has changed.
    if (id !== this.requested || this.view.state.doc !== text) return;
    const legend = client.serverCapabilities?.semanticTokensProvider?.legend;
    if (found && legend) this.view.dispatch({ effects: setTokens.of(decorations(this.view, found.data, legend)) });
  }
}

function decorations(view: EditorView, data: readonly number[], { tokenTypes, tokenModifiers }: SemanticTokensLegend): DecorationSet {
  const builder = new RangeSetBuilder<Decoration>();
  const { doc } = view.state;
  let line = 0;
  let start = 0;
  for (let index = 0; index + 4 < data.length; index += 5) {
    const [lines = 0, characters = 0, length = 0, type = 0, modifiers = 0] = data.slice(index, index + 5);
    line += lines;
    start = lines === 0 ? start + characters : characters;
    if (line >= doc.lines) break;
    const from = doc.line(line + 1).from + start;
    const names = tokenModifiers.filter((_, bit) => (modifiers >> bit) & 1).map((name) => ` tok-${name}`);
    if (from + length <= doc.length) builder.add(from, from + length, mark(`tok-${tokenTypes[type] ?? ""}${names.join("")}`));
  }
  return builder.finish();
}

const marks = new Map<string, Decoration>();

function mark(name: string): Decoration {
  const known = marks.get(name) ?? Decoration.mark({ class: name });
  marks.set(name, known);
  return known;
}

export function semanticColours(): LSPClientExtension {
  return {
    clientCapabilities: {
      textDocument: { semanticTokens: { requests: { full: true }, tokenTypes: [], tokenModifiers: [], formats: ["relative"] } },
    },
    editorExtension: [tokens, ViewPlugin.fromClass(Colours)],
  };
}
