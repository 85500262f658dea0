// Paths and actions in words, for the tooltip and for screen readers.
import type { PlannedAction } from "../host/protocol";
import * as format from "./format";
import type { Hit } from "./hit";
import type { Model } from "./model";

/** An action in short sentences; the first is its text. */
export function describeAction({ robot, leg }: Hit): string[] {
  const { action, start, duration } = leg;
  const facts = [action.text, `${robot.name} · ${describePlace(action)}`];
  if (leg.isPossible) {
    return [...facts, `possible, sensors decide: takes up to ${format.duration(duration)}`, `may end at ${format.pose(leg.to)}`];
  }
  const when = start === null ? "start time unknown" : `from ${format.duration(start)} to ${format.duration(start + duration)}`;
  return [...facts, `takes ${format.duration(duration)}, ${when}`, `ends at ${format.pose(leg.to)}`];
}

/** Where an action is: its movement and number, the rounds of the loops around it, and the movements that lead to it. */
export function describePlace(action: PlannedAction): string {
  const { movement, index, calls = [], done = movement } = action;
  const rounds = describeRounds(action);
  const parts = [done, `action ${index + 1}${rounds === "" ? "" : ` in ${rounds}`}`];
  if (calls.length > 0) parts.push(`done by ${calls.map((call) => call.movement).join(" › ")}`);
  return parts.join(", ");
}

/** The rounds of the loops around an action, the outermost first; empty if there are none. */
export function describeRounds({ rounds = [], counts = [] }: PlannedAction): string {
  const [round, ...inner] = rounds;
  if (round === undefined) return "";
  if (inner.length > 0) return `rounds ${rounds.join(", ")}`;
  const [count] = counts;
  return `round ${round}${count === undefined ? "" : ` of ${count}`}`;
}

export function describePath({ environment, robots, collisions, duration, isComplete }: Model): string {
  const parts = [count(robots.length, "robot"), isComplete ? format.duration(duration) : "of unknown duration"];
  if (collisions.length > 0) parts.push(count(collisions.length, "collision"));
  return `Planned path of ${environment}: ${parts.join(", ")}. Press ? for the keys.`;
}

function count(number: number, noun: string): string {
  return `${number} ${noun}${number === 1 ? "" : "s"}`;
}
