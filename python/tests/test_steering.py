"""Steering returns a robot to its line without swinging across it."""

import math

import pytest
from pydslrep_runtime.pose import Pose
from pydslrep_runtime.steering import steer

STEP = 0.01  # s


@pytest.mark.parametrize("speed", [-0.3, -0.09, 0.09, 0.3])
@pytest.mark.parametrize(("y", "theta"), [(0.03, 0.0), (0.0, 0.1), (-0.02, 0.1)])
def test_a_robot_returns_to_its_line(speed: float, y: float, theta: float) -> None:
    x, to_go = 0.0, 2.0
    crossings, before = 0, y
    while abs(x) < to_go:
        here = Pose(x, y, theta)
        theta += STEP * steer(speed, here, math.copysign(to_go - abs(x), speed))
        x += STEP * speed * math.cos(theta)
        y += STEP * speed * math.sin(theta)
        if y * before < 0.0 and abs(y) > 1e-3:
            crossings += 1
        before = y
    assert abs(y) < 0.001
    assert abs(theta) < 0.005
    assert crossings <= 1
