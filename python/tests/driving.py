"""Shared by the tests of driving: robots with all drives, and their errors."""

import math
import sys
from collections.abc import Callable, Coroutine
from typing import Any

import pytest
from fake_simulator import (
    FakeJoint,
    FakeRobot,
    FakeWorld,
    four_wheel_joints,
    two_wheel_joints,
)
from pydslrep_runtime import (
    FourWheelRobot,
    MecanumRobot,
    Robot,
    TwoWheelRobot,
    movement,
    runner,
)
from pydslrep_runtime.command_line import parse_arguments

ROBOTS: dict[str, type[Robot]] = {
    "two-wheel": TwoWheelRobot,
    "four-wheel": FourWheelRobot,
    "mecanum": MecanumRobot,
}
DRIVES = tuple(ROBOTS)

Actions = Callable[[Robot], Coroutine[Any, Any, None]]


def joints(drive: str, **options: Any) -> list[FakeJoint]:
    """The joints of a drive."""
    if drive == "two-wheel":
        return two_wheel_joints(**options)
    return four_wheel_joints(mecanum=drive == "mecanum", **options)


def declared(fake: FakeRobot, drive: str, port: int = 19999) -> Robot:
    """The robot as a script declares it."""
    wheels = [(joint.name, joint.radius) for joint in fake.joints]
    sensors = tuple(fake.sensors)
    if drive == "two-wheel":
        left, right = wheels
        return TwoWheelRobot(
            fake.name, port=port, left=left, right=right, sensors=sensors
        )
    left_front, left_rear, right_front, right_rear = wheels
    robot_type = MecanumRobot if drive == "mecanum" else FourWheelRobot
    return robot_type(
        fake.name,
        port=port,
        left_front=left_front,
        left_rear=left_rear,
        right_front=right_front,
        right_rear=right_rear,
        sensors=sensors,
    )


def drive_all(
    world: FakeWorld,
    monkeypatch: pytest.MonkeyPatch,
    drives: tuple[str, ...],
    main: Callable[[dict[str, Robot]], Coroutine[Any, Any, None]],
    *arguments: str,
) -> None:
    """Runs `main` with all robots of a world, by name; raises what ends the run."""
    world.serve(monkeypatch)
    monkeypatch.setattr(sys, "argv", ["script.py", *arguments])
    robots = {
        fake.name: declared(fake, drive)
        for fake, drive in zip(world.robots.values(), drives, strict=True)
    }
    options = parse_arguments(
        list(robots.values()),
        description=None,
        host="127.0.0.1",
        backend="coppeliasim",
        environment="m",
    )
    runner.drive(
        lambda: main(robots), list(robots.values()), "coppeliasim", "m", options
    )


def drive_alone(
    world: FakeWorld, monkeypatch: pytest.MonkeyPatch, drive: str, actions: Actions
) -> None:
    """Runs actions of the only robot of a world."""
    (name,) = world.robots

    @movement(name="m")
    async def main(robots: dict[str, Robot]) -> None:
        await actions(robots[name])

    drive_all(world, monkeypatch, (drive,), main)


def wheel_middle(robot: FakeRobot) -> tuple[float, float]:
    """The position of the wheels' centre."""
    cx = sum(joint.x for joint in robot.joints) / len(robot.joints)
    cy = sum(joint.y for joint in robot.joints) / len(robot.joints)
    cos, sin = math.cos(robot.theta), math.sin(robot.theta)
    return robot.x + cx * cos - cy * sin, robot.y + cx * sin + cy * cos


def errors(robot: FakeRobot, x: float, y: float, theta: float) -> tuple[float, float]:
    """The error of a robot's pose in metres and degrees."""
    here_x, here_y = wheel_middle(robot)
    angle = math.remainder(robot.theta - theta, math.tau)
    return math.hypot(here_x - x, here_y - y), abs(math.degrees(angle))
