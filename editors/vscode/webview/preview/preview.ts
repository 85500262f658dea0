// The whole page: what it shows, and what happens when somebody does something.
import type { FromPage, PageState, ToPage } from "../../src/preview/messages";
import type { NumberedAction } from "../../src/preview/protocol";
import { Controls } from "./controls";
import { element } from "./elements";
import { Help } from "./help";
import { hitTest, type Hit } from "./hit";
import { commandOf, type Command } from "./keys";
import { Legend } from "./legend";
import { boundsOf, drivenOf, isOf, modelOf, type Crash, type Driven, type Model } from "./model";
import { Playback } from "./playback";
import { watchPointer } from "./pointer";
import { Stage, type Scene } from "./stage";
import { readTheme, watchTheme, type Theme } from "./theme";
import { Toolbar } from "./toolbar";
import { describe, Tooltip } from "./tooltip";
import { niceStep } from "./view";
import * as format from "./format";

export interface Outside {
  say: (message: FromPage) => void;
  keep: (state: PageState) => void;
}

export class Preview {
  private model: Model | undefined;
  /** The program whose path is shown. */
  private shownUri: string | undefined;
  /** The program whose environments are named. */
  private namedUri: string | undefined;
  /** Whether there was a path before: the first begins where the page was left. */
  private hadPath = false;
  private driven: Driven | undefined;
  /** The program and environment that was driven. */
  private drivenOf: string | undefined;
  private isRunShown = true;
  private readonly hidden: Set<string>;
  /** The action at the cursor of the editor. */
  private cursor: NumberedAction | null = null;
  /** Its drives: looked for once, for time goes by without them. */
  private atCursor: Hit[] = [];
  private pointed: Hit | undefined;
  /** What the keys have reached. */
  private chosen: Hit | undefined;
  /** Whether the picture follows the path, until somebody moves it. */
  private isFitted = true;
  private theme: Theme;
  private readonly playback = new Playback();
  private readonly calm = window.matchMedia("(prefers-reduced-motion: reduce)");
  private lastFrame: number | undefined;
  private awaitsStill = false;
  private readonly root: HTMLElement;
  private readonly surface: HTMLElement;
  private readonly stage: Stage;
  private readonly toolbar: Toolbar;
  private readonly controls: Controls;
  private readonly legend: Legend;
  private readonly tooltip = new Tooltip();
  private readonly help = new Help();
  private readonly spoken = element("p", { class: "spoken", "aria-live": "polite", "data-part": "spoken" });

  constructor(
    body: HTMLElement,
    private readonly state: PageState,
    private readonly outside: Outside,
  ) {
    this.hidden = new Set(state.hidden ?? []);
    this.playback.chosenSpeed = state.speed;
    this.theme = readTheme(body);
    this.toolbar = new Toolbar({
      choose: (environment) => outside.say({ type: "choose", environment }),
      zoom: (factor) => this.zoom(factor),
      fit: () => this.fit(),
      exportFile: () => outside.say({ type: "export" }),
      help: () => this.help.toggle(),
      remedy: (remedy) => outside.say({ type: "remedy", remedy }),
    });
    this.controls = new Controls({
      toggle: () => this.toggle(),
      seek: (time) => this.seek(time),
      setSpeed: (speed) => this.setSpeed(speed),
    });
    this.legend = new Legend({
      hide: (robot, isHidden) => this.hide(robot, isHidden),
      showRun: (isShown) => this.showRun(isShown),
      goTo: (crash) => this.goTo(crash),
    });
    const [still, moving] = [element("canvas", { "aria-hidden": "true" }), element("canvas", { "aria-hidden": "true" })];
    this.surface = element(
      "div",
      { class: "surface", tabindex: "0", role: "application", "aria-roledescription": "picture", "data-part": "picture" },
      still,
      moving,
      this.tooltip.box,
    );
    this.stage = new Stage(still, moving);
    this.root = element(
      "main",
      { class: "preview", "data-state": "empty", "data-drawn": "0", "data-steps": "0" },
      this.toolbar.bar,
      element("div", { class: "middle" }, element("div", { class: "stage" }, this.surface, this.toolbar.banner, this.help.box), this.legend.panel),
      this.controls.bar,
      this.spoken,
    );
    body.prepend(this.root);
    this.toolbar.setEnvironments([], null);
    this.legend.show(this.content);
    this.controls.setPath(this.playback, [], true);
    this.listen();
  }

