// Moves the view over the floor. It follows the path until the user moves it.
import type { Bounds } from "./model";
import type { View } from "./view";

export interface CameraEvents {
  /** The bounds of the path, if there is one. */
  bounds: () => Bounds | undefined;
  /** The user moved the view. */
  moved: () => void;
  draw: () => void;
}

export class Camera {
  private isFollowing = true;
  private isDrawQueued = false;

  constructor(
    private readonly view: View,
    private readonly events: CameraEvents,
  ) {}

  zoom(factor: number, px?: number, py?: number): void {
    this.view.zoom(factor, px, py);
    this.moved();
  }

  pan(dx: number, dy: number): void {
    this.view.pan(dx, dy);
    this.moved();
  }

  /** Fits the view to the path and follows it again. */
  fit(): void {
    this.isFollowing = true;
    this.follow(true);
  }

  /** Fits the view if it follows the path; unless forced, only if the path does not fit well. */
  follow(isForced: boolean): void {
    const bounds = this.isFollowing ? this.events.bounds() : undefined;
    if (bounds && (isForced || !this.view.isGoodFit(bounds))) this.view.fit(bounds);
  }

  private moved(): void {
    this.isFollowing = false;
    this.events.moved();
    // Several events may arrive within one frame.
    if (this.isDrawQueued) return;
    this.isDrawQueued = true;
    requestAnimationFrame(() => {
      this.isDrawQueued = false;
      this.events.draw();
    });
  }
}
