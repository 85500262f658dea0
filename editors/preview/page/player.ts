// Advances the playback with the frames of the browser.
import { Playback } from "./playback";

export class Player {
  readonly playback = new Playback();
  private readonly reducedMotion = window.matchMedia("(prefers-reduced-motion: reduce)");
  private lastFrame: number | undefined;

  constructor(private readonly timeChanged: () => void) {}

  toggle(): void {
    this.playback.toggle();
    this.timeChanged();
    this.lastFrame = undefined;
    if (this.playback.isPlaying) requestAnimationFrame((now) => this.frame(now));
  }

  private frame(now: number): void {
    const seconds = this.lastFrame === undefined ? 0 : (now - this.lastFrame) / 1000;
    this.lastFrame = now;
    if (this.playback.advance(seconds, this.reducedMotion.matches)) this.timeChanged();
    if (this.playback.isPlaying) requestAnimationFrame((next) => this.frame(next));
  }
}
