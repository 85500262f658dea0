// What an action does, beside the pointer.
import { element } from "./elements";
import type { Hit } from "./hit";
import * as format from "./format";

/** An action in sentences; the first is the action itself. */
export function describe({ robot, leg }: Hit): string[] {
  const { action, start, duration } = leg;
  const when = start === null ? "when is not known" : `from ${format.time(start)} to ${format.time(start + duration)}`;
  return [
    action.text,
    `${robot.name} · ${action.movement}, action ${action.index + 1}`,
    `takes ${format.time(duration)}, ${when}`,
    `ends at ${format.pose(leg.to)}`,
  ];
}

export class Tooltip {
  readonly box = element("div", { class: "tooltip", role: "tooltip", "data-part": "tooltip" });

  constructor() {
    this.box.hidden = true;
  }

  /** Beside a place of the picture, on the side where there is room. */
  show(hit: Hit, px: number, py: number, width: number, height: number): void {
    const [action = "", ...facts] = describe(hit);
    this.box.replaceChildren(element("code", {}, action), ...facts.map((fact) => element("div", {}, fact)));
    this.box.hidden = false;
    const { offsetWidth, offsetHeight } = this.box;
    const left = px + 14 + offsetWidth > width ? px - 14 - offsetWidth : px + 14;
    const top = py + 14 + offsetHeight > height ? py - 14 - offsetHeight : py + 14;
    this.box.style.left = `${Math.max(left, 4)}px`;
    this.box.style.top = `${Math.max(top, 4)}px`;
  }

  hide(): void {
    this.box.hidden = true;
  }
}
