"""What comes from a simulator or robot is checked before it is used, whatever it is."""

import math
from collections.abc import Callable
from typing import Any

import pytest
from driving import drive_alone, joints
from fake_simulator import FakeRobot, FakeSim, FakeWorld
from pydslrep_runtime import (
    Backend,
    MovementError,
    Pose,
    RealTimeClock,
    Robot,
    RobotSpec,
    SensorCone,
    SetupError,
    SimulatorError,
    readings,
    vrep,
)
from pydslrep_runtime.api_calls import CALLS
from pydslrep_runtime.checked_backend import CheckedBackend
from pydslrep_runtime.event_loop import SimulationLoop
from pydslrep_runtime.readings import MATRIX, read_reply, shown

LEVEL = [1.0, 0.0, 0.0, 0.5, 0.0, 1.0, 0.0, -0.5, 0.0, 0.0, 1.0, 0.1]
NONSENSE = [math.nan, math.inf, -math.inf, 1e308, "x", None, [], {}, b"x", 10**400]


def test_the_result_of_every_call_is_checked() -> None:
    named = {name for name in readings.RESULTS if "." not in name}
    assert named == set(CALLS)


@pytest.mark.parametrize("wrong", NONSENSE, ids=lambda value: shown(value))
def test_a_matrix_has_numbers(wrong: Any) -> None:
    assert MATRIX.accepts(LEVEL)
    for index in range(12):
        assert not MATRIX.accepts([*LEVEL[:index], wrong, *LEVEL[index + 1 :]])
    assert not MATRIX.accepts(wrong)


@pytest.mark.parametrize("wrong", [LEVEL[:11], [*LEVEL, 0.0], [0.0] * 12, [1.0] * 12])
def test_a_matrix_is_one(wrong: list[float]) -> None:
    assert not MATRIX.accepts(wrong)


@pytest.mark.parametrize("name", [n for n, forms in readings.RESULTS.items() if forms])
def test_no_result_may_be_nonsense(name: str) -> None:
    forms = readings.RESULTS[name]
    fine = [value for value in NONSENSE if value not in ([], {}, None, "x", b"x")]
    for wrong in fine:
        with pytest.raises(SimulatorError, match=name) as error:
            read_reply(f"sim.{name}", [wrong] * len(forms))
        assert len(str(error.value)) < 250
        assert len(shown(wrong)) < 40


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (math.nan, "nan"),
        ("a\x1b[31m\x9b\u202e" + "b" * 99, '"a [31m ' + "b" * 53 + '..."'),
        ([1.5] * 12, "[1.5, 1.5, 1.5, 1.5, ... (12 values)]"),
        ({"a": 1}, "a map of 1"),
        (-(10**5000), "a very large number"),
        ([[[["x" * 999] * 9] * 9] * 9] * 9, None),
    ],
    ids=["nan", "controls", "list", "map", "large", "nested"],
)
def test_a_value_is_shown_in_a_few_words(value: object, words: str | None) -> None:
    text = shown(value)
    assert words in (text, None)
    assert len(text) <= 125


@pytest.mark.parametrize("wrong", [math.nan, math.inf, 1e308, "north"])
def test_a_pose_that_is_no_number_ends_the_run(
    monkeypatch: pytest.MonkeyPatch, wrong: Any
) -> None:
    fake = FakeRobot("r", joints("two-wheel"))
    world = FakeWorld(fake)
    honest = FakeSim.getObjectMatrix

    def diverge(sim: FakeSim, handle: int) -> Any:
        matrix = honest(sim, handle)
        return [wrong, *matrix[1:]] if world.steps >= 20 else matrix

    monkeypatch.setattr(FakeSim, "getObjectMatrix", diverge)
    with pytest.raises(MovementError) as error:
        drive_alone(world, monkeypatch, "two-wheel", lambda robot: robot.move(1.0))
    shown_value = '"north"' if wrong == "north" else str(wrong)
    assert str(error.value).startswith(
        "robot r, movement m, action 1: move 1 m: error from 127.0.0.1:19999: "
        f"sim.getObjectMatrix returned [{shown_value}, "
    )
    assert all(joint.target == 0.0 for joint in fake.joints)
    assert not world.running


