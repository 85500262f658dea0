"""The factors of track and wheels, learnt from what scans say."""

import math
import random

import pytest
from ideal_robot import at_once
from length import few
from pydslrep_runtime.slam.odometry.calibration import Factor
from rooms import Pillar, Rooms
from slipping_robot import SlippingRobot, slam_robot


def test_a_factor_is_learnt_with_its_uncertainty() -> None:
    dice, factor = random.Random(1), Factor(0.03, 0.0005)
    for _ in range(100):
        factor.observe(math.pi, 0.97 * math.pi + dice.gauss(0.0, 0.03), 0.03)
    assert factor.sigma == pytest.approx(0.03 / math.pi / 10.0, rel=0.01)
    assert factor.value == pytest.approx(0.97, abs=3.0 * factor.sigma)


def test_left_and_right_turns_teach_the_same() -> None:
    factor = Factor(0.03, 0.0005)
    for reported in (2.0, -2.0, 0.0):
        factor.observe(reported, 1.02 * reported, 0.01)
    assert factor.value == pytest.approx(1.02, abs=0.001)


def test_a_push_teaches_nothing() -> None:
    factor = Factor(0.03, 0.0005)
    factor.observe(math.pi, math.pi, 0.03)
    before = factor.value, factor.sigma
    factor.observe(math.pi, 0.8 * math.pi, 0.03)
    assert (factor.value, factor.sigma) == before


def test_a_factor_never_is_quite_sure() -> None:
    factor = Factor(0.03, 0.002)
    for _ in range(1000):
        factor.observe(math.pi, math.pi, 0.01)
    assert factor.sigma == pytest.approx(0.002)


@pytest.mark.parametrize("error", few(1, (0.03, -0.03)))
def test_exploring_with_another_track_and_other_wheels(error: float) -> None:
    rooms = Rooms(3.0, 3.0, start=(0.6, 0.6), pillars=[Pillar((1.5, 1.5), 0.45)])
    robot = SlippingRobot(
        rooms, 0.02, 0.01, track_error=error, radius_error=-error / 2.0
    )
    exploring = slam_robot(robot)
    explorer = exploring.explorer()
    at_once(explorer.explore())
    assert not robot.touched
    away, turned = robot.off()
    assert away < 0.1
    assert turned < 3.0
    turn = (1.0 - error / 2.0) / (1.0 + error)
    assert exploring.calibration.turn.value == pytest.approx(turn, abs=0.006)
    assert exploring.calibration.way.value == pytest.approx(1.0 - error / 2.0, abs=0.01)
    nodes = [node.position for node in explorer.map.nodes]
    assert rooms.coverage(nodes, 1.5, grain=0.2) >= 0.95
