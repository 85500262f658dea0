// The messages between the preview's page and its host.
import type { ActionAt, DrivenPath, NumberedAction, PlannedPath } from "./protocol";

/** To the page. */
export type ToPage =
  | { type: "path"; uri: string; path: PlannedPath; isRunEarlier?: boolean }
  /** The program has no path now, and why. The page keeps its last path. */
  | { type: "problem"; uri: string | null; message: string; suggestion?: Suggestion; place?: string; fix?: string }
  /** How the latest run ended; null when another one starts, or another environment is shown. */
  | { type: "result"; result: Result | null }
  | { type: "environments"; uri: string; names: string[]; shown: string | null; canRun?: boolean }
  | { type: "cursor"; action: ActionAt | null }
  /** The latest run, if there was one, whether it has just ended, and whether its program was an earlier version. */
  | { type: "driven"; uri: string; environment: string; driven: DrivenPath | null; isNew: boolean; isRunEarlier?: boolean }
  /** Requests the picture as PNG. */
  | { type: "capture" };

/** What the host says of a run, so that nothing covers the picture. */
export interface Result {
  message: string;
  isError: boolean;
  /** Labels of buttons, in order. */
  buttons: string[];
  /** Whether the program has changed since. */
  isEarlier?: boolean;
}

/** What the user can do about a problem. */
export type Suggestion = "addEnvironment";

/** From the page. */
export type FromPage =
  /** The page is loaded. */
  | { type: "ready" }
  | { type: "select"; environment: string }
  | { type: "reveal"; action: NumberedAction }
  | { type: "accept"; suggestion: Suggestion }
  /** Show the place of the problem, or apply its fix. */
  | { type: "place" }
  | { type: "fix" }
  | { type: "run" }
  /** A button of the result. */
  | { type: "press"; button: number }
  | { type: "export" }
  /** The picture as a data URI. */
  | { type: "captured"; png: string };

/** What the page keeps when the window is reloaded. */
export interface PageState {
  uri?: string;
  environment?: string;
  hidden?: string[];
  speed?: number;
  time?: number;
}

/** Parses a message from the page; undefined if it is invalid. */
export function fromPage(message: unknown): FromPage | undefined {
  if (!isRecord(message)) return undefined;
  switch (message.type) {
    case "ready":
    case "place":
    case "fix":
    case "run":
      return { type: message.type };
    case "press":
      return typeof message.button === "number" ? { type: "press", button: message.button } : undefined;
    case "select":
      return typeof message.environment === "string"
        ? { type: "select", environment: message.environment }
        : undefined;
    case "reveal":
      return isNumberedAction(message.action) ? { type: "reveal", action: message.action } : undefined;
    case "accept":
      return message.suggestion === "addEnvironment" ? { type: "accept", suggestion: message.suggestion } : undefined;
    case "export":
      return { type: "export" };
    case "captured":
      return typeof message.png === "string" && message.png.startsWith(PNG_PREFIX) ? { type: "captured", png: message.png } : undefined;
    default:
      return undefined;
  }
}

/** The start of a data URI that contains a PNG. */
export const PNG_PREFIX = "data:image/png;base64,";

/** Parses the page's state; invalid parts are dropped. */
export function pageState(state: unknown): PageState {
  if (!isRecord(state)) return {};
  const { uri, environment, hidden, speed, time } = state;
  return {
    ...(typeof uri === "string" ? { uri } : {}),
    ...(typeof environment === "string" ? { environment } : {}),
    ...(Array.isArray(hidden) ? { hidden: hidden.filter((name) => typeof name === "string") } : {}),
    ...(isPositive(speed) ? { speed } : {}),
    ...(isPositive(time) ? { time } : {}),
  };
}

function isPositive(value: unknown): value is number {
  return typeof value === "number" && Number.isFinite(value) && value > 0;
}

function isNumberedAction(value: unknown): value is NumberedAction {
  return isStatement(value) && (value.calls === undefined || (Array.isArray(value.calls) && value.calls.every(isStatement)));
}

function isStatement(value: unknown): value is Record<string, unknown> {
  return isRecord(value) && typeof value.movement === "string" && Number.isInteger(value.index);
}

function isRecord(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null;
}
