"""Tests of `approach`."""

import itertools
import math

import pytest
from pydslrep_runtime.approach import Approach
from pydslrep_runtime.facts import RIM_ACCELERATION
from pydslrep_runtime.pace import Pace
from pydslrep_runtime.settings import (
    ARRIVAL_TOLERANCE,
    CLOSE_TOLERANCE,
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
    approach = Approach(top_speed, Pace(dt))
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
        if top_speed > 0.01:
            assert_takes(steps, duration(way, top_speed, dt), dt)


def duration(way: float, top_speed: float, dt: float) -> float:
    """Seconds that a drive takes in theory: up a ramp, along, braking, and ever more slowly over the last millimetres.

    It brakes with three quarters of the acceleration, until its speed is the distance to the goal times a rate: 10 1/s,
    or less where steps are so long that it would be further than 60 % of the distance in one.
    """
    deceleration, rate = 0.75 * RIM_ACCELERATION, min(10.0, 0.6 / dt)
    ramp_way = top_speed**2 / (2.0 * RIM_ACCELERATION)
    slow_speed = min(top_speed, deceleration / rate)
    slow_way = slow_speed / rate
    braking_way = (top_speed**2 - slow_speed**2) / (2.0 * deceleration)
    return (
        top_speed / RIM_ACCELERATION
        + (way - ramp_way - braking_way - slow_way) / top_speed
        + (top_speed - slow_speed) / deceleration
        + math.log(slow_way / ARRIVAL_TOLERANCE) / rate
    )


def assert_takes(steps: int, seconds: float, dt: float) -> None:
    """It is a few steps faster than in theory, since a speed holds for a whole step, but not more."""
    assert seconds - 5.5 * dt < steps * dt < seconds - 1.0 * dt


@pytest.mark.parametrize(("dt", "top_speed"), [(0.005, 0.4), (0.005, 3.0), (0.05, 3.0)])
def test_brakes_as_hard_as_it_should(dt: float, top_speed: float) -> None:
    """Braking 5 % more softly or harder takes at least four steps more or less."""
    approach, remaining, steps = Approach(top_speed, Pace(dt)), 40.0, 0
    while not approach.arrived(remaining):
        remaining -= approach.next_speed(remaining) * dt
        steps += 1
    assert_takes(steps, duration(40.0, top_speed, dt), dt)


def test_a_delay_of_the_wheels_causes_no_oscillation() -> None:
    approach, dt = Approach(0.09, Pace(0.05)), 0.05
    remaining, speed = 1.0, 0.0
    while not approach.arrived(remaining):
        wanted = approach.next_speed(remaining)
        remaining -= dt * (speed + wanted) / 2.0
        speed = wanted
        assert remaining > -0.001


@pytest.mark.parametrize("dt", [0.04, 0.08])
def test_ramps_are_as_steep_as_they_should_be_with_steps_that_are_late(
    dt: float,
) -> None:
    pace = Pace(0.05)
    for _ in range(100):
        pace.observe(dt)
    approach = Approach(0.09, pace)
    speeds = [approach.next_speed(1.0) for _ in range(4)]
    ramp = [RIM_ACCELERATION * dt * step for step in (1, 2, 3, 4)]
    assert speeds == pytest.approx([min(0.09, speed) for speed in ramp])
    assert approach.decelerate() == pytest.approx(speeds[-1] - RIM_ACCELERATION * dt)


def test_brakes_in_steps() -> None:
    approach = Approach(0.09, Pace(0.05))
    approach.speed = -0.06
    assert [approach.decelerate() for _ in range(4)] == pytest.approx(
        [-0.035, -0.01, 0.0, 0.0]
    )


def test_near_the_goal_a_robot_that_comes_no_nearer_has_arrived() -> None:
    approach = Approach(0.09, Pace(0.05))
    assert next(step for step in range(1000) if approach.arrived(0.0005)) == 4
    assert not any(Approach(0.09, Pace(0.05)).arrived(0.002) for _ in range(1000))


def test_near_the_goal_a_slow_action_has_more_time() -> None:
    approach, speed, dt = Approach(0.0003, Pace(0.05)), 0.0003, 0.05
    ways = (0.001 - speed * dt * step for step in range(1000))
    assert next(way for way in ways if approach.arrived(way)) <= ARRIVAL_TOLERANCE


def test_stalls_only_without_progress() -> None:
    approach = Approach(0.09, Pace(0.05))
    times = (0.05 * step for step in itertools.count())
    assert not any(
        approach.stalled(1.0 - 0.001 * step, next(times)) for step in range(900)
    )
    stuck = next(step for step in range(1000) if approach.stalled(0.1, next(times)))
    assert stuck * 0.05 == pytest.approx(STALL_TIME, abs=0.06)


def test_only_simulated_time_counts() -> None:
    approach = Approach(0.09, Pace(0.05))
    assert not any(approach.stalled(0.1, 7.0) for _ in range(1000))


def test_moving_away_is_no_progress() -> None:
    approach = Approach(0.09, Pace(0.05))
    assert any(
        approach.stalled(1.0 + math.sin(step), 0.05 * step) for step in range(200)
    )
