"""Whatever happens, the robot stops, and the script says why."""

from __future__ import annotations

import math
import signal
from collections.abc import Iterator

import pytest
from conftest import END_LIMIT, Start, said
from fake_robot import STEP, FakeRobot
from geometry_msgs.msg import Pose, Twist, TwistStamped
from sensor_msgs.msg import LaserScan

STOP = (0.0, 0.0, 0.0)
DRIVE = "await rover.move(2.0, speed=0.3)"


@pytest.fixture
def rover(domain: int) -> Iterator[FakeRobot]:
    rover = FakeRobot()
    yield rover
    rover.close()


def moving(commands: list[tuple[float, float, float]]) -> int:
    """In how many steps it was told to move."""
    return sum(command != STOP for command in commands)


def test_without_odometry_it_does_not_drive_on(script: Start, rover: FakeRobot) -> None:
    since = 0

    def lose() -> None:
        nonlocal since
        if rover.time > 1.0 and not rover.is_lost:
            rover.is_lost, since = True, len(rover.commands)

    process = script(DRIVE)
    rover.drive(process, lose)
    output = said(process)
    assert process.returncode == 1, output
    assert "the odometry on /rover/odom is 0.55 s old" in output
    assert "its driver may have ended" in output
    assert 0 < moving(rover.commands[since:]) * STEP <= 0.6
    assert rover.commands[-2:] == [STOP] * 2


def test_odometry_that_comes_late_is_old(script: Start, rover: FakeRobot) -> None:
    held: list[object] = []
    publish = rover.odometry.publish

    class Slow:
        """From the first second on, what it sends arrives 0.7 s late, in order."""

        def publish(self, message: object) -> None:
            held.append(message)
            if rover.time < 1.0 or len(held) * STEP > 0.7:
                publish(held.pop(0))

    rover.odometry = Slow()
    process = script(DRIVE)
    rover.drive(process)
    output = said(process)
    assert process.returncode == 1, output
    assert "the odometry on /rover/odom is" in output
    assert rover.commands[-2:] == [STOP] * 2


def test_messages_out_of_order_are_left_out(script: Start, rover: FakeRobot) -> None:
    """A pose from before, after a newer one, changes nothing.

    There are two poses for each clock message here, so that a script that is slow to read may know the pose of five steps
    ago: it keeps ten messages.
    """
    before = rover._odometry()
    publish = rover.odometry.publish

    class Unordered:
        def publish(self, message: object) -> None:
            publish(message)
            if rover.time > 0.5:
                publish(before)

    rover.odometry = Unordered()
    process = script("await rover.move(0.3, speed=0.3)")
    rover.drive(process)
    assert process.returncode == 0, said(process)
    assert rover.x == pytest.approx(0.3, abs=5 * 0.3 * STEP + 1e-3)


def test_a_sensor_that_falls_silent_stops_it(script: Start, rover: FakeRobot) -> None:
    rover.add_range("front", lambda: math.inf)

    def lose() -> None:
        if rover.time > 1.0:
            rover.says.clear()

    process = script(
        "await rover.move(2.0, speed=0.3, until=detects('front'))", 'sensors=["front"]'
    )
    rover.drive(process, lose)
    output = said(process)
    assert process.returncode == 1, output
    assert "the reading of sensor front is 0.55 s old" in output
    assert rover.commands[-2:] == [STOP] * 2


@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP", "SIGINT"])
def test_signals_stop_it(script: Start, rover: FakeRobot, name: str) -> None:
    def end() -> None:
        if moving(rover.commands) == 10:
            process.send_signal(getattr(signal, name))

    process = script(DRIVE)
    rover.drive(process, end)
    output = said(process)
    assert process.returncode == 130, output
    assert moving(rover.commands) > 0
    assert rover.commands[-2:] == [STOP] * 2


def test_an_orientation_that_is_none_is_told(script: Start, rover: FakeRobot) -> None:
    message = rover.odometry_type()
    message.pose.pose.orientation.w = 0.0
    rover._odometry = lambda: message
    process = script(DRIVE)
    rover.drive(process)
    output = said(process)
    assert process.returncode == 1, output
    assert "/rover/odom: the orientation is no unit quaternion: its norm is" in output


def test_a_second_driver_is_told(script: Start, rover: FakeRobot) -> None:
    rival = rover.node.create_publisher(Twist, "/rover/cmd_vel", 10)
    process = script("await rover.move(0.1, speed=0.3)")
    rover.drive(process)
    rover.node.destroy_publisher(rival)
    output = said(process)
    assert process.returncode == 0, output
    assert (
        "somebody else drives robot rover, too: /rover/fake publishes on /rover/cmd_vel"
        in output
    )


@pytest.mark.parametrize(
    ("kinds", "arguments", "expected"),
    [
        (
            {"odometry": Pose},
            "",
            "/rover/odom is geometry_msgs/msg/Pose, not nav_msgs/msg/Odometry",
        ),
        (
            {"command": TwistStamped},
            "",
            "/rover/cmd_vel is geometry_msgs/msg/TwistStamped, not geometry_msgs/msg/Twist: set stamped = true in the scene",
        ),
        (
            {},
            'ros2={"stamped": True}',
            "/rover/cmd_vel is geometry_msgs/msg/Twist, not geometry_msgs/msg/TwistStamped: set stamped = false in the scene",
        ),
    ],
)
def test_other_types_are_told(
    script: Start, domain: int, kinds: dict[str, type], arguments: str, expected: str
) -> None:
    rover = FakeRobot(**kinds)
    process = script(DRIVE, arguments)
    rover.drive(process)
    rover.close()
    output = said(process)
    assert process.returncode == 2, output
    assert expected in output
    assert rover.commands == []


def test_a_sensor_of_another_type_is_told(script: Start, rover: FakeRobot) -> None:
    rover._add("range/front", LaserScan)
    process = script("await rover.move(1, until=detects('front'))", 'sensors=["front"]')
    rover.drive(process)
    output = said(process)
    assert process.returncode == 2, output
    assert (
        "/rover/range/front is sensor_msgs/msg/LaserScan, not sensor_msgs/msg/Range"
        in output
    )


def test_nobody_there_is_told(script: Start, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYDSLREP_TIME_LIMITS", "CONNECT_TIMEOUT=0.5")
    process = script(DRIVE, "", "--help")
    assert "--sim-time" in said(process)
    process = script(DRIVE, "", "--events", "-")
    output = said(process)
    assert process.returncode == 2, output
    assert "nobody listens to /rover/cmd_vel; nobody publishes /rover/odom" in output
    assert "There are no topics of others" in output


def test_a_robot_that_is_another_one_is_told_with_the_topics(
    script: Start, rover: FakeRobot, monkeypatch: pytest.MonkeyPatch
) -> None:
    expected = (
        "nobody publishes /other/odom",
        "The topics there are: /clock, /rover/cmd_vel, /rover/odom",
    )
    # The script waits for /other until its limit, which must be long enough to find the other topics on a busy machine.
    for limit in (3, 12, END_LIMIT // 2):
        monkeypatch.setenv("PYDSLREP_TIME_LIMITS", f"CONNECT_TIMEOUT={limit}")
        process = script(DRIVE, 'ros2={"namespace": "/other"}')
        rover.drive(process)
        output = said(process)
        if all(part in output for part in expected):
            break
    assert process.returncode == 2, output
    assert all(part in output for part in expected), output
