// Robots as bodies that show where they head, their names, and where they would run into something.
import { label } from "./floor";
import type { Crash, Robot } from "./model";
import type { Theme } from "./theme";
import type { Pose } from "./time";
import type { View } from "./view";

export type Look = "start" | "end" | "ghost" | "solid";

/** Bodies are drawn no smaller than this, pixels: they would not be seen. */
const LEAST = 9;

export function drawBody(context: CanvasRenderingContext2D, view: View, robot: Robot, pose: Pose, colour: string, look: Look, theme: Theme): void {
  const long = Math.max(robot.body.length * view.scale, LEAST);
  const wide = Math.max(robot.body.width * view.scale, LEAST * 0.8);
  context.save();
  context.translate(view.toX(pose.x), view.toY(pose.y));
  context.rotate(-pose.theta);
  context.strokeStyle = colour;
  context.fillStyle = colour;
  context.lineJoin = "round";
  context.lineWidth = look === "solid" ? 1.5 : 1.25;
  if (look === "start" || look === "ghost") context.setLineDash([4, 3]);
  context.beginPath();
  context.roundRect(-long / 2, -wide / 2, long, wide, Math.min(long, wide) / 8);
  if (look !== "start" && look !== "ghost") {
    context.save();
    context.globalAlpha = look === "solid" ? 1 : 0.22;
    context.fill();
    context.restore();
  }
  context.stroke();
  context.setLineDash([]);
  drawNose(context, long, wide, look === "solid" ? theme.paper : colour, look === "solid");
  context.restore();
}

/** A wedge that points to where the robot heads. */
function drawNose(context: CanvasRenderingContext2D, long: number, wide: number, colour: string, isFilled: boolean): void {
  const size = Math.min(long, wide);
  const tip = long / 2 - size * 0.12;
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

/** What the sensors of a robot see. */
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

/** A mark that is seen also where it cannot be told by its colour. */
export function drawCrash(context: CanvasRenderingContext2D, view: View, theme: Theme, crash: Crash): void {
  drawBody(context, view, crash.robot, crash, theme.crash, "ghost", theme);
  const [x, y] = [view.toX(crash.x), view.toY(crash.y)];
  context.beginPath();
  context.arc(x, y, 8, 0, 2 * Math.PI);
  context.fillStyle = theme.paper;
  context.fill();
  context.strokeStyle = theme.crash;
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
  /** From the robot's middle to its farthest corner, pixels. */
  reach: number;
}

/** Names beside their robots, each on the first side where it covers no other robot and no other name. */
export function drawNames(context: CanvasRenderingContext2D, view: View, theme: Theme, names: readonly Name[]): void {
  context.font = `600 11px ${theme.font}`;
  context.textBaseline = "middle";
  const taken = names.map(({ x, y, reach }) => ({ left: x - reach, right: x + reach, top: y - reach, bottom: y + reach }));
  for (const { text, colour, x, y, reach } of names) {
    const half = context.measureText(text).width / 2;
    const places = [
      { x, y: y - reach - 9 },
      { x, y: y + reach + 10 },
      { x: x + reach + half + 5, y },
      { x: x - reach - half - 5, y },
    ].map((place) => ({ ...place, left: place.x - half, right: place.x + half, top: place.y - 7, bottom: place.y + 7 }));
    const isFree = (place: (typeof places)[number]): boolean =>
      place.left > 4 && place.right < view.width - 4 && place.top > 4 && place.bottom < view.height - 22 &&
      taken.every((other) => place.right < other.left || place.left > other.right || place.bottom < other.top || place.top > other.bottom);
    const place = places.find(isFree) ?? places[0];
    if (!place) continue;
    taken.push(place);
    label(context, text, place.x, place.y, "center", theme, colour);
  }
}
