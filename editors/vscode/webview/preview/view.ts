// The part of the floor that is shown, and where: metres to pixels and back.
import type { Bounds } from "./model";

/** Pixels per metre, at the least and at the most. */
const SCALES = { least: 0.5, most: 20_000 };

/** Room about what is fitted in, pixels. */
const MARGIN = 34;

/** Least distance between grid lines, pixels: a label fits between two. */
const SPACING = 52;

export class View {
  /** Pixels per metre. */
  scale = 100;
  /** The point of the floor in the middle. */
  x = 0;
  y = 0;
  width = 1;
  height = 1;

  /** Where a point of the floor is in the picture. */
  toX(x: number): number {
    return this.width / 2 + (x - this.x) * this.scale;
  }

  toY(y: number): number {
    return this.height / 2 - (y - this.y) * this.scale;
  }

  /** Which point of the floor is at a place of the picture. */
  fromX(px: number): number {
    return this.x + (px - this.width / 2) / this.scale;
  }

  fromY(py: number): number {
    return this.y - (py - this.height / 2) / this.scale;
  }

  /** Shows a rectangle as large as it goes. */
  fit({ left, bottom, right, top }: Bounds): void {
    const wide = Math.max(this.width - 2 * MARGIN, 40) / Math.max(right - left, 0.2);
    const high = Math.max(this.height - 2 * MARGIN, 40) / Math.max(top - bottom, 0.2);
    this.scale = clamp(Math.min(wide, high));
    this.x = (left + right) / 2;
    this.y = (bottom + top) / 2;
  }

  /** Whether a rectangle can be seen whole and not much too small: then nothing need jump while somebody types. */
  suits({ left, bottom, right, top }: Bounds): boolean {
    const isWhole =
      this.toX(left) >= 4 && this.toX(right) <= this.width - 4 && this.toY(top) >= 4 && this.toY(bottom) <= this.height - 4;
    const fills = Math.max(((right - left) * this.scale) / this.width, ((top - bottom) * this.scale) / this.height);
    return isWhole && fills > 0.55;
  }

  /** Makes everything larger by a factor; the floor at a place of the picture stays there. */
  zoom(factor: number, px = this.width / 2, py = this.height / 2): void {
    const [x, y] = [this.fromX(px), this.fromY(py)];
    this.scale = clamp(this.scale * factor);
    this.x += x - this.fromX(px);
    this.y += y - this.fromY(py);
  }

  /** Moves the floor by pixels. */
  pan(dx: number, dy: number): void {
    this.x -= dx / this.scale;
    this.y += dy / this.scale;
  }

  /** Metres between grid lines: 1, 2 or 5 times a power of ten. */
  get step(): number {
    return niceStep(SPACING / this.scale);
  }
}

/** The least of 1, 2 and 5 times a power of ten that is not below a length. */
export function niceStep(least: number): number {
  const power = 10 ** Math.floor(Math.log10(least));
  // What rounding leaves below must not cost a whole step.
  const found = [1, 2, 5].find((digit) => digit * power >= least * (1 - 1e-9));
  return (found ?? 10) * power;
}

/** The multiples of a step from one length to another. */
export function ticks(from: number, to: number, step: number): number[] {
  const first = Math.ceil(from / step);
  const count = Math.min(Math.floor(to / step) - first + 1, 400);
  return Array.from({ length: Math.max(count, 0) }, (_, index) => (first + index) * step);
}

function clamp(scale: number): number {
  return Math.min(Math.max(scale, SCALES.least), SCALES.most);
}
