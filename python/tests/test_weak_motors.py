"""Robots whose motors are slower under load end their turns; none fails within the tolerance of an action."""

import itertools
import math
from collections.abc import Sequence

import pytest
from pydslrep_runtime import MovementError, Pose, Robot
from pydslrep_runtime.settings import END_ANGLE, END_DISTANCE
from stand_in import Physics, StandIn, drive

WEAK = [
    Physics(droop=0.02),
    Physics(droop=0.04),
    Physics(droop=0.02, lag=0.05),
    Physics(droop=0.02, step=0.1),
    Physics(droop=0.015, step=0.1, bounce=0.04),
    Physics(droop=0.02, late=0.3, jitter=0.3),
    Physics(droop=0.03, step=0.02),
]


@pytest.mark.parametrize("physics", WEAK)
def test_wheels_that_scrub_turn_to_the_end(physics: Physics) -> None:
    robot = StandIn("four-wheel", physics)
    off: list[float] = []

    async def actions(driven: Robot) -> None:
        heading = 0.0
        for degrees in (90.0, -37.0, 5.0, -1.0, 180.0):
            await driven.turn(degrees)
            heading += degrees
            off.append(math.degrees(robot.here.theta) - heading)

    drive(robot, actions)
    assert max(abs(math.remainder(each, 360.0)) for each in off) < 0.5
    assert math.hypot(robot.here.x, robot.here.y) < 0.005


@pytest.mark.parametrize(
    "physics", [Physics(), Physics(lag=0.05), Physics(late=0.5, jitter=0.3)]
)
def test_nothing_is_pushed_that_does_not_stand_still(physics: Physics) -> None:
    rims: list[float] = []

    class Recorded(StandIn):
        def set_wheel_rates(self, rates: Sequence[float]) -> None:
            super().set_wheel_rates(rates)
            rims.append(self.told[-1])

    robot = Recorded("four-wheel", physics)

    async def actions(driven: Robot) -> None:
        await driven.turn(30.0)

    drive(robot, actions)
    falls = rims[rims.index(max(rims)) :]
    assert all(after <= before for before, after in itertools.pairwise(falls))


@pytest.mark.parametrize("kind", ["two-wheel", "four-wheel", "mecanum"])
def test_a_robot_that_stands_within_the_tolerance_has_arrived(kind: str) -> None:
    robot = StandIn(kind, Physics(wall=1.0 - 0.9 * END_DISTANCE))

    async def actions(driven: Robot) -> None:
        await driven.move(1.0)

    drive(robot, actions)
    assert abs(robot.here.x - 1.0) < END_DISTANCE
    robot = StandIn(kind, Physics(wall=1.0 - 1.1 * END_DISTANCE))
    with pytest.raises(MovementError, match=r"no progress for 5 s, 0\.00[56] m from"):
        drive(robot, actions)


def test_the_tolerance_of_a_turn_is_an_angle() -> None:
    """Its wheels slip on ice from there on."""

    def turn(short: float) -> None:
        robot = StandIn("two-wheel")
        stuck = math.radians(90.0) - short * END_ANGLE
        go_on = robot.move_on

        def move_on(dt: float) -> None:
            go_on(dt)
            here = robot.here
            robot.here = Pose(here.x, here.y, min(here.theta, stuck))

        robot.move_on = move_on  # type: ignore[method-assign]

        async def actions(driven: Robot) -> None:
            await driven.turn(90.0)

        drive(robot, actions)

    turn(0.9)
    with pytest.raises(MovementError, match="no progress for 5 s"):
        turn(1.1)
