"""Conditions: how they end actions, what counts for them, and how old readings may be."""

import math
from collections.abc import Callable
from typing import Any

import pytest
from driving import DRIVES, drive_alone, errors, joints
from fake_simulator import FakeRobot, FakeSim, FakeWorld
from pydslrep_runtime import (
    Backend,
    Condition,
    MovementError,
    Pose,
    RealTimeClock,
    Robot,
    RobotSpec,
    SimulatorError,
    clear,
    detects,
    vrep,
)
from pydslrep_runtime.checked_backend import CheckedBackend
from pydslrep_runtime.facts import RIM_ACCELERATION, RIM_SPEED

# m of way to stop from 9 cm/s: by the ramp, and a step further.
BRAKING = RIM_SPEED**2 / (2.0 * 0.5) + RIM_SPEED * 0.05


def beyond(x: float) -> Callable[[FakeRobot], bool]:
    """A sensor that detects something from a place on."""
    return lambda robot: robot.x >= x


def robot_with(drive: str = "two-wheel", **sensors: Any) -> FakeRobot:
    return FakeRobot("r", joints(drive), sensors=sensors)


class Readings(Backend):
    """A robot whose sensors read what a test wants."""

    def __init__(self, **distances: float | None) -> None:
        self.clock = RealTimeClock(0.05)
        self.distances = distances
        self.age = 0.0

    def wheel_mounts(self) -> list[tuple[float, float]]:
        return [(0.0, 0.1), (0.0, -0.1)]

    def pose(self) -> Pose:
        return Pose(0.0, 0.0, 0.0)

    def set_wheel_rates(self, rates: object) -> None:
        """Does not move."""

    def distance(self, sensor: str) -> float | None:
        return self.distances[sensor]

    def reading_age(self, sensor: str) -> float:
        return self.age


@pytest.mark.parametrize(
    ("condition", "holds"),
    [
        (detects("near"), True),
        (detects("none"), False),
        (detects("none", "near"), True),
        (detects("near", within=0.4), True),
        (detects("near", within=0.3), False),
        (detects("none", "far", within=0.4), False),
        (clear("none"), True),
        (clear("none", "near"), False),
        (clear("far", within=0.4), True),
        (clear("far", "near", within=0.4), False),
    ],
)
def test_what_counts(condition: Condition, holds: bool) -> None:
    assert condition.holds(Readings(near=0.3, far=0.9, none=None), ()) is holds


def test_bumpers_measure_no_distance() -> None:
    backend = Readings(bumper=0.01, near=0.3)
    assert detects("bumper").holds(backend, ["bumper"])
    assert not detects("bumper", within=0.5).holds(backend, ["bumper"])
    assert clear("bumper", within=0.5).holds(backend, ["bumper"])
    assert detects("bumper", "near", within=0.5).holds(backend, ["bumper"])


@pytest.mark.parametrize(
    ("condition", "words", "unmet"),
    [
        (detects("f"), "f detects something", "f still detects nothing"),
        (
            detects("f", "g", "h", within=0.4),
            "f, g or h detects something within 0.4 m",
            "f, g, h still detect nothing within 0.4 m",
        ),
        (clear("f"), "f detects nothing", "f still detects something"),
        (
            clear("f", "g", within=1.0),
            "f, g detect nothing within 1 m",
            "f, g still detect something within 1 m",
        ),
    ],
)
def test_conditions_in_words(condition: Condition, words: str, unmet: str) -> None:
    assert (str(condition), condition.unmet()) == (words, unmet)


def test_impossible_conditions() -> None:
    with pytest.raises(ValueError, match="needs a sensor"):
        detects()
    with pytest.raises(ValueError, match="nothing is nearer than 0 m"):
        clear("f", within=0.0)


