// The preview's page: shows what its host sends and reacts to the user.
import type { PageState, ToPage } from "../host/messages";
import { keyOf, type NumberedAction } from "../host/protocol";
import { Camera } from "./camera";
import { Controls } from "./controls";
import { describeAction, describePath, describeRounds } from "./descriptions";
import { element, focusOf } from "./elements";
import * as format from "./format";
import { Help } from "./help";
import { Highlights } from "./highlights";
import { hitTest, type Hit } from "./hit";
import { commandOf, type Command } from "./keys";
import { Legend, type LegendContent } from "./legend";
import { boundsOf, drivenOf, modelOf, type Collision, type Driven, type Model } from "./model";
import { Player } from "./player";
import { watchPointer } from "./pointer";
import { Stage, type Scene } from "./stage";
import type { Connection } from "./start";
import { readTheme, watchTheme, type Theme } from "./theme";
import { Toolbar } from "./toolbar";
import { Tooltip } from "./tooltip";
import { niceStep } from "./view";

export class Preview {
  private model: Model | undefined;
  /** The program whose path is shown. */
  private pathUri: string | undefined;
  /** The program whose environments the toolbar names. */
  private environmentsUri: string | undefined;
  /** Whether a path was shown before; the first path starts at the saved time. */
  private hadPath = false;
  private driven: Driven | undefined;
  /** The key of the environment that `driven` is a run of. */
  private drivenKey: string | undefined;
  private isRunShown = true;
  /** Whether `driven` is a run of an earlier version of the program. */
  private isRunEarlier = false;
  private readonly hidden: Set<string>;
  private readonly highlights = new Highlights();
  private theme: Theme;
  private readonly player = new Player(() => this.showTime());
  private readonly playback = this.player.playback;
  private readonly root: HTMLElement;
  private readonly surface: HTMLElement;
  private readonly stage: Stage;
  private readonly camera: Camera;
  private readonly toolbar: Toolbar;
  private readonly controls: Controls;
  private readonly legend: Legend;
  private readonly tooltip = new Tooltip();
  private readonly help = new Help();
  private readonly announcement = element("p", { class: "announcement", "aria-live": "polite", "data-part": "announcement" });

  constructor(
    body: HTMLElement,
    private readonly state: PageState,
    private readonly host: Pick<Connection, "post" | "saveState">,
  ) {
    this.hidden = new Set(state.hidden ?? []);
    this.playback.chosenSpeed = state.speed;
    this.theme = readTheme(body);
    this.toolbar = new Toolbar({
      select: (environment) => host.post({ type: "select", environment }),
      zoom: (factor) => this.camera.zoom(factor),
      fit: () => this.fit(),
      export: () => host.post({ type: "export" }),
      help: () => this.help.toggle(),
      accept: (suggestion) => host.post({ type: "accept", suggestion }),
      place: () => host.post({ type: "place" }),
      fix: () => host.post({ type: "fix" }),
      run: () => host.post({ type: "run" }),
      press: (button) => host.post({ type: "press", button }),
    });
    this.controls = new Controls({
      toggle: () => this.toggle(),
      seek: (time) => this.seek(time),
      setSpeed: (speed) => this.setSpeed(speed),
    });
    this.legend = new Legend({
      hide: (robot, isHidden) => this.hide(robot, isHidden),
      showRun: (isShown) => this.showRun(isShown),
      goTo: (collision) => this.goTo(collision),
    });
    const [fixed, moving] = [element("canvas", { "aria-hidden": "true" }), element("canvas", { "aria-hidden": "true" })];
    this.surface = element(
      "div",
      { class: "surface", tabindex: "0", role: "application", "aria-roledescription": "picture", "data-part": "picture" },
      fixed,
      moving,
      this.tooltip.box,
    );
    this.stage = new Stage(fixed, moving);
    this.camera = new Camera(this.stage.view, {
      bounds: () => this.model && boundsOf(this.model, this.shownRun),
      moved: () => this.tooltip.hide(),
      draw: () => this.draw(),
    });
    this.root = element(
      "main",
      { class: "preview", "data-state": "empty", "data-drawn": "0", "data-steps": "0" },
      this.toolbar.bar,
      this.toolbar.result,
      element("div", { class: "middle" }, element("div", { class: "stage" }, this.surface, this.toolbar.banner, this.help.box), this.legend.panel),
      this.controls.bar,
      this.announcement,
    );
    body.prepend(this.root);
    this.toolbar.setEnvironments([], null);
    this.legend.show(this.legendContent);
    this.controls.setPath(this.playback, [], true);
    this.listen();
  }

