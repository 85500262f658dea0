"""Drives four robots around a pillar at the same time in CoppeliaSim."""

import argparse
import math
from collections.abc import Generator
from typing import Any

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

SPEED = 0.15  # m/s
TURN_RATE = 0.6  # rad/s
DISTANCE_TOLERANCE = 0.002  # m
ANGLE_TOLERANCE = math.radians(0.2)
STALL_TIME = 5.0  # s

Action = Generator[None, None, None]


class RobotError(Exception):
    """The robot cannot do what it should."""


class Robot:
    """A robot with wheels on both sides, whose pose the simulator tells.

    Its actions are generators: each `yield` waits for the next step of the simulation, which all robots share.
    """

    def __init__(
        self, sim: Any, name: str, left: list[str], right: list[str], radius: float
    ) -> None:
        self.sim = sim
        self.name = name
        self.radius = radius
        self.body = sim.getObject(f"/{name}")
        self.left = [sim.getObject(f"/{name}/{wheel}") for wheel in left]
        self.right = [sim.getObject(f"/{name}/{wheel}") for wheel in right]
        self.track = math.dist(
            sim.getObjectPosition(self.left[0]), sim.getObjectPosition(self.right[0])
        )
        self.goal = self.pose()

    def pose(self) -> tuple[float, float, float]:
        x, y, _ = self.sim.getObjectPosition(self.body)
        _, _, heading = self.sim.getObjectOrientation(self.body)
        return x, y, heading

    def drive(self, speed: float, turn_rate: float) -> None:
        # Mecanum robots turn slower than this, which the feedback makes up for.
        half = turn_rate * self.track / 2
        for wheels, rim in ((self.left, speed - half), (self.right, speed + half)):
            for wheel in wheels:
                self.sim.setJointTargetVelocity(wheel, rim / self.radius)

    def move(self, distance: float) -> Action:
        """Drives from the last goal, so that errors do not add up."""
        x, y, heading = self.goal
        cos, sin = math.cos(heading), math.sin(heading)
        self.goal = x + distance * cos, y + distance * sin, heading
        nearest, progress_at = math.inf, self.sim.getSimulationTime()
        while True:
            now_x, now_y, now_heading = self.pose()
            dx, dy = self.goal[0] - now_x, self.goal[1] - now_y
            ahead, aside = dx * cos + dy * sin, dy * cos - dx * sin
            if abs(ahead) < DISTANCE_TOLERANCE:
                break
            now = self.sim.getSimulationTime()
            if abs(ahead) < nearest - DISTANCE_TOLERANCE:
                nearest, progress_at = abs(ahead), now
            elif now - progress_at > STALL_TIME:
                raise RobotError(f"{self.name} is blocked")
            speed = limit(2 * ahead, SPEED)
            wanted = heading + limit(2 * aside, 0.5) * math.copysign(1, speed)
            self.drive(speed, limit(3 * wrap(wanted - now_heading), TURN_RATE))
            yield
        self.drive(0, 0)
        yield

    def turn(self, degrees: float) -> Action:
        x, y, heading = self.goal
        self.goal = x, y, wrap(heading + math.radians(degrees))
        deadline = self.sim.getSimulationTime() + 60
        while abs(error := wrap(self.goal[2] - self.pose()[2])) > ANGLE_TOLERANCE:
            if self.sim.getSimulationTime() > deadline:
                raise RobotError(f"{self.name} cannot turn")
            self.drive(0, limit(3 * error, TURN_RATE))
            yield
        self.drive(0, 0)
        yield


def limit(value: float, largest: float) -> float:
    return max(-largest, min(largest, value))


def wrap(angle: float) -> float:
    return math.remainder(angle, math.tau)


def around_the_pillar(robot: Robot) -> Action:
    yield from robot.move(2.1)
    yield from robot.turn(45)
    yield from robot.move(1.4)
    yield from robot.turn(45)
    yield from robot.move(1.0)


def is_running(movement: Action) -> bool:
    return next(movement, "ended") is None


def run_together(sim: Any, movements: list[Action]) -> None:
    while movements:
        movements = [movement for movement in movements if is_running(movement)]
        sim.step()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=int, default=23000)
    options = parser.parse_args()
    sim = RemoteAPIClient(options.host, options.port).require("sim")
    two = ["wheelL"], ["wheelR"]
    four = ["wheelL", "wheelL2"], ["wheelR", "wheelR2"]
    mecanum = ["rollerL", "rollerL2"], ["rollerR", "rollerR2"]
    robots = [
        Robot(sim, "north", *two, 0.045),
        Robot(sim, "east", *four, 0.045),
        Robot(sim, "south", *two, 0.045),
        Robot(sim, "west", *mecanum, 0.04),
    ]
    sim.setStepping(True)
    sim.startSimulation()
    try:
        run_together(sim, [around_the_pillar(robot) for robot in robots])
        for robot in robots:
            x, y, heading = robot.pose()
            print(
                f"{robot.name} is at {x:.3f} m, {y:.3f} m, {math.degrees(heading):.1f} deg"
            )
    finally:
        for robot in robots:
            robot.drive(0, 0)
        sim.stopSimulation()


if __name__ == "__main__":
    main()
