// The description of an action, next to the pointer.
import { describeAction } from "./descriptions";
import { element } from "./elements";
import type { Hit } from "./hit";

/** Pixels between the tooltip and its point. */
const GAP = 14;

export class Tooltip {
  readonly box = element("div", { class: "tooltip", role: "tooltip", "data-part": "tooltip" });

  constructor() {
    this.box.hidden = true;
  }

  /** Shows the tooltip next to a point of a picture of this size, on the side that has room. */
  show(hit: Hit, px: number, py: number, { width, height }: { width: number; height: number }): void {
    const [action = "", ...facts] = describeAction(hit);
    this.box.replaceChildren(element("code", {}, action), ...facts.map((fact) => element("div", {}, fact)));
    this.box.hidden = false;
    const { offsetWidth, offsetHeight } = this.box;
    const left = px + GAP + offsetWidth > width ? px - GAP - offsetWidth : px + GAP;
    const top = py + GAP + offsetHeight > height ? py - GAP - offsetHeight : py + GAP;
    this.box.style.left = `${Math.max(left, 4)}px`;
    this.box.style.top = `${Math.max(top, 4)}px`;
  }

  hide(): void {
    this.box.hidden = true;
  }
}
