// The path preview: a frame with the page that all editors share, and what it asks of the playground.
import type { Position } from "vscode-languageserver-protocol";

import { PreviewHost } from "../../preview/host/host";
import { PNG_PREFIX, type ToPage } from "../../preview/host/messages";
import {
  DRIVEN_PATH,
  DRIVEN_PATH_CHANGED,
  keyOf,
  PLANNED_PATH_CHANGED,
  type DrivenPath,
  type EnvironmentId,
  type Location,
} from "../../preview/host/protocol";
import type { Connection } from "./connection";
import type { Theme } from "./theme";

export interface PreviewEvents {
  reveal: (location: Location) => void;
  addEnvironment: () => void;
  /** Applies the code action of this title at a location. */
  fix: (location: Location, title: string) => void;
  /** Another environment is shown. */
  shown: (environment: EnvironmentId | undefined) => void;
  /** There is another path, or none because of a problem. */
  changed: () => void;
}

export class Preview {
  private readonly host: PreviewHost;
  private readonly driven = new Map<string, DrivenPath>();
  private theme: Theme = "light";

  constructor(
    private readonly frame: HTMLIFrameElement,
    connection: Connection,
    private readonly events: PreviewEvents,
  ) {
    this.host = new PreviewHost(
      // Scripts run here, not in the server.
      (method, params, signal) =>
        method === DRIVEN_PATH
          ? Promise.resolve(this.driven.get(keyOf(params as EnvironmentId)) ?? null)
          : connection.request(method, params, signal),
      (message) => this.post(message),
      {
        reveal: events.reveal,
        accept: events.addEnvironment,
        fix: events.fix,
        export: () => void this.download(),
      },
    );
    connection.on(PLANNED_PATH_CHANGED, (id: EnvironmentId) => void this.host.notified(PLANNED_PATH_CHANGED, id));
    window.addEventListener("message", ({ source, data }: MessageEvent<unknown>) => {
      if (source !== frame.contentWindow) return;
      this.setTheme(this.theme);
      void this.host.received(data);
    });
  }

  /** The environments of the shown program. */
  environments: readonly string[] = [];

  get shown(): EnvironmentId | undefined {
    return this.host.follower.shown;
  }

  async follow(uri: string, position: Position): Promise<void> {
    await this.host.follower.follow(uri, position);
  }

  /** Call this when the text or the cursor of the shown program changes. */
  async update(position: Position, isNew: boolean): Promise<void> {
    await this.host.follower.update(position, !isNew);
  }

  /** Whether the program has changed since the latest run of an environment, if that is shown. */
  hasChangedSinceRun(id: EnvironmentId): boolean {
    return this.shown !== undefined && keyOf(this.shown) === keyOf(id) && this.host.hasChangedSinceRun;
  }

  /** Shows the path of a run; it may go on. */
  async setDriven(id: EnvironmentId, driven: DrivenPath | undefined): Promise<void> {
    if (driven) this.driven.set(keyOf(id), driven);
    else this.driven.delete(keyOf(id));
    await this.host.notified(DRIVEN_PATH_CHANGED, id);
  }

  setTheme(theme: Theme): void {
    this.theme = theme;
    const page = this.frame.contentDocument;
    if (!page?.body || page.documentElement.dataset.colours === theme) return;
    page.documentElement.dataset.colours = theme;
    page.body.className = `vscode-${theme}`;
  }

  private post(message: ToPage): void {
    this.frame.contentWindow?.postMessage(message, location.origin);
    if (message.type === "environments") this.environments = message.names;
    if (message.type === "environments" || message.type === "problem") this.events.shown(this.shown);
    if (message.type === "path" || message.type === "problem") this.events.changed();
  }

  /** Offers the picture as PNG. */
  async download(): Promise<void> {
    const binary = atob((await this.host.capture()).slice(PNG_PREFIX.length));
    const bytes = Uint8Array.from(binary, (character) => character.charCodeAt(0));
    save(`${this.shown?.environment ?? "path"}.png`, new Blob([bytes], { type: "image/png" }));
  }
}

/** Offers a file to download. */
export function save(name: string, content: Blob): void {
  const link = document.createElement("a");
  link.download = name;
  link.href = URL.createObjectURL(content);
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}
