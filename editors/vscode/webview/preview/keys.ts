// What keys do, wherever the focus is.

export type Command =
  | { do: "toggle" | "start" | "end" | "fit" | "reveal" }
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
    default:
      return undefined;
  }
}
