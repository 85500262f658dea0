"""Robots that follow their wheels late, as on rollers, are on time and near enough; four plain wheels turn as planned."""

import math

import pytest
from pydslrep_runtime import Pose, Robot
from pydslrep_runtime.settings import END_ANGLE, END_DISTANCE
from stand_in import Physics, StandIn, drive, planned

Action = tuple[str, float, float]  # what, metres or degrees, and m/s

SHORT: tuple[Action, ...] = (
    ("move", 0.4, 0.12),
    ("turn", 45.0, 0.09),
    ("move", 0.25, 0.15),
    ("turn", -100.0, 0.09),
    ("move", -0.3, 0.09),
    ("turn", 20.0, 0.09),
    ("move", 0.5, 0.15),
)

# With each, a robot overshoots by as much as one on rollers in CoppeliaSim, and came back: 6 to 10 % late.
LATE_BODIES = [
    Physics(bounce=0.04),
    Physics(bounce=0.03, lag=0.03),
    Physics(lag=0.05),
]


def drive_short(robot: StandIn) -> tuple[float, float, float]:
    """The time as a share of the plan, and the largest errors of any action in metres and radians."""
    plan = Pose(0.0, 0.0, 0.0)
    far: list[float] = []
    askew: list[float] = []

    async def actions(driven: Robot) -> None:
        nonlocal plan
        for what, amount, speed in SHORT:
            await getattr(driven, what)(amount, speed)
            plan = plan.ahead(amount) if what == "move" else turned(plan, amount)
            off = robot.here.relative_to(plan)
            far.append(math.hypot(off.x, off.y))
            askew.append(abs(off.theta))

    seconds = drive(robot, actions)
    return seconds / planned(robot.kind, *SHORT), max(far), max(askew)


def turned(pose: Pose, degrees: float) -> Pose:
    return pose.turned(math.radians(degrees))


@pytest.mark.parametrize("kind", ["four-wheel", "mecanum"])
@pytest.mark.parametrize("physics", LATE_BODIES)
def test_bodies_that_follow_late_are_on_time(kind: str, physics: Physics) -> None:
    share, far, askew = drive_short(StandIn(kind, physics))
    assert share < (1.05 if kind == "mecanum" else 1.06)
    assert far < END_DISTANCE
    assert askew < END_ANGLE


@pytest.mark.parametrize("kind", ["two-wheel", "four-wheel", "mecanum"])
def test_others_end_as_exactly_as_ever(kind: str) -> None:
    share, far, askew = drive_short(StandIn(kind))
    assert share < 1.03
    assert far < 1e-4
    assert askew < math.radians(0.05)


def test_one_that_is_far_beyond_its_goal_comes_back() -> None:
    """It is pushed, and not only late."""
    robot = StandIn("two-wheel")
    go_on = robot.move_on
    pushes = iter([0.02])

    def move_on(dt: float) -> None:
        go_on(dt)
        if robot.here.x > 0.99:
            robot.here = robot.here.ahead(next(pushes, 0.0))

    robot.move_on = move_on  # type: ignore[method-assign]

    async def actions(driven: Robot) -> None:
        await driven.move(1.0)

    drive(robot, actions)
    assert next(pushes, None) is None
    assert robot.here.x == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize("degrees", [10.0, 45.0, 90.0, -180.0])
def test_four_plain_wheels_turn_in_the_planned_time(degrees: float) -> None:
    robot = StandIn("four-wheel")

    async def actions(driven: Robot) -> None:
        for _ in range(4):
            await driven.turn(degrees)

    turns = [("turn", degrees)] * 4
    assert drive(robot, actions) == pytest.approx(
        planned("four-wheel", *turns), rel=0.01, abs=0.4
    )
