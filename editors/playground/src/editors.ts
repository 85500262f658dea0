// The editors of the playground: program, scene and settings, which the server checks, and the generated script.
import { formatDocument, findReferencesKeymap, formatKeymap, hoverTooltips, jumpToDefinitionKeymap, LSPClient, renameKeymap, serverCompletion, signatureHelp } from "@codemirror/lsp-client";
import { EditorView, keymap } from "@codemirror/view";
import type { Position, Range, WorkspaceEdit } from "vscode-languageserver-protocol";

import { LSPPlugin } from "@codemirror/lsp-client";

import type { Connection } from "./connection";
import { FOLDER, programUri, sceneUri, SETTINGS_URI, type Project } from "./documents";
import { applyAction, applyEdit, requestActions } from "./editor/actions";
import { diagnostics } from "./editor/diagnostics";
import { inlayHints, refreshHints } from "./editor/inlay_hints";
import { sanitize } from "./editor/markup";
import { semanticColours } from "./editor/semantic";
import { ScriptView, TextView } from "./editor/text_view";

export const NAMES = ["program", "scene", "settings", "script"] as const;
export type Name = (typeof NAMES)[number];

/** What the page can do beyond CodeMirror's client. */
const CAPABILITIES = {
  textDocument: {
    codeAction: {
      codeActionLiteralSupport: { codeActionKind: { valueSet: ["quickfix", "refactor", "source"] } },
      disabledSupport: true,
    },
    documentSymbol: { hierarchicalDocumentSymbolSupport: true },
  },
  workspace: { applyEdit: true },
};

export interface EditorEvents {
  /** A text has changed, or only a cursor. */
  changed: (name: Name, isNew: boolean) => void;
  counted: (name: Name, errors: number, warnings: number) => void;
}

export class Editors {
  private readonly views: Record<Exclude<Name, "script">, TextView>;
  readonly script: ScriptView;
  private name: string;
  /** The scenes of environments other than the shown one. */
  private scenes: Record<string, string>;
  private environment: string | undefined;

  constructor(
    host: HTMLElement,
    private readonly connection: Connection,
    project: Project,
    imported: Record<string, string>,
    private readonly events: EditorEvents,
  ) {
    this.name = project.name;
    this.scenes = { ...project.scenes };
    const client = new LSPClient({
      rootUri: FOLDER,
      timeout: 20_000,
      sanitizeHTML: sanitize,
      extensions: [
        serverCompletion(),
        hoverTooltips(),
        keymap.of([...formatKeymap, ...renameKeymap, ...jumpToDefinitionKeymap, ...findReferencesKeymap]),
        signatureHelp(),
        diagnostics((uri, errors, warnings) => this.count(uri, errors, warnings)),
        semanticColours(),
        inlayHints(),
        { clientCapabilities: CAPABILITIES },
      ],
    });
    client.connect(connection);
    connection.waitFor(client.initializing);
    connection.notify("pydslrep/files", { files: Object.entries(imported).map(([uri, text]) => ({ uri, text })) });
    // A shadow tree takes style sheets made by code, which the policy of the page forbids elsewhere.
    const root = host.attachShadow({ mode: "open" });
    this.provide();
    const changed = (name: Name) => (change: { isNew: boolean }) => this.changed(name, change.isNew);
    this.views = {
      program: new TextView(root, "Program", "pydslrep", client, { uri: programUri(this.name), text: project.program }, { changed: changed("program") }),
      scene: new TextView(root, "Scene", "toml", client, { uri: sceneUri(undefined, ""), text: "" }, { changed: changed("scene") }),
      settings: new TextView(root, "Settings", "toml", client, { uri: SETTINGS_URI, text: project.settings }, { changed: changed("settings") }),
    };
    this.script = new ScriptView(root, "Generated script");
    this.show("program");
  }

  get programUri(): string {
    return programUri(this.name);
  }

  get project(): Project {
    const { program, settings } = this.views;
    return { name: this.name, program: program.text, settings: settings.text, scenes: this.allScenes() };
  }

  /** The text of the shown environment's scene; undefined if it has none. */
  get scene(): string | undefined {
    const { text } = this.views.scene;
    return text.trim() === "" ? undefined : text;
  }

  get cursor(): Position {
    const { view } = this.views.program;
    return positionOf(view, view.state.selection.main.head);
  }

