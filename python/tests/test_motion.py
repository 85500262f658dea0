"""Moves and turns: robots end where planned, for any angle, distance and start."""

import itertools
import math
import random
from collections.abc import Callable

import pytest
from driving import DRIVES, drive_alone, errors, joints, wheel_middle
from fake_simulator import FakeRobot, FakeWorld
from length import few
from pydslrep_runtime import Robot
from pydslrep_runtime.facts import RIM_ACCELERATION
from pydslrep_runtime.pose import Pose

POSITION = 0.001  # m; the requirement is 0.005
HEADING = 0.1  # degrees; the requirement is 0.5

# Variants of robots that occur in scenes.
BODIES: dict[str, Callable[[FakeRobot], None]] = {}


def body(change: Callable[[FakeRobot], None]) -> None:
    """Adds a variant of the robot."""
    BODIES[change.__name__] = change


@body
def strong(robot: FakeRobot) -> None:
    """Leaves the robot as it is."""


@body
def weak(robot: FakeRobot) -> None:
    robot.motor_acceleration = 25.0


@body
def mirrored(robot: FakeRobot) -> None:
    for joint in robot.joints[::2]:
        joint.axis_sign = -1.0


@body
def off_centre(robot: FakeRobot) -> None:
    for joint in robot.joints:
        joint.x += 0.07
        joint.y -= 0.03


def make_robot(drive: str, body: str, chance: random.Random) -> FakeRobot:
    """A robot at a random pose."""
    x, y, theta = (chance.uniform(-5.0, 5.0) for _ in range(3))
    robot = FakeRobot("r", joints(drive), x, y, theta)
    BODIES[body](robot)
    return robot


