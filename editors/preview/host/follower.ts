// Decides which environment the preview shows as the text and the cursor change, and requests its path.
import type { Suggestion, ToPage } from "./messages";
import {
  ACTION_LOCATION,
  DRIVEN_PATH,
  PLANNED_AT,
  PLANNED_PATH,
  type ActionAt,
  type DrivenPath,
  type EnvironmentId,
  type ErrorData,
  type Location,
  type NumberedAction,
  type PlannedAt,
  type PlannedPath,
  type Position,
} from "./protocol";

/** Sends a request to the server; rejects with an error whose message is shown. */
export type Request = (method: string, params: object, signal: AbortSignal) => Promise<unknown>;

export class Follower {
  private uri: string | undefined;
  private environment: string | undefined;
  private environments: string[] = [];
  private action: ActionAt | null = null;
  /** Whether the path of the shown environment, or why there is none, was requested. */
  private isPathRequested = false;
  /** Whether the server has named the program's environments. */
  private areEnvironmentsKnown = false;
  private latestProblem: ErrorData | undefined;
  /** The latest request of each kind; a newer one cancels it. */
  private readonly pending = new Map<string, AbortController>();

  constructor(
    private readonly sendRequest: Request,
    private readonly show: (message: ToPage) => void,
  ) {}

  /** What can be done about the problem that is shown, if one is. */
  get problem(): ErrorData | undefined {
    return this.latestProblem;
  }

  /** The URI of the shown program. */
  get program(): string | undefined {
    return this.uri;
  }

  /** The shown environment. */
  get shown(): EnvironmentId | undefined {
    const { uri, environment } = this;
    return uri === undefined || environment === undefined ? undefined : { uri, environment };
  }

  /** Shows a program with the given environment, or else the one at the position. */
  async follow(uri: string, position: Position, environment?: string): Promise<void> {
    if (uri !== this.uri) {
      this.uri = uri;
      this.environment = environment;
      this.environments = [];
      this.areEnvironmentsKnown = false;
      this.isPathRequested = false;
      await this.update(position);
    } else if (environment !== undefined && environment !== this.environment) {
      this.environment = environment;
      this.isPathRequested = false;
      // So that the page is told which one is shown.
      this.environments = [];
      await this.update(position);
    } else {
      await this.update(position, true);
    }
  }

  /** Shows the environment whose scene this is. */
  async followScene(uri: string): Promise<void> {
    const found = await this.request("scene", PLANNED_AT, { textDocument: { uri }, position: { line: 0, character: 0 } });
    if (!isPlannedAt(found) || found.program === undefined) return;
    const { program, environments } = found;
    if (program === this.uri && environments[0] === this.environment) return;
    await this.follow(program, { line: 0, character: 0 }, environments[0]);
  }

  /** Call this when the text or the cursor changes. Only `maySwitch` allows another environment to be shown. */
  async update(position: Position, maySwitch = false): Promise<void> {
    const uri = this.uri;
    if (uri === undefined) return;
    const found = (await this.request("at", PLANNED_AT, { textDocument: { uri }, position })) as
      | PlannedAt
      | Failure
      | null
      | undefined;
    if (found === undefined || uri !== this.uri) return;
    if (found === null || found instanceof Failure) {
      this.showProblem(found?.message ?? "The program is not open in the editor.");
      return;
    }
    this.areEnvironmentsKnown = true;
    const before = this.environment;
    this.environment = this.choose(found, maySwitch);
    const list = JSON.stringify([found.environments, this.environment]);
    if (list !== JSON.stringify([this.environments, before]) || this.environments.length === 0) {
      this.environments = found.environments;
      this.showEnvironments();
    }
    if (JSON.stringify(found.action) !== JSON.stringify(this.action)) {
      this.action = found.action;
      this.show({ type: "cursor", action: found.action });
    }
    if (this.environment === undefined) {
      this.isPathRequested = false;
      this.showNoEnvironment();
    } else if (this.environment !== before || !this.isPathRequested) {
      await this.requestPaths();
    }
  }

  /** The shown environment stays while it uses what is at the cursor. */
  private choose(found: PlannedAt, maySwitch: boolean): string | undefined {
    const current = this.environment;
    const exists = current !== undefined && found.environments.includes(current);
    if (exists && (!maySwitch || found.using.length === 0 || found.using.includes(current))) return current;
    return found.using[0] ?? (exists ? current : found.environments[0]);
  }

