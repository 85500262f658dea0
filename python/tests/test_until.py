"""Turning until sensors are free."""

import math
from collections.abc import Callable

import pytest
from driving import DRIVES, drive_alone, errors, joints
from fake_simulator import FakeRobot, FakeWorld
from pydslrep_runtime import MovementError, Robot


def sees(low: float, high: float) -> Callable[[FakeRobot], bool]:
    """A sensor that detects something while the heading is between two angles in degrees."""
    return lambda robot: (
        low < math.degrees(math.remainder(robot.theta, math.tau)) < high
    )


@pytest.mark.parametrize("drive", DRIVES)
def test_turns_until_none_detects(drive: str, monkeypatch: pytest.MonkeyPatch) -> None:
    sensors = {"f": sees(-30.0, 50.0), "l": sees(-70.0, 20.0), "r": sees(-180.0, 180.0)}
    fake = FakeRobot("r", joints(drive), sensors=sensors)

    async def actions(robot: Robot) -> None:
        await robot.turn(10.0)
        await robot.turn_until_free("right", "f", "l")
        assert -77.0 < math.degrees(fake.theta) < -70.0
        heading = fake.theta
        await robot.move(1.0)
        assert errors(fake, math.cos(heading), math.sin(heading), heading)[0] < 0.002
        assert errors(fake, 0.0, 0.0, heading)[1] < 0.1

    drive_alone(FakeWorld(fake), monkeypatch, drive, actions)


def test_turns_left(monkeypatch: pytest.MonkeyPatch) -> None:
    fake = FakeRobot("r", joints("two-wheel"), sensors={"f": sees(-30.0, 50.0)})
    drive_alone(
        FakeWorld(fake),
        monkeypatch,
        "two-wheel",
        lambda robot: robot.turn_until_free("left", "f"),
    )
    assert 50.0 < math.degrees(fake.theta) < 57.0


def test_free_sensors_mean_no_rotation(monkeypatch: pytest.MonkeyPatch) -> None:
    fake = FakeRobot("r", joints("two-wheel"), sensors={"f": sees(30.0, 50.0)})
    drive_alone(
        FakeWorld(fake),
        monkeypatch,
        "two-wheel",
        lambda robot: robot.turn_until_free("left", "f"),
    )
    assert fake.theta == 0.0


def test_a_gap_passed_in_one_step_does_not_end_the_turn(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    wide = sees(-180.0, 20.0), sees(20.5, 60.0)
    fake = FakeRobot("r", joints("two-wheel"), sensors={"a": wide[0], "b": wide[1]})
    drive_alone(
        FakeWorld(fake),
        monkeypatch,
        "two-wheel",
        lambda robot: robot.turn_until_free("left", "a", "b"),
    )
    assert 60.0 < math.degrees(fake.theta) < 67.0


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_full_turn_without_success_fails(
    side: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake = FakeRobot(
        "r",
        joints("two-wheel"),
        sensors={"f": sees(-200.0, 200.0), "g": sees(0.0, 1.0)},
    )

    async def actions(robot: Robot) -> None:
        await robot.turn_until_free("left" if side == "left" else "right", "f", "g")

    with pytest.raises(
        MovementError, match="after a full turn f, g still detect something"
    ):
        drive_alone(FakeWorld(fake), monkeypatch, "two-wheel", actions)
    assert abs(fake.theta) == pytest.approx(math.tau, abs=0.01)


@pytest.mark.parametrize("drive", DRIVES)
def test_wheels_rest_after_each_action(
    drive: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake = FakeRobot("r", joints(drive), sensors={"f": sees(20.0, 50.0)})

    def assert_at_rest() -> None:
        assert [joint.target for joint in fake.joints] == [0.0] * len(fake.joints)
        assert max(abs(joint.rate) for joint in fake.joints) < 1e-3

    async def actions(robot: Robot) -> None:
        await robot.move(0.1)
        assert_at_rest()
        await robot.turn(30.0)
        assert_at_rest()
        await robot.turn_until_free("left", "f")
        assert_at_rest()

    drive_alone(FakeWorld(fake), monkeypatch, drive, actions)
