"""Steps that take longer than they should, as those of busy computers and physical robots do, slow no robot down."""

import math

import pytest
from driving import DRIVES
from pydslrep_runtime import Robot
from pydslrep_runtime.pace import MAX_STEP, Pace
from stand_in import Physics, StandIn, drive, planned

SQUARE = (("move", 1.0), ("turn", 90.0)) * 4


async def square(robot: Robot) -> None:
    for what, amount in SQUARE:
        await getattr(robot, what)(amount)


@pytest.mark.parametrize("kind", DRIVES)
@pytest.mark.parametrize(
    ("late", "jitter"),
    [
        *((late, 0.0) for late in (0.0, 0.1, 0.2, 0.5)),
        *((late, 0.3) for late in (0.0, 0.1, 0.2, 0.35, 0.5)),
    ],
)
def test_robots_are_on_time(kind: str, late: float, jitter: float) -> None:
    robot = StandIn(kind, Physics(late=late, jitter=jitter))
    seconds = drive(robot, square)
    assert seconds == pytest.approx(planned(kind, *SQUARE), rel=0.02)
    assert math.hypot(robot.here.x, robot.here.y) < 0.002


@pytest.mark.parametrize("late", [0.0, 0.3, 0.5])
def test_a_wait_is_as_long_as_it_should_be(late: float) -> None:
    async def wait(robot: Robot) -> None:
        await robot.turn(10.0)
        began = robot.time
        await robot.wait(3.0)
        half = 0.5 * 0.05 * (1.0 + late)
        assert robot.time - began == pytest.approx(3.0, abs=half + 1e-3)

    drive(StandIn("two-wheel", Physics(late=late)), wait)


def test_a_pause_is_no_step() -> None:
    pace = Pace(0.05)
    pace.observe(7.0)
    assert pace.last == MAX_STEP * 0.05
    assert pace.usual < 0.06
    for _ in range(100):
        pace.observe(0.05)
    assert pace.last == 0.05
    assert pace.usual == pytest.approx(0.05, abs=1e-6)


@pytest.mark.parametrize("elapsed", [0.0, -0.2])
def test_a_step_without_time_says_nothing(elapsed: float) -> None:
    """While CoppeliaSim is paused, and when its clock has counted steps that were not taken."""
    pace = Pace(0.05)
    for _ in range(1000):
        pace.observe(elapsed)
    assert (pace.last, pace.usual) == (0.0, 0.05)


def test_steps_on_time_change_nothing() -> None:
    pace = Pace(0.05)
    for _ in range(10):
        pace.observe(0.05)
    assert (pace.last, pace.usual) == (0.05, 0.05)
