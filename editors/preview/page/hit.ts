// Finds the leg under the pointer.
import type { Leg, Robot } from "./model";
import type { View } from "./view";

export interface Hit {
  robot: Robot;
  leg: Leg;
}

/** Pixels. */
const MAX_DISTANCE = 7;

/** The leg nearest to a point of the picture; of those equally near, a known one before a possible one. Turns win at joints, the only points where they can be hit. */
export function hitTest(robots: readonly Robot[], view: View, px: number, py: number): Hit | undefined {
  let best: Hit | undefined;
  let nearest = MAX_DISTANCE;
  for (const robot of robots) {
    for (const leg of robot.allLegs) {
      const distance = leg.isTurn
        ? Math.hypot(view.toX(leg.from.x) - px, view.toY(leg.from.y) - py) - 2
        : distanceToLine(leg, view, px, py);
      if (distance < nearest) {
        nearest = distance;
        best = { robot, leg };
      }
    }
  }
  return best;
}

function distanceToLine({ line, first, last }: Leg, view: View, px: number, py: number): number {
  let nearest = Infinity;
  for (let index = first; index < last; index += 1) {
    const ax = view.toX(line[2 * index] ?? 0);
    const ay = view.toY(line[2 * index + 1] ?? 0);
    const bx = view.toX(line[2 * index + 2] ?? 0);
    const by = view.toY(line[2 * index + 3] ?? 0);
    nearest = Math.min(nearest, distanceToSegment(px, py, ax, ay, bx, by));
  }
  return nearest;
}

export function distanceToSegment(px: number, py: number, ax: number, ay: number, bx: number, by: number): number {
  const [dx, dy] = [bx - ax, by - ay];
  const squared = dx * dx + dy * dy;
  const share = squared > 0 ? Math.min(Math.max(((px - ax) * dx + (py - ay) * dy) / squared, 0), 1) : 0;
  return Math.hypot(px - ax - share * dx, py - ay - share * dy);
}
