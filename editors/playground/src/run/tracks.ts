// The paths that robots drove, from the lines of a trace as they are written.
import type { DrivenRobot } from "../../../preview/host/protocol";

type Pose = DrivenRobot["poses"][number];

/** Poses closer than this to the last one kept, in metres and radians, are dropped: a picture shows far less. */
const FINENESS = 0.005;

class Track {
  private readonly kept: Pose[] = [];
  /** The latest pose, if it is not kept. */
  private latest: Pose | undefined;

  add(pose: Pose): void {
    const last = this.kept.at(-1);
    if (last && isNear(last, pose)) {
      this.latest = pose;
      return;
    }
    // Where a rest ends.
    if (this.latest) this.kept.push(this.latest);
    this.latest = undefined;
    this.kept.push(pose);
  }

  get poses(): Pose[] {
    return this.latest ? [...this.kept, this.latest] : [...this.kept];
  }
}

function isNear(a: Pose, b: Pose): boolean {
  return Math.hypot(a.x - b.x, a.y - b.y) < FINENESS && Math.abs(a.theta - b.theta) < FINENESS;
}

export class Tracks {
  private readonly tracks = new Map<string, Track>();
  private rest = "";
  /** Of the latest line, seconds. */
  time = 0;

  /** Reads what was appended to the trace; a line may come in parts. */
  read(text: string): void {
    const lines = (this.rest + text).split("\n");
    this.rest = lines.pop() ?? "";
    for (const line of lines) this.add(JSON.parse(line) as Pose & { robot: string });
  }

  /** The paths so far, with the maps in the text of a map file. */
  robots(map: string | null): DrivenRobot[] {
    const found = map === null ? undefined : (JSON.parse(map) as MapFile);
    return [...this.tracks].map(([name, track]) => ({ name, poses: track.poses, map: mapOf(found, name) }));
  }

  private add({ robot, t, x, y, theta }: Pose & { robot: string }): void {
    const track = this.tracks.get(robot) ?? new Track();
    this.tracks.set(robot, track);
    track.add({ t, x, y, theta });
    this.time = Math.max(this.time, t);
  }
}

/** A map file; its edges name nodes by their index. */
interface MapFile {
  nodes: { robot: string; x: number; y: number }[];
  edges: { from: number; to: number }[];
}

function mapOf(file: MapFile | undefined, robot: string): DrivenRobot["map"] {
  const point = (index: number): [number, number] | undefined => {
    const node = file?.nodes[index];
    return node?.robot === robot ? [node.x, node.y] : undefined;
  };
  const nodes = file?.nodes.flatMap((_, index) => [point(index)].filter((found) => found !== undefined)) ?? [];
  const edges = (file?.edges ?? []).flatMap(({ from, to }): [[number, number], [number, number]][] => {
    const [start, end] = [point(from), point(to)];
    return start && end ? [[start, end]] : [];
  });
  return { nodes, edges };
}
