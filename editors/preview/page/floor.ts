// Draws the floor: a grid in metres, obstacles and labels.
import type { ObstacleShape } from "./model";
import { offsetAt } from "./motion";
import { trace } from "./paths";
import type { Theme } from "./theme";
import { ticks, type View } from "./view";
import { tickLabel } from "./format";

/** Space for the labels of the grid, pixels. */
const LABEL_SPACE = 18;

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

/** Labels the grid's lines at two edges. */
export function drawScale(context: CanvasRenderingContext2D, view: View, theme: Theme): void {
  const { step, width, height } = view;
  context.font = `11px ${theme.font}`;
  context.textBaseline = "middle";
  for (const x of ticks(view.fromX(40), view.fromX(width - 20), step)) {
    label(context, tickLabel(x, step), view.toX(x), height - LABEL_SPACE / 2 - 1, "center", theme);
  }
  for (const y of ticks(view.fromY(height - LABEL_SPACE - 8), view.fromY(12), step)) {
    label(context, tickLabel(y, step), 6, view.toY(y), "left", theme);
  }
}

/** Draws obstacles where they are at a time. */
export function drawObstacles(context: CanvasRenderingContext2D, view: View, theme: Theme, obstacles: readonly ObstacleShape[], time = 0): void {
  context.fillStyle = theme.obstacle;
  context.strokeStyle = theme.obstacleEdge;
  context.lineWidth = theme.isHighContrast ? 1.5 : 1;
  context.lineJoin = "round";
  for (const obstacle of obstacles) {
    const moved = obstacle.motion ? offsetAt(obstacle.motion, time) : { x: 0, y: 0 };
    context.beginPath();
    if ("points" in obstacle) {
      obstacle.points.forEach(([x, y], index) => {
        const [px, py] = [view.toX(x + moved.x), view.toY(y + moved.y)];
        if (index === 0) context.moveTo(px, py);
        else context.lineTo(px, py);
      });
      context.closePath();
    } else {
      context.arc(view.toX(obstacle.x + moved.x), view.toY(obstacle.y + moved.y), obstacle.radius * view.scale, 0, 2 * Math.PI);
    }
    context.fill();
    context.stroke();
  }
}

/** Draws the ways of the obstacles that move. */
export function drawObstaclePaths(context: CanvasRenderingContext2D, view: View, theme: Theme, obstacles: readonly ObstacleShape[]): void {
  context.save();
  context.strokeStyle = theme.obstacleEdge;
  context.lineWidth = 1;
  context.setLineDash([3, 3]);
  for (const { motion } of obstacles) {
    if (!motion) continue;
    trace(context, view, motion.line, 0, motion.line.length / 2 - 1);
    context.stroke();
  }
  context.restore();
}

/** Text with a halo, legible on any background. */
export function label(
  context: CanvasRenderingContext2D,
  text: string,
  x: number,
  y: number,
  align: CanvasTextAlign,
  theme: Theme,
  colour = theme.muted,
): void {
  context.textAlign = align;
  context.lineJoin = "round";
  context.lineWidth = 3;
  context.strokeStyle = theme.background;
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