class LegacyClient:
    """V-REP's client, with one answer to everything."""

    simx_opmode_blocking = 0

    def __init__(self, *answer: Any) -> None:
        self._answer = answer
        for name in readings.LEGACY_RESULTS:
            setattr(self, name, self._function(name))

    def _function(self, name: str) -> Callable[..., Any]:
        def function(*_: Any) -> Any:
            return (0, *self._answer)

        function.__name__ = name
        return function

    def simxStart(self, *_: Any) -> int:  # noqa: N802
        """A connection."""
        return 0


@pytest.mark.parametrize("name", readings.LEGACY_RESULTS)
@pytest.mark.parametrize(
    "wrong", [math.nan, math.inf, 1e308, "x", None, [math.nan] * 3]
)
def test_v_rep_is_checked(name: str, wrong: Any) -> None:
    client = LegacyClient(wrong)
    connection = vrep.Connection(client, "127.0.0.1", 19999)
    with pytest.raises(SimulatorError, match=f"19999: {name} returned") as error:
        connection.call(getattr(client, name), 1)
    assert len(str(error.value)) < 250


Times = Callable[[float], float]


@pytest.mark.parametrize(
    ("lie", "words"),
    [
        (lambda _: 0.5, "stands still at 0.5 s"),
        (lambda time: time if time < 2.0 else 1.0, "went back from"),
        (lambda time: time if time < 2.0 else 1e8, "1e+08 s at once"),
        (lambda _: math.nan, "returned nan instead of a time from 0"),
        (lambda _: "noon", 'returned "noon" instead of a time'),
    ],
)
def test_a_clock_that_lies_ends_the_run(
    monkeypatch: pytest.MonkeyPatch, lie: Times, words: str
) -> None:
    fake = FakeRobot("r", joints("two-wheel"))
    world = FakeWorld(fake)
    monkeypatch.setattr(
        FakeSim, "getSimulationTime", lambda sim: lie(world.steps * world.dt)
    )

    async def for_ever(robot: Robot) -> None:
        for _ in range(100):
            await robot.move(1.0)

    with pytest.raises((MovementError, SimulatorError)) as error:
        drive_alone(world, monkeypatch, "two-wheel", for_ever)
    assert "sim.getSimulationTime" in str(error.value)
    assert words in str(error.value)
    assert all(joint.target == 0.0 for joint in fake.joints)


class Rover(Backend):
    """A robot that answers what a test wants."""

    def __init__(self, **answers: Any) -> None:
        self.clock = RealTimeClock(0.05)
        self.answers = answers

    def wheel_mounts(self) -> Any:
        """Two wheels."""
        return self.answers.get("wheel_mounts", [(0.0, 0.1), (0, -0.1)])

    def pose(self) -> Any:
        """Where it is."""
        return self.answers.get("pose", Pose(1, 2.0, 3.0))

    def set_wheel_rates(self, rates: object) -> None:
        """Does not move."""

    def detects(self, sensor: str) -> Any:
        """Nothing."""
        return self.answers.get("detects", False)

    def distance(self, sensor: str) -> Any:
        """Nothing."""
        return self.answers.get("distance")

    def sensor_cone(self, sensor: str) -> Any:
        """Ahead."""
        return self.answers.get("sensor_cone", SensorCone(Pose(0.1, 0.0, 0.0)))

    def wheel_angles(self) -> Any:
        """At rest."""
        return self.answers.get("wheel_angles", [0, 0.0])


