"""Tests of `approach`."""

import itertools
import math

import pytest
from pydslrep_runtime.approach import Approach
from pydslrep_runtime.settings import (
    ARRIVAL_TOLERANCE,
    CLOSE_TOLERANCE,
    RIM_ACCELERATION,
    STALL_TIME,
)


@pytest.mark.parametrize("dt", [0.005, 0.05, 0.2])
@pytest.mark.parametrize("top_speed", [0.00001, 0.09, 3.0])
@pytest.mark.parametrize("way", [0.0005, 0.004, 0.05, 7.0])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_ramps_up_cruises_and_ends_at_the_goal(
    dt: float, top_speed: float, way: float, side: float
) -> None:
    if way / top_speed > 1e4:
        way = top_speed * 100.0
    approach = Approach(top_speed, dt)
    remaining, speed, fastest, steps = way * side, 0.0, 0.0, 0
    while not approach.arrived(remaining):
        assert not approach.stalled(remaining, steps * dt)
        before, speed = speed, approach.next_speed(remaining)
        assert abs(speed - before) <= RIM_ACCELERATION * dt * 1.01, "a wheel jumps"
        assert abs(speed) <= top_speed
        fastest = max(fastest, abs(speed))
        remaining -= speed * dt
        steps += 1
    # A very slow robot counts as arrived once it stays near the goal.
    assert abs(remaining) <= (
        ARRIVAL_TOLERANCE if top_speed > 0.01 else CLOSE_TOLERANCE
    )
    if way > 2.0 * top_speed**2 / RIM_ACCELERATION + 2.0 * top_speed * dt:
        assert fastest == top_speed
        # the duration of a trapezoidal profile, plus the slow final approach
        assert (
            steps * dt
            <= way / top_speed + top_speed / RIM_ACCELERATION + 1.0 + 20.0 * dt
        )


def test_a_delay_of_the_wheels_causes_no_oscillation() -> None:
    approach, dt = Approach(0.09, 0.05), 0.05
    remaining, speed = 1.0, 0.0
    while not approach.arrived(remaining):
        wanted = approach.next_speed(remaining)
        remaining -= dt * (speed + wanted) / 2.0
        speed = wanted
        assert remaining > -0.001


def test_brakes_in_steps() -> None:
    approach = Approach(0.09, 0.05)
    approach.speed = -0.06
    assert [approach.decelerate() for _ in range(4)] == pytest.approx(
        [-0.035, -0.01, 0.0, 0.0]
    )


def test_near_the_goal_a_robot_that_comes_no_nearer_has_arrived() -> None:
    approach = Approach(0.09, 0.05)
    assert next(step for step in range(1000) if approach.arrived(0.0005)) == 4
    assert not any(Approach(0.09, 0.05).arrived(0.002) for _ in range(1000))


def test_near_the_goal_a_slow_action_has_more_time() -> None:
    approach, speed, dt = Approach(0.0003, 0.05), 0.0003, 0.05
    ways = (0.001 - speed * dt * step for step in range(1000))
    assert next(way for way in ways if approach.arrived(way)) <= ARRIVAL_TOLERANCE


def test_stalls_only_without_progress() -> None:
    approach = Approach(0.09, 0.05)
    times = (0.05 * step for step in itertools.count())
    assert not any(
        approach.stalled(1.0 - 0.001 * step, next(times)) for step in range(900)
    )
    stuck = next(step for step in range(1000) if approach.stalled(0.1, next(times)))
    assert stuck * 0.05 == pytest.approx(STALL_TIME, abs=0.06)


def test_only_simulated_time_counts() -> None:
    approach = Approach(0.09, 0.05)
    assert not any(approach.stalled(0.1, 7.0) for _ in range(1000))


def test_moving_away_is_no_progress() -> None:
    approach = Approach(0.09, 0.05)
    assert any(
        approach.stalled(1.0 + math.sin(step), 0.05 * step) for step in range(200)
    )
