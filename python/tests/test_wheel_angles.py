"""The angles that odometry reads are those of the wheels, whichever way the axes of their joints point."""

import pytest
from driving import DRIVES, declared, joints
from fake_simulator import FakeRobot, FakeWorld
from pydslrep_runtime.coppeliasim import CoppeliaSim


@pytest.mark.parametrize("drive", DRIVES)
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_angles_are_positive_forward(
    drive: str, side: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake = FakeRobot("r", joints(drive))
    for joint in fake.joints[::2]:
        joint.axis_sign = -1.0
    world = FakeWorld(fake)
    world.serve(monkeypatch)
    clock = CoppeliaSim("127.0.0.1", realtime=False)
    robot = clock.connect(declared(fake, drive).spec("127.0.0.1", 23000))
    clock.start()
    before = robot.wheel_angles()
    robot.set_wheel_rates([2.0 * side] * len(fake.joints))
    for _ in range(20):
        clock.advance()
        assert all(angle * side > 0.0 for angle in robot.wheel_angles())
    rolled = [
        after - start for after, start in zip(robot.wheel_angles(), before, strict=True)
    ]
    assert fake.x * side > 0.05
    assert rolled == pytest.approx([fake.x / 0.045] * len(fake.joints))
