import math
from types import SimpleNamespace
from typing import Any

import pytest
from pydslrep_runtime.pose import Pose
from pydslrep_runtime.slam.odometry.odometer import Odometer
from pydslrep_runtime.vrep import VRepRobot


def odometer_of(angles: list[float]) -> Odometer:
    """The odometer of a robot with these wheel angles, 1 m and 2 m from the origin."""
    backend: Any = SimpleNamespace(
        pose=lambda: Pose(1.0, 2.0, math.pi / 2.0),
        wheel_angles=lambda: list(angles),
    )
    return Odometer(backend, (0.05, 0.05), 0.15)


def test_equal_rotation_drives_straight() -> None:
    angles = [3.0, -3.0]
    odometer = odometer_of(angles)
    angles[:] = [5.0, -1.0]
    there = odometer.pose()
    assert (there.x, there.y) == pytest.approx((1.0, 2.1))
    assert odometer.pose() == there


def test_joint_angles_may_wrap_around() -> None:
    angles = [3.1, 3.1]
    odometer = odometer_of(angles)
    angles[:] = [3.1 - math.tau + 0.2] * 2
    assert odometer.pose().y == pytest.approx(2.01)


def test_an_arc_is_exact() -> None:
    angles = [0.0, 0.0]
    odometer = odometer_of(angles)
    # About a centre 0.3 m to the left, by 0.2 rad: rims at 0.15 and 0.45 m from it.
    angles[:] = [0.15 * 0.2 / 0.05, 0.45 * 0.2 / 0.05]
    there = odometer.pose()
    assert there.theta == pytest.approx(math.pi / 2.0 + 0.2)
    assert there.x == pytest.approx(1.0 - 0.3 + 0.3 * math.cos(0.2))
    assert there.y == pytest.approx(2.0 + 0.3 * math.sin(0.2))


def test_wheel_travel_counts_both_directions() -> None:
    angles = [0.0, 0.0]
    odometer = odometer_of(angles)
    angles[:] = [-1.0, 2.0]
    odometer.pose()
    angles[:] = [0.0, 2.0]
    odometer.pose()
    assert odometer.wheel_travel == pytest.approx(0.05 * (1.5 + 0.5))


def test_wheels_in_vrep_whose_axes_point_to_the_right_turn_forward_too() -> None:
    client = SimpleNamespace(simxGetJointPosition=None, simx_opmode_buffer=0)
    robot: Any = SimpleNamespace(
        _client=client,
        _connection=SimpleNamespace(wait_for=lambda _time: None),
        clock=SimpleNamespace(milliseconds=0),
        _call=lambda _read, joint, _mode: {7: 2.0, 8: -2.0}[joint],
        _joints=[7, 8],
        _mounting=SimpleNamespace(axis_signs=[1.0, -1.0]),
    )
    assert VRepRobot.wheel_angles(robot) == [2.0, 2.0]