  receive(message: ToPage): void {
    switch (message.type) {
      case "path":
        this.showPath(message);
        break;
      case "problem":
        this.showProblem(message);
        break;
      case "result":
        this.toolbar.showResult(message.result);
        break;
      case "environments":
        this.toolbar.setEnvironments(message.names, message.shown, message.canRun);
        this.environmentsUri = message.uri;
        this.save({ uri: message.uri, ...(message.shown === null ? {} : { environment: message.shown }) });
        break;
      case "cursor":
        this.highlights.setCursor(message.action, this.visibleRobots);
        this.drawMoving();
        break;
      case "driven":
        this.showDriven(message);
        break;
      case "capture":
        this.host.post({ type: "captured", png: this.stage.capture(this.theme) });
        break;
    }
  }

  // Messages

  private showPath({ uri, path, isRunEarlier = false }: Extract<ToPage, { type: "path" }>): void {
    const isOther = this.model?.environment !== path.environment || this.pathUri !== uri;
    this.model = modelOf(path);
    this.pathUri = uri;
    this.isRunEarlier = isRunEarlier;
    this.highlights.clear();
    this.tooltip.hide();
    if (isOther) {
      if (this.drivenKey !== keyOf({ uri, environment: path.environment })) this.driven = undefined;
      this.playback.isPlaying = false;
      this.playback.setDuration(this.model.duration);
      this.playback.seek(this.hadPath ? 0 : (this.state.time ?? 0));
    }
    this.hadPath = true;
    this.save({ uri, environment: path.environment });
    this.root.dataset.state = "ready";
    this.root.dataset.environment = path.environment;
    this.toolbar.hideProblem();
    this.update(isOther);
    this.root.dataset.drawn = `${Number(this.root.dataset.drawn) + 1}`;
  }

  private showProblem(problem: Extract<ToPage, { type: "problem" }>): void {
    const { uri } = problem;
    if (uri !== this.pathUri) this.clear();
    if (uri !== this.environmentsUri) this.toolbar.setEnvironments([], null);
    const hasPath = this.model !== undefined;
    this.root.dataset.state = hasPath ? "stale" : "empty";
    this.toolbar.showProblem(problem, hasPath);
  }

  /** Clears the picture when another program is to be shown. */
  private clear(): void {
    this.model = undefined;
    this.pathUri = undefined;
    this.driven = undefined;
    this.highlights.clear();
    this.tooltip.hide();
    this.playback.reset();
    this.root.dataset.environment = "";
    this.root.dataset.driven = "";
    this.update(true);
  }

  private showDriven({ driven, isNew, isRunEarlier = false, ...id }: Extract<ToPage, { type: "driven" }>): void {
    this.isRunEarlier = isRunEarlier;
    this.driven = driven ? drivenOf(driven) : undefined;
    this.drivenKey = keyOf(id);
    if (isNew && this.playback.isPlaying) this.playback.reset();
    this.root.dataset.driven = driven ? driven.environment : "";
    this.update(false);
  }

  /** Updates everything that depends on the planned and the driven path. */
  private update(isOther: boolean): void {
    const { model } = this;
    const driven = this.shownRun;
    this.highlights.findCursor(this.visibleRobots);
    this.playback.setDuration(Math.max(model?.duration ?? 0, driven?.duration ?? 0));
    this.controls.setPath(this.playback, model?.collisions ?? [], model?.isComplete !== false || driven !== undefined);
    this.legend.show(this.legendContent);
    this.surface.setAttribute("aria-label", model ? describePath(model) : "No path yet");
    if (isOther) this.camera.fit();
    else this.camera.follow(false);
    this.draw();
  }

  // User input

  private listen(): void {
    watchPointer(this.surface, {
      pan: (dx, dy) => this.camera.pan(dx, dy),
      zoom: (factor, px, py) => this.camera.zoom(factor, px, py),
      hover: (px, py) => this.hover(px, py),
      leave: () => this.leave(),
      click: (px, py) => this.click(this.hitAt(px, py)),
      fit: () => this.fit(),
    });
    window.addEventListener("keydown", (event) => {
      const command = commandOf(event, focusOf(event.target));
      if (!command) return;
      event.preventDefault();
      this.execute(command);
    });
    new ResizeObserver(() => this.resize()).observe(this.surface);
    watchTheme(() => {
      this.theme = readTheme(document.body);
      this.draw();
    });
  }

  private execute(command: Command): void {
    const { playback } = this;
    switch (command.do) {
      case "toggle":
        this.toggle();
        break;
      case "start":
        this.seek(0);
        break;
      case "end":
        this.seek(playback.duration);
        break;
      case "step":
        this.seek(playback.time + command.steps * playback.step);
        break;
      case "action":
        this.selectAction(command.direction);
        break;
      case "reveal":
        this.reveal(this.highlights.selected);
        break;
      case "zoom":
        this.camera.zoom(command.factor);
        break;
      case "pan":
        this.camera.pan(command.x, command.y);
        break;
      case "fit":
        this.fit();
        break;
      case "export":
        this.host.post({ type: "export" });
        break;
      case "help":
        this.help.toggle();
        break;
      case "close":
        this.help.hide();
        break;
    }
  }

