// The playground's page: connects the editors, the preview, the outline and runs.
import { groups, imported } from "virtual:examples";
import type { WorkspaceEdit } from "vscode-languageserver-protocol";

import { Connection } from "./connection";
import { FOLDER, type Project } from "./documents";
import { DraftKeeper, isFree } from "./draft_keeper";
import { DraftList } from "./draft_list";
import type { Draft } from "./drafts";
import { Editors, NAMES, type Name } from "./editors";
import { byId, element } from "./elements";
import { Outline } from "./outline";
import { fragmentOf, projectIn } from "./permalink";
import { Preview } from "./preview";
import { RunPanel } from "./run/panel";
import { Tabs } from "./tabs";
import { followTheme } from "./theme";

const UNSTORED = "This browser does not keep your changes. Copy the program or press Share before you leave the page.";

const fallback = groups[0]?.projects[0] ?? { name: "program", program: "", settings: "", scenes: {} };

const server = new Worker("server.js", { name: "language server" });
server.postMessage({ wasm: new URL("pydslrep.wasm", location.href).href });
const connection = new Connection(server, (method, params) => {
  switch (method) {
    case "workspace/applyEdit":
      editors.apply((params as { edit: WorkspaceEdit }).edit);
      return { applied: true };
    case "workspace/inlayHint/refresh":
      editors.refreshHints();
      return null;
    case "client/registerCapability":
    case "window/workDoneProgress/create":
      return null;
    case "workspace/configuration":
      return (params as { items: unknown[] }).items.map(() => null);
    default:
      return undefined;
  }
});
connection.on("pydslrep/crashed", ({ message }: { message: string }) => announce(`${message}. Reload the page to go on.`));
const importedFiles = Object.fromEntries(Object.entries(imported).map(([path, text]) => [FOLDER + path, text]));

const linked = await projectIn(location.hash);
const firstDraft = await DraftKeeper.first(linked === "damaged" ? undefined : linked);
const first = firstDraft?.project ?? (linked === "damaged" ? undefined : linked) ?? fallback;

const editors = new Editors(byId("editor"), connection, first, importedFiles, {
  changed: (name, isNew) => {
    if (isNew) keeper.changed();
    // They decide which hints there are.
    if (isNew && name === "settings") editors.refreshHints();
    if (isNew && name === "program") outline.update(editors.programUri);
    if (isNew) runs.textChanged();
    if (name === "program") {
      if (isNew) editors.sync();
      void preview.update(editors.cursor, isNew);
    }
  },
  counted: (name, errors, warnings) => tabs.mark(name, errors, warnings),
});

const preview = new Preview(byId("preview"), connection, {
  reveal: ({ uri, range }) => {
    if (uri !== editors.programUri) return;
    tabs.choose("program");
    editors.reveal(range);
  },
  addEnvironment: () => editors.focus("program"),
  fix: ({ uri, range }, title) => {
    if (uri === editors.programUri) void editors.fix(range, title);
  },
  shown: (id) => {
    editors.setEnvironment(id?.environment, preview.environments);
    runs.setEnvironment(id);
  },
  changed: () => runs.pathChanged(),
});

const runs = new RunPanel({ connection, editors, preview, imported: importedFiles });

const outline = new Outline(byId("outline"), connection, (line, character) => {
  const position = { line, character };
  tabs.choose("program");
  editors.reveal({ start: position, end: position });
  editors.focus("program");
});

const tabs = new Tabs(byId("tabs"), (name) => {
  byId("editor").setAttribute("aria-labelledby", `tab-${name}`);
  editors.show(name as Name);
  if (name === "script") void runs.showScript();
});

const keeper = new DraftKeeper(() => editors.project, {
  stored: (isStored) => {
    forgetLink();
    if (!isStored) announce(UNSTORED);
    else if (byId("announcement").textContent === UNSTORED) announce("");
  },
});
keeper.opened(firstDraft);

new DraftList(byId<HTMLButtonElement>("drafts"), {
  opening: () => keeper.store(),
  open: (draft) => void openDraft(draft),
  delete: (id) => keeper.delete(id),
  shown: () => keeper.shown,
});

/** Opens a draft; a copy of it, if another tab shows it. */
async function openDraft(draft: Draft): Promise<void> {
  if (draft.id === keeper.shown) return;
  const isOurs = await isFree(draft.id);
  open(draft.project, isOurs ? draft : undefined);
  if (!isOurs) announce("Another tab shows this draft: your changes here become a new one.");
}

function open(project: Project, draft?: Draft): void {
  keeper.store();
  announce("");
  runs.stop();
  editors.open(project);
  keeper.opened(draft);
  tabs.choose("program");
  start();
}

function start(): void {
  void preview.follow(editors.programUri, editors.cursor);
  outline.update(editors.programUri);
}

/** The address is no longer that of what is shown. */
function forgetLink(): void {
  if (location.hash !== "") history.replaceState(null, "", location.pathname + location.search);
}

async function share(): Promise<void> {
  keeper.store();
  history.replaceState(null, "", await fragmentOf(editors.project));
  try {
    await navigator.clipboard.writeText(location.href);
    announce("The address has been copied. It contains the program.");
  } catch {
    announce("The address in the address bar now contains the program.");
  }
}

function announceDamage(): void {
  announce("This link is damaged: the program in it cannot be read. Ask for the link again; part of it may have been cut off.");
}

function announce(text: string): void {
  byId("announcement").textContent = text;
}

const examples = byId<HTMLSelectElement>("examples");
for (const { label, projects } of groups) {
  examples.append(element("optgroup", { label }, ...projects.map(({ name }) => element("option", { value: name }, name))));
}
examples.addEventListener("change", () => {
  const project = groups.flatMap(({ projects }) => projects).find(({ name }) => name === examples.value);
  if (project) {
    open(project);
    forgetLink();
  }
  examples.value = "";
});

byId("share").addEventListener("click", () => void share());
byId("format").addEventListener("click", () => editors.format(tabs.shown as Name));
window.addEventListener("hashchange", () => {
  void projectIn(location.hash).then((project) => {
    if (project === "damaged") announceDamage();
    else if (project) open(project);
  });
});
window.addEventListener("keydown", (event) => {
  // As in VS Code; Alt+1 to Alt+4 lead to the editors.
  const digit = event.altKey && !event.ctrlKey ? NAMES[Number(event.key) - 1] : undefined;
  if (event.key === "F5" && !event.ctrlKey) runs.toggle();
  else if (digit) {
    tabs.choose(digit);
    editors.focus(digit);
  } else return;
  event.preventDefault();
});
followTheme(byId("theme"), (theme) => preview.setTheme(theme));
start();
if (linked === "damaged") announceDamage();