  /** Replaces everything. */
  open(project: Project): void {
    const before = Object.keys(this.allScenes());
    this.connection.notify("pydslrep/files", { files: before.map((name) => ({ uri: sceneUri(name, "-"), text: null })) });
    this.name = project.name;
    this.scenes = { ...project.scenes };
    this.environment = undefined;
    this.provide();
    this.views.scene.open(sceneUri(undefined, ""), "");
    this.views.settings.open(SETTINGS_URI, project.settings);
    this.views.program.open(this.programUri, project.program, true);
  }

  /** All texts, by their URI. */
  get files(): Record<string, string> {
    const { program, settings, scenes } = this.project;
    const sceneFiles = Object.entries(scenes).map(([name, text]) => [sceneUri(name, text), text] as const);
    return { [this.programUri]: program, [SETTINGS_URI]: settings, ...Object.fromEntries(sceneFiles) };
  }

  get isScriptShown(): boolean {
    return !this.script.view.dom.hidden;
  }

  show(name: Name): void {
    for (const other of ["program", "scene", "settings"] as const) this.views[other].show(other === name);
    this.script.show(name === "script");
  }

  focus(name: Name): void {
    (name === "script" ? this.script : this.views[name]).view.focus();
  }

  /** Another environment is shown: shows its scene. A scene whose environment was renamed goes along. */
  setEnvironment(environment: string | undefined, existing: readonly string[]): void {
    // While a name is typed there may be none for a moment.
    if (environment === undefined || environment === this.environment) return;
    const before = this.environment;
    const { text } = this.views.scene;
    this.environment = environment;
    const isRenamed = before !== undefined && !existing.includes(before) && this.scenes[environment] === undefined;
    if (before !== undefined && !isRenamed && text.trim() !== "") this.scenes[before] = text;
    if (isRenamed) {
      this.views.scene.rename(sceneUri(environment, text));
    } else {
      const next = this.scenes[environment] ?? "";
      this.provide();
      this.views.scene.open(sceneUri(environment, next), next);
    }
  }

  /** Selects a range of the program, and shows it. */
  reveal({ start, end }: Range): void {
    const { view } = this.views.program;
    const selection = { anchor: offsetOf(view, start), head: offsetOf(view, end) };
    view.dispatch({ selection, effects: EditorView.scrollIntoView(selection.anchor, { y: "center" }) });
  }

  format(name: Name): void {
    if (name !== "script") formatDocument(this.views[name].view);
  }

  apply(edit: WorkspaceEdit): void {
    applyEdit(this.views.program.view, edit);
  }

  /** Applies the quick fix of this title in the program, if it is still offered. */
  async fix(range: Range, title: string): Promise<void> {
    const { view } = this.views.program;
    const offered = await requestActions(view, range, [], ["quickfix"]);
    const action = offered.find((one) => one.title === title);
    if (action) applyAction(view, action);
  }

  /** Shows the hints of all texts anew. */
  refreshHints(): void {
    for (const { view } of Object.values(this.views)) refreshHints(view);
  }

  /** Sends what was typed. */
  sync(): void {
    LSPPlugin.get(this.views.program.view)?.client.sync();
  }

  private allScenes(): Record<string, string> {
    const { scene } = this;
    const others = Object.entries(this.scenes).filter(([name, text]) => name !== this.environment && text.trim() !== "");
    return { ...Object.fromEntries(others), ...(this.environment !== undefined && scene !== undefined ? { [this.environment]: scene } : {}) };
  }

  /** Gives the server the scenes, of which only one is open. */
  private provide(): void {
    const files = Object.entries(this.scenes).map(([name, text]) => ({ uri: sceneUri(name, "-"), text }));
    this.connection.notify("pydslrep/files", { files });
  }

  private changed(name: Name, isNew: boolean): void {
    const { scene } = this.views;
    // Until there is text there is no file.
    if (name === "scene" && isNew) queueMicrotask(() => scene.rename(sceneUri(this.environment, scene.text)));
    this.events.changed(name, isNew);
  }

  private count(uri: string, errors: number, warnings: number): void {
    if (uri === this.programUri) this.events.counted("program", errors, warnings);
    else if (uri === SETTINGS_URI) this.events.counted("settings", errors, warnings);
    else if (uri === sceneUri(this.environment, this.views.scene.text)) this.events.counted("scene", errors, warnings);
  }
}

function positionOf(view: EditorView, offset: number): Position {
  const line = view.state.doc.lineAt(offset);
  return { line: line.number - 1, character: offset - line.from };
}

function offsetOf(view: EditorView, { line, character }: Position): number {
  const found = view.state.doc.line(Math.min(line + 1, view.state.doc.lines));
  return Math.min(found.from + character, found.to);
}
