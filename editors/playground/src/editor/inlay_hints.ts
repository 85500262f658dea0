// Inlay hints of the server: poses, durations and defaults, at the ends of what they are about.
import { LSPPlugin, type LSPClientExtension } from "@codemirror/lsp-client";
import { StateEffect, StateField } from "@codemirror/state";
import { Decoration, EditorView, ViewPlugin, WidgetType, type DecorationSet, type ViewUpdate } from "@codemirror/view";
import type { InlayHint } from "vscode-languageserver-protocol";

import { element } from "../elements";

/** After the latest keystroke, milliseconds: a hint that changes with each letter only distracts. */
const DELAY = 200;

const setHints = StateEffect.define<DecorationSet>();
/** Requests the hints again. */
const refresh = StateEffect.define();

const hints = StateField.define<DecorationSet>({
  create: () => Decoration.none,
  update: (shown, transaction) => {
    const changed = transaction.effects.find((effect) => effect.is(setHints));
    return changed ? changed.value : shown.map(transaction.changes);
  },
  provide: (field) => EditorView.decorations.from(field),
});

class HintWidget extends WidgetType {
  constructor(private readonly hint: InlayHint) {
    super();
  }

  override eq({ hint }: HintWidget): boolean {
    return labelOf(hint) === labelOf(this.hint) && tooltipOf(hint) === tooltipOf(this.hint);
  }

  toDOM(view: EditorView): HTMLElement {
    const { hint } = this;
    const shown = element("span", { class: "hint", title: tooltipOf(hint) }, labelOf(hint));
    if (hint.paddingLeft) shown.style.marginLeft = "0.6em";
    if (hint.paddingRight) shown.style.marginRight = "0.6em";
    shown.addEventListener("dblclick", (event) => {
      event.preventDefault();
      insert(view, shown, hint);
    });
    return shown;
  }

  override ignoreEvent(event: Event): boolean {
    return event.type === "dblclick";
  }
}

/** Writes into the text what a hint says, if it is one that can be written. */
function insert(view: EditorView, shown: HTMLElement, { textEdits }: InlayHint): void {
  const text = textEdits?.map(({ newText }) => newText).join("");
  const at = view.posAtDOM(shown);
  if (text) view.dispatch({ changes: { from: at, insert: text }, selection: { anchor: at + text.length }, userEvent: "input.complete" });
}

function labelOf({ label }: InlayHint): string {
  return typeof label === "string" ? label : label.map(({ value }) => value).join("");
}

/** The tooltip without its marks of code and emphasis. */
function tooltipOf({ tooltip }: InlayHint): string {
  const text = typeof tooltip === "object" ? tooltip.value : (tooltip ?? "");
  return text.replaceAll(/[`*]/g, "");
}

class Hints {
  private timer = 0;
  private requested = 0;

  constructor(private readonly view: EditorView) {
    this.schedule(0);
  }

  update({ docChanged, viewportChanged, transactions }: ViewUpdate): void {
    const isRefreshed = transactions.some(({ effects }) => effects.some((effect) => effect.is(refresh)));
    if (docChanged || viewportChanged || isRefreshed) this.schedule(DELAY);
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
    const { from, to } = this.view.viewport;
    const params = { textDocument: { uri }, range: { start: plugin.toPosition(from), end: plugin.toPosition(to) } };
    const found = (await client.request("textDocument/inlayHint", params).catch(() => null)) as InlayHint[] | null;
    // Newer hints are on their way if the text has changed.
    if (id !== this.requested || this.view.state.doc !== text) return;
    const widgets = (found ?? []).map((hint) => Decoration.widget({ widget: new HintWidget(hint), side: 1 }).range(plugin.fromPosition(hint.position)));
    this.view.dispatch({ effects: setHints.of(Decoration.set(widgets, true)) });
  }
}

/** Has an editor ask for its hints again. */
export function refreshHints(view: EditorView): void {
  view.dispatch({ effects: refresh.of(null) });
}

export function inlayHints(): LSPClientExtension {
  return {
    clientCapabilities: { textDocument: { inlayHint: {} }, workspace: { inlayHint: { refreshSupport: true } } },
    editorExtension: [hints, ViewPlugin.fromClass(Hints)],
  };
}
