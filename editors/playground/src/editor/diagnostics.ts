// Diagnostics of the server, and the fixes for each, which are requested when its message is shown.
import { LSPPlugin, type LSPClientExtension } from "@codemirror/lsp-client";
import { setDiagnostics, type Diagnostic } from "@codemirror/lint";
import { ViewPlugin, type EditorView } from "@codemirror/view";
import type { Diagnostic as ServerDiagnostic, PublishDiagnosticsParams } from "vscode-languageserver-protocol";

import { button, element } from "../elements";
import { applyAction, requestActions } from "./actions";

const SEVERITIES = ["error", "error", "warning", "info", "hint"] as const;

/** What a file's diagnostics are: called whenever they change. */
export type Counted = (uri: string, errors: number, warnings: number) => void;

/** Shows diagnostics, and sends every change to the server at once, so that they follow each keystroke. */
export function diagnostics(counted: Counted): LSPClientExtension {
  return {
    clientCapabilities: {
      textDocument: { publishDiagnostics: { versionSupport: true, relatedInformation: true, codeDescriptionSupport: true } },
    },
    notificationHandlers: {
      "textDocument/publishDiagnostics": (client, params: PublishDiagnosticsParams) => {
        const count = (severity: number): number => params.diagnostics.filter((found) => found.severity === severity).length;
        counted(params.uri, count(1), count(2));
        const file = client.workspace.getFile(params.uri);
        const view = file?.getView();
        // Diagnostics of an older text are followed by those of the newer one.
        if (view && (params.version === undefined || params.version === file?.version)) show(view, params.diagnostics);
        return true;
      },
    },
    editorExtension: ViewPlugin.define((view) => ({
      update: ({ docChanged }) => {
        if (docChanged) queueMicrotask(() => LSPPlugin.get(view)?.client.sync());
      },
    })),
  };
}

function show(view: EditorView, found: readonly ServerDiagnostic[]): void {
  const plugin = LSPPlugin.get(view);
  if (!plugin) return;
  const offset = (position: ServerDiagnostic["range"]["start"]): number =>
    plugin.unsyncedChanges.mapPos(plugin.fromPosition(position, plugin.syncedDoc));
  const shown = found.map((diagnostic): Diagnostic => {
    const [from, to] = [offset(diagnostic.range.start), offset(diagnostic.range.end)];
    return {
      from,
      to,
      severity: SEVERITIES[diagnostic.severity ?? 1],
      source: diagnostic.code === undefined ? "" : `${diagnostic.code}`,
      message: textOf(diagnostic),
      renderMessage: (shownIn) => message(shownIn, diagnostic),
    };
  });
  view.dispatch(setDiagnostics(view.state, shown));
}

/** A message with a button for each fix. */
function message(view: EditorView, diagnostic: ServerDiagnostic): HTMLElement {
  const fixes = element("span", { class: "fixes" });
  void requestActions(view, diagnostic.range, [diagnostic], ["quickfix"]).then((actions) => {
    fixes.append(...actions.map((action) => button(action.title, () => applyAction(view, action), { class: "fix" })));
  });
  return element("span", { class: "diagnostic" }, element("span", {}, textOf(diagnostic)), fixes);
}

function textOf({ message }: ServerDiagnostic): string {
  return typeof message === "string" ? message : message.value;
}
