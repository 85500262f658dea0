"""Arcs: robots follow circles and end where planned, forward and in reverse, to both sides."""

import itertools
import math
import random

import pytest
from driving import DRIVES, drive_alone, errors, joints, wheel_middle
from fake_simulator import FakeRobot, FakeWorld
from length import few
from pydslrep_runtime import MovementError, Pose, Robot, detects
from pydslrep_runtime.circles import Circle
from pydslrep_runtime.facts import RIM_ACCELERATION, RIM_SPEED

POSITION = 0.001  # m; the requirement is 0.005
HEADING = 0.1  # degrees; the requirement is 0.5


def after_arc(start: Pose, degrees: float, radius: float, reverse: bool) -> Pose:
    """Where an arc ends: the start, turned about the circle's centre."""
    angle = math.radians(degrees)
    to_left = radius if (degrees > 0.0) != reverse else -radius
    x = start.x - to_left * math.sin(start.theta)
    y = start.y + to_left * math.cos(start.theta)
    dx, dy = start.x - x, start.y - y
    cos, sin = math.cos(angle), math.sin(angle)
    return Pose(x + cos * dx - sin * dy, y + sin * dx + cos * dy, start.theta + angle)


@pytest.mark.parametrize(
    ("degrees", "reverse", "end"),
    [
        (90.0, False, (1.0, 1.0, 90.0)),
        (-90.0, False, (1.0, -1.0, -90.0)),
        (90.0, True, (-1.0, -1.0, 90.0)),
        (-90.0, True, (-1.0, 1.0, -90.0)),
    ],
)
def test_an_arc_turns_to_its_side_in_reverse_as_well(
    degrees: float,
    reverse: bool,
    end: tuple[float, float, float],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fake = FakeRobot("r", joints("two-wheel"))

    async def actions(robot: Robot) -> None:
        await robot.arc(degrees, radius=1.0, reverse=reverse)

    drive_alone(FakeWorld(fake), monkeypatch, "two-wheel", actions)
    distance, angle = errors(fake, end[0], end[1], math.radians(end[2]))
    assert distance < POSITION
    assert angle < HEADING
    ahead = [left + right for left, right in fake.rate_history]
    assert all(rate <= 1e-3 if reverse else rate >= -1e-3 for rate in ahead)


@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.parametrize("radius", few(2, (0.1, 1.0, 0.3, 5.0)))
@pytest.mark.parametrize("reverse", [False, True])
@pytest.mark.parametrize("motor", few(1, (25.0, 40.0)))
def test_every_arc_ends_where_planned(
    drive: str,
    radius: float,
    reverse: bool,
    motor: float,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    chance = random.Random(f"{drive} {radius} {reverse} {motor}")
    x, y, theta = (chance.uniform(-5.0, 5.0) for _ in range(3))
    fake = FakeRobot("r", joints(drive), x, y, theta, motor_acceleration=motor)
    planned = Pose(*wheel_middle(fake), theta)

    async def actions(robot: Robot) -> None:
        nonlocal planned
        for _ in range(4):
            degrees = chance.uniform(-400.0, 400.0) / max(1.0, 2.0 * radius)
            speed = chance.choice([0.05, RIM_SPEED, 0.3])
            await robot.arc(degrees, radius=radius, speed=speed, reverse=reverse)
            planned = after_arc(planned, degrees, radius, reverse)
            distance, angle = errors(fake, planned.x, planned.y, planned.theta)
            assert distance < POSITION
            assert angle < HEADING
        assert all(joint.target == 0.0 for joint in fake.joints)

    drive_alone(FakeWorld(fake), monkeypatch, drive, actions)


@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.parametrize("radius", few(1, (0.1, 2.0, 0.5)))
@pytest.mark.parametrize("scrub", [0.1, -0.1])
def test_a_track_that_is_not_as_measured(
    drive: str, radius: float, scrub: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake = FakeRobot("r", joints(drive), scrub=scrub)
    planned = Pose(0.0, 0.0, 0.0)

    async def actions(robot: Robot) -> None:
        nonlocal planned
        for degrees, reverse in ((90.0, False), (-90.0, True), (200.0, True)):
            await robot.arc(degrees, radius=radius, reverse=reverse)
            planned = after_arc(planned, degrees, radius, reverse)
            distance, angle = errors(fake, planned.x, planned.y, planned.theta)
            assert distance < 0.005
            assert angle < HEADING

    drive_alone(FakeWorld(fake), monkeypatch, drive, actions)


@pytest.mark.parametrize("radius", few(2, (0.1, 1.0, 0.5, 5.0)))
@pytest.mark.parametrize("reverse", [False, True])
def test_wheels_that_slide_in_turns_stay_on_their_circle(
    radius: float, reverse: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The default robot with full friction turns 1.69 times less than its wheels roll: docs/kinematics.md.
    fake = FakeRobot("r", joints("four-wheel"), scrub=1.0 - 1.0 / 1.69)
    planned = Pose(*wheel_middle(fake), 0.0)

    async def actions(robot: Robot) -> None:
        nonlocal planned
        for degrees in (180.0, -90.0):
            await robot.arc(degrees, radius=radius, reverse=reverse)
            planned = after_arc(planned, degrees, radius, reverse)
            distance, angle = errors(fake, planned.x, planned.y, planned.theta)
            assert distance < 0.005
            assert angle < 0.5

    drive_alone(FakeWorld(fake), monkeypatch, "four-wheel", actions)


@pytest.mark.parametrize("drive", DRIVES)
def test_a_robot_stays_on_its_circle(
    drive: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake = FakeRobot("r", joints(drive), slip=0.02)
    world = FakeWorld(fake)
    away: list[float] = []

    def measure() -> None:
        x, y = wheel_middle(fake)
        away.append(abs(math.hypot(x, y - 0.5) - 0.5))

    world.before_step = measure
    drive_alone(world, monkeypatch, drive, lambda robot: robot.arc(360.0, radius=0.5))
    assert max(away) < 0.005
    assert errors(fake, 0.0, 0.0, 0.0)[0] < 0.005


def test_a_pushed_robot_returns_to_its_circle(monkeypatch: pytest.MonkeyPatch) -> None:
    fake = FakeRobot("r", joints("two-wheel"))
    world = FakeWorld(fake)

    def push() -> None:
        if world.steps == 60:
            fake.y += 0.03
            fake.theta += 0.2

    world.before_step = push
    drive_alone(
        world, monkeypatch, "two-wheel", lambda robot: robot.arc(180.0, radius=0.5)
    )
    distance, angle = errors(fake, 0.0, 1.0, math.pi)
    assert distance < POSITION
    assert angle < HEADING


@pytest.mark.parametrize("drive", DRIVES)
def test_the_fastest_wheel_has_the_speed(
    drive: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake = FakeRobot("r", joints(drive), motor_acceleration=1e9)
    world = FakeWorld(fake)

    async def actions(robot: Robot) -> None:
        await robot.arc(-120.0, radius=0.4, speed=0.2)

    drive_alone(world, monkeypatch, drive, actions)
    rims = [[rate * 0.045 for rate in row] for row in fake.rate_history]
    assert max(max(row) for row in rims) == pytest.approx(0.2, rel=0.01)
    steps = [
        abs(after - before)
        for row, following in itertools.pairwise(rims)
        for before, after in zip(row, following, strict=True)
    ]
    assert max(steps) < 1.1 * RIM_ACCELERATION * world.dt, "no wheel jumps"
    # That of four plain wheels is 1.69 times as large: docs/kinematics.md.
    turning_radius = {"mecanum": 0.275, "four-wheel": 0.254}.get(drive, 0.15)
    planned = math.radians(120.0) * (0.4 + turning_radius) / 0.2 + 0.2 / 0.5
    assert world.steps * world.dt == pytest.approx(planned, abs=0.5)


def test_a_blocked_arc_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    fake = FakeRobot("r", joints("two-wheel"), wall=0.3)

    async def actions(robot: Robot) -> None:
        await robot.arc(90.0, radius=1.0)

    with pytest.raises(
        MovementError,
        match=r"action 1: turn left 90 deg with radius 1 m: no progress for 5 s, \d\.\d{3} m from the goal",
    ):
        drive_alone(FakeWorld(fake), monkeypatch, "two-wheel", actions)


@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.parametrize("reverse", [False, True])
def test_an_arc_stops_on_its_circle(
    drive: str, reverse: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What follows starts where it stands, on the planned circle and along it."""
    seen = {"f": lambda robot: math.degrees(robot.theta) < -40.0}
    fake = FakeRobot("r", joints(drive), sensors=seen)

    async def actions(robot: Robot) -> None:
        await robot.arc("right", radius=0.5, reverse=reverse, until=detects("f"))
        assert -46.0 < math.degrees(fake.theta) < -40.0
        angle = math.degrees(fake.theta)
        on_circle = after_arc(Pose(0.0, 0.0, 0.0), angle, 0.5, reverse)
        assert errors(fake, on_circle.x, on_circle.y, on_circle.theta)[0] < POSITION
        await robot.move(1.0)
        there = on_circle.ahead(1.0)
        assert errors(fake, there.x, there.y, there.theta)[0] < POSITION

    drive_alone(FakeWorld(fake), monkeypatch, drive, actions)


def test_a_full_circle_without_success_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    fake = FakeRobot("r", joints("two-wheel"), sensors={"f": lambda _: False})

    async def actions(robot: Robot) -> None:
        await robot.arc("left", radius=0.2, until=detects("f", within=0.5))

    with pytest.raises(MovementError) as error:
        drive_alone(FakeWorld(fake), monkeypatch, "two-wheel", actions)
    assert str(error.value) == (
        "robot r, movement m, action 1: turn left with radius 0.2 m until f detects something within 0.5 m: "
        "after a full circle f still detects nothing within 0.5 m"
    )
    assert fake.theta == pytest.approx(math.tau, abs=0.01)


@pytest.mark.parametrize("radius", [0.0, -1.0])
def test_a_circle_has_a_radius(radius: float, monkeypatch: pytest.MonkeyPatch) -> None:
    fake = FakeRobot("r", joints("two-wheel"))
    with pytest.raises(ValueError, match="no circle"):
        drive_alone(
            FakeWorld(fake),
            monkeypatch,
            "two-wheel",
            lambda robot: robot.arc(90.0, radius=radius),
        )


@pytest.mark.parametrize("radius", [0.1, 5.0, 1e6])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_points_of_a_circle(radius: float, side: float) -> None:
    circle = Circle(Pose(3.0, -2.0, 0.7), side / radius)
    for degrees in (-700.0, -90.0, -1e-3, 0.0, 1e-3, 170.0, 190.0, 900.0):
        angle = math.radians(degrees)
        there = circle.pose_at(angle)
        assert circle.angle_at(there, angle + 3.0) == pytest.approx(angle, abs=1e-9)
        to_side = Pose(there.x, there.y, there.theta + math.pi / 2.0)
        assert circle.angle_at(to_side.ahead(0.02), angle) == pytest.approx(
            angle, abs=1e-9
        ), "beside it the nearest point is the same"
