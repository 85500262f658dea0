// Draws robots with their headings, names, sensors and planned collisions.
import { label } from "./floor";
import type { Collision, Robot } from "./model";
import type { Theme } from "./theme";
import type { Pose } from "./time";
import type { View } from "./view";

/** `start` and `ghost` are dashed, `end` is tinted, `solid` is filled. */
export type BodyStyle = "start" | "end" | "ghost" | "solid";

/** Robots are drawn at least this long, pixels. */
const MIN_SIZE = 9;

export function drawBody(context: CanvasRenderingContext2D, view: View, robot: Robot, pose: Pose, colour: string, style: BodyStyle, theme: Theme): void {
  const length = Math.max(robot.body.length * view.scale, MIN_SIZE);
  const width = Math.max(robot.body.width * view.scale, MIN_SIZE * 0.8);
  context.save();
  context.translate(view.toX(pose.x), view.toY(pose.y));
  context.rotate(-pose.theta);
  context.strokeStyle = colour;
  context.fillStyle = colour;
  context.lineJoin = "round";
  context.lineWidth = style === "solid" ? 1.5 : 1.25;
  if (style === "start" || style === "ghost") context.setLineDash([4, 3]);
  context.beginPath();
  context.roundRect(-length / 2, -width / 2, length, width, Math.min(length, width) / 8);
  if (style !== "start" && style !== "ghost") {
    context.save();
    context.globalAlpha = style === "solid" ? 1 : 0.22;
    context.fill();
    context.restore();
  }
  context.stroke();
  context.setLineDash([]);
  drawHeading(context, length, width, style === "solid" ? theme.background : colour, style === "solid");
  context.restore();
}

/** A wedge that points in the robot's heading. */
function drawHeading(context: CanvasRenderingContext2D, length: number, width: number, colour: string, isFilled: boolean): void {
  const size = Math.min(length, width);
  const tip = length / 2 - size * 0.12;
  context.beginPath();
  context.moveTo(tip, 0);
  context.lineTo(tip - size * 0.34, size * 0.26);
  context.lineTo(tip - size * 0.34, -size * 0.26);
  context.closePath();
  context.fillStyle = colour;
  context.strokeStyle = colour;
  context.lineWidth = 1;
  if (isFilled) context.fill();
  else context.stroke();
}

/** The fields of view of a robot's sensors. */
export function drawSensors(context: CanvasRenderingContext2D, view: View, robot: Robot, pose: Pose, colour: string, theme: Theme): void {
  if (robot.sensors.length === 0) return;
  context.save();
  context.translate(view.toX(pose.x), view.toY(pose.y));
  context.rotate(-pose.theta);
  for (const { x, y, theta, range, cone } of robot.sensors) {
    const [sx, sy] = [x * view.scale, -y * view.scale];
    context.beginPath();
    context.moveTo(sx, sy);
    context.arc(sx, sy, range * view.scale, -theta - cone / 2, -theta + cone / 2);
    context.closePath();
    context.globalAlpha = theme.isHighContrast ? 0.9 : 0.13;
    if (theme.isHighContrast) {
      context.strokeStyle = colour;
      context.lineWidth = 0.75;
      context.stroke();
    } else {
      context.fillStyle = colour;
      context.fill();
    }
  }
  context.restore();
}

/** A ghost of the robot and a crossed circle, which is recognizable without its colour. */
export function drawCollision(context: CanvasRenderingContext2D, view: View, theme: Theme, collision: Collision): void {
  drawBody(context, view, collision.robot, collision, theme.collision, "ghost", theme);
  const [x, y] = [view.toX(collision.x), view.toY(collision.y)];
  context.beginPath();
  context.arc(x, y, 8, 0, 2 * Math.PI);
  context.fillStyle = theme.background;
  context.fill();
  context.strokeStyle = theme.collision;
  context.lineWidth = 2;
  context.stroke();
  context.beginPath();
  for (const sign of [-1, 1]) {
    context.moveTo(x - 3.5, y - sign * 3.5);
    context.lineTo(x + 3.5, y + sign * 3.5);
  }
  context.stroke();
}

export interface Name {
  text: string;
  colour: string;
  x: number;
  y: number;
  /** Of the robot, pixels. */
  radius: number;
  /** Whether there is more room to its right and left than above and below it. */
  isUpright?: boolean;
}

/** Draws names next to their robots, each on the first side where it covers no robot and no other name. */
export function drawNames(context: CanvasRenderingContext2D, view: View, theme: Theme, names: readonly Name[]): void {
  context.font = `600 11px ${theme.font}`;
  context.textBaseline = "middle";
  const occupied = names.map(({ x, y, radius }) => ({ left: x - radius, right: x + radius, top: y - radius, bottom: y + radius }));
  for (const { text, colour, x, y, radius, isUpright = false } of names) {
    const half = context.measureText(text).width / 2;
    const upAndDown = [{ x, y: y - radius - 9 }, { x, y: y + radius + 10 }];
    const beside = [{ x: x + radius + half + 5, y }, { x: x - radius - half - 5, y }];
    const sides = (isUpright ? [...beside, ...upAndDown] : [...upAndDown, ...beside]).map((box) => ({ ...box, left: box.x - half, right: box.x + half, top: box.y - 7, bottom: box.y + 7 }));
    const isFree = (box: (typeof sides)[number]): boolean =>
      box.left > 4 && box.right < view.width - 4 && box.top > 4 && box.bottom < view.height - 22 &&
      occupied.every((other) => box.right < other.left || box.left > other.right || box.bottom < other.top || box.top > other.bottom);
    const box = sides.find(isFree) ?? sides[0];
    if (!box) continue;
    occupied.push(box);
    label(context, text, box.x, box.y, "center", theme, colour);
  }
}
