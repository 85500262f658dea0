// The list of drafts: a dialog from which they are opened and deleted.
import { drafts, store, type Draft } from "./drafts";
import { button, byId, element } from "./elements";

export interface DraftListEvents {
  /** Stores what is shown, so that it is in the list. */
  opening: () => void;
  open: (draft: Draft) => void;
  delete: (id: string) => void;
  /** The draft that is shown. */
  shown: () => string | undefined;
}

export class DraftList {
  private readonly dialog = byId<HTMLDialogElement>("drafts-dialog");
  private readonly list = byId("drafts-list");

  constructor(
    opener: HTMLButtonElement,
    private readonly events: DraftListEvents,
  ) {
    opener.addEventListener("click", () => this.open());
    byId("drafts-close").addEventListener("click", () => this.dialog.close());
  }

  private open(): void {
    this.events.opening();
    const found = drafts();
    this.list.replaceChildren(...found.map((draft) => this.item(draft)));
    byId("drafts-empty").hidden = found.length > 0;
    this.dialog.showModal();
  }

  private item(draft: Draft): HTMLElement {
    const isShown = draft.id === this.events.shown();
    const name = titleOf(draft);
    const opener = button(name, () => {
      this.dialog.close();
      this.events.open(draft);
    });
    opener.append(element("span", { class: "detail" }, `${new Date(draft.time).toLocaleString()}${isShown ? ", shown now" : ""}`));
    const deleter = button("Delete", () => row.replaceChildren(...this.deleted(draft, row)), { "aria-label": `Delete ${name}` });
    const row = element("li", {}, opener, deleter);
    return row;
  }

  private deleted(draft: Draft, row: HTMLElement): Node[] {
    this.events.delete(draft.id);
    const undo = button("Undo", () => {
      store(draft);
      row.replaceWith(this.item(draft));
    });
    queueMicrotask(() => undo.focus());
    return [element("span", {}, `${titleOf(draft)} is deleted.`), undo];
  }
}

/** The name of a draft's program with its first environment, as far as they differ. */
export function titleOf({ project: { name, program } }: Draft): string {
  const environment = /\benvironment\s+(\w+)/.exec(program)?.[1];
  return environment === undefined || environment === name ? name : `${name}: ${environment}`;
}
