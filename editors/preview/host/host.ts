// What every host of the page does, whichever editor it is: answers the page's messages and passes on those of the server.
import { Follower, type Request } from "./follower";
import { LatestRun } from "./latest_run";
import { fromPage, type Result, type Suggestion, type ToPage } from "./messages";
import { DRIVEN_PATH_CHANGED, type EnvironmentId, keyOf, type Location, type NumberedAction, PLANNED_PATH_CHANGED } from "./protocol";

/** What a host does in its own way. */
export interface Actions {
  /** Shows an action in the editor. */
  reveal: (location: Location) => void;
  /** The user accepted what was suggested about a problem of a program. */
  accept: (suggestion: Suggestion, program: string) => void;
  export: () => void;
  /** Applies the code action of this title at a location; where there is none, no fix is offered. */
  fix?: (location: Location, title: string) => void;
  /** Runs the shown environment; where there is none, there is no button. */
  run?: (environment: EnvironmentId) => void;
}

/** A button of a run's result. */
export interface Button {
  label: string;
  press: () => unknown;
}

export class PreviewHost {
  readonly follower: Follower;
  private buttons: readonly Button[] = [];
  private readonly run = new LatestRun();
  /** The result that the page shows. */
  private result: Result | null = null;
  /** Resolves the pending capture. */
  private captured: ((png: string) => void) | undefined;

  constructor(
    request: Request,
    private readonly post: (message: ToPage) => void,
    private readonly actions: Actions,
  ) {
    this.follower = new Follower(request, (message) => this.show(message));
  }

  /** The server's notification; others than those about paths are ignored. */
  async notified(method: string, id: EnvironmentId): Promise<void> {
    if (method === PLANNED_PATH_CHANGED) await this.follower.pathChanged(id);
    else if (method === DRIVEN_PATH_CHANGED) await this.follower.drivenChanged(id);
  }

  /** A message from the page; invalid ones are ignored. */
  async received(data: unknown): Promise<void> {
    const message = fromPage(data);
    switch (message?.type) {
      case "ready":
        if (this.result) this.post({ type: "result", result: this.result });
        await this.follower.resend();
        break;
      case "place": {
        const location = this.follower.problem?.location;
        if (location) this.actions.reveal(location);
        break;
      }
      case "fix": {
        const { location, fix } = this.follower.problem ?? {};
        if (location && fix !== undefined) this.actions.fix?.(location, fix);
        break;
      }
      case "run":
        if (this.follower.shown) this.actions.run?.(this.follower.shown);
        break;
      case "press":
        await this.buttons[message.button]?.press();
        break;
      case "select":
        await this.follower.select(message.environment);
        break;
      case "reveal":
        await this.reveal(message.action);
        break;
      case "accept":
        if (this.follower.program !== undefined) this.actions.accept(message.suggestion, this.follower.program);
        break;
      case "export":
        this.actions.export();
        break;
      case "captured":
        this.captured?.(message.png);
        break;
    }
  }

  /** Shows how a run of an environment ended, until the next one starts. */
  setResult(environment: EnvironmentId, message: string, isError: boolean, buttons: readonly Button[]): void {
    this.buttons = buttons;
    this.run.end(keyOf(environment), { message, isError, buttons: buttons.map(({ label }) => label) });
    this.showResult();
  }

  /** A run of an environment starts. */
  clearResult(environment: EnvironmentId): void {
    this.buttons = [];
    this.run.begin(keyOf(environment));
    this.showResult();
  }

  /** Whether the latest run of the shown environment was one of another plan than that in the picture. */
  get isRunEarlier(): boolean {
    return this.run.isDrivenEarlier;
  }

  /** Whether the program has changed since the latest run of the shown environment. */
  get hasChangedSinceRun(): boolean {
    return this.run.hasChanged;
  }

  private show(message: ToPage): void {
    const { shown } = this.follower;
    this.run.follow(message, shown && keyOf(shown));
    if (message.type === "environments" && this.actions.run) this.post({ ...message, canRun: true });
    else if (message.type === "problem" && !this.actions.fix) this.post(withoutFix(message));
    else if (message.type === "path" || message.type === "driven") this.post({ ...message, isRunEarlier: this.isRunEarlier });
    else this.post(message);
    this.showResult();
  }

  private showResult(): void {
    const { result } = this.run;
    if (JSON.stringify(result) === JSON.stringify(this.result)) return;
    this.result = result;
    this.post({ type: "result", result });
  }

  /** The page's picture as a data URI. */
  capture(): Promise<string> {
    return new Promise((resolve) => {
      this.captured = resolve;
      this.post({ type: "capture" });
    });
  }

  private async reveal(action: NumberedAction): Promise<void> {
    const location = await this.follower.locate(action);
    if (location) this.actions.reveal(location);
  }
}

function withoutFix(problem: Extract<ToPage, { type: "problem" }>): ToPage {
  const { fix, ...rest } = problem;
  return fix === undefined ? problem : rest;
}