  hear(message: ToPage): void {
    switch (message.type) {
      case "path":
        this.showPath(message);
        break;
      case "trouble":
        this.showTrouble(message);
        break;
      case "environments":
        this.toolbar.setEnvironments(message.names, message.shown);
        this.namedUri = message.uri;
        this.remember({ uri: message.uri, ...(message.shown === null ? {} : { environment: message.shown }) });
        break;
      case "cursor":
        this.cursor = message.action;
        this.chosen = undefined;
        this.findCursor();
        this.drawMoving();
        break;
      case "driven":
        this.showDriven(message);
        break;
      case "draw":
        this.outside.say({ type: "picture", data: this.stage.picture(this.theme) });
        break;
    }
  }

  //// What arrives ////

  private showPath({ uri, path }: Extract<ToPage, { type: "path" }>): void {
    const before = this.model;
    const isOther = before?.environment !== path.environment || this.shownUri !== uri;
    this.model = modelOf(path);
    this.shownUri = uri;
    this.pointed = undefined;
    this.chosen = undefined;
    this.tooltip.hide();
    if (isOther) {
      this.isFitted = true;
      if (this.drivenOf !== nameOf(uri, path.environment)) this.driven = undefined;
      this.playback.isPlaying = false;
      this.playback.setDuration(this.model.duration);
      this.playback.seek(this.hadPath ? 0 : (this.state.time ?? 0));
    }
    this.hadPath = true;
    this.remember({ uri, environment: path.environment });
    this.root.dataset.state = "ready";
    this.root.dataset.environment = path.environment;
    this.toolbar.setTrouble(undefined, true);
    this.takeIn(isOther);
    this.root.dataset.drawn = `${Number(this.root.dataset.drawn) + 1}`;
  }

  private showTrouble({ uri, sentence, remedy }: Extract<ToPage, { type: "trouble" }>): void {
    if (uri !== this.shownUri) this.forget();
    if (uri !== this.namedUri) this.toolbar.setEnvironments([], null);
    const hasPicture = this.model !== undefined;
    this.root.dataset.state = hasPicture ? "stale" : "empty";
    this.toolbar.setTrouble(sentence, hasPicture, remedy);
  }

  /** Another program is meant: what is shown is none of it. */
  private forget(): void {
    this.model = undefined;
    this.shownUri = undefined;
    this.driven = undefined;
    this.pointed = undefined;
    this.chosen = undefined;
    this.tooltip.hide();
    this.playback.end();
    this.root.dataset.environment = "";
    this.root.dataset.driven = "";
    this.takeIn(true);
  }

  private showDriven({ uri, environment, driven, isNew }: Extract<ToPage, { type: "driven" }>): void {
    this.driven = driven ? drivenOf(driven) : undefined;
    this.drivenOf = nameOf(uri, environment);
    if (isNew && this.playback.isPlaying) this.playback.end();
    this.root.dataset.driven = driven ? driven.environment : "";
    this.takeIn(false);
  }

  /** What is shown is something else: all that depends on it. */
  private takeIn(isOther: boolean): void {
    const { model } = this;
    const driven = this.shownRun;
    this.findCursor();
    this.playback.setDuration(Math.max(model?.duration ?? 0, driven?.duration ?? 0));
    this.controls.setPath(this.playback, model?.crashes ?? [], model?.isWhole !== false || driven !== undefined);
    this.legend.show(this.content);
    this.surface.setAttribute("aria-label", model ? this.summary(model) : "No path yet");
    if (this.isFitted && model) {
      const bounds = boundsOf(model, driven);
      if (isOther || !this.stage.view.suits(bounds)) this.stage.view.fit(bounds);
    }
    this.draw();
  }

