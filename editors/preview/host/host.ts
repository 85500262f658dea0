// What every host of the page does, whichever editor it is: answers the page's messages and passes on those of the server.
import { Follower, type Request } from "./follower";
import { fromPage, type Suggestion, type ToPage } from "./messages";
import { DRIVEN_PATH_CHANGED, type EnvironmentId, type Location, type NumberedAction, PLANNED_PATH_CHANGED } from "./protocol";

/** What a host does in its own way. */
export interface Actions {
  /** Shows an action in the editor. */
  reveal: (location: Location) => void;
  /** The user accepted what was suggested about a problem of a program. */
  accept: (suggestion: Suggestion, program: string) => void;
  export: () => void;
}

export class PreviewHost {
  readonly follower: Follower;
  /** Resolves the pending capture. */
  private captured: ((png: string) => void) | undefined;

  constructor(
    request: Request,
    private readonly post: (message: ToPage) => void,
    private readonly actions: Actions,
  ) {
    this.follower = new Follower(request, post);
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
        await this.follower.resend();
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
