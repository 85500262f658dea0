// What the lines mean, who may be hidden, where each robot ends, and what it would run into.
import { element } from "./elements";
import { deviation, type Crash, type Driven, type Model, type Robot } from "./model";
import { ROBOT_COLOURS } from "./theme";
import * as format from "./format";

export interface LegendEvents {
  hide: (robot: string, isHidden: boolean) => void;
  showRun: (isShown: boolean) => void;
  goTo: (crash: Crash) => void;
}

export interface LegendContent {
  model: Model | undefined;
  /** The latest run, also where it is not shown. */
  driven: Driven | undefined;
  isRunShown: boolean;
  hidden: ReadonlySet<string>;
}

export class Legend {
  readonly panel = element("aside", { class: "legend", "aria-label": "Legend", "data-part": "legend" });

  constructor(private readonly events: LegendEvents) {}

  /** Makes it anew; the focus stays on what is still there. */
  show(content: LegendContent): void {
    const { model, driven } = content;
    const focused = document.activeElement?.getAttribute("data-key");
    this.panel.hidden = model === undefined;
    if (!model) return;
    const robots = model.robots.map((robot) => this.entry(robot, content));
    const parts: HTMLElement[] = [element("ul", { class: "robots", "aria-label": "Robots" }, ...robots)];
    if (driven) parts.push(this.run(content.isRunShown));
    if (model.crashes.length > 0) parts.push(this.crashes(model.crashes));
    parts.push(key(content));
    this.panel.replaceChildren(...parts);
    if (focused) this.panel.querySelector<HTMLElement>(`[data-key="${CSS.escape(focused)}"]`)?.focus();
  }

  private entry(robot: Robot, { driven, isRunShown, hidden }: LegendContent): HTMLElement {
    const check = element("input", { type: "checkbox", "data-key": `robot ${robot.name}`, "data-robot": robot.name });
    check.checked = !hidden.has(robot.name);
    check.addEventListener("change", () => this.events.hide(robot.name, !check.checked));
    const swatch = element("span", { class: `swatch robot-${robot.colour % ROBOT_COLOURS}`, "aria-hidden": "true" });
    const name = element("span", { class: "name", title: robot.name }, robot.name);
    const found = isRunShown ? driven?.robots.get(robot.name)?.end : undefined;
    const lines = [robot.unknownAfter ? `planned up to “${robot.unknownAfter.text}”; the rest depends on the world` : `→ ${format.pose(robot.end)}`];
    if (found && robot.unknownAfter) lines.push(`driven → ${format.pose(found)}`);
    else if (found) {
      const { distance, angle } = deviation(robot.end, found);
      lines.push(`driven path ends ${format.small(distance)}, ${format.fixed((angle * 180) / Math.PI, 1)}° off`);
    }
    const notes = lines.map((line) => element("small", {}, line));
    return element("li", {}, element("label", {}, check, swatch, name), ...notes);
  }

  private run(isShown: boolean): HTMLElement {
    const check = element("input", { type: "checkbox", "data-key": "run", "data-part": "show-run" });
    check.checked = isShown;
    check.addEventListener("change", () => this.events.showRun(check.checked));
    return element("label", { class: "run" }, check, "Latest run");
  }

  private crashes(crashes: readonly Crash[]): HTMLElement {
    const items = crashes.map((crash, index) => {
      const when = crash.t === null ? "" : ` after ${format.time(crash.t)}`;
      const sentence = `${crash.robot.name} would run into ${crash.other}${when}`;
      const go = element("button", { type: "button", class: "crash", "data-key": `crash ${index}`, "data-collision": `${index}` });
      go.append(sample("collision"), element("span", {}, sentence));
      go.addEventListener("click", () => this.events.goTo(crash));
      return element("li", {}, go);
    });
    return element("ul", { class: "crashes", "aria-label": "Collisions" }, ...items);
  }
}

/** Samples of what is in the picture. */
function key({ model, driven, isRunShown }: LegendContent): HTMLElement {
  const samples = [["planned", "planned path"]];
  if (driven && isRunShown) samples.push(["driven", "driven path"]);
  samples.push(["start", "start"]);
  if (model?.robots.some(({ legs }) => legs.length > 0)) samples.push(["end", "planned end"]);
  if (driven && isRunShown && [...driven.robots.values()].some(({ nodes }) => nodes.length > 0)) samples.push(["map", "map"]);
  if (model && model.outlines.length > 0) samples.push(["obstacle", "obstacle"]);
  if (model && model.crashes.length > 0) samples.push(["collision", "collision"]);
  const items = samples.map(([kind = "", meaning = ""]) =>
    element("li", {}, sample(kind), meaning),
  );
  return element("ul", { class: "key", "aria-label": "Key" }, ...items);
}

function sample(kind: string): HTMLElement {
  return element("span", { class: `sample ${kind}`, "aria-hidden": "true" });
}
