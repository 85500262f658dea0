// The bar above the picture: the environment, the scale and buttons; and the banner that shows problems.
import type { Result, Suggestion, ToPage } from "../host/messages";
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
  /** The place of the problem, its fix, a run, a button of the result of a run. */
  place: () => void;
  fix: () => void;
  run: () => void;
  press: (button: number) => void;
}

const SUGGESTION_LABELS: Record<Suggestion, string> = { addEnvironment: "Add Environment" };

export class Toolbar {
  readonly bar: HTMLElement;
  readonly banner: HTMLElement;
  /** What the latest run said; beside the picture, which it must not cover. */
  readonly result = element("p", { class: "result", role: "status", "data-part": "result" });
  private readonly run: HTMLElement;
  private readonly title = element("h1", { "data-part": "environment" });
  private readonly scale = element("span", { class: "scale", "aria-hidden": "true", "data-part": "scale" });
  private readonly picker = element("select", { "aria-label": "Environment", "data-part": "picker" });

  constructor(private readonly events: ToolbarEvents) {
    this.picker.addEventListener("change", () => events.select(this.picker.value));
    this.run = button("Run in the simulator", ICONS.play, "run", events.run);
    this.run.hidden = true;
    this.result.hidden = true;
    this.bar = element(
      "header",
      { class: "toolbar" },
      this.title,
      this.picker,
      this.run,
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
  setEnvironments(names: readonly string[], shown: string | null, canRun = false): void {
    this.run.hidden = !canRun || shown === null;
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

  showProblem({ message, suggestion, place, fix }: Extract<ToPage, { type: "problem" }>, hasPath: boolean): void {
    this.banner.replaceChildren(...withCode(withFullStop(message)));
    if (place !== undefined) this.banner.append(" ", textButton(place, "place", this.events.place, "link"));
    if (hasPath) this.banner.append(place === undefined ? " " : " — ", "Showing the last valid path.");
    if (suggestion) this.banner.append(" ", textButton(SUGGESTION_LABELS[suggestion], "suggestion", () => this.events.accept(suggestion)));
    if (fix !== undefined) this.banner.append(" ", textButton(fix, "fix", this.events.fix));
    this.banner.hidden = false;
  }

  showResult(result: Result | null): void {
    this.result.hidden = result === null;
    if (!result) return;
    this.result.classList.toggle("error", result.isError);
    this.result.classList.toggle("earlier", result.isEarlier === true);
    const buttons = result.buttons.flatMap((label, index) => [" ", textButton(label, `result-${index}`, () => this.events.press(index), "link")]);
    const since = result.isEarlier ? [" ", element("strong", {}, "The program has changed since.")] : [];
    this.result.replaceChildren(...withCode(withFullStop(result.message)), ...since, ...buttons);
  }

  hideProblem(): void {
    this.banner.hidden = true;
  }
}

/** A text whose backquotes mark code. */
function withCode(text: string): (HTMLElement | string)[] {
  return text.split("`").map((part, index) => (index % 2 === 1 ? element("code", {}, part) : part));
}

function textButton(label: string, part: string, pressed: () => void, kind = "suggestion"): HTMLElement {
  const created = element("button", { type: "button", class: kind, "data-part": part }, ...withCode(label));
  created.addEventListener("click", pressed);
  return created;
}

export function button(label: string, shape: string, part: string, pressed: () => void): HTMLButtonElement {
  const created = element("button", { type: "button", class: "icon", title: label, "aria-label": label, "data-part": part }, icon(shape));
  created.addEventListener("click", pressed);
  return created;
}
