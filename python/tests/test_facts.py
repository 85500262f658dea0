"""The types of robots that the command knows are those that this package drives."""

import inspect

import pydslrep_runtime
import pytest
from pydslrep_runtime import Robot, drives, robots
from pydslrep_runtime.facts import ROBOT_TYPES, TRACK_FACTOR, RobotType

NOT_WHEELS = {"name", "port", "sensors", "bumpers", "objects"}


@pytest.mark.parametrize("kind", ROBOT_TYPES.values(), ids=ROBOT_TYPES)
def test_each_type_has_its_classes(kind: RobotType) -> None:
    assert kind.robot in pydslrep_runtime.__all__
    robot = getattr(robots, kind.robot)
    drive = getattr(drives, kind.drive)
    assert robot.drive_type is drive
    parameters = inspect.signature(robot).parameters
    wheels = tuple(name for name in parameters if name not in NOT_WHEELS)
    assert wheels == kind.wheels
    assert drive.scrubs == kind.scrubs


def test_no_class_is_left_out() -> None:
    classes = {
        name
        for name in pydslrep_runtime.__all__
        if name.endswith("Robot") and getattr(pydslrep_runtime, name) is not Robot
    }
    assert classes == {kind.robot for kind in ROBOT_TYPES.values()}


@pytest.mark.parametrize("kind", ROBOT_TYPES.values(), ids=ROBOT_TYPES)
def test_wheels_are_where_their_names_say(kind: RobotType) -> None:
    drive = getattr(drives, kind.drive)
    mounts = [
        (
            0.1 if name.endswith("front") else -0.1 if name.endswith("rear") else 0.0,
            0.15 if name.startswith("left") else -0.15,
        )
        for name in kind.wheels
    ]
    rates = {}
    for name, twist in {"left": (0.0, 1.0), "ahead": (1.0, 0.0)}.items():
        made = drive(mounts, [0.1] * len(mounts))
        ahead, turn = twist
        rates[name] = (
            made.wheel_rates(ahead, 0.0, turn)
            if kind.mecanum
            else made.wheel_rates(ahead, turn)
        )
    for name, turning, rolling in zip(
        kind.wheels, rates["left"], rates["ahead"], strict=True
    ):
        assert (turning < 0.0) == name.startswith("left")
        assert rolling == pytest.approx(10.0)
    if kind.mecanum:
        sideways = made.wheel_rates(0.0, 1.0, 0.0)
        assert [rate / 10.0 for rate in sideways] == pytest.approx(list(kind.pushes))


def test_the_factor_of_the_track_is_that_of_the_command() -> None:
    assert drives.FourWheelDrive.TRACK_FACTOR == TRACK_FACTOR
