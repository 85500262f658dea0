// Keeps what is written: the shown project becomes a draft with its first change, and is stored soon after each change.
import { draftOfTab, drafts, isSame, remove, setDraftOfTab, store, type Draft } from "./drafts";
import type { Project } from "./documents";

/** After the latest change, milliseconds. */
const DELAY = 300;

export interface KeeperEvents {
  /** The shown project is stored, or cannot be. */
  stored: (isStored: boolean) => void;
}

export class DraftKeeper {
  /** The draft of the shown project. */
  private id: string | undefined;
  /** The project as it was opened or stored. */
  private kept: Project;
  private timer = 0;
  private isRefused = false;
  /** Lets another tab have the draft. */
  private release: () => void = () => undefined;

  constructor(
    private readonly current: () => Project,
    private readonly events: KeeperEvents,
  ) {
    this.kept = current();
    addEventListener("pagehide", () => this.store());
    addEventListener("visibilitychange", () => this.store());
    // The browser asks before it leaves the page.
    addEventListener("beforeunload", (event) => {
      this.store();
      if (this.isRefused) event.preventDefault();
    });
  }

  /** The draft to begin with: that of this tab; for a new tab, the latest one that no other tab shows. */
  static async first(linked: Project | undefined): Promise<Draft | undefined> {
    const ofTab = draftOfTab();
    const candidates = linked || ofTab ? [ofTab].filter((draft) => draft !== undefined) : drafts();
    for (const draft of candidates) {
      if (linked && !isSame(draft.project, linked)) continue;
      if (await isFree(draft.id)) return draft;
    }
    return undefined;
  }

  /** The id of the shown draft. */
  get shown(): string | undefined {
    return this.id;
  }

  /** The editors show another project, or will: call this after `store`. */
  opened(draft: Draft | undefined): void {
    this.kept = this.current();
    this.isRefused = false;
    this.hold(draft?.id);
  }

  /** A text may have changed. */
  changed(): void {
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.store(), DELAY);
  }

  /** Stores the project if it has changed. */
  store(): void {
    clearTimeout(this.timer);
    const project = this.current();
    if (isSame(project, this.kept)) return;
    const id = this.id ?? crypto.randomUUID();
    if (this.id === undefined) this.hold(id);
    const isStored = store({ id, project, time: Date.now() });
    if (isStored) this.kept = project;
    this.isRefused = !isStored;
    this.events.stored(isStored);
  }

  /** Deletes a draft; what is shown stays, and becomes a new draft with its next change. */
  delete(id: string): void {
    remove(id);
    if (id === this.id) this.hold(undefined);
  }

  private hold(id: string | undefined): void {
    if (id === this.id) return;
    this.release();
    this.id = id;
    setDraftOfTab(id);
    if (id !== undefined) {
      void locks()?.request(lockOf(id), () => new Promise<void>((resolve) => (this.release = resolve)));
    }
  }
}

/** True if no other tab shows a draft. */
export async function isFree(id: string): Promise<boolean> {
  return (await locks()?.request(lockOf(id), { ifAvailable: true }, (lock) => lock !== null)) ?? true;
}

/** Pages that came without encryption have none. */
function locks(): LockManager | undefined {
  return (navigator as { locks?: LockManager }).locks;
}

function lockOf(id: string): string {
  return `pydslrep.draft.${id}`;
}
