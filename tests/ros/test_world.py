"""`pydslrep sim --ros2` and `pydslrep run --target ros2`: the way from a program to a robot that has driven."""

from __future__ import annotations

import json
import math
import os
import pathlib
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import pytest
import rclpy
from conftest import ROOT, Start
from nav_msgs.msg import Odometry
from pydslrep_runtime.facts import MOTOR_ACCELERATION, STEP
from pydslrep_runtime.ros2_world import Watchdog
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from until import until

TIMEOUT = 600  # s for a run on a machine that does much else
STANDS = 0.6  # s after its last command within which a robot stands
# m and degrees by engine, as without ROS 2
OFF = {"embedded": (0.005, 0.5), "mujoco": (0.02, 1.5)}
ENGINES = pytest.mark.parametrize("engine", OFF)

ROOM = """[world]
size = [3, 3]
corner = [0, 0]

[robots.explorer]
start = [1.5, 1.5]
"""

Drive = Callable[..., dict[str, Any]]


@pytest.fixture
def drive(command: str, start: Start, tmp_path: pathlib.Path) -> Drive:
    """Drives a program in a world as a node, in lockstep; returns the figures of the run."""

    def drive(
        program: pathlib.Path,
        engine: str = "embedded",
        python: str = sys.executable,
        options: Sequence[object] = (),
    ) -> Any:
        start_world(start, command, program, "--lockstep", "--engine", engine)
        figures = tmp_path / "figures.json"
        run = subprocess.run(
            [
                *(command, "run", program, "--target", "ros2", "--sim-time"),
                *("--python", python, "--figures", figures, "--no-progress"),
                *options,
            ],
            capture_output=True,
            text=True,
            timeout=TIMEOUT,
        )
        assert run.returncode == 0, run.stdout + run.stderr
        return json.loads(figures.read_text(encoding="utf-8"))

    return drive


def start_world(
    start: Start, command: str, program: pathlib.Path, *options: str
) -> subprocess.Popen[str]:
    """Starts the world, and returns when it is ready."""
    world = start(
        command, "sim", program, "--ros2", "--python", sys.executable, *options
    )
    assert world.stdout is not None
    before = []
    for line in world.stdout:
        if line.startswith("Ready"):
            return world
        # A program may have warnings.
        before.append(line)
    pytest.fail(f"the world has ended: {''.join(before)}")


@ENGINES
def test_a_program_drives_in_the_world(
    drive: Drive, short: pathlib.Path, engine: str
) -> None:
    figures = drive(short, engine)
    (robot,) = figures["robots"]
    # It stops before the wall, whose near side is at -0.85 m; the sensor is 0.15 m ahead of the middle.
    x, y, _ = pose(robot)
    assert x == pytest.approx(0.3, abs=OFF[engine][0])
    assert -0.25 < y < -0.15


def pose(robot: dict[str, Any]) -> tuple[float, float, float]:
    """Where a robot ends."""
    end = robot["driven"]
    return end["x"], end["y"], end["theta"]


PROGRAMS = (
    "tests/paper/table2_two_wheels.pyr",
    "examples/wall.pyr",
    "tests/paper/table3_four_wheels.pyr",
    "tests/paper/table4_holonomic.pyr",
    "tests/paper/table6_sensors.pyr",
)


@pytest.mark.parametrize(
    ("name", "engine"),
    [
        pytest.param(
            name, engine, marks=[] if name == PROGRAMS[0] else [pytest.mark.long]
        )
        for name in PROGRAMS
        for engine in OFF
    ],
)
def test_the_programs_of_the_article_drive(
    drive: Drive, name: str, engine: str
) -> None:
    figures = drive(ROOT / name, engine)
    assert figures["complete"], figures
    distance, angle = OFF[engine]
    # Where sensors decide, nobody knows the end before.
    for off in (robot["off"] for robot in figures["robots"] if robot["off"]):
        assert off["distance"] <= distance, figures
        assert math.degrees(off["angle"]) <= angle, figures