  //// What somebody does ////

  private listen(): void {
    watchPointer(this.surface, {
      pan: (dx, dy) => this.pan(dx, dy),
      zoom: (factor, px, py) => this.zoom(factor, px, py),
      point: (px, py) => this.point(px, py),
      leave: () => this.leave(),
      click: (px, py) => this.reveal(this.hit(px, py)),
      fit: () => this.fit(),
    });
    window.addEventListener("keydown", (event) => {
      const command = commandOf(event, focusOf(event.target));
      if (!command) return;
      event.preventDefault();
      this.obey(command);
    });
    new ResizeObserver(() => this.resize()).observe(this.surface);
    watchTheme(() => {
      this.theme = readTheme(document.body);
      this.draw();
    });
  }

  private obey(command: Command): void {
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
        this.choose(command.direction);
        break;
      case "reveal":
        this.reveal(this.chosen);
        break;
      case "zoom":
        this.zoom(command.factor);
        break;
      case "pan":
        this.pan(command.x, command.y);
        break;
      case "fit":
        this.fit();
        break;
      case "export":
        this.outside.say({ type: "export" });
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
    this.remember({ time: this.playback.time });
  }

  private toggle(): void {
    this.playback.toggle();
    this.showTime();
    this.lastFrame = undefined;
    if (this.playback.isPlaying) requestAnimationFrame((now) => this.frame(now));
    else this.remember({ time: this.playback.time });
  }

  private frame(now: number): void {
    const seconds = this.lastFrame === undefined ? 0 : (now - this.lastFrame) / 1000;
    this.lastFrame = now;
    if (this.playback.advance(seconds, this.calm.matches)) this.showTime();
    if (this.playback.isPlaying) requestAnimationFrame((next) => this.frame(next));
  }

  private setSpeed(speed: number): void {
    this.playback.chosenSpeed = speed;
    this.remember({ speed });
  }

  private hide(robot: string, isHidden: boolean): void {
    if (isHidden) this.hidden.add(robot);
    else this.hidden.delete(robot);
    this.remember({ hidden: [...this.hidden] });
    this.findCursor();
    this.draw();
  }

  private showRun(isShown: boolean): void {
    this.isRunShown = isShown;
    this.takeIn(false);
  }

  private goTo(crash: Crash): void {
    if (crash.t !== null) this.seek(crash.t);
    if (crash.action) this.outside.say({ type: "reveal", action: numbered(crash.action) });
  }

  private reveal(hit: Hit | undefined): void {
    if (!hit) return;
    this.outside.say({ type: "reveal", action: numbered(hit.leg.action) });
  }

  /** Goes to the next or the one before of all actions that can be seen. */
  private choose(direction: 1 | -1): void {
    const all = this.seen.flatMap((robot) => robot.legs.map((leg) => ({ robot, leg })));
    if (all.length === 0) return;
    const current = all.findIndex(({ leg }) => (this.chosen ? leg === this.chosen.leg : isOf(leg, this.cursor)));
    const next = current < 0 ? (direction > 0 ? 0 : all.length - 1) : (current + direction + all.length) % all.length;
    const chosen = all[next];
    if (!chosen) return;
    this.chosen = chosen;
    this.spoken.textContent = describe(chosen).join(", ");
    this.placeTooltip(chosen);
    this.drawMoving();
  }

  private point(px: number, py: number): void {
    const hit = this.hit(px, py);
    this.surface.classList.toggle("pointing", hit !== undefined);
    if (hit) this.tooltip.show(hit, px, py, this.stage.view.width, this.stage.view.height);
    else this.tooltip.hide();
    if (hit?.leg === this.pointed?.leg) return;
    this.pointed = hit;
    this.drawMoving();
  }

