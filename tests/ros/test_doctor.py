"""`pydslrep doctor --target ros2`: what is there of a robot, and what is wrong with it."""

from __future__ import annotations

import json
import math
import os
import pathlib
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import pytest
from conftest import Start, said
from fake_robot import FakeRobot
from geometry_msgs.msg import Pose, Twist, TwistStamped
from nav_msgs.msg import Odometry
from pydslrep_runtime.ros2_findings import RULES
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from sensor_msgs.msg import LaserScan, Range

PROGRAM = """wheel l with radius 4.5
wheel r with radius 4.5
sensor front : distance
sensor unused : distance
robot rover with port 23000 has { l r } wheels with sensors { front unused }
movement m of rover { move 1 meters until { front } detect within 50 centimeters }
environment yard has { rover } robots with { m } moves
"""
BASE = {"simulation"}  # what is found of every robot of these tests

Doctor = Callable[..., "subprocess.Popen[str]"]


@pytest.fixture
def doctor(command: str, start: Start, tmp_path: pathlib.Path) -> Doctor:
    """Starts the command, with a table of the scene that describes the robot."""

    def doctor(*options: str, scene: str = "") -> subprocess.Popen[str]:
        program = tmp_path / "yard.pyr"
        program.write_text(PROGRAM, encoding="utf-8")
        text = f"[robots.rover.ros2]\n{scene}\n"
        (tmp_path / "yard.scene.toml").write_text(text, encoding="utf-8")
        python = ("--python", sys.executable)
        return start(command, "doctor", program, "--target", "ros2", *python, *options)

    return doctor


@pytest.fixture
def rover(domain: int) -> Iterator[FakeRobot]:
    rover = FakeRobot()
    rover.add_range("front", lambda: math.inf)
    yield rover
    rover.close()


def test_a_robot_that_fits_is_told_and_turns(doctor: Doctor, rover: FakeRobot) -> None:
    process = doctor("--drive")
    rover.drive(process)
    output = said(process)
    assert process.returncode == 0, output
    for line in (
        "/rover/cmd_vel      geometry_msgs/Twist",
        "/rover/odom         nav_msgs/Odometry",
        "/rover/range/front  sensor_msgs/Range",
        "told to turn by 34.4 deg/s, it turned by 34.4 deg/s, as if its wheels were 0.300 m apart",
        "1 hint",
    ):
        assert line in output
    assert "unused" not in output
    assert math.degrees(rover.theta) == pytest.approx(90.0 + 34.4, abs=8.0)
    assert (rover.x, rover.y) == (0.0, 0.0)
    assert rover.commands[-2:] == [(0.0, 0.0, 0.0)] * 2


@dataclass
class Case:
    """A robot with something wrong, and what is said of it."""

    says: str  # a part of a message or help
    spoil: Callable[[FakeRobot], object] = lambda rover: None
    kinds: dict[str, Any] = field(default_factory=dict)  # of its topics
    scene: str = ""
    options: tuple[str, ...] = ()
    code: int = 1
    besides: set[str] = field(default_factory=set)  # other findings


def rival(topic: str, kind: Any) -> Callable[[FakeRobot], object]:
    return lambda rover: rover.node.create_publisher(kind, topic, 10)


def without_front(rover: FakeRobot) -> None:
    rover.node.destroy_publisher(rover.publishers.pop("range/front"))
    del rover.says["range/front"]


def silent(rover: FakeRobot) -> None:
    del rover.says["range/front"]


def best_effort(rover: FakeRobot) -> None:
    rover.node.destroy_publisher(rover.odometry)
    rover.odometry = rover.node.create_publisher(
        Odometry, "odom", qos_profile_sensor_data
    )


def demanding(rover: FakeRobot) -> None:
    """It wants commands again that were sent before it began."""
    (listener,) = (
        each for each in rover.node.subscriptions if each.topic.endswith("cmd_vel")
    )
    rover.node.destroy_subscription(listener)
    lasting = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    rover.node.create_subscription(Twist, "cmd_vel", rover._take, lasting)


def deaf(rover: FakeRobot) -> None:
    (listener,) = (
        each for each in rover.node.subscriptions if each.topic.endswith("cmd_vel")
    )
    rover.node.destroy_subscription(listener)


