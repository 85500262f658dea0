// The time shown, and how it advances during playback.

/** Simulated seconds per second of playback. */
export const SPEEDS = [0.5, 1, 2, 4, 8, 16, 32, 64, 128];

/** The default speed plays the whole path in at most this time, seconds. */
const MAX_PLAYBACK = 20;

/** With reduced motion, time advances in steps of this many seconds. */
const REDUCED_MOTION_STEP = 0.5;

export class Playback {
  time = 0;
  duration = 0;
  isPlaying = false;
  /** If undefined, the speed depends on the duration. */
  chosenSpeed: number | undefined;
  /** Seconds of playback not shown yet. */
  private elapsed = 0;

  get speed(): number {
    return this.chosenSpeed ?? SPEEDS.find((speed) => speed >= 1 && this.duration / speed <= MAX_PLAYBACK) ?? 128;
  }

  /** Sets the duration of another path and keeps the time if possible. */
  setDuration(duration: number): void {
    this.duration = duration;
    this.seek(this.time);
    if (duration === 0) this.isPlaying = false;
  }

  seek(time: number): void {
    this.time = Math.min(Math.max(time, 0), this.duration);
  }

  /** Plays or pauses; at the end, plays from the start. */
  toggle(): void {
    if (this.duration === 0) return;
    this.isPlaying = !this.isPlaying;
    this.elapsed = 0;
    if (this.isPlaying && this.time >= this.duration) this.time = 0;
  }

  /** Stops and goes back to the start. */
  reset(): void {
    this.isPlaying = false;
    this.time = 0;
  }

  /** Advances the playback by seconds; returns whether the time changed. */
  advance(seconds: number, isMotionReduced: boolean): boolean {
    if (!this.isPlaying) return false;
    // After its window was hidden, the playback must not jump.
    this.elapsed += Math.min(seconds, 0.25);
    if (isMotionReduced && this.elapsed < REDUCED_MOTION_STEP) return false;
    this.seek(this.time + this.elapsed * this.speed);
    this.elapsed = 0;
    if (this.time >= this.duration) this.isPlaying = false;
    return true;
  }

  /** A small step of the slider: about a hundredth of the duration, rounded. */
  get step(): number {
    const hundredth = this.duration / 100;
    return [0.1, 0.2, 0.5, 1, 2, 5, 10].find((step) => step >= hundredth) ?? 30;
  }
}
