"""Scripts drive a robot by its topics, and read its sensors."""

from __future__ import annotations

import math
from collections.abc import Iterator

import pytest
from conftest import Start, said
from fake_robot import FakeRobot
from geometry_msgs.msg import PoseWithCovarianceStamped, TwistStamped


@pytest.fixture
def rover(domain: int) -> Iterator[FakeRobot]:
    rover = FakeRobot()
    yield rover
    rover.close()


def test_a_robot_drives_and_turns_as_told(script: Start, rover: FakeRobot) -> None:
    process = script(
        "await rover.move(0.3, speed=0.3); await rover.turn(90, speed=0.2)"
    )
    rover.drive(process)
    output = said(process)
    assert process.returncode == 0, output
    assert (rover.x, rover.y) == pytest.approx((0.3, 0.0), abs=1e-3)
    assert math.degrees(rover.theta) == pytest.approx(90.0, abs=0.1)
    assert rover.commands[-2:] == [(0.0, 0.0, 0.0)] * 2


def test_mecanum_wheels_also_push_to_the_left(script: Start, rover: FakeRobot) -> None:
    rover.y = 0.0

    def push() -> None:
        # Somebody pushes it aside: it comes back sideways.
        if len(rover.commands) == 20:
            rover.y -= 0.02

    process = script("await rover.move(0.4, speed=0.2)", robot_type="MecanumRobot")
    rover.drive(process, push)
    assert process.returncode == 0, said(process)
    assert max(left for _, left, _ in rover.commands) > 0.01
    assert (rover.x, rover.y) == pytest.approx((0.4, 0.0), abs=2e-3)


def test_commands_have_a_limit(script: Start, rover: FakeRobot) -> None:
    process = script("await rover.move(0.3, speed=0.4)", 'ros2={"speed_limit": 0.15}')
    rover.drive(process)
    output = said(process)
    assert process.returncode == 0, output
    assert max(ahead for ahead, _, _ in rover.commands) == pytest.approx(0.15, abs=1e-6)
    assert "drives at 0.15 m/s, its speed-limit" in output


def test_topics_can_be_elsewhere_and_commands_have_a_stamp(
    script: Start, domain: int
) -> None:
    rover = FakeRobot("fleet/r7", command=TwistStamped)
    settings = '{"namespace": "/fleet/r7", "stamped": True, "base_frame": "base"}'
    process = script("await rover.move(0.1, speed=0.3)", f"ros2={settings}")
    rover.drive(process)
    rover.close()
    assert process.returncode == 0, said(process)
    assert rover.frames == {"base"}
    assert rover.x == pytest.approx(0.1, abs=1e-3)


def test_poses_may_come_from_localisation(script: Start, rover: FakeRobot) -> None:
    pose = rover.node.create_publisher(PoseWithCovarianceStamped, "/located", 10)
    rover.publishers["located"] = pose
    rover.is_lost = True

    def located() -> PoseWithCovarianceStamped:
        message = PoseWithCovarianceStamped()
        position, orientation = (
            message.pose.pose.position,
            message.pose.pose.orientation,
        )
        position.x, position.y = rover.x, rover.y
        orientation.z = math.sin(rover.theta / 2.0)
        orientation.w = math.cos(rover.theta / 2.0)
        return message

    rover.says["located"] = located
    process = script("await rover.move(0.1, speed=0.3)", 'ros2={"pose": "/located"}')
    rover.drive(process)
    assert process.returncode == 0, said(process)
    assert rover.x == pytest.approx(0.1, abs=1e-3)


@pytest.mark.parametrize(
    ("reading", "is_free"),
    [(math.inf, True), (0.9, True), (0.4, False), (-math.inf, False)],
)
def test_ranges_end_actions(
    script: Start, rover: FakeRobot, reading: float, is_free: bool
) -> None:
    """As REP 117 says: infinity is free, minus infinity too near."""
    rover.add_range("front", lambda: reading)
    process = script(
        "await rover.move(0.1, speed=0.3, until=detects('front', within=0.5))",
        'sensors=["front"]',
    )
    rover.drive(process)
    assert process.returncode == 0, said(process)
    assert rover.x == pytest.approx(0.1 if is_free else 0.0, abs=1e-3)


def test_a_reading_that_is_no_number_fails(script: Start, rover: FakeRobot) -> None:
    rover.add_range("front", lambda: math.nan)
    process = script(
        "await rover.move(0.2, until=detects('front'))", 'sensors=["front"]'
    )
    rover.drive(process)
    output = said(process)
    assert process.returncode == 1, output
    assert "sensor front, /rover/range/front: its reading is no number" in output
    assert all(ahead == 0.0 for ahead, _, _ in rover.commands)


def test_a_sensor_is_a_sector_of_a_scan(script: Start, rover: FakeRobot) -> None:
    """It stops at the wall ahead, not at what is beside it; 0 is what many scanners say of nothing."""

    def distances() -> list[float]:
        ahead = 180
        found = [0.0] * 360
        found[ahead - 8 : ahead + 8] = [1.0 - rover.x] * 16
        found[ahead + 60 : ahead + 120] = [0.2] * 60
        return found

    rover.add_scan(distances)
    process = script(
        "await rover.move(2.0, speed=0.3, until=detects('front', within=0.5))",
        'sensors=["front"], ros2={"scan": "scan"}, mounts={"front": (0.1, 0.0, 0.0, 0.8, 20.0)}',
    )
    rover.drive(process)
    assert process.returncode == 0, said(process)
    assert 0.5 < rover.x < 0.6
