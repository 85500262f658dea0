// One text of the playground in an editor: what all of them share, and the connection to the server.
import { closeBrackets, closeBracketsKeymap } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, indentWithTab } from "@codemirror/commands";
import { bracketMatching, StreamLanguage } from "@codemirror/language";
import { python } from "@codemirror/legacy-modes/mode/python";
import { toml } from "@codemirror/legacy-modes/mode/toml";
import { openLintPanel } from "@codemirror/lint";
import type { LSPClient } from "@codemirror/lsp-client";
import { searchKeymap, highlightSelectionMatches } from "@codemirror/search";
import { Compartment, EditorState, Transaction, type Extension } from "@codemirror/state";
import { drawSelection, EditorView, highlightActiveLine, highlightActiveLineGutter, highlightSpecialChars, keymap, lineNumbers, tooltips } from "@codemirror/view";

import { actions, showActions } from "./actions";
import { completion } from "./completion";
import { indent } from "./indent";
import { nextProblem } from "./next_problem";
import { formatOnType } from "./on_type";
import { theme } from "./theme";

const COMMON: Extension = [
  lineNumbers(),
  highlightActiveLineGutter(),
  highlightSpecialChars(),
  highlightActiveLine(),
  history(),
  drawSelection(),
  EditorView.lineWrapping,
  bracketMatching(),
  highlightSelectionMatches(),
  EditorState.tabSize.of(2),
  theme,
  tooltips({ position: "fixed" }),
];

const WRITING: Extension = [
  closeBrackets(),
  actions,
  nextProblem,
  completion,
  keymap.of([
    { key: "Mod-.", run: showActions },
    ...closeBracketsKeymap,
    { key: "Mod-Shift-m", run: openLintPanel, preventDefault: true },
    ...searchKeymap,
    ...historyKeymap,
    ...defaultKeymap,
    // Escape, then Tab leaves the editor: CodeMirror's rule for users of the keyboard alone.
    indentWithTab,
  ]),
];

export interface TextEvents {
  /** The text or the cursor has changed. */
  changed: (text: { isNew: boolean }) => void;
}

/** An editor of a text that the server knows by a URI. */
export class TextView {
  readonly view: EditorView;
  private readonly connection = new Compartment();
  private uri: string;

  constructor(
    root: ShadowRoot,
    label: string,
    private readonly language: "pydslrep" | "toml",
    private readonly client: LSPClient,
    initial: { uri: string; text: string },
    events: TextEvents,
  ) {
    this.uri = initial.uri;
    this.view = new EditorView({
      root,
      parent: root,
      state: EditorState.create({
        doc: initial.text,
        extensions: [
          COMMON,
          WRITING,
          language === "toml" ? StreamLanguage.define(toml) : [formatOnType, indent, EditorState.languageData.of(() => [{ commentTokens: { line: "//" } }])],
          EditorView.contentAttributes.of({ "aria-label": label, "aria-multiline": "true", tabindex: "0" }),
          EditorView.updateListener.of(({ docChanged, selectionSet }) => {
            if (docChanged || selectionSet) events.changed({ isNew: docChanged });
          }),
          this.connection.of(client.plugin(initial.uri, language)),
        ],
      }),
    });
  }

  get text(): string {
    return this.view.state.doc.toString();
  }

  /** Replaces the text, and what the server knows it by. What the user may have written can be brought back by undoing. */
  open(uri: string, text: string, isUndoable = false): void {
    this.disconnect();
    this.view.dispatch({
      changes: { from: 0, to: this.view.state.doc.length, insert: text },
      selection: { anchor: 0 },
      annotations: Transaction.addToHistory.of(isUndoable),
    });
    this.view.scrollDOM.scrollTop = 0;
    this.connect(uri);
  }

  /** Changes what the server knows the text by. */
  rename(uri: string): void {
    if (uri === this.uri) return;
    this.disconnect();
    this.connect(uri);
  }

  show(isShown: boolean): void {
    this.view.dom.hidden = !isShown;
    if (isShown) this.view.requestMeasure();
  }

  private disconnect(): void {
    this.view.dispatch({ effects: this.connection.reconfigure([]) });
  }

  private connect(uri: string): void {
    this.uri = uri;
    this.view.dispatch({ effects: this.connection.reconfigure(this.client.plugin(uri, this.language)) });
  }
}

/** An editor of a script, which is only read. */
export class ScriptView {
  readonly view: EditorView;

  constructor(root: ShadowRoot, label: string) {
    this.view = new EditorView({
      root,
      parent: root,
      state: EditorState.create({
        extensions: [
          COMMON,
          StreamLanguage.define(python),
          EditorState.readOnly.of(true),
          EditorView.contentAttributes.of({ "aria-label": label, "aria-readonly": "true", tabindex: "0" }),
          keymap.of([...searchKeymap, ...defaultKeymap]),
        ],
      }),
    });
  }

  set text(text: string) {
    if (text === this.text) return;
    this.view.dispatch({ changes: { from: 0, to: this.view.state.doc.length, insert: text } });
  }

  get text(): string {
    return this.view.state.doc.toString();
  }

  show(isShown: boolean): void {
    this.view.dom.hidden = !isShown;
    if (isShown) this.view.requestMeasure();
  }
}
