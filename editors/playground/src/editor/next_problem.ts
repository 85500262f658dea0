// F8 and Shift+F8: the next problem and the previous one, errors first, as in VS Code.
import { forEachDiagnostic, type Diagnostic } from "@codemirror/lint";
import { StateEffect, StateField, type EditorState, type Extension } from "@codemirror/state";
import { keymap, showTooltip, type Command, type EditorView, type Tooltip } from "@codemirror/view";

import { element } from "../elements";

const RANKS: Record<Diagnostic["severity"], number> = { error: 0, warning: 1, info: 2, hint: 3 };

/** The problems of one range. */
export interface Problem {
  from: number;
  to: number;
  /** 0 is the most severe. */
  rank: number;
  diagnostics: Diagnostic[];
}

/** The problems by severity, then by position. */
export function problems(state: EditorState): Problem[] {
  const found = new Map<string, Problem>();
  forEachDiagnostic(state, (diagnostic, from, to) => {
    const key = `${from}-${to}`;
    const problem = found.get(key) ?? { from, to, rank: Infinity, diagnostics: [] };
    problem.diagnostics.push(diagnostic);
    problem.rank = Math.min(problem.rank, RANKS[diagnostic.severity]);
    found.set(key, problem);
  });
  return [...found.values()].sort((a, b) => a.rank - b.rank || a.from - b.from || a.to - b.to);
}

/** The problem after the selected one, or before it; without one, the nearest of the most severe. */
export function neighbour(sorted: readonly Problem[], selected: { from: number; to: number }, step: 1 | -1): Problem | undefined {
  const current = sorted.findIndex(({ from, to }) => from === selected.from && to === selected.to);
  if (current >= 0) return sorted.at((current + step) % sorted.length);
  const severe = sorted.filter(({ rank }) => rank === sorted[0]?.rank);
  return step > 0
    ? (severe.find(({ from }) => from >= selected.from) ?? severe[0])
    : (severe.findLast(({ from }) => from < selected.from) ?? severe.at(-1));
}

const setShown = StateEffect.define<Tooltip>();

/** The messages of the problem that was gone to, until the text or the cursor changes. */
const shown = StateField.define<Tooltip | null>({
  create: () => null,
  update: (tooltip, transaction) => {
    const change = transaction.effects.find((effect) => effect.is(setShown));
    if (change) return change.value;
    return transaction.docChanged || transaction.selection ? null : tooltip;
  },
  provide: (field) => showTooltip.from(field),
});

function messages(view: EditorView, { diagnostics }: Problem): HTMLElement {
  const shownOnes = diagnostics.map((diagnostic) =>
    element(
      "div",
      { class: `cm-diagnostic cm-diagnostic-${diagnostic.severity}` },
      diagnostic.renderMessage?.(view) ?? diagnostic.message,
      element("div", { class: "cm-diagnosticSource" }, diagnostic.source ?? ""),
    ),
  );
  return element("div", { role: "status", class: "problem" }, ...shownOnes);
}

function go(step: 1 | -1): Command {
  return (view) => {
    const { state } = view;
    const problem = neighbour(problems(state), state.selection.main, step);
    if (!problem) return false;
    const { from, to } = problem;
    view.dispatch({
      selection: { anchor: from, head: to },
      scrollIntoView: true,
      effects: setShown.of({ pos: from, end: to, above: false, create: () => ({ dom: messages(view, problem) }) }),
    });
    return true;
  };
}

export const nextProblem: Extension = [shown, keymap.of([{ key: "F8", run: go(1), shift: go(-1), preventDefault: true }])];
