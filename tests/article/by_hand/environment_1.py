"""Drives robot_1 along a U in CoppeliaSim: three sides of 4 m, with right turns between them."""

import argparse
import math
from typing import Any

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

WHEEL_RADIUS = 0.045  # m
SPEED = 0.09  # m/s
TURN_RATE = 0.6  # rad/s
DISTANCE_TOLERANCE = 0.002  # m
ANGLE_TOLERANCE = math.radians(0.2)
STALL_TIME = 5.0  # s


class RobotError(Exception):
    """The robot cannot do what it should."""


class Robot:
    """A differential robot whose pose the simulator tells."""

    def __init__(self, sim: Any, name: str, left: str, right: str) -> None:
        self.sim = sim
        self.name = name
        self.body = sim.getObject(f"/{name}")
        self.left = sim.getObject(f"/{name}/{left}")
        self.right = sim.getObject(f"/{name}/{right}")
        self.track = math.dist(
            sim.getObjectPosition(self.left), sim.getObjectPosition(self.right)
        )
        self.goal = self.pose()

    def pose(self) -> tuple[float, float, float]:
        x, y, _ = self.sim.getObjectPosition(self.body)
        _, _, heading = self.sim.getObjectOrientation(self.body)
        return x, y, heading

    def drive(self, speed: float, turn_rate: float) -> None:
        half = turn_rate * self.track / 2
        self.sim.setJointTargetVelocity(self.left, (speed - half) / WHEEL_RADIUS)
        self.sim.setJointTargetVelocity(self.right, (speed + half) / WHEEL_RADIUS)

    def step(self, speed: float, turn_rate: float) -> None:
        self.drive(speed, turn_rate)
        self.sim.step()

    def move(self, distance: float) -> None:
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
            self.step(speed, limit(3 * wrap(wanted - now_heading), TURN_RATE))
        self.step(0, 0)

    def turn(self, degrees: float) -> None:
        x, y, heading = self.goal
        self.goal = x, y, wrap(heading + math.radians(degrees))
        deadline = self.sim.getSimulationTime() + 60
        while abs(error := wrap(self.goal[2] - self.pose()[2])) > ANGLE_TOLERANCE:
            if self.sim.getSimulationTime() > deadline:
                raise RobotError(f"{self.name} cannot turn")
            self.step(0, limit(3 * error, TURN_RATE))
        self.step(0, 0)


def limit(value: float, largest: float) -> float:
    return max(-largest, min(largest, value))


def wrap(angle: float) -> float:
    return math.remainder(angle, math.tau)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=int, default=23000)
    options = parser.parse_args()
    sim = RemoteAPIClient(options.host, options.port).require("sim")
    robot = Robot(sim, "robot_1", "wheelL", "wheelR")
    sim.setStepping(True)
    sim.startSimulation()
    try:
        robot.move(4.0)
        robot.turn(-90)
        robot.move(4.0)
        robot.turn(-90)
        robot.move(4.0)
        x, y, heading = robot.pose()
        print(
            f"{robot.name} is at {x:.3f} m, {y:.3f} m, {math.degrees(heading):.1f} deg"
        )
    finally:
        robot.drive(0, 0)
        sim.stopSimulation()


if __name__ == "__main__":
    main()
