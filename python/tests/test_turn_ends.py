"""A turn ends on its spot, or fails as a move does that ends beside its line."""

import math
import re

import pytest
from pydslrep_runtime import MovementError, Robot, clear
from stand_in import Physics, StandIn, drive

DRIVES = ("two-wheel", "four-wheel")
SLIDE = 0.14  # m per radian: 44 cm in half a turn


async def half_turn(robot: Robot) -> None:
    await robot.turn(180.0)


@pytest.mark.parametrize("kind", DRIVES)
def test_a_turn_that_slides_away_fails(kind: str) -> None:
    robot = StandIn(kind, Physics(slide=SLIDE))
    with pytest.raises(MovementError) as error:
        drive(robot, half_turn)
    assert re.fullmatch(
        r"robot r, movement m, action 1: turn left 180 deg: ended 0\.\d\d\d m from the goal; "
        "an obstacle may have deflected it",
        str(error.value),
    )
    away = math.hypot(robot.here.x, robot.here.y)
    assert f"ended {away:.3f} m from" in str(error.value)
    assert away > 0.05
    assert not any(robot.told), "it has stopped"


@pytest.mark.parametrize("kind", DRIVES)
def test_a_turn_that_slides_a_little_succeeds(kind: str) -> None:
    robot = StandIn(kind, Physics(slide=0.01))
    drive(robot, half_turn)
    assert math.hypot(robot.here.x, robot.here.y) < 0.05


@pytest.mark.parametrize("kind", DRIVES)
def test_turns_until_something_is_seen_are_turns(kind: str) -> None:
    """One that ends early may be where it was before, and no further away than another one."""

    def sees_nothing_after(angle: float, robot: StandIn) -> None:
        robot.sensors["eye"] = lambda: None if robot.here.theta > angle else 0.3

    async def until_clear(robot: Robot) -> None:
        await robot.turn("left", until=clear("eye"))

    async def until_free(robot: Robot) -> None:
        await robot.turn_until_free("left", "eye")

    for actions in (until_clear, until_free):
        robot = StandIn(kind, Physics(slide=SLIDE))
        sees_nothing_after(2.0, robot)
        with pytest.raises(MovementError, match="m from the goal; an obstacle may"):
            drive(robot, actions)
        robot = StandIn(kind, Physics(slide=0.02))
        sees_nothing_after(1.0, robot)
        drive(robot, actions)


def test_a_robot_that_was_beside_its_spot_may_stay_there() -> None:
    robot = StandIn("two-wheel")
    robot.sensors["eye"] = lambda: None if robot.here.theta > 0.3 else 0.3

    async def actions(driven: Robot) -> None:
        await driven.move(0.3)
        robot.here = robot.here.transformed_by(type(robot.here)(0.0, 0.08, 0.0))
        await driven.turn("left", until=clear("eye"))

    drive(robot, actions)
    assert robot.here.y > 0.05