@pytest.mark.parametrize("drive", DRIVES)
def test_a_move_stops_and_the_next_one_goes_on(
    drive: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake = robot_with(drive, f=beyond(0.5))

    async def actions(robot: Robot) -> None:
        await robot.turn(1e-9)
        await robot.move(until=detects("f"))
        assert 0.5 <= fake.x < 0.5 + RIM_SPEED * 0.05 + BRAKING
        assert all(joint.target == 0.0 for joint in fake.joints)
        there = fake.x
        await robot.move(-0.2)
        assert errors(fake, there - 0.2, 0.0, 0.0)[0] < 0.001

    drive_alone(FakeWorld(fake), monkeypatch, drive, actions)


@pytest.mark.parametrize("speed", [0.03, RIM_SPEED, 0.3])
def test_a_robot_brakes_by_its_ramp(
    speed: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake = robot_with(f=beyond(0.5))
    drive_alone(
        FakeWorld(fake),
        monkeypatch,
        "two-wheel",
        lambda robot: robot.move(speed=speed, until=detects("f")),
    )
    braking = speed**2 / (2.0 * RIM_ACCELERATION) + speed * 0.05
    # It is noticed a step later at most.
    assert 0.5 <= fake.x < 0.5 + speed * 0.05 + braking


def test_a_move_that_is_deflected_and_stops_fails(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fake = robot_with(f=beyond(0.5))
    world = FakeWorld(fake)

    def push() -> None:
        fake.kerb = max(0.3 * fake.x, fake.kerb)

    world.before_step = push
    with pytest.raises(
        MovementError,
        match=r"move until f detects something: ended 0\.1\d\d m to the left of the goal",
    ):
        drive_alone(
            world,
            monkeypatch,
            "two-wheel",
            lambda robot: robot.move(until=detects("f")),
        )


def test_what_held_first_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    """A pole that one step detects: the robot brakes, although nothing is there any more."""
    fake = robot_with(f=lambda robot: 0.5 <= robot.x < 0.505)

    async def actions(robot: Robot) -> None:
        await robot.move(until=detects("f"))

    drive_alone(FakeWorld(fake), monkeypatch, "two-wheel", actions)
    assert 0.505 < fake.x < 0.53


def test_a_distance_ends_a_move_normally(monkeypatch: pytest.MonkeyPatch) -> None:
    fake = robot_with(f=lambda _: False)

    async def actions(robot: Robot) -> None:
        await robot.move(-0.3, 0.2, until=detects("f"))
        await robot.turn(90.0, 0.2, until=detects("f"))
        await robot.move(0.2)

    drive_alone(FakeWorld(fake), monkeypatch, "two-wheel", actions)
    assert errors(fake, -0.3, 0.2, math.radians(90.0))[0] < 0.001


def test_a_time_ends_a_wait_and_an_angle_a_circle_normally(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fake = robot_with(f=lambda _: False)

    async def actions(robot: Robot) -> None:
        await robot.wait(0.05)
        began = robot.time
        await robot.wait(0.5, until=detects("f"))
        assert robot.time - began == pytest.approx(0.5)
        await robot.arc(90.0, radius=0.3, until=detects("f"))

    drive_alone(FakeWorld(fake), monkeypatch, "two-wheel", actions)
    assert errors(fake, 0.3, 0.3, math.radians(90.0))[0] < 0.001


def test_a_condition_that_holds_before_means_no_motion(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fake = robot_with(f=lambda _: True)
    world = FakeWorld(fake)
    times: list[float] = []

    async def actions(robot: Robot) -> None:
        await robot.move(1.0, until=detects("f"))
        times.append(robot.time)
        await robot.turn("left", until=detects("f"))
        await robot.arc(90.0, radius=0.5, until=detects("f"))
        await robot.wait(5.0, until=detects("f"))
        times.append(robot.time)

    drive_alone(world, monkeypatch, "two-wheel", actions)
    assert times == [world.dt, world.dt], (
        "the first condition of a run waits for one step"
    )
    assert (fake.x, fake.y, fake.theta) == (0.0, 0.0, 0.0)


def test_the_first_condition_has_readings_after_other_actions(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fake = robot_with(f=lambda _: True)

    async def actions(robot: Robot) -> None:
        await robot.wait(0.1)
        assert robot.time == pytest.approx(0.1)
        assert await robot.check(detects("f"))
        assert not await robot.check(clear("f"))
        assert robot.time == pytest.approx(0.1)

    drive_alone(FakeWorld(fake), monkeypatch, "two-wheel", actions)


def test_the_first_check_of_a_run_waits_for_a_step(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fake = robot_with(f=lambda _: True)

    async def actions(robot: Robot) -> None:
        assert await robot.check(detects("f"))
        assert robot.time == pytest.approx(0.05)
        assert await robot.check(detects("f"))
        assert robot.time == pytest.approx(0.05)

    drive_alone(FakeWorld(fake), monkeypatch, "two-wheel", actions)


@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.parametrize("degrees", ["left", 300.0])
def test_a_turn_stops(
    drive: str, degrees: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake = robot_with(drive, f=lambda robot: robot.theta > 0.8)

    async def actions(robot: Robot) -> None:
        await robot.turn(degrees, until=detects("f"))
        assert 0.8 < fake.theta < 0.9
        heading = fake.theta
        await robot.move(1.0)
        assert errors(fake, math.cos(heading), math.sin(heading), heading)[0] < 0.002

    drive_alone(FakeWorld(fake), monkeypatch, drive, actions)


Acts = Callable[[Robot], Any]


@pytest.mark.parametrize(
    ("act", "words"),
    [
        (
            lambda robot: robot.move(speed=4.0, until=detects("f", within=0.4)),
            "move until f detects something within 0.4 m: after 100 m f still detects nothing within 0.4 m",
        ),
        (
            lambda robot: robot.turn("right", until=detects("f", "g")),
            "turn right until f or g detects something: after a full turn f, g still detect nothing",
        ),
        (
            lambda robot: robot.wait(until=detects("f")),
            "wait until f detects something: after 600 s f still detects nothing",
        ),
    ],
)
def test_an_action_without_an_end_fails(
    act: Acts, words: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake = robot_with(f=lambda _: False, g=lambda _: False)
    with pytest.raises(MovementError) as error:
        drive_alone(FakeWorld(fake), monkeypatch, "two-wheel", act)
    assert str(error.value) == f"robot r, movement m, action 1: {words}"


def test_how_far_and_how_long_an_open_end_is(monkeypatch: pytest.MonkeyPatch) -> None:
    fake = robot_with(f=lambda _: False)
    world = FakeWorld(fake)
    times: list[float] = []

    async def actions(robot: Robot) -> None:
        with pytest.raises(MovementError):
            await robot.move(speed=4.0, until=detects("f"))
        assert fake.x == pytest.approx(100.0, abs=0.001)
        times.append(robot.time)
        with pytest.raises(MovementError):
            await robot.wait(until=detects("f"))
        times.append(robot.time)

    drive_alone(world, monkeypatch, "two-wheel", actions)
    assert times[1] - times[0] == pytest.approx(600.0, abs=world.dt)


@pytest.mark.parametrize(
    "act",
    [
        lambda robot: robot.move(),
        lambda robot: robot.turn("left"),
        lambda robot: robot.arc("left", radius=1.0),
        lambda robot: robot.wait(),
    ],
)
def test_an_action_needs_an_end(act: Acts, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ValueError, match="an action ends by"):
        drive_alone(FakeWorld(robot_with()), monkeypatch, "two-wheel", act)


@pytest.mark.parametrize("dt", [0.01, 0.05])
def test_a_wait_takes_its_time(dt: float, monkeypatch: pytest.MonkeyPatch) -> None:
    fake = robot_with()
    world = FakeWorld(fake, dt=dt)

    async def actions(robot: Robot) -> None:
        for seconds in (2.0, 0.3, 0.7, 1.1, 0.0):
            before = world.steps
            await robot.wait(seconds)
            assert world.steps - before == round(seconds / dt)

    drive_alone(world, monkeypatch, "two-wheel", actions)
    assert fake.x == 0.0


def test_a_wait_ends_when_the_way_is_free(monkeypatch: pytest.MonkeyPatch) -> None:
    fake = robot_with(f=lambda _: world.steps < 50 and 0.3)
    world: FakeWorld = FakeWorld(fake)

    async def actions(robot: Robot) -> None:
        await robot.wait(until=clear("f", within=0.5))
        await robot.wait(60.0, until=clear("f"))

    drive_alone(world, monkeypatch, "two-wheel", actions)
    assert world.steps == 50


def test_a_pushed_robot_returns_to_its_line_after_a_wait(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fake = robot_with()
    world = FakeWorld(fake)

    def push() -> None:
        if world.steps == 20:
            fake.y += 0.02

    world.before_step = push

    async def actions(robot: Robot) -> None:
        await robot.wait(2.0)
        await robot.move(1.0)

    drive_alone(world, monkeypatch, "two-wheel", actions)
    assert errors(fake, 1.0, 0.0, 0.0)[0] < 0.001


def test_a_reading_must_be_recent() -> None:
    backend = Readings(f=0.3, g=None)
    backend.age = 0.5
    assert detects("f").holds(backend, ())
    backend.age = 0.55
    with pytest.raises(SimulatorError) as error:
        clear("g", within=0.4).holds(backend, ())
    assert str(error.value) == (
        "the reading of sensor g is 0.55 s old; conditions need one of the last 0.5 s"
    )


def test_the_age_of_a_reading_is_checked() -> None:
    spec = RobotSpec("rover", "127.0.0.1", 23000, {"left": 0.05, "right": 0.05})
    backend = Readings(f=0.3)
    robot = CheckedBackend(backend, spec)
    backend.age = math.inf
    assert robot.reading_age("f") == math.inf
    for wrong in (math.nan, -1.0, None):
        backend.age = wrong  # type: ignore[assignment]
        with pytest.raises(SimulatorError, match=r"Readings.reading_age returned"):
            robot.reading_age("f")


def test_robots_of_earlier_versions_tell_no_age() -> None:
    class Earlier:
        clock = RealTimeClock(0.05)

        def detects(self, sensor: str) -> bool:
            return True

    spec = RobotSpec("rover", "127.0.0.1", 23000, {"left": 0.05, "right": 0.05})
    earlier: Any = Earlier()
    assert detects("f").holds(CheckedBackend(earlier, spec), ())


@pytest.mark.parametrize(
    ("act", "words"),
    [
        (
            lambda robot: robot.move(until=detects("f")),
            "move until f detects something",
        ),
        (
            lambda robot: robot.wait(until=detects("f")),
            "wait until f detects something",
        ),
        (lambda robot: robot.check(detects("f")), "if f detects something"),
        (
            lambda robot: robot.turn_until_free("left", "f"),
            "turn left until f detects nothing",
        ),
    ],
)
def test_a_sensor_that_stops_answering_fails_the_action(
    act: Acts, words: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After the simulator refuses it, and after the engine no longer reads it."""
    fake = robot_with(f=lambda robot: words.startswith("turn"))
    world = FakeWorld(fake)
    honest = FakeSim.readProximitySensor

    def read(sim: FakeSim, handle: int) -> tuple[Any, ...]:
        if world.steps < 10:
            return honest(sim, handle)
        return (-1, 0.0, [0.0, 0.0, 0.0], -1, [0.0, 0.0, 0.0])

    monkeypatch.setattr(FakeSim, "readProximitySensor", read)

    async def actions(robot: Robot) -> None:
        for _ in robot.repeat(1000):
            await act(robot)
            await robot.wait(0.05)

    with pytest.raises(MovementError) as error:
        drive_alone(world, monkeypatch, "two-wheel", actions)
    assert f": {words}: " in str(error.value)
    assert "sim.handleProximitySensor" in str(error.value)
    assert all(joint.target == 0.0 for joint in fake.joints)


def test_a_sensor_that_the_scene_does_not_handle_is_handled_for_every_reading(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Else it would say for ever what it detected when it was handled first."""
    fake = robot_with(f=beyond(0.2))
    last = {"state": -1}

    def handle(sim: FakeSim, handle: int) -> tuple[Any, ...]:
        last["state"] = int(fake.x >= 0.2)
        return (last["state"], 0.1, [0.0, 0.0, 0.0], -1, [0.0, 0.0, 0.0])

    monkeypatch.setattr(FakeSim, "handleProximitySensor", handle)
    monkeypatch.setattr(
        FakeSim,
        "readProximitySensor",
        lambda sim, handle: (last["state"], 0.1, [0.0] * 3, -1, [0.0] * 3),
    )
    drive_alone(
        FakeWorld(fake),
        monkeypatch,
        "two-wheel",
        lambda robot: robot.move(1.0, until=detects("f")),
    )
    assert 0.2 <= fake.x < 0.23


def test_the_age_of_readings_in_v_rep() -> None:
    """Its client returns the last reading for ever; but it knows when that was."""

    class Client:
        simx_opmode_buffer = 0
        time = 1000

        def simxGetLastCmdTime(self, _number: int) -> int:  # noqa: N802
            return self.time

        def simxReadProximitySensor(self, *_: Any) -> tuple[Any, ...]:  # noqa: N802
            self.time = 1000
            return 0, 1, [0.0, 0.0, 0.3], 5, [0.0, 0.0, 0.0]

        def simxGetPingTime(self, _number: int) -> tuple[int, int]:  # noqa: N802
            self.time = robot.clock.milliseconds
            return 0, 1

        def simxGetInMessageInfo(self, *_: int) -> tuple[int, int]:  # noqa: N802
            return 1, 1

    client = Client()
    connection = vrep.Connection.__new__(vrep.Connection)
    connection.client, connection.id, connection.address = client, 0, "here"
    robot = vrep.VRepRobot.__new__(vrep.VRepRobot)
    robot._client, robot._connection, robot._sensors = client, connection, {"f": 7}
    robot.clock = vrep.VRep.__new__(vrep.VRep)
    for now, age in ((1000, 0.0), (1500, 0.5), (1650, 0.65)):
        robot.clock.milliseconds = now
        assert robot.reading_age("f") == pytest.approx(age)
    assert robot.distance("f") == pytest.approx(0.3)
    with pytest.raises(SimulatorError, match=r"sensor f is 0\.65 s old"):
        detects("f", within=0.4).holds(robot, ())
    robot.clock.milliseconds = 1200
    assert detects("f", within=0.4).holds(robot, ())