@pytest.mark.long
@ENGINES
def test_a_robot_explores_by_five_ranges(
    drive: Drive, tmp_path: pathlib.Path, engine: str
) -> None:
    """A room of 3 m by 3 m, which the map covers, and whose walls the robot does not touch."""
    program = tmp_path / "rooms.pyr"
    rooms = (ROOT / "examples/rooms.pyr").read_text(encoding="utf-8")
    program.write_text(rooms, encoding="utf-8")
    (tmp_path / "rooms.scene.toml").write_text(ROOM, encoding="utf-8")
    map_file = tmp_path / "map.json"
    assert drive(program, engine, options=("--map", map_file))["complete"]
    nodes = json.loads(map_file.read_text(encoding="utf-8"))["nodes"]
    for axis in ("x", "y"):
        places = [node[axis] for node in nodes]
        assert min(places) < 0.6
        assert max(places) > 2.4
        assert all(0.2 < place < 2.8 for place in places)


@pytest.mark.long
@pytest.mark.skipif(
    not os.environ.get("ROS_PYTHON_JAZZY"), reason="there are no wheels of Jazzy"
)
def test_a_script_on_jazzy_drives_a_robot_on_kilted(
    drive: Drive, short: pathlib.Path
) -> None:
    (robot,) = drive(short, python=os.environ["ROS_PYTHON_JAZZY"])["robots"]
    assert pose(robot)[0] == pytest.approx(0.3, abs=OFF["embedded"][0])


class Witness:
    """Hears how fast a robot is."""

    def __init__(self, name: str) -> None:
        self.context = rclpy.Context()
        self.context.init()
        self.node = Node("witness", context=self.context, enable_rosout=False)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)
        self.speed = 0.0  # m/s
        self.node.create_subscription(
            Odometry, f"/{name}/odom", self._hear, qos_profile_sensor_data
        )

    def _hear(self, message: Odometry) -> None:
        twist = message.twist.twist
        self.speed = math.hypot(twist.linear.x, twist.linear.y) + abs(twist.angular.z)

    def wait(self, what: str, is_so: Callable[[], bool]) -> None:
        """Listens until something is so."""

        def look() -> bool:
            self.executor.spin_once(timeout_sec=0.1)
            return is_so()

        until(what, look, lambda: f"{self.speed} m/s")

    def close(self) -> None:
        self.node.destroy_node()
        self.context.try_shutdown()


@pytest.fixture
def witness(domain: int) -> Iterator[Witness]:
    witness = Witness("rover")
    yield witness
    witness.close()


@ENGINES
def test_the_robot_stands_when_its_script_is_killed(
    command: str,
    start: Start,
    script: Start,
    short: pathlib.Path,
    witness: Witness,
    engine: str,
) -> None:
    start_world(start, command, short, "--engine", engine)
    process = script("await rover.move(5)")
    witness.wait("the robot drives", lambda: witness.speed > 0.05)
    process.send_signal(signal.SIGKILL)
    process.wait()
    witness.wait("the robot stands", lambda: witness.speed < 1e-3)


def test_commands_hold_for_a_short_time() -> None:
    """Less than it may take to stand by what it takes to brake from the fastest speed that programs have by default."""
    watchdog = Watchdog()
    watchdog.take((0.09, 0.0, 0.5), 1.0)
    braking = STEP + 0.09 / MOTOR_ACCELERATION
    assert watchdog.twist(1.0 + STANDS - braking) == (0.0, 0.0, 0.0)
    assert watchdog.twist(1.0 + 4 * STEP) == (0.09, 0.0, 0.5)
    watchdog.take((math.nan, 0.0, 0.0), 2.0)
    assert watchdog.twist(2.0) == (0.0, 0.0, 0.0)


def test_what_mujoco_cannot_do_is_told(command: str, short: pathlib.Path) -> None:
    for options, expected in (
        (("--engine", "mujoco"), "--engine mujoco has no ports for scripts"),
        (
            ("--engine", "mujoco", "--ros2", "--trace", "driven.jsonl"),
            "--trace is of the embedded simulator, not of MuJoCo",
        ),
    ):
        run = subprocess.run(
            [command, "sim", short, *options], capture_output=True, text=True
        )
        assert run.returncode == 2, run.stdout
        assert expected in run.stderr


def test_a_python_without_ros_is_told(command: str, short: pathlib.Path) -> None:
    """Without ROS 2 the run says what to do; nothing is installed."""
    run = subprocess.run(
        [command, "run", short, "--target", "ros2", "--python", "/usr/bin/python3"],
        capture_output=True,
        text=True,
        env={"HOME": os.environ["HOME"], "PATH": os.environ["PATH"]},
    )
    assert run.returncode == 2, run.stdout
    assert "cannot import rclpy" in run.stderr
    assert "source /opt/ros/jazzy/setup.bash" in run.stderr
