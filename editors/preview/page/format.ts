// Formats numbers for people.
import type { Pose } from "./time";

/** A number with fixed decimals and no minus sign before zero; the sign is the hyphen that hints and scripts use. */
export function fixed(value: number, decimals: number): string {
  const digits = Math.abs(value).toFixed(decimals);
  return value < 0 && Number(digits) !== 0 ? `-${digits}` : digits;
}

/** The value of a grid line, with as many decimals as the step needs. */
export function tickLabel(tick: number, step: number): string {
  return fixed(tick, Math.min(Math.max(Math.ceil(-Math.log10(step) - 1e-9), 0), 9));
}

/** A length in centimetres, or in metres if it is long. */
export function length(metres: number): string {
  return metres < 1 ? `${fixed(metres * 100, metres < 0.01 ? 1 : 0)} cm` : `${fixed(metres, metres % 1 === 0 ? 0 : 1)} m`;
}

/** A duration in seconds, or in minutes and seconds. */
export function duration(seconds: number): string {
  const tenths = Math.round(seconds * 10);
  if (tenths < 600) return `${(tenths / 10).toFixed(1)} s`;
  const rest = (tenths % 600) / 10;
  return `${Math.floor(tenths / 600)} min ${rest.toFixed(rest % 1 === 0 && tenths >= 6000 ? 0 : 1)} s`;
}

/** Radians as degrees in (−180, 180]. */
export function degrees(theta: number): string {
  const turned = (((theta * 180) / Math.PI) % 360 + 360) % 360;
  const rounded = Math.round((turned > 180 ? turned - 360 : turned) * 10) / 10;
  return `${fixed(rounded === -180 ? 180 : rounded, Number.isInteger(rounded) ? 0 : 1)}°`;
}

export function pose({ x, y, theta }: Pose): string {
  return `(${fixed(x, 2)}, ${fixed(y, 2)}) m, ${degrees(theta)}`;
}

/** A distance in millimetres, or in metres if it is long. */
export function smallDistance(metres: number): string {
  return metres < 0.1 ? `${fixed(metres * 1000, 1)} mm` : `${fixed(metres, 2)} m`;
}
