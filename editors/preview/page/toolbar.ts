// The bar above the picture: the environment, the scale and buttons; and the banner that shows problems.
import type { Suggestion } from "../host/messages";
import { withFullStop } from "../host/sentence";
import { element, icon, ICONS } from "./elements";
import { ZOOM_STEP } from "./view";

export interface ToolbarEvents {
  select: (environment: string) => void;
  zoom: (factor: number) => void;
  fit: () => void;
  export: () => void;
  help: () => void;
  accept: (suggestion: Suggestion) => void;
}

const SUGGESTION_LABELS: Record<Suggestion, string> = { addEnvironment: "Add Environment" };

export class Toolbar {
  readonly bar: HTMLElement;
  readonly banner: HTMLElement;
  private readonly title = element("h1", { "data-part": "environment" });
  private readonly scale = element("span", { class: "scale", "aria-hidden": "true", "data-part": "scale" });
  private readonly picker = element("select", { "aria-label": "Environment", "data-part": "picker" });

  constructor(private readonly events: ToolbarEvents) {
    this.picker.addEventListener("change", () => events.select(this.picker.value));
    this.bar = element(
      "header",
      { class: "toolbar" },
      this.title,
      this.picker,
      element("span", { class: "space" }),
      this.scale,
      button("Zoom out (−)", ICONS.minus, "zoom-out", () => events.zoom(1 / ZOOM_STEP)),
      button("Zoom in (+)", ICONS.plus, "zoom-in", () => events.zoom(ZOOM_STEP)),
      button("Fit to view (0)", ICONS.fit, "fit", events.fit),
      button("Export the path (E)", ICONS.export, "export", events.export),
      button("Keys (?)", ICONS.help, "keys", events.help),
    );
    this.banner = element("p", { class: "banner", role: "status", "data-part": "banner" });
    this.banner.hidden = true;
    this.picker.hidden = true;
  }

  /** Shows one environment as a title, several as a picker. */
  setEnvironments(names: readonly string[], shown: string | null): void {
    const isChoice = names.length > 1;
    this.picker.hidden = !isChoice;
    this.title.hidden = isChoice;
    this.title.textContent = shown ?? names[0] ?? "Path preview";
    this.picker.replaceChildren(...names.map((name) => element("option", { value: name }, name)));
    if (shown !== null) this.picker.value = shown;
  }

  /** Shows how long a length of the floor is in the picture. */
  setScale(pixels: number, length: string): void {
    this.scale.style.setProperty("--length", `${pixels}px`);
    this.scale.textContent = length;
  }

  showProblem(message: string, hasPath: boolean, suggestion?: Suggestion): void {
    const text = hasPath ? `${withFullStop(message)} Showing the last valid path.` : withFullStop(message);
    // Backquotes mark code.
    const parts = text.split("`").map((part, index) => (index % 2 === 1 ? element("code", {}, part) : part));
    this.banner.replaceChildren(...parts);
    if (suggestion) this.banner.append(" ", this.suggestionButton(suggestion));
    this.banner.hidden = false;
  }

  hideProblem(): void {
    this.banner.hidden = true;
  }

  private suggestionButton(suggestion: Suggestion): HTMLElement {
    const created = element("button", { type: "button", class: "suggestion", "data-part": "suggestion" }, SUGGESTION_LABELS[suggestion]);
    created.addEventListener("click", () => this.events.accept(suggestion));
    return created;
  }
}

export function button(label: string, shape: string, part: string, pressed: () => void): HTMLButtonElement {
  const created = element("button", { type: "button", class: "icon", title: label, "aria-label": label, "data-part": part }, icon(shape));
  created.addEventListener("click", pressed);
  return created;
}
