"""Explores a closed area with robot_1 in CoppeliaSim and writes a map of it, as JSON.

The places of the map lie on a grid. The robot drives from each to those of its neighbours that its sensors see no obstacle
before, depth first, and returns along known ways to places with neighbours that it has not tried.
"""

import argparse
import json
import math
import pathlib
from collections import deque
from typing import Any

from coppeliasim_zmqremoteapi_client import RemoteAPIClient

WHEEL_RADIUS = 0.045  # m
SPEED = 0.4  # m/s
TURN_RATE = 2.0  # rad/s
GRID = 0.5  # m
FREE = 0.55  # m, the distance that a neighbour needs
NEAR = 0.05  # m, where the robot stops before obstacles
DISTANCE_TOLERANCE = 0.01  # m
ANGLE_TOLERANCE = math.radians(1)
STALL_STEPS = 40
TURN_STEPS = 600
AHEAD = "fSensor1"
SLANTED = "fSensor0", "fSensor2"
LEFT, RIGHT = "lSensor", "rSensor"
DIRECTIONS = (1, 0), (0, 1), (-1, 0), (0, -1)

Place = tuple[int, int]


class RobotError(Exception):
    """The robot cannot do what it should."""


class Robot:
    """A differential robot with distance sensors, whose pose the simulator tells."""

    def __init__(self, sim: Any, name: str) -> None:
        self.sim = sim
        self.name = name
        self.body = sim.getObject(f"/{name}")
        self.left = sim.getObject(f"/{name}/wheelL")
        self.right = sim.getObject(f"/{name}/wheelR")
        self.sensors = {
            sensor: sim.getObject(f"/{name}/{sensor}")
            for sensor in (AHEAD, *SLANTED, LEFT, RIGHT)
        }
        self.track = math.dist(
            sim.getObjectPosition(self.left), sim.getObjectPosition(self.right)
        )

    def pose(self) -> tuple[float, float, float]:
        x, y, _, _, _, qz, qw = self.sim.getObjectPose(self.body)
        return x, y, 2 * math.atan2(qz, qw)

    def distance(self, *sensors: str) -> float:
        """The distance to the nearest obstacle that the sensors see."""
        nearest = math.inf
        for sensor in sensors:
            state, distance, *_ = self.sim.readProximitySensor(self.sensors[sensor])
            if state == 1:
                nearest = min(nearest, distance)
        return nearest

    def drive(self, speed: float, turn_rate: float) -> None:
        half = turn_rate * self.track / 2
        self.sim.setJointTargetVelocity(self.left, (speed - half) / WHEEL_RADIUS)
        self.sim.setJointTargetVelocity(self.right, (speed + half) / WHEEL_RADIUS)

    def step(self, speed: float, turn_rate: float) -> None:
        self.drive(speed, turn_rate)
        self.sim.step()

    def turn_to(self, heading: float) -> None:
        for _ in range(TURN_STEPS):
            error = wrap(heading - self.pose()[2])
            if abs(error) < ANGLE_TOLERANCE:
                break
            self.step(0, limit(4 * error, TURN_RATE))
        else:
            raise RobotError(f"{self.name} cannot turn")
        self.step(0, 0)

    def go_to(self, x: float, y: float, heading: float, *, is_known: bool) -> bool:
        """Drives to a position in front or behind; returns whether nothing is in the way."""
        cos, sin = math.cos(heading), math.sin(heading)
        nearest, idle_steps = math.inf, 0
        while True:
            now_x, now_y, now_heading = self.pose()
            dx, dy = x - now_x, y - now_y
            ahead, aside = dx * cos + dy * sin, dy * cos - dx * sin
            if abs(ahead) < DISTANCE_TOLERANCE:
                self.step(0, 0)
                return True
            idle_steps += 1
            if abs(ahead) < nearest - DISTANCE_TOLERANCE:
                nearest, idle_steps = abs(ahead), 0
            is_blocked = not is_known and self.distance(AHEAD, *SLANTED) < NEAR
            if is_blocked or idle_steps > STALL_STEPS:
                self.step(0, 0)
                return False
            speed = limit(3 * ahead, SPEED)
            wanted = heading + limit(2 * aside, 0.5) * math.copysign(1, speed)
            self.step(speed, limit(4 * wrap(wanted - now_heading), TURN_RATE))