def without_clock(rover: FakeRobot) -> None:
    rover.node.destroy_publisher(rover.clock)
    rover.time = 1.0  # 0 would be no stamp

    class Nobody:
        def publish(self, message: object) -> None: ...

    rover.clock = Nobody()


def rarely(seconds: float) -> Callable[[FakeRobot], object]:
    """Its stamps are so far apart, as it says."""

    def spoil(rover: FakeRobot) -> None:
        without_clock(rover)
        publish = rover.publish

        def slow() -> None:
            rover.time += seconds
            publish()

        rover.publish = slow  # type: ignore[method-assign]

    return spoil


def attribute(**values: Any) -> Callable[[FakeRobot], object]:
    return lambda rover: rover.__dict__.update(values)


def late_at_first(rover: FakeRobot) -> None:
    """It turns less than it is told, and its poses are a step late until the turn is being measured."""
    rover.turning = 0.8
    say, held = rover._odometry, [rover._odometry()]

    def late() -> Any:
        held.append(say())
        return held[-2] if rover.time < 2.0 else held[-1]

    rover._odometry = late  # type: ignore[method-assign]


CASES = {
    "no-listener": Case("nobody listens to /rover/cmd_vel", deaf),
    "missing-topic": Case("nobody publishes /rover/range/front", without_front),
    "missing-topic/elsewhere": Case(
        "`odom` or `namespace` in [robots.rover.ros2] of the scene; of its type are /rover/odom",
        scene='odom = "odometry"',
    ),
    "wrong-type": Case(
        "/rover/odom is geometry_msgs/msg/Pose, not nav_msgs/msg/Odometry",
        kinds={"odometry": Pose},
    ),
    "other-command": Case(
        "set `stamped = true` in [robots.rover.ros2]", kinds={"command": TwistStamped}
    ),
    "other-command/stamped": Case(
        "set `stamped = false` in [robots.rover.ros2]", scene="stamped = true"
    ),
    "incompatible-qos": Case(
        "the quality of service of /rover/fake does not fit on /rover/odom: messages are sent best effort",
        best_effort,
        scene='qos = "reliable"',
    ),
    "incompatible-qos/command": Case("on /rover/cmd_vel: messages are sent", demanding),
    "silent-topic": Case(
        "nothing has come on /rover/range/front, which /rover/fake publishes",
        silent,
    ),
    "bad-reading": Case(
        "/rover/range/front: its reading is no number",
        lambda rover: rover.says.update(
            {"range/front": lambda: Range(max_range=1.0, range=math.nan)}
        ),
    ),
    "stands-still": Case("the stamps on /rover/odom stand still", without_clock),
    "rare-messages": Case("up to 0.7", rarely(0.7), besides=set()),
    "slow-topic": Case("messages per second come on /rover/odom", rarely(0.3)),
    "second-source": Case(
        "/rover/odom has 2 publishers, of /rover/fake", lambda rover: None
    ),
    "second-driver": Case(
        "/rover/fake can drive the robot, too, by /rover/cmd_vel",
        rival("cmd_vel", Twist),
        options=("--drive",),
        besides={"not-driven"},
    ),
    "other-frame": Case(
        'set `base-frame = "base_footprint"` in [robots.rover.ros2]',
        attribute(frame="base_footprint"),
        code=0,
    ),
    "track": Case(
        "told to turn by 34.4 deg/s, it turns by 27.5 deg/s, as if its wheels were 0.375 m apart, not 0.300 m",
        attribute(turning=0.8),
        options=("--drive",),
    ),
    "track/late": Case(
        "told to turn by 34.4 deg/s, it turns by 27.5 deg/s",
        late_at_first,
        options=("--drive",),
    ),
    "track/scene": Case(
        "as if its wheels were 0.200 m apart, not 0.160 m",
        attribute(turning=0.8),
        scene="track = 0.16",
        options=("--drive",),
    ),
    "does-not-turn": Case(
        "look whether it obeys /rover/cmd_vel",
        attribute(turning=0.0),
        options=("--drive",),
    ),
    "turns-back": Case(
        "told to turn to the left, it turns to the right by 34.4 deg/s",
        attribute(turning=-1.0),
        options=("--drive",),
    ),
}
CLOCKLESS = {"stands-still", "rare-messages", "slow-topic"}
ELSEWHERE = {"no-topics", "simulation", "not-driven"}


