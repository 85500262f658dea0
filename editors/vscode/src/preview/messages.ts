// What the extension and the panel's page say to each other.
import type { DrivenPath, NumberedAction, PlannedPath } from "./protocol";

/** To the page. */
export type ToPage =
  | { type: "path"; uri: string; path: PlannedPath }
  /** There is no path of this program now, and why, in a sentence. Its last good picture stays. */
  | { type: "trouble"; uri: string | null; sentence: string; remedy?: Remedy }
  | { type: "environments"; uri: string; names: string[]; shown: string | null }
  | { type: "cursor"; action: NumberedAction | null }
  /** The latest run, if there was one; whether it has just ended. */
  | { type: "driven"; uri: string; environment: string; driven: DrivenPath | null; isNew: boolean }
  /** The picture is wanted as PNG. */
  | { type: "draw" };

/** What a person can do where there is no path. */
export type Remedy = "addEnvironment";

/** From the page. */
export type FromPage =
  /** It is there, and knows nothing yet. */
  | { type: "ready" }
  | { type: "choose"; environment: string }
  | { type: "reveal"; action: NumberedAction }
  | { type: "remedy"; remedy: Remedy }
  /** Somebody wants a file of the picture. */
  | { type: "export" }
  /** The picture, as it is shown: an address with a PNG in it. */
  | { type: "picture"; data: string };

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
    case "remedy":
      return message.remedy === "addEnvironment" ? { type: "remedy", remedy: message.remedy } : undefined;
    case "export":
      return { type: "export" };
    case "picture":
      return typeof message.data === "string" && message.data.startsWith(PNG) ? { type: "picture", data: message.data } : undefined;
    default:
      return undefined;
  }
}

/** What an address with a PNG in it begins with. */
export const PNG = "data:image/png;base64,";

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
