// What the extension and the panel's page say to each other.
import type { DrivenPath, NumberedAction, PlannedPath } from "./protocol";

/** To the page. */
export type ToPage =
  | { type: "path"; uri: string; path: PlannedPath }
  /** There is no path now, and why, in a sentence. The last good picture stays. */
  | { type: "trouble"; sentence: string }
  | { type: "environments"; uri: string; names: string[]; shown: string | null }
  | { type: "cursor"; action: NumberedAction | null }
  | { type: "driven"; driven: DrivenPath | null };

/** From the page. */
export type FromPage =
  /** It is there, and knows nothing yet. */
  | { type: "ready" }
  | { type: "choose"; environment: string }
  | { type: "reveal"; action: NumberedAction };

/** What the page remembers over a reload of the window. */
export interface PageState {
  uri?: string;
  environment?: string;
  hidden?: string[];
  speed?: number;
  time?: number;
}

/** Reads a message from the page; undefined for what is none. */
export function fromPage(message: unknown): FromPage | undefined {
  if (!isRecord(message)) return undefined;
  switch (message.type) {
    case "ready":
      return { type: "ready" };
    case "choose":
      return typeof message.environment === "string"
        ? { type: "choose", environment: message.environment }
        : undefined;
    case "reveal":
      return isNumberedAction(message.action) ? { type: "reveal", action: message.action } : undefined;
    default:
      return undefined;
  }
}

/** Reads what a page remembers; what cannot be understood is forgotten. */
export function pageState(state: unknown): PageState {
  if (!isRecord(state)) return {};
  const { uri, environment, hidden, speed, time } = state;
  return {
    ...(typeof uri === "string" ? { uri } : {}),
    ...(typeof environment === "string" ? { environment } : {}),
    ...(Array.isArray(hidden) ? { hidden: hidden.filter((name) => typeof name === "string") } : {}),
    ...(isAboveZero(speed) ? { speed } : {}),
    ...(isAboveZero(time) ? { time } : {}),
  };
}

function isAboveZero(value: unknown): value is number {
  return typeof value === "number" && Number.isFinite(value) && value > 0;
}

function isNumberedAction(value: unknown): value is NumberedAction {
  return isRecord(value) && typeof value.movement === "string" && Number.isInteger(value.index);
}

function isRecord(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null;
}
