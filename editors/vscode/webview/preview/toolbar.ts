// What is above the picture: which environment it is, how much of the floor is seen, and what is wrong.
import type { Remedy } from "../../src/preview/messages";
import { element, icon, ICONS } from "./elements";

export interface ToolbarEvents {
  choose: (environment: string) => void;
  zoom: (factor: number) => void;
  fit: () => void;
  exportFile: () => void;
  help: () => void;
  remedy: (remedy: Remedy) => void;
}

export class Toolbar {
  readonly bar: HTMLElement;
  readonly banner: HTMLElement;
  private readonly title = element("h1", { "data-part": "environment" });
  private readonly scale = element("span", { class: "scale", "aria-hidden": "true", "data-part": "scale" });
  private readonly picker = element("select", { "aria-label": "Environment", "data-part": "picker" });

  constructor(private readonly events: ToolbarEvents) {
    this.picker.addEventListener("change", () => events.choose(this.picker.value));
    this.bar = element(
      "header",
      { class: "toolbar" },
      this.title,
      this.picker,
      element("span", { class: "space" }),
      this.scale,
      button("Zoom out (−)", ICONS.minus, "zoom-out", () => events.zoom(1 / 1.4)),
      button("Zoom in (+)", ICONS.plus, "zoom-in", () => events.zoom(1.4)),
      button("Fit to view (0)", ICONS.fit, "fit", events.fit),
      button("Export as SVG, PNG or replay (E)", ICONS.export, "export", events.exportFile),
      button("Keys (?)", ICONS.help, "keys", events.help),
    );
    this.banner = element("p", { class: "banner", role: "status", "data-part": "banner" });
    this.banner.hidden = true;
    this.picker.hidden = true;
  }

  /** One environment is a title; among several one may choose. */
  setEnvironments(names: readonly string[], shown: string | null): void {
    const isChoice = names.length > 1;
    this.picker.hidden = !isChoice;
    this.title.hidden = isChoice;
    this.title.textContent = shown ?? names[0] ?? "Path preview";
    this.picker.replaceChildren(...names.map((name) => element("option", { value: name }, name)));
    if (shown !== null) this.picker.value = shown;
  }

  private remedyFor(remedy: Remedy): HTMLElement {
    const made = element("button", { type: "button", class: "remedy", "data-part": "remedy" }, REMEDIES[remedy]);
    made.addEventListener("click", () => this.events.remedy(remedy));
    return made;
  }

  /** How long a length of the floor is in the picture, pixels. */
  setScale(pixels: number, length: string): void {
    this.scale.style.setProperty("--long", `${pixels}px`);
    this.scale.textContent = length;
  }

  /** What is wrong, in a sentence; undefined where nothing is. */
  setTrouble(sentence: string | undefined, hasPicture: boolean, remedy?: Remedy): void {
    this.banner.hidden = sentence === undefined;
    if (sentence === undefined) return;
    const words = hasPicture ? `${ended(sentence)} Showing the last valid path.` : ended(sentence);
    // What stands in backquotes is out of the program.
    const parts = words.split("`").map((part, index) => (index % 2 === 1 ? element("code", {}, part) : part));
    this.banner.replaceChildren(...parts);
    if (remedy) this.banner.append(" ", this.remedyFor(remedy));
  }
}

/** What a button that helps is called. */
const REMEDIES: Record<Remedy, string> = { addEnvironment: "Add Environment" };

export function button(label: string, shape: string, part: string, pressed: () => void): HTMLButtonElement {
  const made = element("button", { type: "button", class: "icon", title: label, "aria-label": label, "data-part": part }, icon(shape));
  made.addEventListener("click", pressed);
  return made;
}

function ended(sentence: string): string {
  return /[.!?]$/.test(sentence) ? sentence : `${sentence}.`;
}
