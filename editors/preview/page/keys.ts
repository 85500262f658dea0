// Maps keys to commands, wherever the focus is.
import { ZOOM_STEP } from "./view";

export type Command =
  | { do: "toggle" | "start" | "end" | "fit" | "reveal" | "help" | "close" | "export" }
  | { do: "step"; steps: number }
  | { do: "action"; direction: 1 | -1 }
  | { do: "zoom"; factor: number }
  | { do: "pan"; x: number; y: number };

export interface Key {
  key: string;
  shiftKey: boolean;
  ctrlKey: boolean;
  altKey: boolean;
  metaKey: boolean;
}

/** The keys by their DOM names, with what the help says about them. */
export const KEYS: readonly { keys: readonly string[]; shift?: true; label: string; effect: string }[] = [
  { keys: [" "], label: "Space", effect: "play or pause" },
  { keys: ["ArrowLeft", "ArrowRight"], label: "← →", effect: "step through time" },
  { keys: ["ArrowUp", "ArrowDown"], label: "↑ ↓", effect: "ten steps" },
  { keys: ["Home", "End"], label: "Home End", effect: "go to the start or the end" },
  { keys: ["n", "p", "PageDown", "PageUp"], label: "N P", effect: "next or previous action" },
  { keys: ["Enter"], label: "Enter", effect: "show the action in the program" },
  { keys: ["+", "=", "-", "−"], label: "+ −", effect: "zoom" },
  { keys: ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"], shift: true, label: "Shift+arrows", effect: "move the picture" },
  { keys: ["0"], label: "0", effect: "fit to view" },
  { keys: ["e"], label: "E", effect: "export the path" },
  { keys: ["?"], label: "?", effect: "show or hide this list" },
  { keys: ["Escape"], label: "Esc", effect: "hide this list" },
];

/** How far Shift+arrow moves the picture, pixels. */
const PAN = 40;

/** The command of a key. `focus` is the tag of the focused element, which handles the keys that it needs itself. */
export function commandOf(event: Key, focus: string): Command | undefined {
  if (event.ctrlKey || event.altKey || event.metaKey || focus === "SELECT") return undefined;
  const isActivatedByKeys = focus === "BUTTON" || focus === "CHECKBOX";
  switch (event.key) {
    case " ":
      return isActivatedByKeys ? undefined : { do: "toggle" };
    case "Enter":
      return isActivatedByKeys ? undefined : { do: "reveal" };
    case "ArrowLeft":
      return event.shiftKey ? { do: "pan", x: PAN, y: 0 } : { do: "step", steps: -1 };
    case "ArrowRight":
      return event.shiftKey ? { do: "pan", x: -PAN, y: 0 } : { do: "step", steps: 1 };
    case "ArrowUp":
      return event.shiftKey ? { do: "pan", x: 0, y: PAN } : { do: "step", steps: 10 };
    case "ArrowDown":
      return event.shiftKey ? { do: "pan", x: 0, y: -PAN } : { do: "step", steps: -10 };
    case "Home":
      return { do: "start" };
    case "End":
      return { do: "end" };
    case "PageUp":
    case "p":
      return { do: "action", direction: -1 };
    case "PageDown":
    case "n":
      return { do: "action", direction: 1 };
    case "+":
    case "=":
      return { do: "zoom", factor: ZOOM_STEP };
    case "-":
    case "−":
      return { do: "zoom", factor: 1 / ZOOM_STEP };
    case "0":
      return { do: "fit" };
    case "e":
      return { do: "export" };
    case "?":
      return { do: "help" };
    case "Escape":
      return { do: "close" };
    default:
      return undefined;
  }
}
