"""The types of robots that the command knows are those that this package drives."""

import inspect

import pydslrep_runtime
import pytest
from pydslrep_runtime import Robot, drives, robots
from pydslrep_runtime.facts import ROBOT_TYPES, RobotType

NOT_WHEELS = {"name", "port", "sensors", "bumpers", "objects", "ros2", "mounts"}


def mounts_of(
    kind: RobotType, track: float, wheelbase: float
) -> list[tuple[float, float]]:
    ahead = {"front": wheelbase / 2.0, "rear": -wheelbase / 2.0}
    return [
        (
            ahead.get(name.rpartition("_")[2], 0.0),
            track / 2.0 if name.startswith("left") else -track / 2.0,
        )
        for name in kind.wheels
    ]


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
    mounts = mounts_of(kind, 0.3, 0.2)
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


SCRUBBING = {name: kind for name, kind in ROBOT_TYPES.items() if kind.scrubs}


@pytest.mark.parametrize("kind", SCRUBBING.values(), ids=SCRUBBING)
@pytest.mark.parametrize(("track", "wheelbase"), [(0.30, 0.25), (0.4, 0.1)])
def test_wheels_that_scrub_make_the_track_wider_as_in_plans(
    track: float, wheelbase: float, kind: RobotType
) -> None:
    # docs/kinematics.md; 1.69 for the default robot on four wheels, wherever its origin is.
    mounts = mounts_of(kind, track, wheelbase)
    off_axle = sum(x != 0.0 for x, _ in mounts) / len(mounts)
    mounts = [(there + 0.07, aside - 0.03) for there, aside in mounts]
    drive = getattr(drives, kind.drive)(mounts, [0.1] * len(mounts))
    scrub = 1.0 + kind.grip * off_axle * (wheelbase / track) ** 2
    assert drive.rims_per_radian == pytest.approx(scrub * track / 2.0)
    assert drive.turning_radius == pytest.approx(track / 2.0)
    right_front = drive.wheel_rates(0.0, 1.0)[kind.wheels.index("right_front")]
    assert right_front * 0.1 == pytest.approx(scrub * track / 2.0)
    assert drive.turn_rate(drive.wheel_rates(0.3, 0.7)) == pytest.approx(0.7)