def test_every_finding_has_a_robot() -> None:
    found = {name.partition("/")[0] for name in CASES}
    assert found | ELSEWHERE == {rule.code for rule in RULES}


@pytest.mark.parametrize("name", CASES)
def test_what_is_wrong_is_found(doctor: Doctor, domain: int, name: str) -> None:
    case, code = CASES[name], name.partition("/")[0]
    rover = FakeRobot(**case.kinds)
    rover.add_range("front", lambda: math.inf)
    case.spoil(rover)
    other = FakeRobot() if code == "second-source" else None
    process = doctor("--json", *case.options, scene=case.scene)
    rover.drive(process)
    for each in filter(None, (rover, other)):
        each.close()
    output = said(process)
    findings = json.loads(output)
    base = set() if code in CLOCKLESS else BASE
    assert {each["code"] for each in findings} == {code} | base | case.besides, output
    assert any(case.says in each["message"] + each["help"] for each in findings), output
    assert process.returncode == case.code, output
    if "not-driven" in case.besides or not case.options:
        assert rover.commands == []


def test_a_scanner_that_looks_elsewhere_is_told(
    doctor: Doctor, rover: FakeRobot
) -> None:
    rover._add("scan", LaserScan)
    rover.says["scan"] = lambda: LaserScan(
        angle_min=1.0, angle_increment=0.1, range_max=3.0, ranges=[1.0] * 10
    )
    process = doctor("--json", scene='scan = "scan"')
    rover.drive(process)
    output = said(process)
    assert process.returncode == 1, output
    assert "/rover/scan: the scan has no reading around 0 deg" in output


def test_an_interrupt_stops_it(doctor: Doctor, rover: FakeRobot) -> None:
    def end() -> None:
        if len(rover.commands) == 10:
            process.send_signal(signal.SIGINT)

    process = doctor("--drive")
    rover.drive(process, end)
    output = said(process)
    assert process.returncode == 130, output
    assert rover.commands[-2:] == [(0.0, 0.0, 0.0)] * 2


def test_it_does_not_turn_blindly(doctor: Doctor, rover: FakeRobot) -> None:
    def lose() -> None:
        rover.is_lost = rover.time > 1.5

    process = doctor("--drive")
    rover.drive(process, lose)
    output = said(process)
    assert process.returncode == 2, output
    assert "the odometry on /rover/odom is 0.55 s old" in output
    assert rover.commands[-2:] == [(0.0, 0.0, 0.0)] * 2


def test_a_simulation_that_is_paused_is_told(
    doctor: Doctor, rover: FakeRobot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYDSLREP_TIME_LIMITS", "CONNECT_TIMEOUT=60,REPLY_TIMEOUT=1")
    rover._integrate = lambda: None  # type: ignore[method-assign]
    process = doctor("--drive")
    rover.drive(process)
    output = said(process)
    assert process.returncode == 2, output
    assert "/clock stands still, for 1 s" in output
    assert rover.commands[-2:] == [(0.0, 0.0, 0.0)] * 2


def test_without_a_program_all_topics_are_listed(
    command: str, start: Start, rover: FakeRobot
) -> None:
    process = start(command, "doctor", "--target", "ros2", "--python", sys.executable)
    rover.drive(process)
    output = said(process)
    assert process.returncode == 0, output
    assert "/clock              rosgraph_msgs/Clock  /rover/fake" in output
    assert "/rover/cmd_vel      geometry_msgs/Twist  /rover/fake" in output


def test_nothing_there_is_told(
    doctor: Doctor, domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYDSLREP_TIME_LIMITS", "CONNECT_TIMEOUT=0.5")
    process = doctor()
    output = said(process)
    assert process.returncode == 2, output
    assert "error[no-topics]: there are no topics of others" in output
    assert "ROS_DOMAIN_ID" in output


def test_a_python_without_ros_is_told(
    command: str, start: Start, tmp_path: pathlib.Path
) -> None:
    run = subprocess.run(
        [command, "doctor", "--target", "ros2", "--python", "/usr/bin/python3"],
        capture_output=True,
        text=True,
        env={"HOME": os.environ["HOME"], "PATH": os.environ["PATH"]},
    )
    assert run.returncode == 2, run.stdout
    assert "error: this Python cannot import rclpy" in run.stderr