  private leave(): void {
    this.tooltip.hide();
    if (!this.pointed) return;
    this.pointed = undefined;
    this.drawMoving();
  }

  private zoom(factor: number, px?: number, py?: number): void {
    this.stage.view.zoom(factor, px, py);
    this.moved();
  }

  private pan(dx: number, dy: number): void {
    this.stage.view.pan(dx, dy);
    this.moved();
  }

  private moved(): void {
    this.isFitted = false;
    this.tooltip.hide();
    // Many of these may come before the next picture is shown.
    if (this.awaitsStill) return;
    this.awaitsStill = true;
    requestAnimationFrame(() => {
      this.awaitsStill = false;
      this.draw();
    });
  }

  private fit(): void {
    this.isFitted = true;
    if (this.model) this.stage.view.fit(boundsOf(this.model, this.shownRun));
    this.draw();
  }

  private resize(): void {
    this.stage.resize();
    if (this.isFitted && this.model) this.stage.view.fit(boundsOf(this.model, this.shownRun));
    this.draw();
  }

  //// What is shown ////

  private get shownRun(): Driven | undefined {
    return this.isRunShown ? this.driven : undefined;
  }

  private get seen(): Model["robots"] {
    return this.model?.robots.filter(({ name }) => !this.hidden.has(name)) ?? [];
  }

  private get content(): { model: Model | undefined; driven: Driven | undefined; isRunShown: boolean; hidden: ReadonlySet<string> } {
    return { model: this.model, driven: this.driven, isRunShown: this.isRunShown, hidden: this.hidden };
  }

  private hit(px: number, py: number): Hit | undefined {
    return hitTest(this.seen, this.stage.view, px, py);
  }

  private findCursor(): void {
    const of = (leg: Hit["leg"]): boolean => isOf(leg, this.cursor);
    this.atCursor = this.cursor === null ? [] : this.seen.flatMap((robot) => robot.legs.filter(of).map((leg) => ({ robot, leg })));
  }

  private scene(): Scene {
    const highlights = [...(this.chosen ? [] : this.atCursor), ...[this.chosen, this.pointed].filter((hit) => hit !== undefined)];
    this.root.dataset.highlighted = highlights.map(({ leg: { action } }) => `${action.movement} ${action.index}`).join(", ");
    return { model: this.model, driven: this.shownRun, hidden: this.hidden, highlights, time: this.playback.time };
  }

  private draw(): void {
    const { scale } = this.stage.view;
    const metres = niceStep(36 / scale);
    this.toolbar.setScale(metres * scale, format.length(metres));
    this.stage.drawStill(this.scene(), this.theme);
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

  private placeTooltip(hit: Hit): void {
    const { view } = this.stage;
    this.tooltip.show(hit, view.toX(hit.leg.to.x), view.toY(hit.leg.to.y), view.width, view.height);
  }

  private summary(model: Model): string {
    const robots = model.robots.length === 1 ? "1 robot" : `${model.robots.length} robots`;
    const crashes = model.crashes.length === 0 ? "" : `, ${model.crashes.length === 1 ? "1 collision" : `${model.crashes.length} collisions`}`;
    const time = model.isWhole ? `, ${format.time(model.duration)}` : ", of unknown duration";
    return `Planned path of ${model.environment}: ${robots}${time}${crashes}. Press ? for the keys.`;
  }

  private remember(news: PageState): void {
    Object.assign(this.state, news);
    this.outside.keep(this.state);
  }
}

function nameOf(uri: string, environment: string): string {
  return `${environment} ${uri}`;
}

function numbered({ movement, index }: NumberedAction): NumberedAction {
  return { movement, index };
}

function focusOf(target: EventTarget | null): string {
  if (target instanceof HTMLInputElement && target.type === "checkbox") return "CHECKBOX";
  return target instanceof HTMLElement ? target.tagName : "";
}
