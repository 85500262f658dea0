// A workspace in the memory of the browser, which cannot be searched.
const vscode = require("vscode");

const PARTS = "wheel l with radius 4.5\nwheel r with radius 4.5\nrobot scout type tw with port 23000 has { l r } wheels\n";
const AREA = 'import "../parts b.pyr"\n\nmovement lap of scout {\n  move 1 meters\n  turn left\n  move 2 meters\n}\n\nenvironment area has { scout } robots with { lap } moves\n';

const bytes = (text) => new TextEncoder().encode(text);
const files = new Map([
  ["/w/parts b.pyr", bytes(PARTS)],
  ["/w/sub/area.pyr", bytes(AREA)],
  ["/w/sub/area.scene.toml", bytes("[robots]\nscout = { start = [0, 0, 0] }\n")],
]);

const changed = new vscode.EventEmitter();

const isFolder = (path) => [...files.keys()].some((file) => file.startsWith(`${path.replace(/\/$/, "")}/`));

const provider = {
  onDidChangeFile: changed.event,
  watch: () => new vscode.Disposable(() => undefined),
  stat({ path }) {
    if (files.has(path)) return { type: vscode.FileType.File, ctime: 0, mtime: 0, size: files.get(path).length };
    if (isFolder(path)) return { type: vscode.FileType.Directory, ctime: 0, mtime: 0, size: 0 };
    throw vscode.FileSystemError.FileNotFound(path);
  },
  readDirectory({ path }) {
    const inside = [...files.keys()].filter((file) => file.startsWith(`${path}/`)).map((file) => file.slice(path.length + 1).split("/"));
    return [...new Map(inside.map(([name, ...rest]) => [name, rest.length > 0 ? vscode.FileType.Directory : vscode.FileType.File]))];
  },
  readFile({ path }) {
    if (!files.has(path)) throw vscode.FileSystemError.FileNotFound(path);
    return files.get(path);
  },
  writeFile(uri, content) {
    const type = files.has(uri.path) ? vscode.FileChangeType.Changed : vscode.FileChangeType.Created;
    files.set(uri.path, content);
    changed.fire([{ type, uri }]);
  },
  delete(uri) {
    files.delete(uri.path);
    changed.fire([{ type: vscode.FileChangeType.Deleted, uri }]);
  },
  createDirectory: () => undefined,
  rename: () => undefined,
};

exports.activate = (context) => {
  context.subscriptions.push(
    vscode.workspace.registerFileSystemProvider("memfs", provider, { isCaseSensitive: true }),
    vscode.commands.registerCommand("virtualFiles.change", () =>
      provider.writeFile(vscode.Uri.parse("memfs:/w/parts%20b.pyr"), bytes(PARTS.replace("scout", "rover"))),
    ),
  );
};
