"""Wheels that slip roll faster, as soon as that is seen; others are as they were."""

import itertools
import math
import random

import pytest
from driving import DRIVES, drive_alone, joints
from fake_simulator import FakeRobot, FakeWorld
from pydslrep_runtime import Robot
from pydslrep_runtime.slip_compensation import (
    IGNORED,
    MAX_GAIN,
    MIN_GAIN,
    STEPS,
    SlipCompensation,
)

STEP = 0.05  # s


def observe(
    compensation: SlipCompensation, share: float, steps: int, speed: float = 0.1
) -> None:
    """A robot moves by a share of what its wheels roll."""
    for _ in range(steps):
        compensation.observe(speed, share * speed * compensation.gain * STEP, STEP)


def test_slip_is_compensated_after_some_steps() -> None:
    compensation = SlipCompensation()
    observe(compensation, 0.89, STEPS)
    assert compensation.gain == 1.0, "the first step may not be steady"
    observe(compensation, 0.89, 1)
    assert compensation.gain == pytest.approx(1.0 / 0.89)
    observe(compensation, 0.89, 100)
    assert compensation.gain == pytest.approx(1.0 / 0.89), "it does not build up"


def test_both_directions_count() -> None:
    compensation = SlipCompensation()
    observe(compensation, 0.89, STEPS + 1, speed=-0.1)
    assert compensation.gain == pytest.approx(1.0 / 0.89)


def test_small_differences_are_ignored_exactly() -> None:
    dice = random.Random(1)
    compensation = SlipCompensation()
    for _ in range(1000):
        observe(compensation, 1.0 + dice.uniform(-0.9, 0.9) * IGNORED, 1)
        assert compensation.gain == 1.0


def test_it_is_forgotten_when_the_wheels_grip_again() -> None:
    compensation = SlipCompensation()
    observe(compensation, 0.85, 100)
    observe(compensation, 1.0, 500)
    assert compensation.gain == 1.0


@pytest.mark.parametrize("share", [-1.0, 0.0, 0.5, 2.0])
def test_what_is_no_slip_is_ignored(share: float) -> None:
    compensation = SlipCompensation()
    observe(compensation, share, 100)
    assert compensation.gain == 1.0


def test_the_gain_is_bounded() -> None:
    for share in (MIN_GAIN + 1e-6, MAX_GAIN - 1e-6):
        compensation = SlipCompensation()
        observe(compensation, share, 100)
        assert MIN_GAIN <= compensation.gain <= MAX_GAIN


def test_speeding_up_is_ignored() -> None:
    compensation = SlipCompensation()
    for speed in itertools.islice(itertools.count(0.1, 0.001), 100):
        compensation.observe(speed, 0.89 * speed * STEP, STEP)
    assert compensation.gain == 1.0


async def trip(robot: Robot) -> None:
    await robot.move(1.0)
    await robot.turn(90.0)
    await robot.move(1.0)


def steps(
    monkeypatch: pytest.MonkeyPatch, drive: str, mean_slip: float
) -> tuple[int, FakeRobot]:
    fake = FakeRobot("r", joints(drive), mean_slip=mean_slip)
    drive_alone(FakeWorld(fake), monkeypatch, drive, trip)
    return len(fake.rate_history), fake


@pytest.mark.parametrize("drive", DRIVES)
def test_robots_that_slip_arrive_on_time(
    monkeypatch: pytest.MonkeyPatch, drive: str
) -> None:
    planned, _ = steps(monkeypatch, drive, 0.0)
    driven, fake = steps(monkeypatch, drive, 0.11)
    assert driven <= 1.03 * planned
    assert math.hypot(fake.x - 1.0, fake.y - 1.0) < 0.002


@pytest.mark.parametrize("drive", ["two-wheel", "mecanum"])
def test_it_is_seen_in_turns(monkeypatch: pytest.MonkeyPatch, drive: str) -> None:
    async def turn(robot: Robot) -> None:
        await robot.turn(720.0)

    counts = []
    for mean_slip in (0.0, 0.11):
        fake = FakeRobot("r", joints(drive), mean_slip=mean_slip)
        drive_alone(FakeWorld(fake), monkeypatch, drive, turn)
        counts.append(len(fake.rate_history))
    assert counts[1] <= 1.03 * counts[0]
