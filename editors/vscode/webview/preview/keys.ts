// What keys do, wherever the focus is.

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

/** What the keys do, in words; each by the name that the browser has for it. */
export const KEYS: readonly { keys: readonly string[]; shift?: true; shown: string; does: string }[] = [
  { keys: [" "], shown: "Space", does: "play or pause" },
  { keys: ["ArrowLeft", "ArrowRight"], shown: "← →", does: "step through time" },
  { keys: ["ArrowUp", "ArrowDown"], shown: "↑ ↓", does: "ten steps" },
  { keys: ["Home", "End"], shown: "Home End", does: "go to the start or the end" },
  { keys: ["n", "p", "PageDown", "PageUp"], shown: "N P", does: "next or previous action" },
  { keys: ["Enter"], shown: "Enter", does: "show the action in the program" },
  { keys: ["+", "=", "-", "−"], shown: "+ −", does: "zoom" },
  { keys: ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"], shift: true, shown: "Shift+arrows", does: "move the picture" },
  { keys: ["0"], shown: "0", does: "fit to view" },
  { keys: ["e"], shown: "E", does: "export as SVG, PNG or replay" },
  { keys: ["?"], shown: "?", does: "show or hide this list" },
  { keys: ["Escape"], shown: "Esc", does: "hide this list" },
];

/** So far arrows with Shift move the floor, pixels. */
const PAN = 40;

/** What a key means; `focus` is the tag of what has the focus, which keeps the keys that it needs itself. */
export function commandOf(event: Key, focus: string): Command | undefined {
  if (event.ctrlKey || event.altKey || event.metaKey || focus === "SELECT") return undefined;
  const isPressed = focus === "BUTTON" || focus === "CHECKBOX";
  switch (event.key) {
    case " ":
      return isPressed ? undefined : { do: "toggle" };
    case "Enter":
      return isPressed ? undefined : { do: "reveal" };
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
      return { do: "zoom", factor: 1.4 };
    case "-":
    case "−":
      return { do: "zoom", factor: 1 / 1.4 };
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
