// The visible part of the floor: converts metres to pixels and back.
import type { Bounds } from "./model";

/** Pixels per metre. */
const SCALES = { min: 0.5, max: 20_000 };

/** The factor of one zoom step. */
export const ZOOM_STEP = 1.4;

/** Space around fitted bounds, pixels. */
const MARGIN = 34;

/** The least distance between grid lines, pixels; leaves space for a label. */
const SPACING = 52;

export class View {
  /** Pixels per metre. */
  scale = 100;
  /** The point of the floor at the centre. */
  x = 0;
  y = 0;
  width = 1;
  height = 1;

  toX(x: number): number {
    return this.width / 2 + (x - this.x) * this.scale;
  }

  toY(y: number): number {
    return this.height / 2 - (y - this.y) * this.scale;
  }

  fromX(px: number): number {
    return this.x + (px - this.width / 2) / this.scale;
  }

  fromY(py: number): number {
    return this.y - (py - this.height / 2) / this.scale;
  }

  /** Shows a rectangle as large as possible. */
  fit({ left, bottom, right, top }: Bounds): void {
    const horizontal = Math.max(this.width - 2 * MARGIN, 40) / Math.max(right - left, 0.2);
    const vertical = Math.max(this.height - 2 * MARGIN, 40) / Math.max(top - bottom, 0.2);
    this.scale = clamp(Math.min(horizontal, vertical));
    this.x = (left + right) / 2;
    this.y = (bottom + top) / 2;
  }

  /** Whether a rectangle is visible and not much too small; the view then stays, so that it does not jump while typing. */
  isGoodFit({ left, bottom, right, top }: Bounds): boolean {
    const isVisible =
      this.toX(left) >= 4 && this.toX(right) <= this.width - 4 && this.toY(top) >= 4 && this.toY(bottom) <= this.height - 4;
    const fills = Math.max(((right - left) * this.scale) / this.width, ((top - bottom) * this.scale) / this.height);
    return isVisible && fills > 0.55;
  }

  /** Scales by a factor; the floor under the given point stays there. */
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

/** The smallest of 1, 2 and 5 times a power of ten that is at least a length. */
export function niceStep(length: number): number {
  const power = 10 ** Math.floor(Math.log10(length));
  // A rounding error must not skip a step.
  const found = [1, 2, 5].find((digit) => digit * power >= length * (1 - 1e-9));
  return (found ?? 10) * power;
}

/** The multiples of a step between two values. */
export function ticks(from: number, to: number, step: number): number[] {
  const first = Math.ceil(from / step);
  const count = Math.min(Math.floor(to / step) - first + 1, 400);
  return Array.from({ length: Math.max(count, 0) }, (_, index) => (first + index) * step);
}

function clamp(scale: number): number {
  return Math.min(Math.max(scale, SCALES.min), SCALES.max);
}
