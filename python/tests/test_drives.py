"""The drives' inverse kinematics against the forward kinematics of the fake simulator."""

import math
import random

import pytest
from driving import DRIVES, ROBOTS, joints
from fake_simulator import Contacts, FakeRobot
from pydslrep_runtime.drives import FourWheelDrive, MecanumDrive, TwoWheelDrive
from pydslrep_runtime.errors import SetupError
from pydslrep_runtime.pose import Pose
from pydslrep_runtime.steering import (
    ARC_SPEED,
    Drift,
    arc_speed,
    return_speed,
    steer,
)

CHANCE = random.Random(3)
TWISTS = [tuple(CHANCE.uniform(-1.0, 1.0) for _ in range(3)) for _ in range(20)]


def twist_of(robot: FakeRobot, rates: list[float]) -> tuple[float, float, float]:
    """How the simulated robot moves when its wheels turn at these rates."""
    for joint, rate in zip(robot.joints, rates, strict=True):
        joint.rate = rate
    return robot.twist(Contacts.of(robot.joints, [1.0] * len(rates)))


@pytest.mark.parametrize("radii", [[0.045] * 2, [0.03, 0.06]])
@pytest.mark.parametrize(("v", "omega", "_unused"), TWISTS)
def test_two_wheels(v: float, omega: float, _unused: float, radii: list[float]) -> None:
    robot = FakeRobot("r", joints("two-wheel", track=0.4))
    for joint, radius in zip(robot.joints, radii, strict=True):
        joint.radius = radius
    drive = TwoWheelDrive([(j.x, j.y) for j in robot.joints], radii)
    assert twist_of(robot, drive.wheel_rates(v, omega)) == pytest.approx(
        (v, 0.0, omega)
    )


@pytest.mark.parametrize(("v", "omega", "_unused"), TWISTS)
def test_four_wheels(v: float, omega: float, _unused: float) -> None:
    robot = FakeRobot("r", joints("four-wheel", track=0.4, wheelbase=0.2))
    drive = FourWheelDrive([(j.x, j.y) for j in robot.joints], [0.045] * 4)
    rates = drive.wheel_rates(v, omega)
    assert rates[0] == rates[1]
    assert rates[2] == rates[3]
    assert twist_of(robot, rates) == pytest.approx((v, 0.0, omega))


@pytest.mark.parametrize(("vx", "vy", "omega"), TWISTS)
def test_mecanum_wheels(vx: float, vy: float, omega: float) -> None:
    robot = FakeRobot("r", joints("mecanum", track=0.4, wheelbase=0.2))
    drive = MecanumDrive([(j.x, j.y) for j in robot.joints], [0.045] * 4)
    assert twist_of(robot, drive.wheel_rates(vx, vy, omega)) == pytest.approx(
        (vx, vy, omega)
    )


def test_mecanum_rates_are_those_of_rollers_that_form_an_x() -> None:
    drive = MecanumDrive(
        [(0.1, 0.2), (-0.1, 0.2), (0.1, -0.2), (-0.1, -0.2)], [0.05] * 4
    )
    assert drive.wheel_rates(1.0, 0.0, 0.0) == pytest.approx([20.0] * 4)
    assert drive.wheel_rates(0.0, 1.0, 0.0) == pytest.approx([-20.0, 20.0, 20.0, -20.0])
    assert drive.wheel_rates(0.0, 0.0, 1.0) == pytest.approx([-6.0, -6.0, 6.0, 6.0])


@pytest.mark.parametrize("drive", DRIVES)
def test_wheels_on_the_wrong_side_are_an_error(drive: str) -> None:
    mounts = [(joint.x, -joint.y) for joint in joints(drive)]
    with pytest.raises(SetupError, match="left"):
        ROBOTS[drive].drive_type(mounts, [0.045] * len(mounts))


def test_rear_wheels_in_front_are_an_error() -> None:
    mounts = [(-joint.x, joint.y) for joint in joints("mecanum")]
    with pytest.raises(SetupError, match="front"):
        MecanumDrive(mounts, [0.045] * 4)


@pytest.mark.parametrize("speed", [0.09, -0.09, 2.0])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_steering_returns_to_the_line(speed: float, side: float) -> None:
    x, y, theta, dt = 0.0, 0.1 * side, 0.0, 0.05
    way = 20.0 * max(0.15, 0.5 * abs(speed))
    widest = abs(y)
    for _ in range(round(way / abs(speed) / dt)):
        theta += dt * steer(speed, Pose(x, y, theta), 100.0)
        x += dt * speed * math.cos(theta)
        y += dt * speed * math.sin(theta)
        widest = max(widest, abs(y))
    assert (y, theta) == pytest.approx((0.0, 0.0), abs=1e-4)
    assert widest < 0.101


def test_at_the_end_of_a_line_only_the_heading_counts() -> None:
    off_line = Pose(0.0, 0.05, 0.0)
    assert steer(0.09, off_line, 1.0) < -0.1
    assert steer(0.09, off_line, 0.0) == 0.0
    assert steer(0.09, Pose(0.0, 0.05, 0.1), 0.0) < -0.1


def test_a_turning_robot_returns_along_its_heading() -> None:
    assert return_speed(Pose(0.005, 0.0, 0.0)) == pytest.approx(-0.01)
    assert return_speed(Pose(0.005, 0.0, math.pi)) == pytest.approx(0.01)
    assert return_speed(Pose(0.0, 0.005, 0.0)) == pytest.approx(0.0)
    assert return_speed(Pose(0.0, 0.005, math.pi / 2.0)) == pytest.approx(-0.01)
    assert return_speed(Pose(1.0, 0.0, 0.0)) == -0.02


@pytest.mark.parametrize("drift", [0.0, 0.02, -0.03])
@pytest.mark.parametrize("angle", [30.0, -90.0, 180.0, 270.0, -360.0])
@pytest.mark.parametrize("error", [Pose(0.0, 0.0, 0.0), Pose(0.004, -0.002, 0.0)])
def test_a_turn_ends_on_its_spot_whatever_slides(
    drift: float, angle: float, error: Pose
) -> None:
    dt, rate = 0.05, math.copysign(0.6, angle)
    goal = math.radians(angle)
    observed = Drift()
    here = Pose(error.x, error.y, -goal)
    turn = goal
    while abs(turn) > 0.001:
        rate = math.copysign(min(0.6, 10.0 * abs(turn)), turn)
        ahead = arc_speed(here, turn, observed.left, rate)
        cos, sin = math.cos(here.theta), math.sin(here.theta)
        left = drift * rate
        after = Pose(
            here.x + dt * (cos * ahead - sin * left),
            here.y + dt * (sin * ahead + cos * left),
            here.theta + dt * rate,
        )
        observed.observe(here, after)
        here, turn = after, turn - dt * rate
    # Short turns leave little time to find out and to make up for it.
    assert math.hypot(here.x, here.y) < (0.012 if abs(goal) < 1.0 else 0.006)
    assert observed.left == pytest.approx(drift, rel=0.3, abs=5e-4)


def test_without_drift_a_turning_robot_stays_on_its_spot() -> None:
    assert arc_speed(Pose(0.0, 0.0, -1.0), 1.0, 0.0, 0.6) == 0.0


def test_a_robot_on_the_wrong_side_does_not_run_away() -> None:
    for turn in (-6.0, -0.001, 0.001, 2.0):
        assert abs(arc_speed(Pose(-3.0, 2.0, 1.0), turn, 0.05, 0.6)) <= ARC_SPEED
    assert arc_speed(Pose(0.1, 0.1, 0.0), 0.0, 0.0, 0.0) == 0.0
