// Draws planned and driven paths, and the maps that robots built.
import type { DrivenRobot, Leg, Robot } from "./model";
import type { Theme } from "./theme";
import type { View } from "./view";

/** Of the joint between two actions, pixels. */
const JOINT_RADIUS = 2.5;

/** Dash and gap of what is possible, pixels. */
const POSSIBLE = [5, 5];

export function drawPlanned(context: CanvasRenderingContext2D, view: View, theme: Theme, robot: Robot, colour: string): void {
  context.strokeStyle = colour;
  context.lineWidth = 2;
  context.lineCap = "round";
  context.lineJoin = "round";
  trace(context, view, robot.line, 0, robot.line.length / 2 - 1);
  context.stroke();
  drawWays(context, view, robot);
  context.fillStyle = theme.background;
  context.lineWidth = 1.5;
  for (const leg of robot.legs) {
    context.beginPath();
    context.arc(view.toX(leg.to.x), view.toY(leg.to.y), JOINT_RADIUS, 0, 2 * Math.PI);
    context.fill();
    context.stroke();
  }
}

/** What a robot may do where its path becomes unknown, in its colour. */
function drawWays(context: CanvasRenderingContext2D, view: View, robot: Robot): void {
  context.save();
  context.lineCap = "butt";
  context.setLineDash(POSSIBLE);
  for (const { line } of robot.ways) {
    trace(context, view, line, 0, line.length / 2 - 1);
    context.stroke();
  }
  context.restore();
}

export function drawDriven(context: CanvasRenderingContext2D, view: View, theme: Theme, driven: DrivenRobot, colour: string): void {
  context.save();
  context.globalAlpha = theme.isHighContrast ? 0.55 : 0.38;
  context.strokeStyle = colour;
  context.lineWidth = 6;
  context.lineCap = "round";
  context.lineJoin = "round";
  trace(context, view, driven.line, 0, driven.line.length / 2 - 1);
  context.stroke();
  context.restore();
}

/** The nodes and edges of a robot's map. */
export function drawMap(context: CanvasRenderingContext2D, view: View, theme: Theme, driven: DrivenRobot): void {
  context.strokeStyle = theme.foreground;
  context.lineWidth = 1.25;
  context.beginPath();
  for (const [[ax, ay], [bx, by]] of driven.edges) {
    context.moveTo(view.toX(ax), view.toY(ay));
    context.lineTo(view.toX(bx), view.toY(by));
  }
  context.stroke();
  context.fillStyle = theme.background;
  for (const [x, y] of driven.nodes) {
    context.beginPath();
    context.arc(view.toX(x), view.toY(y), 3, 0, 2 * Math.PI);
    context.fill();
    context.stroke();
  }
}

export function drawHighlight(context: CanvasRenderingContext2D, view: View, theme: Theme, robot: Robot, leg: Leg, colour: string): void {
  context.lineCap = "round";
  context.lineJoin = "round";
  if (leg.isTurn) {
    const [x, y] = [view.toX(leg.from.x), view.toY(leg.from.y)];
    // Around the robot, which may be there.
    const radius = Math.max((Math.hypot(robot.body.length, robot.body.width) / 2) * view.scale + 3, 9);
    ring(context, x, y, radius, theme.highlight, 5);
    ring(context, x, y, radius, colour, 2);
    return;
  }
  context.strokeStyle = theme.highlight;
  context.lineWidth = 10;
  trace(context, view, leg.line, leg.first, leg.last);
  context.stroke();
  context.save();
  context.strokeStyle = colour;
  context.lineWidth = 3.5;
  if (leg.isPossible) {
    context.lineCap = "butt";
    context.setLineDash(POSSIBLE);
  }
  context.stroke();
  context.restore();
}

function ring(context: CanvasRenderingContext2D, x: number, y: number, radius: number, colour: string, width: number): void {
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.stroke();
}

/** Traces part of a line, skipping points on the same pixel. */
export function trace(context: CanvasRenderingContext2D, view: View, line: Float64Array, first: number, last: number): void {
  context.beginPath();
  let [beforeX, beforeY] = [NaN, NaN];
  for (let index = first; index <= last; index += 1) {
    const x = view.toX(line[2 * index] ?? 0);
    const y = view.toY(line[2 * index + 1] ?? 0);
    if (index === first) context.moveTo(x, y);
    else if (index === last || Math.abs(x - beforeX) + Math.abs(y - beforeY) > 0.7) context.lineTo(x, y);
    else continue;
    [beforeX, beforeY] = [x, y];
  }
}