  private seek(time: number): void {
    this.playback.seek(time);
    this.root.dataset.steps = `${Number(this.root.dataset.steps) + 1}`;
    this.showTime();
    this.save({ time: this.playback.time });
  }

  private toggle(): void {
    this.player.toggle();
    if (!this.playback.isPlaying) this.save({ time: this.playback.time });
  }

  private setSpeed(speed: number): void {
    this.playback.chosenSpeed = speed;
    this.save({ speed });
  }

  private hide(robot: string, isHidden: boolean): void {
    if (isHidden) this.hidden.add(robot);
    else this.hidden.delete(robot);
    this.save({ hidden: [...this.hidden] });
    this.highlights.findCursor(this.visibleRobots);
    this.draw();
  }

  private showRun(isShown: boolean): void {
    this.isRunShown = isShown;
    this.update(false);
  }

  private goTo(collision: Collision): void {
    if (collision.t !== null) this.seek(collision.t);
    if (collision.action) this.host.post({ type: "reveal", action: numbered(collision.action) });
  }

  private reveal(hit: Hit | undefined): void {
    if (hit) this.host.post({ type: "reveal", action: numbered(hit.leg.action) });
  }

  /** Selects a leg, so that its round is named, and goes to its action. */
  private click(hit: Hit | undefined): void {
    this.highlights.selected = hit;
    if (hit) this.announcement.textContent = describeAction(hit).join(", ");
    this.drawMoving();
    this.reveal(hit);
  }

  private selectAction(direction: 1 | -1): void {
    const hit = this.highlights.select(direction, this.visibleRobots);
    if (!hit) return;
    this.announcement.textContent = describeAction(hit).join(", ");
    const { view } = this.stage;
    this.tooltip.show(hit, view.toX(hit.leg.to.x), view.toY(hit.leg.to.y), view);
    this.drawMoving();
  }

  private hover(px: number, py: number): void {
    const hit = this.hitAt(px, py);
    this.surface.classList.toggle("pointing", hit !== undefined);
    if (hit) this.tooltip.show(hit, px, py, this.stage.view);
    else this.tooltip.hide();
    if (hit?.leg === this.highlights.hovered?.leg) return;
    this.highlights.hovered = hit;
    this.drawMoving();
  }

  private leave(): void {
    this.tooltip.hide();
    if (!this.highlights.hovered) return;
    this.highlights.hovered = undefined;
    this.drawMoving();
  }

  private fit(): void {
    this.camera.fit();
    this.draw();
  }

  private resize(): void {
    this.stage.resize();
    this.camera.follow(true);
    this.draw();
  }

  // Drawing

  private get shownRun(): Driven | undefined {
    return this.isRunShown ? this.driven : undefined;
  }

  private get visibleRobots(): Model["robots"] {
    return this.model?.robots.filter(({ name }) => !this.hidden.has(name)) ?? [];
  }

  private get legendContent(): LegendContent {
    return { model: this.model, driven: this.driven, isRunShown: this.isRunShown, isRunEarlier: this.isRunEarlier, hidden: this.hidden };
  }

  private hitAt(px: number, py: number): Hit | undefined {
    return hitTest(this.visibleRobots, this.stage.view, px, py);
  }

  private scene(): Scene {
    const highlights = this.highlights.all;
    const { selected } = this.highlights;
    this.root.dataset.highlighted = highlights.map(({ leg: { action } }) => `${action.movement} ${action.index}`).join(", ");
    this.root.dataset.round = selected ? describeRounds(selected.leg.action) : "";
    return { model: this.model, driven: this.shownRun, hidden: this.hidden, highlights, selected, time: this.playback.time };
  }

  private draw(): void {
    const { scale } = this.stage.view;
    const metres = niceStep(36 / scale);
    this.toolbar.setScale(metres * scale, format.length(metres));
    this.stage.drawFixed(this.scene(), this.theme);
    this.drawMoving();
  }

  private drawMoving(): void {
    this.stage.drawMoving(this.scene(), this.theme);
    this.root.dataset.time = this.playback.time.toFixed(3);
  }

  private showTime(): void {
    this.controls.show(this.playback);
    this.drawMoving();
  }

  private save(changes: PageState): void {
    Object.assign(this.state, changes);
    this.host.saveState(this.state);
  }
}

function numbered({ movement, index, calls }: NumberedAction): NumberedAction {
  return { movement, index, ...(calls ? { calls } : {}) };
}
