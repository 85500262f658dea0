// The project's URLs in the manifest.

/** The repository and the issue tracker, if Cargo.toml names a repository. */
export function addresses(cargo) {
  const [, repository] = /^repository = "([^"]+)"$/m.exec(cargo) ?? [];
  return repository === undefined
    ? {}
    : { repository: { type: "git", url: repository, directory: "editors/vscode" }, bugs: { url: `${repository}/issues` } };
}
