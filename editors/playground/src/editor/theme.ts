// The look of the editor. The colours are those of the page, whose variables reach into the editor's shadow tree.
import { HighlightStyle, syntaxHighlighting } from "@codemirror/language";
import type { Extension } from "@codemirror/state";
import { EditorView } from "@codemirror/view";
import { tags } from "@lezer/highlight";

const view = EditorView.theme({
  "&": { height: "100%", color: "var(--fg)", backgroundColor: "var(--bg)", fontSize: "14px" },
  "&.cm-focused": { outline: "none" },
  ".cm-scroller": { fontFamily: "var(--mono-font)", lineHeight: "1.5" },
  ".cm-content": { caretColor: "var(--fg)" },
  "&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground, .cm-selectionBackground": {
    backgroundColor: "var(--selection) !important",
  },
  ".cm-cursor": { borderLeftColor: "var(--fg)" },
  ".cm-activeLine": { backgroundColor: "var(--line-bg)" },
  ".cm-gutters": { backgroundColor: "var(--bg)", color: "var(--quiet)", border: "none" },
  ".cm-activeLineGutter": { backgroundColor: "var(--line-bg)", color: "var(--fg)" },
  ".cm-tooltip, .cm-panels": {
    backgroundColor: "var(--popup-bg)",
    color: "var(--fg)",
    borderColor: "var(--border)",
    fontFamily: "var(--text-font)",
    fontSize: "13px",
  },
  ".cm-tooltip": { border: "1px solid var(--border)", borderRadius: "6px", maxWidth: "min(36em, 90vw)" },
  ".cm-tooltip.cm-tooltip-hover": { maxHeight: "50vh", overflow: "auto" },
  ".cm-tooltip pre, .cm-tooltip code": { fontFamily: "var(--mono-font)", fontSize: "12px" },
  ".cm-tooltip pre": { whiteSpace: "pre-wrap" },
  ".cm-tooltip a": { color: "var(--links)" },
  ".cm-tooltip-autocomplete > ul": { fontFamily: "var(--mono-font)" },
  ".cm-tooltip-autocomplete > ul > li[aria-selected]": { backgroundColor: "var(--accent) !important", color: "var(--on-accent) !important" },
  ".cm-completionDetail": { color: "inherit", fontStyle: "normal", opacity: "0.85" },
  ".cm-diagnostic": { borderLeft: "3px solid transparent", padding: "4px 8px" },
  ".cm-diagnostic-error": { borderLeftColor: "var(--error)" },
  ".cm-diagnostic-warning": { borderLeftColor: "var(--warning)" },
  ".cm-diagnostic-info, .cm-diagnostic-hint": { borderLeftColor: "var(--links)" },
  ".cm-diagnosticSource": { color: "var(--quiet)", fontSize: "12px", opacity: "1" },
  ".cm-lintRange": { backgroundImage: "none !important", textDecoration: "underline wavy 1px", textUnderlineOffset: "3px", textDecorationSkipInk: "none" },
  ".cm-lintRange-error": { textDecorationColor: "var(--error)" },
  ".cm-lintRange-warning": { textDecorationColor: "var(--warning)" },
  ".cm-lintRange-info, .cm-lintRange-hint": { textDecorationColor: "var(--links)" },
  ".cm-panel.cm-panel-lint ul [aria-selected]": { backgroundColor: "var(--line-bg)" },
  ".cm-panel.cm-panel-lint ul": { maxHeight: "8em" },
  ".cm-panel button, .cm-panel input, .fix": { font: "inherit" },
  ".cm-panel input, .cm-panel button": {
    backgroundColor: "var(--bg)",
    backgroundImage: "none",
    color: "var(--fg)",
    border: "1px solid var(--border)",
    borderRadius: "4px",
  },
  ".cm-searchMatch": { backgroundColor: "var(--selection)" },
  ".fixes": { display: "flex", flexWrap: "wrap", gap: "4px", paddingTop: "4px" },
  ".fixes:empty": { display: "none" },
  ".diagnostic > span": { display: "block" },
  ".fix": {
    backgroundColor: "var(--accent)",
    color: "var(--on-accent)",
    border: "none",
    borderRadius: "4px",
    padding: "2px 8px",
    cursor: "pointer",
  },
  ".hint": { color: "var(--quiet)", fontSize: "12px", userSelect: "none" },
  ".actions": { display: "flex", flexDirection: "column", minWidth: "16em", padding: "4px" },
  ".actions p": { margin: "4px 8px", outline: "none" },
  ".actions button": {
    font: "inherit",
    color: "inherit",
    background: "none",
    border: "none",
    borderRadius: "4px",
    padding: "4px 8px",
    textAlign: "left",
    cursor: "pointer",
  },
  ".actions button:focus, .actions button:hover": { backgroundColor: "var(--accent)", color: "var(--on-accent)", outline: "none" },
  ".tok-keyword": { color: "var(--token-keyword)" },
  ".tok-number, .tok-enumMember": { color: "var(--token-number)" },
  ".tok-string": { color: "var(--token-string)" },
  ".tok-comment": { color: "var(--token-comment)" },
  ".tok-class, .tok-function, .tok-namespace, .tok-declaration": { color: "var(--token-name)" },
});

/** For languages that the server does not colour: TOML and Python. */
const highlights = HighlightStyle.define([
  { tag: [tags.keyword, tags.heading, tags.propertyName], class: "tok-keyword" },
  { tag: [tags.number, tags.bool, tags.atom], class: "tok-number" },
  { tag: tags.string, class: "tok-string" },
  { tag: tags.comment, class: "tok-comment" },
  { tag: [tags.definition(tags.variableName), tags.className], class: "tok-function" },
]);

export const theme: Extension = [view, syntaxHighlighting(highlights)];
