// The command line of a script, as `pydslrep run` has it.
import type { PlannedPath } from "../../../preview/host/protocol";

/** Options for what not every simulator can tell a script: the size of robots and the field of view of sensors. */
export function slamArguments({ robots }: PlannedPath): string[] {
  return robots.flatMap(({ name, body, sensors }) => [
    "--radius",
    `${name}=${Math.hypot(body.length, body.width) / 2}`,
    ...sensors.flatMap((sensor) => [
      "--range",
      `${name}.${sensor.name}=${sensor.range}`,
      "--cone",
      `${name}.${sensor.name}=${sensor.cone * (180 / Math.PI)}`,
    ]),
  ]);
}
