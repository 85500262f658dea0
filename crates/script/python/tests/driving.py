"""Shared by the tests of driving: robots with all drives, and their errors."""

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from fake_simulator import (
    FakeJoint,
    FakeRobot,
    FakeWorld,
    four_wheel_joints,
    two_wheel_joints,
)
from pydslrep_parts import coppeliasim
from pydslrep_parts.drive import Drive
from pydslrep_parts.drive_four_mecanum import FourMecanumDrive
from pydslrep_parts.drive_four_wheel import FourWheelDrive
from pydslrep_parts.drive_two_wheel import TwoWheelDrive
from pydslrep_parts.fleet import Fleet
from pydslrep_parts.model import RobotModel
from pydslrep_parts.movement import Movement
from pydslrep_parts.robot import Robot
from pydslrep_parts.trace_file import Trace

DRIVES: dict[str, type[Drive]] = {
    "two-wheel": TwoWheelDrive,
    "four-wheel": FourWheelDrive,
    "mecanum": FourMecanumDrive,
}


def joints(drive: str, **options: Any) -> list[FakeJoint]:
    """The joints of a drive."""
    if drive == "two-wheel":
        return two_wheel_joints(**options)
    return four_wheel_joints(mecanum=drive == "mecanum", **options)


def model(robot: FakeRobot, drive: str) -> RobotModel:
    """The robot as a program would declare it."""
    wheels = {joint.name: joint.radius for joint in robot.joints}
    return RobotModel(robot.name, 19999, DRIVES[drive], wheels, tuple(robot.sensors))


@contextmanager
def connected(
    world: FakeWorld, monkeypatch: pytest.MonkeyPatch, *drives: str
) -> Iterator[Fleet]:
    """A fleet with all robots of a world, one drive each."""
    monkeypatch.setattr(coppeliasim, "RemoteAPIClient", world.factory())
    fleet = Fleet(Trace(None))
    try:
        for robot, drive in zip(world.robots.values(), drives, strict=True):
            fleet.connect(model(robot, drive), "127.0.0.1", 19999, realtime=False)
        fleet.start()
        yield fleet
    finally:
        fleet.shut_down()


def drive_alone(
    world: FakeWorld,
    monkeypatch: pytest.MonkeyPatch,
    drive: str,
    actions: Callable[[Robot], None],
) -> None:
    """Runs actions of the only robot of a world."""
    (name,) = world.robots
    with connected(world, monkeypatch, drive) as fleet:
        fleet.run(Movement("m", name, actions))


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
