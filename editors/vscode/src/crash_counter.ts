// Decides whether to restart a server after a crash. Does not depend on VS Code.

/** A server that crashes this many times within `WINDOW` is not restarted. */
const MAX_CRASHES = 5;

/** Milliseconds. */
const WINDOW = 3 * 60_000;

/** Counts the recent crashes of a server. */
export class CrashCounter {
  private times: number[] = [];

  /** Records a crash; returns whether to restart the server. */
  add(now: number): boolean {
    this.times = [...this.times.filter((time) => now - time < WINDOW), now];
    return this.times.length < MAX_CRASHES;
  }
}
