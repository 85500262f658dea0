// The legs that stand out: at the cursor of the editor, selected by keys or a click, and under the pointer.
import type { ActionAt } from "../host/protocol";
import type { Hit } from "./hit";
import { isLegOf, isStatementOf, type Robot } from "./model";

export class Highlights {
  /** Under the pointer. */
  hovered: Hit | undefined;
  /** Selected by keys or a click. */
  selected: Hit | undefined;
  private cursor: ActionAt | null = null;
  /** The legs of the statement at the cursor and of those in its blocks, found once per path rather than once per frame. */
  private atCursor: Hit[] = [];

  /** Drops the legs of the last path. */
  clear(): void {
    this.hovered = undefined;
    this.selected = undefined;
  }

  /** The selected leg stays selected while the cursor is at its statement, where a click leads: it is one of several rounds. */
  setCursor(action: ActionAt | null, robots: readonly Robot[]): void {
    this.cursor = action;
    if (this.selected && !isStatementOf(this.selected.leg, action)) this.selected = undefined;
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
  return robots.flatMap((robot) => robot.allLegs.map((leg) => ({ robot, leg })));
}
