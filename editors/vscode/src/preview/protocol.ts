// The server's messages about paths, as described in docs/protocol.md. Lengths are in metres, angles in radians
// counter-clockwise, times in seconds.

export const PLANNED_PATH = "pydslrep/plannedPath";
export const PLANNED_PATH_CHANGED = "pydslrep/plannedPathChanged";
export const PLANNED_AT = "pydslrep/plannedAt";
export const ACTION_LOCATION = "pydslrep/actionLocation";
export const DRIVEN_PATH = "pydslrep/drivenPath";
export const DRIVEN_PATH_CHANGED = "pydslrep/drivenPathChanged";

export interface Position {
  line: number;
  character: number;
}

export interface Location {
  uri: string;
  range: { start: Position; end: Position };
}

/** An environment of a program: the argument of the server's commands. */
export interface EnvironmentId {
  uri: string;
  environment: string;
}

/** The environment as a key of a map. */
export function keyOf({ uri, environment }: EnvironmentId): string {
  return `${environment} ${uri}`;
}

export interface PlannedPath {
  environment: string;
  /** When the last movement ends; null if that is unknown. */
  duration: number | null;
  robots: PlannedRobot[];
  obstacles: Obstacle[];
  collisions: Collision[];
}

export interface PlannedRobot {
  name: string;
  body: { length: number; width: number };
  sensors: Sensor[];
  /** The first is the start. */
  poses: PlannedPose[];
  legs: PlannedLeg[];
  /** The action after which the poses are unknown. */
  unknownAfter: PlannedAction | null;
}

/** A sensor's pose on its robot and its field of view. */
export interface Sensor {
  name: string;
  x: number;
  y: number;
  theta: number;
  range: number;
  cone: number;
}

export interface PlannedPose {
  /** Null after an action of unknown duration. */
  t: number | null;
  x: number;
  y: number;
  theta: number;
}

/** The part of a path that one action drives. */
export interface PlannedLeg {
  action: PlannedAction;
  start: number | null;
  duration: number;
  /** The index of its last pose; its first is the last of the leg before. */
  last: number;
}

/** An action by its index in its movement. */
export interface NumberedAction {
  movement: string;
  index: number;
}

export interface PlannedAction extends NumberedAction {
  text: string;
}

export type Obstacle =
  | { name: string; centre: [number, number]; radius: number }
  | { name: string; corners: [number, number][] };

export interface Collision {
  robot: string;
  action: PlannedAction | null;
  t: number | null;
  x: number;
  y: number;
  theta: number;
  with: { obstacle: string } | { robot: string };
}

/** What a position in a program refers to. */
export interface PlannedAt {
  environments: string[];
  /** Those that use the declaration at the position. */
  using: string[];
  action: NumberedAction | null;
}

/** The path of the latest run. */
export interface DrivenPath {
  environment: string;
  robots: DrivenRobot[];
}

export interface DrivenRobot {
  name: string;
  poses: { t: number; x: number; y: number; theta: number }[];
  /** The map that the robot built with `slam`. */
  map: { nodes: [number, number][]; edges: [[number, number], [number, number]][] };
}
