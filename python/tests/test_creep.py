"""Wheels that slip roll faster, as soon as that is seen; others are as they were."""

import itertools
import math
import random

import pytest
from driving import DRIVES, drive_alone, joints
from fake_simulator import FakeRobot, FakeWorld
from pydslrep_runtime import Robot
from pydslrep_runtime.creep import IGNORED, LEAST, MOST, STEPS, Creep

STEP = 0.05  # s


def observe(creep: Creep, share: float, steps: int, speed: float = 0.1) -> None:
    """A robot moves by a share of what its wheels roll."""
    for _ in range(steps):
        creep.observe(speed, share * speed * creep.gain * STEP, STEP)


def test_it_is_made_up_for_after_some_steps() -> None:
    creep = Creep()
    observe(creep, 0.89, STEPS)
    assert creep.gain == 1.0, "the first step may not be steady"
    observe(creep, 0.89, 1)
    assert creep.gain == pytest.approx(1.0 / 0.89)
    observe(creep, 0.89, 100)
    assert creep.gain == pytest.approx(1.0 / 0.89), "it does not build up"


def test_both_directions_count() -> None:
    creep = Creep()
    observe(creep, 0.89, STEPS + 1, speed=-0.1)
    assert creep.gain == pytest.approx(1.0 / 0.89)


def test_small_differences_are_ignored_exactly() -> None:
    dice = random.Random(1)
    creep = Creep()
    for _ in range(1000):
        observe(creep, 1.0 + dice.uniform(-0.9, 0.9) * IGNORED, 1)
        assert creep.gain == 1.0


def test_it_is_forgotten_when_the_wheels_grip_again() -> None:
    creep = Creep()
    observe(creep, 0.85, 100)
    observe(creep, 1.0, 500)
    assert creep.gain == 1.0


@pytest.mark.parametrize("share", [-1.0, 0.0, 0.5, 2.0])
def test_what_is_no_slip_is_ignored(share: float) -> None:
    creep = Creep()
    observe(creep, share, 100)
    assert creep.gain == 1.0


def test_the_gain_is_bounded() -> None:
    for share in (LEAST + 1e-6, MOST - 1e-6):
        creep = Creep()
        observe(creep, share, 100)
        assert LEAST <= creep.gain <= MOST


def test_speeding_up_is_ignored() -> None:
    creep = Creep()
    for speed in itertools.islice(itertools.count(0.1, 0.001), 100):
        creep.observe(speed, 0.89 * speed * STEP, STEP)
    assert creep.gain == 1.0


async def trip(robot: Robot) -> None:
    await robot.move(1.0)
    await robot.turn(90.0)
    await robot.move(1.0)


def steps(
    monkeypatch: pytest.MonkeyPatch, drive: str, creep: float
) -> tuple[int, FakeRobot]:
    fake = FakeRobot("r", joints(drive), creep=creep)
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
    for creep in (0.0, 0.11):
        fake = FakeRobot("r", joints(drive), creep=creep)
        drive_alone(FakeWorld(fake), monkeypatch, drive, turn)
        counts.append(len(fake.rate_history))
    assert counts[1] <= 1.03 * counts[0]
