// The list of completions: it selects nothing by itself, so Enter ends the line; Tab takes the first item.
import {
  acceptCompletion,
  autocompletion,
  completionStatus,
  moveCompletionSelection,
  selectedCompletionIndex,
  setSelectedCompletion,
  startCompletion,
} from "@codemirror/autocomplete";
import { Prec, type Extension } from "@codemirror/state";
import { keymap, ViewPlugin, type Command, type ViewUpdate } from "@codemirror/view";

const acceptFirst: Command = (view) => {
  if (completionStatus(view.state) !== "active") return false;
  const isSelected = (selectedCompletionIndex(view.state) ?? -1) >= 0 || moveCompletionSelection(true)(view);
  return isSelected && acceptCompletion(view);
};

/** Selects the first item of a list that the user has asked for, once it is there. */
const asked = ViewPlugin.fromClass(
  class {
    isAsked = false;

    update({ docChanged, state, view }: ViewUpdate): void {
      if (docChanged) this.isAsked = false;
      if (!this.isAsked || completionStatus(state) !== "active") return;
      this.isAsked = false;
      // An update cannot begin another one.
      queueMicrotask(() => {
        if (selectedCompletionIndex(view.state) === -1) view.dispatch({ effects: setSelectedCompletion(0) });
      });
    }
  },
);

const ask: Command = (view) => {
  const plugin = view.plugin(asked);
  if (plugin) plugin.isAsked = true;
  return startCompletion(view);
};

export const completion: Extension = [
  autocompletion({ icons: false, selectOnOpen: false }),
  asked,
  Prec.highest(
    keymap.of([
      { key: "Tab", run: acceptFirst },
      { key: "Ctrl-Space", run: ask },
      { mac: "Alt-`", run: ask },
      { mac: "Alt-i", run: ask },
    ]),
  ),
];