SPEC = RobotSpec("rover", "127.0.0.1", 23000, {"left": 0.05, "right": 0.05})
METHODS: dict[str, Callable[[Backend], Any]] = {
    "wheel_mounts": lambda robot: robot.wheel_mounts(),
    "pose": lambda robot: robot.pose(),
    "detects": lambda robot: robot.detects("eye"),
    "distance": lambda robot: robot.distance("eye"),
    "sensor_cone": lambda robot: robot.sensor_cone("eye"),
    "wheel_angles": lambda robot: robot.wheel_angles(),
}
WRONG = [
    ("wheel_mounts", [(0.0, 0.1)], "[[0.0, 0.1]] instead of the positions of 2 wheels"),
    ("wheel_mounts", [(0.0, 0.1), (0.0, math.nan)], "[[0.0, 0.1], [0.0, nan]]"),
    ("wheel_mounts", None, "nothing"),
    ("pose", (0.0, 0.0, 0.0), "[0.0, 0.0, 0.0] instead of a Pose"),
    ("pose", Pose(math.nan, 0.0, 0.0), "pose().x returned nan"),
    ("pose", Pose(0.0, 0.0, math.inf), "pose().theta returned inf"),
    ("detects", "no", '"no" instead of True or False'),
    ("distance", math.nan, "nan instead of a number from 0"),
    ("distance", -1.0, "-1.0 instead of a number from 0"),
    ("sensor_cone", Pose(0.0, 0.0, 0.0), "a Pose instead of a SensorCone"),
    ("sensor_cone", SensorCone(Pose(0.0, 0.0, math.nan)), "theta returned nan"),
    ("wheel_angles", [0.0, 0.0, 0.0], "instead of the angles of 2 wheels"),
]


@pytest.mark.parametrize(("method", "answer", "words"), WRONG)
def test_a_robot_of_your_own_is_checked(method: str, answer: Any, words: str) -> None:
    METHODS[method](CheckedBackend(Rover(), SPEC))
    robot = CheckedBackend(Rover(**{method: answer}), SPEC)
    with pytest.raises(SimulatorError) as error:
        METHODS[method](robot)
    assert str(error.value).startswith(f"Rover.{method}")
    assert words in str(error.value)


@pytest.mark.parametrize("step", [0.0, math.nan, -1.0, 1e308, None])
def test_a_clock_of_your_own_has_a_step(step: Any) -> None:
    rover = Rover()
    rover.clock.time_step = step
    with pytest.raises(
        SetupError, match=r"robot rover: Rover\.clock\.time_step returned"
    ):
        CheckedBackend(rover, SPEC)


class Clock:
    """A clock whose times a test chooses."""

    def __init__(self, *times: Any) -> None:
        self.time: Any = 0.0
        self.time_step = 0.05
        self._times = iter(times)

    def advance(self) -> None:
        """The last time stays."""
        self.time = next(self._times, self.time)


@pytest.mark.parametrize(
    ("clock", "words"),
    [
        (Clock(9.0, 0.5), "Clock.time went back from 9 s to 0.5 s"),
        (Clock(0.1, 1e6), "Clock.time went from 0.1 s to 1e+06 s at once"),
        (Clock(0.1, math.nan), "Clock.time returned nan instead of a time"),
        (Clock(0.1, None), "Clock.time returned nothing instead of a time"),
        (Clock(0.1, 0.0, 0.1, 0.0), "Clock.time stands still at 0.1 s"),
        (
            Clock(0.1),
            "Clock.time stands still at 0.1 s, although steps were taken for 10 s",
        ),
    ],
)
def test_a_clock_goes_on(
    monkeypatch: pytest.MonkeyPatch, clock: Clock, words: str
) -> None:
    real = iter(range(10**6))
    monkeypatch.setattr("time.monotonic", lambda: float(next(real)))
    loop = SimulationLoop()
    loop.use_clock(clock)

    async def wait() -> None:
        for _ in range(10**6):
            await loop.next_step(clock, 0)

    try:
        with pytest.raises(SimulatorError) as error:
            loop.run_until_complete(wait())
    finally:
        loop.close()
    assert words in str(error.value)
