// Quick fixes and refactorings: requested from the server, offered in a menu at the cursor (Ctrl+.), and applied.
import { LSPPlugin } from "@codemirror/lsp-client";
import { closeHoverTooltips, showTooltip, type Command, type EditorView, type Tooltip } from "@codemirror/view";
import { StateEffect, StateField, type Extension } from "@codemirror/state";
import type { CodeAction, Diagnostic, Range, TextEdit, WorkspaceEdit } from "vscode-languageserver-protocol";

import { button, element } from "../elements";

/** The actions for a range that change text; those that need more of a client are left out. */
export async function requestActions(
  view: EditorView,
  range: Range,
  found: readonly Diagnostic[],
  only?: readonly string[],
): Promise<CodeAction[]> {
  const plugin = LSPPlugin.get(view);
  if (!plugin) return [];
  plugin.client.sync();
  const context = { diagnostics: found, triggerKind: 1, ...(only ? { only } : {}) };
  const params = { textDocument: { uri: plugin.uri }, range, context };
  const actions = (await plugin.client.request("textDocument/codeAction", params).catch(() => null)) as CodeAction[] | null;
  return (actions ?? []).filter(({ edit, disabled }) => edit !== undefined && disabled === undefined && isTextOnly(edit));
}

function isTextOnly({ documentChanges }: WorkspaceEdit): boolean {
  return documentChanges?.every((change) => "edits" in change) ?? true;
}

/** Changes the text of all files that an action is about. */
export function applyAction(view: EditorView, { edit }: CodeAction): void {
  if (edit) applyEdit(view, edit);
  view.dispatch({ effects: [closeHoverTooltips, setMenu.of(null)] });
  view.focus();
}

/** Applies an edit to the open files. */
export function applyEdit(view: EditorView, edit: WorkspaceEdit): void {
  const { workspace } = LSPPlugin.get(view)?.client ?? {};
  for (const [uri, edits] of editsOf(edit)) {
    const target = workspace?.getFile(uri)?.getView();
    const plugin = target && LSPPlugin.get(target);
    if (!plugin) continue;
    const changes = edits.map(({ range, newText }) => ({
      from: plugin.fromPosition(range.start),
      to: plugin.fromPosition(range.end),
      insert: newText,
    }));
    target.dispatch({ changes, userEvent: "input.fix" });
  }
}

function editsOf(edit: WorkspaceEdit): [string, TextEdit[]][] {
  const versioned = (edit.documentChanges ?? []).flatMap((change): [string, TextEdit[]][] =>
    "edits" in change ? [[change.textDocument.uri, change.edits.filter((part): part is TextEdit => "newText" in part)]] : [],
  );
  return [...versioned, ...Object.entries(edit.changes ?? {})];
}

const setMenu = StateEffect.define<Tooltip | null>();

const menu = StateField.define<Tooltip | null>({
  create: () => null,
  update: (shown, transaction) => {
    const change = transaction.effects.find((effect) => effect.is(setMenu));
    if (change) return change.value;
    return transaction.docChanged || transaction.selection ? null : shown;
  },
  provide: (field) => showTooltip.from(field),
});

/** Opens the menu of actions at the selection. */
export const showActions: Command = (view) => {
  const plugin = LSPPlugin.get(view);
  if (!plugin) return false;
  const { from, to } = view.state.selection.main;
  const range = { start: plugin.toPosition(from), end: plugin.toPosition(to) };
  void requestActions(view, range, []).then((actions) => {
    view.dispatch({ effects: setMenu.of({ pos: from, above: false, create: () => ({ dom: list(view, actions), mount: focusFirst }) }) });
  });
  return true;
};

function focusFirst(): void {
  // The tooltip is attached after `mount` where its place is measured first.
  requestAnimationFrame(() => document.querySelector<HTMLElement>("#editor")?.shadowRoot?.querySelector<HTMLElement>(".actions :is(button, p)")?.focus());
}

function list(view: EditorView, actions: readonly CodeAction[]): HTMLElement {
  const dom = element("div", { class: "actions", role: "menu", "aria-label": "Fixes and refactorings" });
  if (actions.length === 0) dom.append(element("p", { tabindex: "-1" }, "No fixes or refactorings here"));
  for (const action of actions) dom.append(button(action.title, () => applyAction(view, action), { role: "menuitem" }));
  dom.addEventListener("keydown", (event) => {
    const items = [...dom.querySelectorAll("button")];
    const focused = items.findIndex((item) => item.matches(":focus"));
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step !== undefined) items.at((focused + step) % items.length)?.focus();
    else if (event.key === "Escape" || event.key === "Tab") close(view);
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
  return dom;
}

function close(view: EditorView): void {
  view.dispatch({ effects: setMenu.of(null) });
  view.focus();
}

export const actions: Extension = menu;
