// Classifies the errors of requests by what the user can do about them. Does not depend on VS Code.
import type { Location } from "../../preview/host/protocol";
import { sentence } from "../../preview/host/sentence";

export type Failure =
  | { kind: "cancelled" }
  /** The server exited before it responded. */
  | { kind: "disconnected" }
  /** The program has no file yet. */
  | { kind: "unsaved"; message: string }
  /** The program has errors; the location is that of the first. */
  | { kind: "errors"; message: string; location?: Location }
  /** An action failed in a run; this is where it is. */
  | { kind: "run"; message: string; location: Location }
  /** Anything else; the details belong in the output channel. */
  | { kind: "other"; message: string; details: string };

/** LSP's RequestCancelled and ServerCancelled. */
const CANCELLED = [-32800, -32802];

/** The client library's codes for a request whose connection was closed. */
const DISCONNECTED = [-32097, -32099];

/** Classifies what a request was rejected with, which may be anything. */
export function failureOf(error: unknown): Failure {
  const { code, data } = (typeof error === "object" && error !== null ? error : {}) as { code?: unknown; data?: unknown };
  const details = error instanceof Error ? error.message : String(error);
  if (CANCELLED.includes(code as number)) {
    return { kind: "cancelled" };
  }
  if (DISCONNECTED.includes(code as number)) {
    return { kind: "disconnected" };
  }
  const { reason, location } = (typeof data === "object" && data !== null ? data : {}) as { reason?: unknown; location?: Location | null };
  const message = sentence(details);
  switch (reason) {
    case "unsaved":
      return { kind: "unsaved", message };
    case "errors":
      return location ? { kind: "errors", message, location } : { kind: "errors", message };
    case "failed-run":
      return location ? { kind: "run", message, location } : { kind: "other", message, details };
    default:
      return { kind: "other", message, details };
  }
}
