// The picture, in two layers: what is fixed while time passes, and what moves. A step of time redraws only the second, whose
// cost depends on the number of robots and not on their actions.
import { drawBody, drawCollision, drawNames, drawSensors, type Name } from "./bodies";
import { describeRounds } from "./descriptions";
import { drawGrid, drawObstaclePaths, drawObstacles, drawScale } from "./floor";
import type { Hit } from "./hit";
import { possibleEnds, type Driven, type DrivenRobot, type Model, type ObstacleShape, type Robot } from "./model";
import { drawDriven, drawHighlight, drawMap, drawPlanned } from "./paths";
import { robotColour, type Theme } from "./theme";
import { endOf, poseAt, type Pose } from "./time";
import { View } from "./view";

export interface Scene {
  model: Model | undefined;
  /** The latest run, if it is to be shown. */
  driven: Driven | undefined;
  hidden: ReadonlySet<string>;
  highlights: readonly Hit[];
  /** The leg whose round is named. */
  selected: Hit | undefined;
  time: number;
}

export class Stage {
  readonly view = new View();
  private readonly fixed: CanvasRenderingContext2D;
  private readonly moving: CanvasRenderingContext2D;

  constructor(
    private readonly fixedCanvas: HTMLCanvasElement,
    private readonly movingCanvas: HTMLCanvasElement,
  ) {
    this.fixed = contextOf(fixedCanvas);
    this.moving = contextOf(movingCanvas);
  }

  /** Adopts the size of the page, in pixels of the screen so that lines are crisp. */
  resize(): void {
    const { clientWidth, clientHeight } = this.movingCanvas;
    const ratio = window.devicePixelRatio || 1;
    this.view.width = Math.max(clientWidth, 1);
    this.view.height = Math.max(clientHeight, 1);
    for (const canvas of [this.fixedCanvas, this.movingCanvas]) {
      canvas.width = Math.round(this.view.width * ratio);
      canvas.height = Math.round(this.view.height * ratio);
    }
  }

  /** Both layers on the background, as a data URI that contains a PNG. */
  capture(theme: Theme): string {
    const canvas = document.createElement("canvas");
    canvas.width = this.fixedCanvas.width;
    canvas.height = this.fixedCanvas.height;
    const context = contextOf(canvas);
    context.fillStyle = theme.background;
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.drawImage(this.fixedCanvas, 0, 0);
    context.drawImage(this.movingCanvas, 0, 0);
    return canvas.toDataURL("image/png");
  }

  drawFixed(scene: Scene, theme: Theme): void {
    const context = this.begin(this.fixed);
    const { view } = this;
    drawGrid(context, view, theme);
    const { model, driven } = scene;
    if (model) {
      drawObstacles(context, view, theme, model.obstacles.filter((obstacle) => !isMoving(obstacle)));
      drawObstaclePaths(context, view, theme, model.obstacles);
      const robots = visibleRobots(scene);
      for (const robot of robots) {
        const run = driven?.robots.get(robot.name);
        if (run) drawDriven(context, view, theme, run, robotColour(theme, robot.colour));
      }
      for (const robot of robots) drawPlanned(context, view, theme, robot, robotColour(theme, robot.colour));
      for (const robot of robots) {
        const colour = robotColour(theme, robot.colour);
        drawBody(context, view, robot, robot.start, colour, "start", theme);
        if (robot.legs.length > 0) drawBody(context, view, robot, robot.end, colour, "end", theme);
        // Some ways are shorter than the robot.
        for (const end of possibleEnds(robot)) drawBody(context, view, robot, end, colour, "ghost", theme);
        const run = driven?.robots.get(robot.name);
        if (run) drawMap(context, view, theme, run);
      }
    }
    drawScale(context, view, theme);
  }

  drawMoving(scene: Scene, theme: Theme): void {
    const context = this.begin(this.moving);
    const { view } = this;
    const { model, driven, time } = scene;
    if (!model) return;
    drawObstacles(context, view, theme, model.obstacles.filter(isMoving), time);
    for (const { robot, leg } of scene.highlights) {
      if (!scene.hidden.has(robot.name)) drawHighlight(context, view, theme, robot, leg, robotColour(theme, robot.colour));
    }
    const names: Name[] = [];
    for (const robot of visibleRobots(scene)) {
      const colour = robotColour(theme, robot.colour);
      const pose = this.drawRobot(context, robot, driven?.robots.get(robot.name), time, colour, theme);
      const radius = Math.max((Math.hypot(robot.body.length, robot.body.width) / 2) * view.scale, 6);
      if (model.robots.length > 1) names.push({ text: robot.name, colour, x: view.toX(pose.x), y: view.toY(pose.y), radius });
    }
    if (scene.selected && !scene.hidden.has(scene.selected.robot.name)) names.push(...this.roundOf(scene.selected, theme));
    for (const collision of model.collisions) {
      if (!scene.hidden.has(collision.robot.name)) drawCollision(context, view, theme, collision);
    }
    drawNames(context, view, theme, names);
  }

  /** The round of a leg, if it is in a loop, as a name beside its middle. */
  private roundOf({ robot, leg }: Hit, theme: Theme): Name[] {
    const text = describeRounds(leg.action);
    if (text === "") return [];
    const middle = 2 * Math.round((leg.first + leg.last) / 2);
    const isUpright = Math.abs(leg.to.y - leg.from.y) > Math.abs(leg.to.x - leg.from.x);
    const [x, y] = [this.view.toX(leg.line[middle] ?? 0), this.view.toY(leg.line[middle + 1] ?? 0)];
    return [{ text, colour: robotColour(theme, robot.colour), x, y, radius: 6, isUpright }];
  }

  /**
   * A robot at a time: solid where the run has it, with the plan as a ghost; without a run the plan is solid, and a ghost
   * where the robot was seen last, once nobody knows where it is.
   */
  private drawRobot(context: CanvasRenderingContext2D, robot: Robot, run: DrivenRobot | undefined, time: number, colour: string, theme: Theme): Pose {
    const planned = poseAt(robot.track, time) ?? robot.start;
    const driven = run && poseAt(run.track, time);
    drawSensors(context, this.view, robot, driven ?? planned, colour, theme);
    if (driven) drawBody(context, this.view, robot, planned, colour, "ghost", theme);
    const isLost = !driven && robot.unknownAfter !== null && time > endOf(robot.track);
    drawBody(context, this.view, robot, driven ?? planned, colour, isLost ? "ghost" : "solid", theme);
    return driven ?? planned;
  }

  private begin(context: CanvasRenderingContext2D): CanvasRenderingContext2D {
    const ratio = context.canvas.width / this.view.width;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, this.view.width, this.view.height);
    return context;
  }
}

function isMoving({ motion }: ObstacleShape): boolean {
  return motion !== undefined;
}

function visibleRobots({ model, hidden }: Scene): Robot[] {
  return model?.robots.filter(({ name }) => !hidden.has(name)) ?? [];
}

function contextOf(canvas: HTMLCanvasElement): CanvasRenderingContext2D {
  const context = canvas.getContext("2d");
  if (!context) throw new Error("this browser cannot draw");
  return context;
}
