// The legend: the robots with their ends, the planned collisions, and the meaning of the lines.
import { element } from "./elements";
import * as format from "./format";
import { deviation, possibleEnds, type Collision, type Driven, type Model, type Robot } from "./model";
import { ROBOT_COLOURS } from "./theme";

export interface LegendEvents {
  hide: (robot: string, isHidden: boolean) => void;
  showRun: (isShown: boolean) => void;
  goTo: (collision: Collision) => void;
}

export interface LegendContent {
  model: Model | undefined;
  /** The latest run, even if it is hidden. */
  driven: Driven | undefined;
  isRunShown: boolean;
  /** Whether that was one of an earlier version of the program, whose planned path was another one. */
  isRunEarlier: boolean;
  hidden: ReadonlySet<string>;
}

export class Legend {
  readonly panel = element("aside", { class: "legend", "aria-label": "Legend", "data-part": "legend" });

  constructor(private readonly events: LegendEvents) {}

  /** Replaces the content; the focus stays on the same entry. */
  show(content: LegendContent): void {
    const { model, driven } = content;
    const focused = document.activeElement?.getAttribute("data-key");
    this.panel.hidden = model === undefined;
    if (!model) return;
    const robots = model.robots.map((robot) => this.entry(robot, content));
    const parts: HTMLElement[] = [element("ul", { class: "robots", "aria-label": "Robots" }, ...robots)];
    // A run that failed at once has nothing to show.
    if (driven && hasPath(driven)) parts.push(this.run(content));
    if (model.collisions.length > 0) parts.push(this.collisions(model.collisions));
    parts.push(key(content));
    this.panel.replaceChildren(...parts);
    if (focused) this.panel.querySelector<HTMLElement>(`[data-key="${CSS.escape(focused)}"]`)?.focus();
  }

  private entry(robot: Robot, { driven, isRunShown, isRunEarlier, hidden }: LegendContent): HTMLElement {
    const check = element("input", { type: "checkbox", "data-key": `robot ${robot.name}`, "data-robot": robot.name });
    check.checked = !hidden.has(robot.name);
    check.addEventListener("change", () => this.events.hide(robot.name, !check.checked));
    const swatch = element("span", { class: `swatch robot-${robot.colour % ROBOT_COLOURS}`, "aria-hidden": "true" });
    const name = element("span", { class: "name", title: robot.name }, robot.name);
    const drivenEnd = isRunShown ? driven?.robots.get(robot.name)?.end : undefined;
    const lines = [robot.unknownAfter ? `planned up to “${robot.unknownAfter.text}”; the rest is unknown until it runs` : `→ ${format.pose(robot.end)}`];
    if (drivenEnd && (robot.unknownAfter || isRunEarlier)) lines.push(`driven → ${format.pose(drivenEnd)}`);
    else if (drivenEnd) {
      const { distance, angle } = deviation(robot.end, drivenEnd);
      lines.push(`driven path ends ${format.smallDistance(distance)}, ${format.fixed((angle * 180) / Math.PI, 1)}° off`);
    }
    const notes = lines.map((line) => element("small", {}, line));
    return element("li", {}, element("label", {}, check, swatch, name), ...notes);
  }

  private run({ isRunShown, isRunEarlier }: LegendContent): HTMLElement {
    const check = element("input", { type: "checkbox", "data-key": "run", "data-part": "show-run" });
    check.checked = isRunShown;
    check.addEventListener("change", () => this.events.showRun(check.checked));
    return element("label", { class: "run" }, check, isRunEarlier ? "Latest run, before the program changed" : "Latest run");
  }

  private collisions(collisions: readonly Collision[]): HTMLElement {
    const items = collisions.map((collision, index) => {
      const when = collision.t === null ? "" : ` after ${format.duration(collision.t)}`;
      const sentence = `${collision.robot.name} runs into ${collision.other}${when}`;
      const link = element("button", { type: "button", class: "collision-link", "data-key": `collision ${index}`, "data-collision": `${index}` });
      link.append(sample("collision"), element("span", {}, sentence));
      link.addEventListener("click", () => this.events.goTo(collision));
      return element("li", {}, link);
    });
    return element("ul", { class: "collisions", "aria-label": "Collisions" }, ...items);
  }
}

function hasPath(driven: Driven): boolean {
  return [...driven.robots.values()].some(({ line, nodes }) => line.length > 1 || nodes.length > 0);
}

/** Samples of the lines and shapes in the picture. */
function key({ model, driven, isRunShown }: LegendContent): HTMLElement {
  const samples = [["planned", "planned path"]];
  if (model?.robots.some((robot) => possibleEnds(robot).length > 0)) samples.push(["possible", "possible, sensors decide"]);
  if (driven && isRunShown && hasPath(driven)) samples.push(["driven", "driven path"]);
  samples.push(["start", "start"]);
  if (model?.robots.some(({ legs }) => legs.length > 0)) samples.push(["end", "planned end"]);
  if (driven && isRunShown && [...driven.robots.values()].some(({ nodes }) => nodes.length > 0)) samples.push(["map", "map"]);
  if (model && model.obstacles.length > 0) samples.push(["obstacle", "obstacle"]);
  if (model?.obstacles.some(({ motion }) => motion)) samples.push(["obstacle-path", "path of an obstacle"]);
  if (model && model.collisions.length > 0) samples.push(["collision", "collision"]);
  const items = samples.map(([kind = "", meaning = ""]) =>
    element("li", {}, sample(kind), meaning),
  );
  return element("ul", { class: "key", "aria-label": "Key" }, ...items);
}

function sample(kind: string): HTMLElement {
  return element("span", { class: `sample ${kind}`, "aria-hidden": "true" });
}
