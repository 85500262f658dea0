// Where the project is, as a manifest says it.

/** Where the project is to be found, and where problems are to be told; nothing as long as it has no public address. */
export function addresses(cargo) {
  const [, repository] = /^repository = "([^"]+)"$/m.exec(cargo) ?? [];
  return repository === undefined
    ? {}
    : { repository: { type: "git", url: repository, directory: "editors/vscode" }, bugs: { url: `${repository}/issues` } };
}