@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("seed", few(1, range(4)))
def test_every_action_ends_where_planned(
    drive: str, body: str, seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    chance = random.Random(f"{drive} {body} {seed}")
    fake = make_robot(drive, body, chance)
    world = FakeWorld(fake)
    planned = Pose(*wheel_middle(fake), fake.theta)

    async def actions(robot: Robot) -> None:
        nonlocal planned
        for _ in range(5):
            angle = chance.uniform(-400.0, 400.0)
            await robot.turn(angle)
            planned = planned.turned(math.radians(angle))
            check()
            distance = chance.uniform(-1.5, 1.5)
            await robot.move(distance, chance.choice([0.05, 0.09, 0.4]))
            planned = planned.ahead(distance)
            check()

    def check() -> None:
        distance, angle = errors(fake, planned.x, planned.y, planned.theta)
        assert distance < POSITION
        assert angle < HEADING

    drive_alone(world, monkeypatch, drive, actions)
    assert all(joint.target == 0.0 for joint in fake.joints)


@pytest.mark.parametrize("drive", DRIVES)
def test_no_wheel_jumps(drive: str, monkeypatch: pytest.MonkeyPatch) -> None:
    fake = FakeRobot("r", joints(drive), motor_acceleration=1e9)

    async def actions(robot: Robot) -> None:
        await robot.move(0.5)
        await robot.turn(77.0)
        await robot.move(-0.3, 0.3)

    drive_alone(FakeWorld(fake), monkeypatch, drive, actions)
    rims = [
        [rate * 0.045 for rate in row]
        for row in [[0.0] * len(fake.joints), *fake.rate_history]
    ]
    jumps = [
        abs(b - a)
        for before, after in itertools.pairwise(rims)
        for a, b in zip(before, after, strict=True)
    ]
    assert max(jumps) <= RIM_ACCELERATION * 0.05 * 1.1
    assert max(jumps) >= RIM_ACCELERATION * 0.05 * 0.9


@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.parametrize("seed", few(1, range(5)))
def test_slipping_wheels_still_arrive(
    drive: str, seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake = FakeRobot("r", joints(drive), slip=0.05)

    async def actions(robot: Robot) -> None:
        for _ in range(3):
            await robot.move(2.0)
            await robot.turn(-90.0)
        await robot.move(2.0)

    drive_alone(FakeWorld(fake, seed=seed), monkeypatch, drive, actions)
    distance, angle = errors(fake, 0.0, 0.0, math.radians(90.0))
    assert distance < 0.005
    assert angle < 0.5


@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.parametrize("dt", [0.01, 0.1])
def test_other_time_steps(
    drive: str, dt: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake = FakeRobot("r", joints(drive))

    async def actions(robot: Robot) -> None:
        await robot.move(1.0)
        await robot.turn(30.0)

    drive_alone(FakeWorld(fake, dt=dt), monkeypatch, drive, actions)
    distance, angle = errors(fake, 1.0, 0.0, math.radians(30.0))
    assert distance < POSITION
    assert angle < HEADING


def test_a_pushed_robot_returns_to_its_line(monkeypatch: pytest.MonkeyPatch) -> None:
    fake = FakeRobot("r", joints("two-wheel"))
    world = FakeWorld(fake)

    def push() -> None:
        if world.steps == 100:
            fake.y += 0.05
            fake.theta += 0.2

    world.before_step = push
    drive_alone(world, monkeypatch, "two-wheel", lambda robot: robot.move(3.0))
    distance, angle = errors(fake, 3.0, 0.0, 0.0)
    assert distance < POSITION
    assert angle < HEADING


def test_a_robot_that_ends_turned_is_turned_back(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fake = FakeRobot("r", joints("two-wheel"))
    world = FakeWorld(fake)
    pushes = iter([0.03])

    def push() -> None:
        if fake.x > 0.9995:
            fake.theta += next(pushes, 0.0)

    world.before_step = push
    drive_alone(world, monkeypatch, "two-wheel", lambda robot: robot.move(1.0))
    assert next(pushes, None) is None
    assert errors(fake, 1.0, 0.0, 0.0)[1] < HEADING


def test_few_calls_per_step(monkeypatch: pytest.MonkeyPatch) -> None:
    world = FakeWorld(FakeRobot("r", joints("two-wheel")))
    drive_alone(world, monkeypatch, "two-wheel", lambda robot: robot.move(4.0))
    assert 880 < world.steps < 920
    # The pose and the step; every twentieth step, the rates that the wheels were told.
    assert world.calls.total() < 2.25 * world.steps


@pytest.mark.parametrize("tremor", [0.0, 1e-4])
def test_a_move_rests_once_and_not_for_long(
    tremor: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake = FakeRobot("r", joints("two-wheel"), tremor=tremor)

    async def actions(robot: Robot) -> None:
        await robot.move(0.3)

    drive_alone(FakeWorld(fake), monkeypatch, "two-wheel", actions)
    drives = [any(abs(rate) > 0.01 for rate in row) for row in fake.rate_history]
    rest = drives[::-1].index(True)
    assert rest <= 4, "it does not wait for the end of a tremor"
    assert all(drives[1:-rest]), "it comes to rest once"


def test_a_tremor_is_no_progress(monkeypatch: pytest.MonkeyPatch) -> None:
    """Below the tremor, a robot does not try to come nearer."""
    fake = FakeRobot("r", joints("two-wheel"), tremor=3e-4)
    world = FakeWorld(fake)

    async def actions(robot: Robot) -> None:
        await robot.move(0.3)

    drive_alone(world, monkeypatch, "two-wheel", actions)
    assert world.steps * world.dt < 0.3 / 0.09 + 0.18 + 0.7
    assert abs(fake.x - 0.3) < 0.0015


def test_a_corrected_estimate_is_where_the_next_motion_starts(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Odometry that turns out to be 10 cm off: what follows is as long as it says."""
    fake = FakeRobot("r", joints("two-wheel"))

    async def actions(robot: Robot) -> None:
        motion = robot._connected()

        class Estimate:
            wheel_travel, off = 0.0, 0.0

            def pose(self) -> Pose:
                return motion.backend.pose().ahead(self.off)

            def correct(self, pose: Pose) -> None:
                self.off = pose.x - motion.backend.pose().x

        motion.use_odometry(Estimate())
        await robot.move(0.5)
        here = fake.x
        motion.correct(motion.pose().ahead(0.1))
        await robot.move(0.5)
        assert fake.x - here == pytest.approx(0.5, abs=POSITION)

    drive_alone(FakeWorld(fake), monkeypatch, "two-wheel", actions)
