// Turns messages of the server and of the command into sentences.

/** The headline and the help of a printed error, as sentences. */
export function sentence(printed: string): string {
  // Terminals get lines drawn in front of related parts.
  const lines = printed.split("\n").map((line) => line.replace(/^[\s|│╰├=─▸>-]+/u, "").trim());
  const headline = lines.find((line) => line !== "")?.replace(/^error(?:\[[\w-]+\])?: /, "") ?? "";
  const help = lines.find((line) => line.startsWith("help: "))?.slice("help: ".length) ?? "";
  return [headline, help].filter((part) => part !== "").map((part) => withFullStop(capitalized(part))).join(" ");
}

export function withFullStop(text: string): string {
  return /[.!?]$/.test(text) ? text : `${text}.`;
}

function capitalized(text: string): string {
  return text.slice(0, 1).toUpperCase() + text.slice(1);
}
