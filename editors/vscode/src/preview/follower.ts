// Follows the text: which environment is shown, and its path as it is now. Knows neither the editor nor the panel.
import type { Remedy, ToPage } from "./messages";
import {
  ACTION_LOCATION,
  DRIVEN_PATH,
  PLANNED_AT,
  PLANNED_PATH,
  type DrivenPath,
  type NumberedAction,
  type PlannedAt,
  type PlannedPath,
  type Which,
} from "./protocol";

/** Asks the server; rejects with an error whose message is for people. */
export type Ask = (method: string, params: object, signal: AbortSignal) => Promise<unknown>;

export interface Position {
  line: number;
  character: number;
}

/** A place in a file as the protocol has it. */
export interface Location {
  uri: string;
  range: { start: Position; end: Position };
}

export class Follower {
  private uri: string | undefined;
  private environment: string | undefined;
  private environments: string[] = [];
  private action: NumberedAction | null = null;
  /** Requests under way, by what they are about: a newer one of its kind cancels an older one. */
  private readonly asked = new Map<string, AbortController>();

  constructor(
    private readonly ask: Ask,
    private readonly show: (message: ToPage) => void,
  ) {}

  /** The program that is shown. */
  get program(): string | undefined {
    return this.uri;
  }

  /** The environment that is shown. */
  get which(): Which | undefined {
    const { uri, environment } = this;
    return uri === undefined || environment === undefined ? undefined : { uri, environment };
  }

  /** Shows a program, and in it the given environment, else the one at the position. */
  async follow(uri: string, at: Position, environment?: string): Promise<void> {
    if (uri !== this.uri) {
      this.uri = uri;
      this.environment = environment;
      this.environments = [];
      this.isAnswered = false;
      this.isShown = false;
      await this.look(at);
    } else if (environment !== undefined && environment !== this.environment) {
      this.environment = environment;
      await this.look(at);
    } else {
      await this.look(at, true);
    }
  }

  /** The cursor or the text has changed: the environment that is shown stays while the text at the cursor is part of it. */
  async look(at: Position, mayMove = false): Promise<void> {
    const uri = this.uri;
    if (uri === undefined) return;
    const found = (await this.request("at", PLANNED_AT, { textDocument: { uri }, position: at })) as
      | PlannedAt
      | Failure
      | null
      | undefined;
    if (found === undefined || uri !== this.uri) return;
    if (found === null || found instanceof Failure) {
      this.trouble(found?.message ?? "The program is not open in the editor.");
      return;
    }
    this.isAnswered = true;
    const before = this.environment;
    this.environment = this.choice(found, mayMove);
    const list = JSON.stringify([found.environments, this.environment]);
    if (list !== JSON.stringify([this.environments, before]) || this.environments.length === 0) {
      this.environments = found.environments;
      this.tellEnvironments();
    }
    if (JSON.stringify(found.action) !== JSON.stringify(this.action)) {
      this.action = found.action;
      this.show({ type: "cursor", action: found.action });
    }
    if (this.environment === undefined) {
      this.isShown = false;
      this.noEnvironment();
    } else if (this.environment !== before || !this.isShown) {
      await this.plan();
    }
  }

  /** Whether a path, or why there is none, was asked for the environment that is shown. */
  private isShown = false;

  /** Whether the server has told which environments there are. */
  private isAnswered = false;

  private choice(found: PlannedAt, mayMove: boolean): string | undefined {
    const current = this.environment;
    const exists = current !== undefined && found.environments.includes(current);
    if (exists && (!mayMove || found.using.length === 0 || found.using.includes(current))) return current;
    return found.using[0] ?? (exists ? current : found.environments[0]);
  }

  /** The person chose an environment. */
  async choose(environment: string): Promise<void> {
    if (environment === this.environment) return;
    this.environment = environment;
    this.tellEnvironments();
    await this.plan();
  }

  /** The server says that a path is no longer right. */
  async pathChanged(which: Which): Promise<void> {
    if (this.isThis(which)) await this.planned(which);
  }

  /** The server says that an environment was run. */
  async drivenChanged(which: Which): Promise<void> {
    if (this.isThis(which)) await this.driven(which, true);
  }

  /** Says everything again, to a page that knows nothing. */
  async again(): Promise<void> {
    this.isShown = false;
    if (this.uri === undefined) {
      this.trouble("Open a program (a file that ends in .pyr) to see its planned path.");
      return;
    }
    this.tellEnvironments();
    this.show({ type: "cursor", action: this.action });
    if (this.environment !== undefined) await this.plan();
    else if (this.isAnswered) this.noEnvironment();
  }

  /** Where an action of the shown environment stands. */
  async place(action: NumberedAction): Promise<Location | undefined> {
    const { uri, environment } = this;
    if (uri === undefined || environment === undefined) return undefined;
    const params = { uri, environment, movement: action.movement, index: action.index };
    const found = await this.request("place", ACTION_LOCATION, params);
    return found === null || found instanceof Failure ? undefined : (found as Location | undefined);
  }

  private isThis(which: Which): boolean {
    return which.uri === this.uri && which.environment === this.environment;
  }

  private tellEnvironments(): void {
    if (this.uri === undefined) return;
    this.show({ type: "environments", uri: this.uri, names: this.environments, shown: this.environment ?? null });
  }

  private async plan(): Promise<void> {
    const { uri, environment } = this;
    if (uri === undefined || environment === undefined) return;
    this.isShown = true;
    await Promise.all([this.planned({ uri, environment }), this.driven({ uri, environment })]);
  }

  private async planned(which: Which): Promise<void> {
    const path = await this.request("planned", PLANNED_PATH, which);
    if (path === undefined || !this.isThis(which)) return;
    if (path instanceof Failure) this.trouble(path.message);
    else this.show({ type: "path", uri: which.uri, path: path as PlannedPath });
  }

  private async driven(which: Which, isNew = false): Promise<void> {
    const driven = await this.request("driven", DRIVEN_PATH, which);
    if (driven === undefined || driven instanceof Failure || !this.isThis(which)) return;
    this.show({ type: "driven", ...which, driven: driven as DrivenPath | null, isNew });
  }

  private noEnvironment(): void {
    this.trouble("The program has no environment yet. Add one to see the path.", "addEnvironment");
  }

  private trouble(sentence: string, remedy?: Remedy): void {
    this.show({ type: "trouble", uri: this.uri ?? null, sentence, ...(remedy ? { remedy } : {}) });
  }

  /** The answer; undefined where a newer question of the same kind was asked meanwhile. */
  private async request(kind: string, method: string, params: object): Promise<unknown> {
    this.asked.get(kind)?.abort();
    const controller = new AbortController();
    this.asked.set(kind, controller);
    try {
      const answer = await this.ask(method, params, controller.signal);
      return controller.signal.aborted ? undefined : answer;
    } catch (error) {
      return controller.signal.aborted ? undefined : new Failure(error);
    }
  }
}

/** Why there is no answer, in words. */
class Failure {
  readonly message: string;

  constructor(error: unknown) {
    this.message = error instanceof Error ? error.message : String(error);
  }
}