  /** The user selected an environment. */
  async select(environment: string): Promise<void> {
    if (environment === this.environment) return;
    this.environment = environment;
    this.showEnvironments();
    await this.requestPaths();
  }

  /** The server reports that a planned path changed. */
  async pathChanged(id: EnvironmentId): Promise<void> {
    if (this.isShown(id)) await this.requestPlanned(id);
  }

  /** The server reports that a run has ended. */
  async drivenChanged(id: EnvironmentId): Promise<void> {
    if (this.isShown(id)) await this.requestDriven(id, true);
  }

  /** Sends everything again, to a page that was just loaded. */
  async resend(): Promise<void> {
    this.isPathRequested = false;
    if (this.uri === undefined) {
      this.showProblem("Open a program (a .pyr file) to see its planned path.");
      return;
    }
    this.showEnvironments();
    this.show({ type: "cursor", action: this.action });
    if (this.environment !== undefined) await this.requestPaths();
    else if (this.areEnvironmentsKnown) this.showNoEnvironment();
  }

  /** The location of an action of the shown environment. */
  async locate(action: NumberedAction): Promise<Location | undefined> {
    const { uri, environment } = this;
    if (uri === undefined || environment === undefined) return undefined;
    const { movement, index, calls } = action;
    const params = { uri, environment, movement, index, ...(calls ? { calls } : {}) };
    const found = await this.request("location", ACTION_LOCATION, params);
    return found === null || found instanceof Failure ? undefined : (found as Location | undefined);
  }

  private isShown(id: EnvironmentId): boolean {
    return id.uri === this.uri && id.environment === this.environment;
  }

  private showEnvironments(): void {
    if (this.uri === undefined) return;
    this.show({ type: "environments", uri: this.uri, names: this.environments, shown: this.environment ?? null });
  }

  private async requestPaths(): Promise<void> {
    const { shown } = this;
    if (shown === undefined) return;
    this.isPathRequested = true;
    await Promise.all([this.requestPlanned(shown), this.requestDriven(shown)]);
  }

  private async requestPlanned(id: EnvironmentId): Promise<void> {
    const path = await this.request("planned", PLANNED_PATH, id);
    if (path === undefined || !this.isShown(id)) return;
    if (path instanceof Failure) {
      this.showProblem(path.message, undefined, path.data);
      return;
    }
    this.latestProblem = undefined;
    this.show({ type: "path", uri: id.uri, path: path as PlannedPath });
  }

  private async requestDriven(id: EnvironmentId, isNew = false): Promise<void> {
    const driven = await this.request("driven", DRIVEN_PATH, id);
    if (driven === undefined || driven instanceof Failure || !this.isShown(id)) return;
    this.show({ type: "driven", ...id, driven: driven as DrivenPath | null, isNew });
  }

  private showNoEnvironment(): void {
    this.showProblem("The program has no environment yet. Add one to see the path.", "addEnvironment");
  }

  private showProblem(message: string, suggestion?: Suggestion, data: ErrorData = {}): void {
    this.latestProblem = data;
    const { location, fix } = data;
    this.show({
      type: "problem",
      uri: this.uri ?? null,
      message,
      ...(suggestion ? { suggestion } : {}),
      ...(location ? { place: this.placeOf(location) } : {}),
      ...(location && fix !== undefined ? { fix } : {}),
    });
  }

  private placeOf({ uri, range }: Location): string {
    const line = `line ${range.start.line + 1}`;
    return uri === this.uri ? line : `${decodeURIComponent(uri.slice(uri.lastIndexOf("/") + 1))}, ${line}`;
  }

  /** The response; undefined if a newer request of the same kind has been sent. */
  private async request(kind: string, method: string, params: object): Promise<unknown> {
    this.pending.get(kind)?.abort();
    const controller = new AbortController();
    this.pending.set(kind, controller);
    try {
      const answer = await this.sendRequest(method, params, controller.signal);
      return controller.signal.aborted ? undefined : answer;
    } catch (error) {
      return controller.signal.aborted ? undefined : new Failure(error);
    }
  }
}

/** A request that was rejected. */
class Failure {
  readonly message: string;
  readonly data: ErrorData;

  constructor(error: unknown) {
    this.message = error instanceof Error ? error.message : String(error);
    const data: unknown = error instanceof Error && "data" in error ? error.data : undefined;
    this.data = typeof data === "object" && data !== null ? data : {};
  }
}

function isPlannedAt(found: unknown): found is PlannedAt {
  return typeof found === "object" && found !== null && !(found instanceof Failure);
}
