// Saves a file from a page.

/** Saves a data URI under a name. */
export function download(dataUri: string, name: string): void {
  const link = document.createElement("a");
  link.href = dataUri;
  link.download = name;
  link.click();
}
