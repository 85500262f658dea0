// The project's URLs in the manifest and the readme.

/** The repository and the issue tracker, if Cargo.toml names a repository. */
export function addresses(cargo) {
  const repository = repositoryOf(cargo);
  return repository === undefined
    ? {}
    : { repository: { type: "git", url: repository, directory: "editors/vscode" }, bugs: { url: `${repository}/issues` } };
}

/** The readme for the gallery: relative links lead into the repository; without one, their pictures are left out. */
export function forGallery(readme, cargo) {
  const repository = repositoryOf(cargo);
  const picture = /^!\[([^\]]*)\]\((?:\.\.\/){2}([^)]+)\)\n\n/gm;
  return readme.replace(picture, (_, words, file) =>
    repository === undefined ? "" : `![${words}](${repository}/raw/HEAD/${file})\n\n`,
  );
}

function repositoryOf(cargo) {
  return /^repository = "([^"]+)"$/m.exec(cargo)?.[1];
}
