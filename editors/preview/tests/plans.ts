// Paths to test with.
import type { PlannedLeg, PlannedPath, PlannedPose } from "../host/protocol";

/** A robot that drives 2 m in 2 s, waits for a second, turns left in 1 s, and drives 1 m in 1 s. */
export function plan(): PlannedPath {
  const at = (t: number, x: number, y: number, theta: number): PlannedPose => ({ t, x, y, theta, action: null });
  const poses = [
    at(0, 0, 0, 0),
    at(1, 1, 0, 0),
    at(2, 2, 0, 0),
    at(3.5, 2, 0, Math.PI / 4),
    at(4, 2, 0, Math.PI / 2),
    at(4.5, 2, 0.5, Math.PI / 2),
    at(5, 2, 1, Math.PI / 2),
  ];
  const leg = (index: number, text: string, start: number, duration: number, last: number): PlannedLeg => ({
    action: { movement: "go", index, text },
    start,
    duration,
    last,
  });
  return {
    environment: "yard",
    duration: 5,
    robots: [
      {
        name: "rover",
        body: { length: 0.4, width: 0.3 },
        sensors: [],
        poses,
        legs: [leg(0, "move 2 meters", 0, 2, 2), leg(1, "turn left", 3, 1, 4), leg(2, "move 1 meters", 4, 1, 6)],
        unknownAfter: null,
      },
    ],
    obstacles: [
      { name: "pole", centre: [4, 1], radius: 0.5 },
      { name: "wall", corners: [[-1, -2], [3, -2], [3, -1.9]] },
    ],
    collisions: [
      { robot: "rover", action: null, t: 1, x: 1, y: 0, theta: 0, with: { obstacle: "pole" } },
      { robot: "stranger", action: null, t: 1, x: 1, y: 0, theta: 0, with: { robot: "rover" } },
    ],
  };
}

/**
 * A robot that drives 2 m in the first of four rounds and then, by what it sees, up to 3 m more, or turns and drives 3 m,
 * among obstacles that move.
 */
export function open(): PlannedPath {
  const at = (t: number, x: number, y: number, theta: number): PlannedPose => ({ t, x, y, theta, action: null });
  const leg = (index: number, text: string, start: number, duration: number, last: number): PlannedLeg => ({
    action: { movement: "go", index, text, rounds: [1], counts: [4] },
    start,
    duration,
    last,
  });
  const [rover] = plan().robots;
  if (!rover) throw new Error("there is one");
  return {
    ...plan(),
    duration: null,
    robots: [
      {
        ...rover,
        poses: [at(0, 0, 0, 0), at(2, 2, 0, 0)],
        legs: [leg(1, "move 2 meters", 0, 2, 1)],
        unknownAfter: { movement: "go", index: 2, text: "if { front } clear", rounds: [1], counts: [4] },
        possible: [
          { poses: [at(2, 2, 0, 0), at(5, 5, 0, 0)], legs: [leg(3, "move 3 meters until { front } detect", 2, 3, 1)] },
          {
            poses: [at(2, 2, 0, 0), at(3, 2, 0, Math.PI / 2), at(6, 2, 3, Math.PI / 2)],
            legs: [leg(4, "turn left", 2, 1, 1), leg(5, "move 3 meters", 3, 3, 2)],
          },
        ],
      },
    ],
    obstacles: [
      { name: "cart", corners: [[7, 0], [8, 0], [8, 1]], path: { points: [[2, 7, 0], [8, 8, 0]], repeat: false } },
      { name: "person", centre: [-1, 0], radius: 0.5, path: { points: [[1, -1, 0], [4, -1, 1.5]], repeat: true } },
    ],
    collisions: [],
  };
}

/** So many robots with so many legs each. */
export function large(robots: number, legs: number): PlannedPath {
  const [only] = plan().robots;
  if (!only) throw new Error("there is one");
  return {
    ...plan(),
    robots: Array.from({ length: robots }, (_, index) => ({
      ...only,
      name: `robot ${index}`,
      poses: Array.from({ length: 8 * legs + 1 }, (__, at) => ({ t: at / 8, x: at / 80, y: index, theta: 0, action: null })),
      legs: Array.from({ length: legs }, (__, at) => ({
        action: { movement: "go", index: at, text: "move 10 centimeters" },
        start: at,
        duration: 1,
        last: 8 * (at + 1),
      })),
    })),
  };
}
