// The floor: a grid in metres, and what stands on it.
import type { Outline } from "./model";
import type { Theme } from "./theme";
import { ticks, type View } from "./view";
import { tickLabel } from "./format";

/** Room for the labels of the grid, pixels. */
const EDGE = 18;

export function drawGrid(context: CanvasRenderingContext2D, view: View, theme: Theme): void {
  const { step, width, height } = view;
  context.lineWidth = 1;
  for (const x of ticks(view.fromX(0), view.fromX(width), step)) {
    const at = Math.round(view.toX(x)) + 0.5;
    line(context, at, 0, at, height, x === 0 ? theme.axis : theme.grid);
  }
  for (const y of ticks(view.fromY(height), view.fromY(0), step)) {
    const at = Math.round(view.toY(y)) + 0.5;
    line(context, 0, at, width, at, y === 0 ? theme.axis : theme.grid);
  }
}

/** The values of the grid's lines at two edges, on top of everything. */
export function drawScale(context: CanvasRenderingContext2D, view: View, theme: Theme): void {
  const { step, width, height } = view;
  context.font = `11px ${theme.font}`;
  context.textBaseline = "middle";
  for (const x of ticks(view.fromX(40), view.fromX(width - 20), step)) {
    label(context, tickLabel(x, step), view.toX(x), height - EDGE / 2 - 1, "center", theme);
  }
  for (const y of ticks(view.fromY(height - EDGE - 8), view.fromY(12), step)) {
    label(context, tickLabel(y, step), 6, view.toY(y), "left", theme);
  }
}

export function drawOutlines(context: CanvasRenderingContext2D, view: View, theme: Theme, outlines: readonly Outline[]): void {
  context.fillStyle = theme.obstacle;
  context.strokeStyle = theme.obstacleEdge;
  context.lineWidth = theme.isHighContrast ? 1.5 : 1;
  context.lineJoin = "round";
  for (const outline of outlines) {
    context.beginPath();
    if ("points" in outline) {
      outline.points.forEach(([x, y], index) => {
        if (index === 0) context.moveTo(view.toX(x), view.toY(y));
        else context.lineTo(view.toX(x), view.toY(y));
      });
      context.closePath();
    } else {
      context.arc(view.toX(outline.x), view.toY(outline.y), outline.radius * view.scale, 0, 2 * Math.PI);
    }
    context.fill();
    context.stroke();
  }
}

/** Text that stays legible on whatever is below. */
export function label(
  context: CanvasRenderingContext2D,
  text: string,
  x: number,
  y: number,
  align: CanvasTextAlign,
  theme: Theme,
  colour = theme.quiet,
): void {
  context.textAlign = align;
  context.lineJoin = "round";
  context.lineWidth = 3;
  context.strokeStyle = theme.paper;
  context.strokeText(text, x, y);
  context.fillStyle = colour;
  context.fillText(text, x, y);
}

function line(context: CanvasRenderingContext2D, ax: number, ay: number, bx: number, by: number, colour: string): void {
  context.strokeStyle = colour;
  context.beginPath();
  context.moveTo(ax, ay);
  context.lineTo(bx, by);
  context.stroke();
}
