// Time that goes by: from pressing play to the end.

/** Seconds of the run per second of watching. */
export const SPEEDS = [0.5, 1, 2, 4, 8, 16, 32, 64, 128];

/** So long may a run take to watch unless somebody chose a speed, seconds. */
const PATIENCE = 20;

/** With reduced motion time goes by in steps, seconds. */
const CALM_STEP = 0.5;

export class Playback {
  time = 0;
  duration = 0;
  isPlaying = false;
  /** What somebody chose; else it follows the duration. */
  chosenSpeed: number | undefined;
  /** Watching time that has not been shown yet. */
  private waiting = 0;

  get speed(): number {
    return this.chosenSpeed ?? SPEEDS.find((speed) => speed >= 1 && this.duration / speed <= PATIENCE) ?? 128;
  }

  /** The path is another one; the time stays where it still is one. */
  setDuration(duration: number): void {
    this.duration = duration;
    this.seek(this.time);
    if (duration === 0) this.isPlaying = false;
  }

  seek(time: number): void {
    this.time = Math.min(Math.max(time, 0), this.duration);
  }

  /** Plays or pauses; at the end it begins anew. */
  toggle(): void {
    if (this.duration === 0) return;
    this.isPlaying = !this.isPlaying;
    this.waiting = 0;
    if (this.isPlaying && this.time >= this.duration) this.time = 0;
  }

  /** What was played is no more: the next begins at its start. */
  end(): void {
    this.isPlaying = false;
    this.time = 0;
  }

  /** Some seconds of watching went by; says whether the time is another one now. */
  advance(seconds: number, isCalm: boolean): boolean {
    if (!this.isPlaying) return false;
    // A window that was hidden for a while must not jump.
    this.waiting += Math.min(seconds, 0.25);
    if (isCalm && this.waiting < CALM_STEP) return false;
    this.seek(this.time + this.waiting * this.speed);
    this.waiting = 0;
    if (this.time >= this.duration) this.isPlaying = false;
    return true;
  }

  /** A small step of the slider: what a hundredth of the way is, in round numbers. */
  get step(): number {
    const hundredth = this.duration / 100;
    return [0.1, 0.2, 0.5, 1, 2, 5, 10].find((step) => step >= hundredth) ?? 30;
  }
}
