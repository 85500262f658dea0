// Two layers of a picture: what stays while time goes by, and what moves. A step of time draws the second alone, whose
// cost follows the number of robots and not that of their actions.
import { drawBody, drawCrash, drawNames, drawSensors, type Name } from "./bodies";
import { drawGrid, drawOutlines, drawScale } from "./floor";
import type { Driven, DrivenRobot, Leg, Model, Robot } from "./model";
import { drawDriven, drawHighlight, drawMap, drawPlanned } from "./paths";
import { robotColour, type Theme } from "./theme";
import { poseAt, type Pose } from "./time";
import { View } from "./view";

export interface Scene {
  model: Model | undefined;
  /** The latest run, where it is to be shown. */
  driven: Driven | undefined;
  hidden: ReadonlySet<string>;
  /** What stands out, with its robot. */
  highlights: readonly { robot: Robot; leg: Leg }[];
  time: number;
}

export class Stage {
  readonly view = new View();
  private readonly still: CanvasRenderingContext2D;
  private readonly moving: CanvasRenderingContext2D;

  constructor(
    private readonly stillCanvas: HTMLCanvasElement,
    private readonly movingCanvas: HTMLCanvasElement,
  ) {
    this.still = contextOf(stillCanvas);
    this.moving = contextOf(movingCanvas);
  }

  /** Takes the size that the page gives it; pixels of the screen, for crisp lines. */
  resize(): void {
    const { clientWidth, clientHeight } = this.movingCanvas;
    const ratio = window.devicePixelRatio || 1;
    this.view.width = Math.max(clientWidth, 1);
    this.view.height = Math.max(clientHeight, 1);
    for (const canvas of [this.stillCanvas, this.movingCanvas]) {
      canvas.width = Math.round(this.view.width * ratio);
      canvas.height = Math.round(this.view.height * ratio);
    }
  }

  /** Both layers on paper, as an address with a PNG in it. */
  picture(theme: Theme): string {
    const canvas = document.createElement("canvas");
    canvas.width = this.stillCanvas.width;
    canvas.height = this.stillCanvas.height;
    const context = contextOf(canvas);
    context.fillStyle = theme.paper;
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.drawImage(this.stillCanvas, 0, 0);
    context.drawImage(this.movingCanvas, 0, 0);
    return canvas.toDataURL("image/png");
  }

  drawStill(scene: Scene, theme: Theme): void {
    const context = this.begin(this.still);
    const { view } = this;
    drawGrid(context, view, theme);
    const { model, driven } = scene;
    if (model) {
      drawOutlines(context, view, theme, model.outlines);
      const robots = shown(scene);
      for (const robot of robots) {
        const found = driven?.robots.get(robot.name);
        if (found) drawDriven(context, view, theme, found, robotColour(theme, robot.colour));
      }
      for (const robot of robots) drawPlanned(context, view, theme, robot, robotColour(theme, robot.colour));
      for (const robot of robots) {
        const colour = robotColour(theme, robot.colour);
        drawBody(context, view, robot, robot.start, colour, "start", theme);
        if (robot.legs.length > 0) drawBody(context, view, robot, robot.end, colour, "end", theme);
        const found = driven?.robots.get(robot.name);
        if (found) drawMap(context, view, theme, found);
      }
    }
    drawScale(context, view, theme);
  }

  drawMoving(scene: Scene, theme: Theme): void {
    const context = this.begin(this.moving);
    const { view } = this;
    const { model, driven, time } = scene;
    if (!model) return;
    for (const { robot, leg } of scene.highlights) {
      if (!scene.hidden.has(robot.name)) drawHighlight(context, view, theme, robot, leg, robotColour(theme, robot.colour));
    }
    const names: Name[] = [];
    for (const robot of shown(scene)) {
      const colour = robotColour(theme, robot.colour);
      const found = driven?.robots.get(robot.name);
      const pose = this.drawRobot(context, robot, found, time, colour, theme);
      const reach = Math.max((Math.hypot(robot.body.length, robot.body.width) / 2) * view.scale, 6);
      if (model.robots.length > 1) names.push({ text: robot.name, colour, x: view.toX(pose.x), y: view.toY(pose.y), reach });
    }
    for (const crash of model.crashes) {
      if (!scene.hidden.has(crash.robot.name)) drawCrash(context, view, theme, crash);
    }
    drawNames(context, view, theme, names);
  }

  /** A robot where it is: what was driven is solid, and then the plan is a ghost beside it. */
  private drawRobot(context: CanvasRenderingContext2D, robot: Robot, driven: DrivenRobot | undefined, time: number, colour: string, theme: Theme): Pose {
    const planned = poseAt(robot.track, time) ?? robot.start;
    const real = driven && poseAt(driven.track, time);
    drawSensors(context, this.view, robot, real ?? planned, colour, theme);
    if (real) drawBody(context, this.view, robot, planned, colour, "ghost", theme);
    drawBody(context, this.view, robot, real ?? planned, colour, "solid", theme);
    return real ?? planned;
  }

  private begin(context: CanvasRenderingContext2D): CanvasRenderingContext2D {
    const ratio = context.canvas.width / this.view.width;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, this.view.width, this.view.height);
    return context;
  }
}

function shown({ model, hidden }: Scene): Robot[] {
  return model?.robots.filter(({ name }) => !hidden.has(name)) ?? [];
}

function contextOf(canvas: HTMLCanvasElement): CanvasRenderingContext2D {
  const context = canvas.getContext("2d");
  if (!context) throw new Error("this browser cannot draw");
  return context;
}
