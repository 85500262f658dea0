// The result of a run in metres, radians and seconds. docs/protocol.md repeats these types.

export interface Figures {
  environment: string;
  /** Whether every movement was completed. */
  complete: boolean;
  /** Planned duration; null if it cannot be planned. */
  planned: number | null;
  /** Duration in simulation time and in wall time. */
  simulated: number;
  wall: number;
  robots: RobotFigures[];
}

export interface RobotFigures {
  name: string;
  /** Where it was to end; null if it cannot be planned. */
  planned: End | null;
  /** Where it ended; null if nothing was recorded. */
  driven: End | null;
  /** The difference of the two; null if the run is not complete. */
  off: { distance: number; angle: number } | null;
}

export interface End {
  x: number;
  y: number;
  theta: number;
}

/** The duration of a run in a sentence. */
export function summary({ environment, planned, simulated, wall }: Figures): string {
  const plan = planned === null ? "" : ` (planned: ${planned.toFixed(1)} s)`;
  const factor = wall > 0 ? simulated / wall : 0;
  const times = `${factor.toFixed(factor < 10 ? 1 : 0)} times real time`;
  return `${environment}: ${simulated.toFixed(1)} s${plan} simulated in ${wall.toFixed(1)} s, ${times}`;
}
