// Whether what is known of the latest run belongs to the program as it is now.
import type { Result, ToPage } from "./messages";
import type { PlannedPath } from "./protocol";

/** What is planned, or the problem because of which nothing is; undefined where that is not known. */
type Plan = PlannedPath | string | undefined;

export class LatestRun {
  /** The key of the shown environment. */
  private shown: string | undefined;
  private plan: Plan;
  /** The path in the picture, which stays when there is a problem. */
  private path: PlannedPath | undefined;
  /** What was planned when the run began whose path is shown. */
  private drivenPlan: Plan;
  /** What was planned when the latest run began. */
  private planAtStart: Plan;
  private ended: { key: string; result: Result; plan: Plan } | undefined;

  /** A message to the page of the environment with this key. */
  follow(message: ToPage, shown: string | undefined): void {
    if (shown !== this.shown) {
      this.shown = shown;
      this.plan = this.path = this.drivenPlan = undefined;
    }
    if (message.type === "path") this.plan = this.path = message.path;
    else if (message.type === "problem") this.plan = message.message;
    else if (message.type === "driven") this.drivenPlan = message.driven?.planned ?? undefined;
  }

  /** A run has begun. */
  begin(key: string): void {
    this.ended = undefined;
    this.planAtStart = key === this.shown ? this.plan : undefined;
  }

  /** The run has ended. */
  end(key: string, result: Result): void {
    const known = [this.planAtStart, result.isError ? undefined : this.drivenPlan, this.plan];
    this.ended = { key, result, plan: known.find((plan) => plan !== undefined) };
  }

  /** How the latest run ended, if it was one of the shown environment. That errors prevented it is said as long as they are there. */
  get result(): Result | null {
    if (!this.ended || this.ended.key !== this.shown) return null;
    const { plan, result } = this.ended;
    const isEarlier = isOther(plan, this.plan);
    return isEarlier && typeof plan === "string" ? null : { ...result, isEarlier };
  }

  /** Whether the driven path is one of another plan than that in the picture. */
  get isDrivenEarlier(): boolean {
    return isOther(this.drivenPlan, this.path);
  }

  /** Whether the program has changed since the run whose path is shown; a program with a problem has. */
  get hasChanged(): boolean {
    return isOther(this.drivenPlan, this.plan);
  }
}

function isOther(before: Plan, now: Plan): boolean {
  return before !== undefined && now !== undefined && !isEqual(before, now);
}

/** Whether two values of JSON are equal. */
function isEqual(one: unknown, other: unknown): boolean {
  if (typeof one !== "object" || typeof other !== "object" || one === null || other === null) return one === other;
  const [entries, others] = [Object.entries(one), new Map(Object.entries(other))];
  return entries.length === others.size && entries.every(([key, value]) => others.has(key) && isEqual(value, others.get(key)));
}
