"""Robots that slide sideways while they turn are on their spot at the end of every turn but the first."""

import math

import pytest
from driving import drive_alone, joints
from fake_simulator import FakeRobot, FakeWorld
from pydslrep_runtime import Robot


@pytest.mark.parametrize("drive", ["two-wheel", "four-wheel"])
@pytest.mark.parametrize("drift", [-0.02, 0.02])
def test_turns_end_on_their_spot(
    monkeypatch: pytest.MonkeyPatch, drive: str, drift: float
) -> None:
    fake = FakeRobot("r", joints(drive), drift=drift)
    off = []

    async def turns(robot: Robot) -> None:
        for _ in range(3):
            await robot.turn(90.0)
            off.append(math.hypot(fake.x, fake.y))

    drive_alone(FakeWorld(fake), monkeypatch, drive, turns)
    assert max(off[1:]) < 0.004
