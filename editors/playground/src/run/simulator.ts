// The simulator of a run: a world made of the project's files, and what it answers to the script's client.
import initialize, { Simulator } from "virtual:pydslrep";

import type { WorldFiles } from "./messages";

/** A reply, and the connection that it is for. */
export type Reply = [connection: number, message: Uint8Array];

export class Simulated {
  /** The connections whose requests are not answered yet, by ticket. */
  private readonly waiting = new Map<number, number>();
  private tickets = 0;

  private constructor(private readonly simulator: Simulator) {}

  static async start({ environment, program, files }: WorldFiles): Promise<Simulated> {
    await initialize({ module_or_path: new URL("pydslrep.wasm", self.location.href) });
    const path = (uri: string): string => decodeURIComponent(new URL(uri).pathname);
    const texts = Object.fromEntries(Object.entries(files).map(([uri, text]) => [path(uri), text]));
    return new Simulated(new Simulator(JSON.stringify({ environment, program: path(program), files: texts })));
  }

  /** Answers a request; others may be answered with it. */
  request(connection: number, message: Uint8Array): Reply[] {
    // A simulation that nobody steps goes on while its client looks.
    const earlier = this.simulator.isFreeRunning ? this.replies(this.simulator.tick()) : [];
    const ticket = this.tickets++;
    this.waiting.set(ticket, connection);
    return [...earlier, ...this.replies(this.simulator.request(connection, ticket, performance.now() / 1000, message))];
  }

  disconnect(connection: number): Reply[] {
    return this.replies(this.simulator.disconnect(connection));
  }

  /** Ends the simulation: nothing may be requested any more. */
  end(): void {
    this.simulator.free();
  }

  private replies(answers: [number, Uint8Array][]): Reply[] {
    return answers.flatMap(([ticket, message]): Reply[] => {
      const connection = this.waiting.get(ticket);
      this.waiting.delete(ticket);
      return connection === undefined ? [] : [[connection, message]];
    });
  }
}
