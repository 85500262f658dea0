// Drafts: the projects that a visitor has changed, in the browser's storage.
import { projectOf, type Project } from "./documents";

/** One entry per draft, so that tabs do not overwrite each other's. */
const PREFIX = "pydslrep.draft.";
/** The draft of this tab, in the storage of the tab. */
const CURRENT = "pydslrep.draft";

export interface Draft {
  id: string;
  project: Project;
  /** When it was stored, milliseconds since 1970. */
  time: number;
}

/** All drafts, the latest first; none where storage is forbidden. */
export function drafts(): Draft[] {
  return attempt(() => Object.keys(localStorage), [])
    .filter((key) => key.startsWith(PREFIX))
    .map((key) => read(key.slice(PREFIX.length)))
    .filter((draft) => draft !== undefined)
    .sort((a, b) => b.time - a.time);
}

function read(id: string): Draft | undefined {
  const text = attempt(() => localStorage.getItem(PREFIX + id), null);
  const found = text === null ? undefined : attempt(() => JSON.parse(text) as Partial<Draft> | null, null);
  const project = projectOf(found?.project);
  return project && { id, project, time: typeof found?.time === "number" ? found.time : 0 };
}

/** Stores a draft; false if the browser refuses. */
export function store({ id, project, time }: Draft): boolean {
  return attempt(() => {
    localStorage.setItem(PREFIX + id, JSON.stringify({ project, time }));
    return true;
  }, false);
}

export function remove(id: string): void {
  attempt(() => localStorage.removeItem(PREFIX + id), undefined);
}

/** The draft that this tab showed before it was loaded anew. */
export function draftOfTab(): Draft | undefined {
  const id = attempt(() => sessionStorage.getItem(CURRENT), null);
  return id === null ? undefined : read(id);
}

export function setDraftOfTab(id: string | undefined): void {
  attempt(() => {
    if (id === undefined) sessionStorage.removeItem(CURRENT);
    else sessionStorage.setItem(CURRENT, id);
  }, undefined);
}

export function isSame(a: Project, b: Project): boolean {
  return canonical(a) === canonical(b);
}

function canonical({ name, program, settings, scenes }: Project): string {
  return JSON.stringify([name, program, settings, Object.entries(scenes).sort(([a], [b]) => (a < b ? -1 : 1))]);
}

/** Storage may be forbidden, or full. */
function attempt<Result>(action: () => Result, otherwise: Result): Result {
  try {
    return action();
  } catch {
    return otherwise;
  }
}
