// Provides the server with the files that are not open: programs, scenes and settings of the workspace, and scripts, which it
// must not replace unless it generated them.
import * as vscode from "vscode";
import type { BaseLanguageClient } from "vscode-languageclient";

const PATTERN = "**/{*.pyr,*.scene.toml,pydslrep.toml,*.py}";
const IS_WANTED = /\.pyr$|\.scene\.toml$|\/pydslrep\.toml$|\.py$/;

/** So many files and folders are visited; what is beyond is only found by a search. */
const MAX_ENTRIES = 2_000;

/** Files that are larger are no programs, bytes. */
const MAX_BYTES = 1 << 20;

export class ProvidedFiles implements vscode.Disposable {
  private readonly subscriptions: vscode.Disposable[] = [];

  constructor(private readonly client: BaseLanguageClient) {
    const watcher = vscode.workspace.createFileSystemWatcher(PATTERN);
    const provide = (uri: vscode.Uri) => void this.provide([uri]);
    this.subscriptions.push(
      watcher,
      watcher.onDidCreate(provide),
      watcher.onDidChange(provide),
      watcher.onDidDelete((uri) => this.send([{ uri, text: null }])),
      vscode.workspace.onDidChangeWorkspaceFolders(({ added }) => void this.provideFolders(added)),
      vscode.workspace.onDidOpenTextDocument((document) => void this.provideAround(document)),
    );
    void this.provideFolders(vscode.workspace.workspaceFolders ?? []);
    vscode.workspace.textDocuments.forEach((document) => void this.provideAround(document));
  }

  dispose(): void {
    vscode.Disposable.from(...this.subscriptions).dispose();
  }

  private async provideFolders(folders: readonly vscode.WorkspaceFolder[]): Promise<void> {
    const known = new Set<string>();
    const provideNew = async (found: vscode.Uri[]) => {
      const unknown = found.filter((uri) => !known.has(uri.toString()));
      unknown.forEach((uri) => known.add(uri.toString()));
      await this.provide(unknown);
    };
    for (const { uri } of folders) {
      // A file system that cannot search never answers.
      void vscode.workspace.findFiles(new vscode.RelativePattern(uri, PATTERN)).then(provideNew);
      await provideNew(await visit(uri, MAX_ENTRIES));
    }
  }

  /** What is beside a program that is not in the workspace. */
  private async provideAround({ languageId, uri }: vscode.TextDocument): Promise<void> {
    if (languageId === "pydslrep" && uri.scheme !== "untitled" && vscode.workspace.getWorkspaceFolder(uri) === undefined) {
      const folder = vscode.Uri.joinPath(uri, "..");
      const found = (await list(folder)).filter(([name, type]) => type === vscode.FileType.File && IS_WANTED.test(`/${name}`));
      await this.provide(found.map(([name]) => vscode.Uri.joinPath(folder, name)));
    }
  }

  private async provide(uris: vscode.Uri[]): Promise<void> {
    const files = await Promise.all(uris.map(async (uri) => ({ uri, text: await read(uri) })));
    this.send(files);
  }

  private send(files: { uri: vscode.Uri; text: string | null }[]): void {
    if (files.length > 0 && this.client.isRunning()) {
      const provided = files.map(({ uri, text }) => ({ uri: this.client.code2ProtocolConverter.asUri(uri), text }));
      void this.client.sendNotification("pydslrep/files", { files: provided });
    }
  }
}

/** The text of a file; null if it is gone, or is no text. */
async function read(uri: vscode.Uri): Promise<string | null> {
  try {
    const bytes = await vscode.workspace.fs.readFile(uri);
    return bytes.length > MAX_BYTES ? null : new TextDecoder("utf-8", { fatal: true }).decode(bytes);
  } catch {
    return null;
  }
}

/** The wanted files in a folder and below it. */
async function visit(folder: vscode.Uri, most: number): Promise<vscode.Uri[]> {
  const found: vscode.Uri[] = [];
  const folders = [folder];
  let visited = 0;
  for (let next = folders.shift(); next !== undefined && visited < most; next = folders.shift()) {
    for (const [name, type] of await list(next)) {
      visited += 1;
      const uri = vscode.Uri.joinPath(next, name);
      if (type === vscode.FileType.Directory && !name.startsWith(".") && name !== "node_modules") {
        folders.push(uri);
      } else if (type === vscode.FileType.File && IS_WANTED.test(`/${name}`)) {
        found.push(uri);
      }
    }
  }
  return found;
}

async function list(folder: vscode.Uri): Promise<[string, vscode.FileType][]> {
  try {
    return await vscode.workspace.fs.readDirectory(folder);
  } catch {
    return [];
  }
}