class Explorer:
    """What is known of the area: places, the ways between them, and neighbours to try."""

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self.origin_x, self.origin_y, _ = robot.pose()
        self.place: Place = (0, 0)
        self.ways: dict[Place, set[Place]] = {self.place: set()}
        self.to_try: dict[Place, set[Place]] = {self.place: set()}

    def position(self, place: Place) -> tuple[float, float]:
        column, row = place
        return self.origin_x + column * GRID, self.origin_y + row * GRID

    def explore(self) -> None:
        self.robot.turn_to(math.pi)
        self.look_around()
        self.robot.turn_to(0)
        self.look_around()
        while route := self.route_to_work():
            for place in route[1:]:
                self.follow(place)
            self.try_neighbour()

    def look_around(self) -> None:
        """Notes the free neighbours in front and on both sides."""
        heading = self.robot.pose()[2]
        for turn, sensor in ((0, AHEAD), (1, LEFT), (-1, RIGHT)):
            if self.robot.distance(sensor) > FREE:
                neighbour = self.neighbour(heading + turn * math.pi / 2)
                if neighbour not in self.ways[self.place]:
                    self.to_try[self.place].add(neighbour)

    def neighbour(self, heading: float) -> Place:
        dx, dy = DIRECTIONS[round(heading / (math.pi / 2)) % 4]
        return self.place[0] + dx, self.place[1] + dy

    def route_to_work(self) -> list[Place]:
        """The shortest known way to a place with neighbours to try."""
        queue, seen = deque([[self.place]]), {self.place}
        while queue:
            route = queue.popleft()
            if self.to_try[route[-1]]:
                return route
            for place in sorted(self.ways[route[-1]] - seen):
                seen.add(place)
                queue.append([*route, place])
        return []

    def heading_to(self, place: Place) -> float:
        return math.atan2(place[1] - self.place[1], place[0] - self.place[0])

    def follow(self, place: Place) -> None:
        heading = self.heading_to(place)
        self.robot.turn_to(heading)
        if not self.robot.go_to(*self.position(place), heading, is_known=True):
            raise RobotError(f"{self.robot.name} is blocked on a known way")
        self.place = place

    def try_neighbour(self) -> None:
        """Drives to the neighbour that takes the least turning, if it is free."""
        _, _, now = self.robot.pose()
        place = min(
            sorted(self.to_try[self.place]),
            key=lambda place: round(abs(wrap(self.heading_to(place) - now)), 1),
        )
        self.to_try[self.place].remove(place)
        heading = self.heading_to(place)
        self.robot.turn_to(heading)
        if self.robot.distance(AHEAD) < FREE:
            return
        if not self.robot.go_to(*self.position(place), heading, is_known=False):
            here = self.position(self.place)
            if not self.robot.go_to(*here, heading, is_known=True):
                raise RobotError(f"{self.robot.name} cannot return")
            return
        self.ways.setdefault(place, set()).add(self.place)
        self.ways[self.place].add(place)
        self.to_try.setdefault(place, set()).discard(self.place)
        self.place = place
        self.look_around()

    def map(self) -> dict[str, list[dict[str, float]]]:
        ids = {place: number for number, place in enumerate(self.ways)}
        positions = {number: self.position(place) for place, number in ids.items()}
        return {
            "nodes": [{"id": n, "x": x, "y": y} for n, (x, y) in positions.items()],
            "edges": [
                {"from": ids[place], "to": ids[other], "length": GRID}
                for place, others in self.ways.items()
                for other in sorted(others)
                if ids[place] < ids[other]
            ],
        }


def limit(value: float, largest: float) -> float:
    return max(-largest, min(largest, value))


def wrap(angle: float) -> float:
    return math.remainder(angle, math.tau)


def main() -> None:
    parser = argparse.ArgumentParser(description="Explores an area and maps it.")
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=int, default=23000)
    parser.add_argument("--map", type=pathlib.Path, default="map.json")
    options = parser.parse_args()
    sim = RemoteAPIClient(options.host, options.port).require("sim")
    robot = Robot(sim, "robot_1")
    sim.setStepping(True)
    sim.startSimulation()
    try:
        sim.step()
        explorer = Explorer(robot)
        explorer.explore()
    finally:
        robot.drive(0, 0)
        sim.stopSimulation()
    options.map.write_text(json.dumps(explorer.map()), encoding="utf-8")
    print(f"{len(explorer.ways)} places")


if __name__ == "__main__":
    main()
