// Why the server did not do what it was asked for, in words and with what a person can do about it. Knows nothing of VS Code.
import type { Location } from "./preview/follower";

export type Failure =
  /** Somebody wanted it so. */
  | { kind: "cancelled" }
  /** The server went away before it answered. */
  | { kind: "ended" }
  /** The program has no file yet. */
  | { kind: "unsaved"; message: string }
  /** The program has errors; the first is there. */
  | { kind: "errors"; message: string; location?: Location }
  /** Anything else; the details are for the output. */
  | { kind: "other"; message: string; details: string };

/** The protocol's codes for a request that was taken back, by either side. */
const CANCELLED = [-32800, -32802];

/** The client's codes for a request that has lost its connection. */
const ENDED = [-32097, -32099];

/** What an error that a request was answered with comes down to. */
export function failureOf(error: unknown): Failure {
  const { code, data } = (typeof error === "object" && error !== null ? error : {}) as { code?: unknown; data?: unknown };
  const details = error instanceof Error ? error.message : String(error);
  if (CANCELLED.includes(code as number)) {
    return { kind: "cancelled" };
  }
  if (ENDED.includes(code as number)) {
    return { kind: "ended" };
  }
  const { reason, location } = (typeof data === "object" && data !== null ? data : {}) as { reason?: unknown; location?: Location | null };
  const message = sentence(details);
  switch (reason) {
    case "unsaved":
      return { kind: "unsaved", message };
    case "errors":
      return location ? { kind: "errors", message, location } : { kind: "errors", message };
    default:
      return { kind: "other", message, details };
  }
}

/** The headline and the help of what a command printed, as a sentence. */
export function sentence(printed: string): string {
  // A terminal draws a line beside what belongs together.
  const lines = printed.split("\n").map((line) => line.replace(/^[\s|│╰├=─▸>-]+/u, "").trim());
  const headline = lines.find((line) => line !== "")?.replace(/^error(?:\[[\w-]+\])?: /, "") ?? "";
  const help = lines.find((line) => line.startsWith("help: "))?.slice("help: ".length);
  return [headline, help].filter((part) => part !== undefined && part !== "").map((part) => ended(upper(part ?? ""))).join(" ");
}

function upper(text: string): string {
  return text.slice(0, 1).toUpperCase() + text.slice(1);
}

function ended(text: string): string {
  return /[.!?]$/.test(text) ? text : `${text}.`;
}
