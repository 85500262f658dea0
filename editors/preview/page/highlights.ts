// The legs that stand out: at the cursor of the editor, selected by keys, and under the pointer.
import type { NumberedAction } from "../host/protocol";
import type { Hit } from "./hit";
import { isLegOf, type Robot } from "./model";

export class Highlights {
  /** Under the pointer. */
  hovered: Hit | undefined;
  /** Selected by keys. */
  selected: Hit | undefined;
  private cursor: NumberedAction | null = null;
  /** The legs of the action at the cursor, found once per path rather than once per frame. */
  private atCursor: Hit[] = [];

  /** Drops the legs of the last path. */
  clear(): void {
    this.hovered = undefined;
    this.selected = undefined;
  }

  setCursor(action: NumberedAction | null, robots: readonly Robot[]): void {
    this.cursor = action;
    this.selected = undefined;
    this.findCursor(robots);
  }

  /** Call this when other robots are visible. */
  findCursor(robots: readonly Robot[]): void {
    this.atCursor = hitsOf(robots).filter(({ leg }) => isLegOf(leg, this.cursor));
  }

  /** Selects the next or the previous leg; the first time, from the action at the cursor. */
  select(direction: 1 | -1, robots: readonly Robot[]): Hit | undefined {
    const hits = hitsOf(robots);
    const current = hits.findIndex(({ leg }) => (this.selected ? leg === this.selected.leg : isLegOf(leg, this.cursor)));
    const next = current < 0 ? (direction > 0 ? 0 : hits.length - 1) : (current + direction + hits.length) % hits.length;
    this.selected = hits[next] ?? this.selected;
    return hits[next];
  }

  get all(): Hit[] {
    return [...(this.selected ? [] : this.atCursor), this.selected, this.hovered].filter((hit) => hit !== undefined);
  }
}

function hitsOf(robots: readonly Robot[]): Hit[] {
  return robots.flatMap((robot) => robot.legs.map((leg) => ({ robot, leg })));
}
