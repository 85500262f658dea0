// The server's messages about paths. docs/protocol.md repeats these types, and samples from the server's own tests hold
// them (tests). Lengths are in metres, angles in radians counter-clockwise, times in seconds from the start.

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
  /** Planned collisions, earliest first; paths continue as if there were none. */
  collisions: PlannedCollision[];
}

export interface PlannedRobot {
  name: string;
  /** Along and across its heading. */
  body: { length: number; width: number };
  sensors: SensorCone[];
  /** The start pose, then several for each action. */
  poses: PlannedPose[];
  /** The actions it performs, in order: a movement may be listed twice, which poses do not show. */
  legs: PlannedLeg[];
  /** The action after which the poses are unknown. */
  unknownAfter: PlannedAction | null;
  /** What it may do from there, as far as that has a bound: an action up to its bound, or each branch of an `if`. */
  possible?: PossibleWay[];
}

/** A way that a robot may take where its path becomes unknown; collisions are not looked for on it. */
export interface PossibleWay {
  /** The last known pose, then several for each action; times are the latest. */
  poses: PlannedPose[];
  /** The actions, in order, up to one that has no bound; `last` is an index of these poses. */
  legs: PlannedLeg[];
}

/** A sensor's pose on its robot and its field of view: how far it sees, and how wide. */
export interface SensorCone {
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
  /** Absolute. */
  x: number;
  y: number;
  theta: number;
  /** The action that leads to it; null for the start. */
  action: PlannedAction | null;
}

/** The part of a path that one action drives. */
export interface PlannedLeg {
  action: PlannedAction;
  /** Null after an action of unknown duration. */
  start: number | null;
  duration: number;
  /** The index of its last pose in `poses`; its first is the last of the leg before. */
  last: number;
}

/** An action by its index in its movement. */
export interface NumberedAction {
  /** The movement that the environment lists. */
  movement: string;
  /** From 0, among the statements of the movement, those with blocks included; of the last one that is done, if there are calls. */
  index: number;
  /** The statements that lead to it by `do`, outermost first. */
  calls?: PlannedCall[];
}

/** A statement that does another movement. */
export interface PlannedCall {
  /** The movement that the statement is in. */
  movement: string;
  /** From 0. */
  index: number;
}

export interface PlannedAction extends NumberedAction {
  /** As the program writes it, on one line. */
  text: string;
  /** The rounds of the loops around it, from 1, outermost first. */
  rounds?: number[];
  /** How many rounds each of these loops has. */
  counts?: number[];
  /** The movement whose statement it is, if that is one that others do. */
  done?: string;
}

/** An obstacle seen from above; one that moves, where it is at the start. */
export type Obstacle = { name: string; path?: ObstaclePath } & ({ centre: [number, number]; radius: number } | { corners: [number, number][] });

/** How an obstacle moves: straight between points, each at a constant speed; its heading stays. */
export interface ObstaclePath {
  /** Time, x and y of each, earliest first. Before the first one it is there, after the last one it stays. */
  points: [number, number, number][];
  /** Whether it goes there and back instead, again and again. */
  repeat: boolean;
}

export interface PlannedCollision {
  robot: string;
  /** What it is doing. */
  action: PlannedAction | null;
  /** When, and where it is then. */
  t: number | null;
  x: number;
  y: number;
  theta: number;
  /** What it meets, by its name. */
  with: { obstacle: string } | { robot: string };
}

/** A statement at a position, by its index in its movement. */
export interface ActionAt {
  movement: string;
  /** From 0, among the statements of the movement, those with blocks included. */
  index: number;
  /** The index of the last statement in its blocks, if there are any. */
  last?: number;
}

/** What a position in a program refers to. */
export interface PlannedAt {
  /** The program's environments, in order. */
  environments: string[];
  /** Those that are declared there or use, directly or through others, the declaration at the position. */
  using: string[];
  /** The action there; it includes the space beside it on its line. */
  action: ActionAt | null;
  /** The program's URI, if the position is in the scene of one of its environments. */
  program?: string;
}

/** The `data` of the error that says why there is no path, where the user can do something about it. */
export interface ErrorData {
  /** Where the first error is. */
  location?: Location | null;
  /** The title of the code action there that fixes it. */
  fix?: string;
}

/** The path of the latest run. */
export interface DrivenPath {
  environment: string;
  robots: DrivenRobot[];
  /** What was planned when the run began. */
  planned: PlannedPath | null;
}

export interface DrivenRobot {
  name: string;
  /** Those at least 5 mm or 5 mrad from the one before, the ends of rests, and the last. */
  poses: { t: number; x: number; y: number; theta: number }[];
  /** The map that the robot built with `slam`. */
  map: { nodes: [number, number][]; edges: [[number, number], [number, number]][] };
}
