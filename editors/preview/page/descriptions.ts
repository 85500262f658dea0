// Paths and actions in words, for the tooltip and for screen readers.
import * as format from "./format";
import type { Hit } from "./hit";
import type { Model } from "./model";

/** An action in short sentences; the first is its text. */
export function describeAction({ robot, leg }: Hit): string[] {
  const { action, start, duration } = leg;
  const when = start === null ? "start time unknown" : `from ${format.duration(start)} to ${format.duration(start + duration)}`;
  return [
    action.text,
    `${robot.name} · ${action.movement}, action ${action.index + 1}`,
    `takes ${format.duration(duration)}, ${when}`,
    `ends at ${format.pose(leg.to)}`,
  ];
}

export function describePath({ environment, robots, collisions, duration, isComplete }: Model): string {
  const parts = [count(robots.length, "robot"), isComplete ? format.duration(duration) : "of unknown duration"];
  if (collisions.length > 0) parts.push(count(collisions.length, "collision"));
  return `Planned path of ${environment}: ${parts.join(", ")}. Press ? for the keys.`;
}

function count(number: number, noun: string): string {
  return `${number} ${noun}${number === 1 ? "" : "s"}`;
}
