"""A world as a node of ROS 2: its robots take commands and publish where they are and what they detect.

`pydslrep sim --ros2` starts it: it steps the embedded simulator by the remote API, as any script does, or MuJoCo, which is in its
own process.
"""

import argparse
import json
import math
import signal
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import FrameType
from typing import Any, Protocol

from . import drives
from .backend import Backend, RobotSpec
from .errors import SetupError, SimulatorError
from .facts import ROBOT_TYPES, ROS2_BASE_FRAME, ROS2_ODOM_FRAME
from .pose import Pose, wrap_angle
from .ros2_link import Link
from .ros2_topics import CLOCK, Topic, Topics

WATCHDOG = 0.3  # s of simulation time without a command, after which a robot stops
REPEAT_PERIOD = 0.25  # s of real time, after which a script that steps the world is told again how it is
ULTRASOUND = 0  # sensor_msgs/Range.ULTRASOUND
EXIT_CODE = 130  # after an interrupt


class Simulation(Protocol):
    """What steps the robots."""

    time: float  # s
    time_step: float  # s

    def connect(self, spec: RobotSpec) -> Backend:
        """Connects a robot; raises SetupError."""

    def start(self) -> None:
        """Time begins."""

    def advance(self) -> None:
        """Takes one step; raises SimulatorError."""

    def close(self) -> None:
        """Leaves it."""


def simulation(mujoco: Path | None) -> Simulation:
    """The world of a file of MuJoCo's, or else the embedded simulator; raises SetupError.

    Only what is used is imported: a Python for one of them need not have the packages of the other.
    """
    if mujoco is not None:
        from .mujoco_engine import MuJoCo

        return MuJoCo(mujoco)
    from .coppeliasim import CoppeliaSim

    return CoppeliaSim("127.0.0.1", realtime=False)


class Watchdog:
    """The latest command of a robot, which holds for a short time."""

    def __init__(self) -> None:
        self._twist = (0.0, 0.0, 0.0)
        self._since = -math.inf

    def take(self, twist: tuple[float, float, float], now: float) -> None:
        """A command has come: m/s ahead and to the left, and rad/s. One that is no number stops the robot."""
        self._twist = twist if all(map(math.isfinite, twist)) else (0.0, 0.0, 0.0)
        self._since = now

    def twist(self, now: float) -> tuple[float, float, float]:
        """What the robot has to do."""
        is_fresh = now - self._since <= WATCHDOG + 1e-9
        return self._twist if is_fresh else (0.0, 0.0, 0.0)


class RobotNode:
    """The driver of one robot."""

    def __init__(
        self, described: Mapping[str, Any], world: Simulation, link: Link
    ) -> None:
        self.name: str = described["name"]
        settings = described["ros2"]
        self._world, self._link = world, link
        self._sensors = {each["name"]: each for each in described["sensors"]}
        wheels = {wheel["name"]: wheel["radius"] for wheel in described["wheels"]}
        spec = RobotSpec(
            self.name, "127.0.0.1", described["port"], wheels, tuple(self._sensors)
        )
        self._robot: Backend = world.connect(spec)
        row = ROBOT_TYPES[described["type"]]
        self._is_mecanum = row.mecanum
        self._drive = getattr(drives, row.drive)(
            self._robot.wheel_mounts(), [*wheels.values()]
        )
        self._base_frame = settings.get("base_frame", ROS2_BASE_FRAME)
        self._odom_frame = settings.get("odom_frame", ROS2_ODOM_FRAME)
        topics = Topics(self.name, settings)
        self._command = topics.command
        self._watchdog = Watchdog()
        self.has_command = False  # since the last step
        link.subscribe(topics.command, self._take, reliable=True)
        self._odometry = link.publisher(topics.odometry)
        self._ranges = {
            name: link.publisher(topics.range(name)) for name in self._sensors
        }
        self._odometry_type = topics.odometry.type.load()
        self._range_type = Topic("", "range").type.load()
        self._pose: Pose | None = None
        self._time = 0.0

    def is_driven(self) -> bool:
        """Whether somebody can command it."""
        return bool(self._link.publishers(self._command.name))

    def drive(self) -> None:
        """Passes the latest command on to the wheels."""
        ahead, sideways, turn = self._watchdog.twist(self._world.time)
        rates: Sequence[float] = (
            self._drive.wheel_rates(ahead, sideways, turn)
            if self._is_mecanum
            else self._drive.wheel_rates(ahead, turn)
        )
        self._robot.set_wheel_rates(rates)
        self.has_command = False

    def publish(self, stamp: Any) -> None:
        """Says where the robot is and what it detects."""
        self._publish_odometry(stamp)
        for name, publisher in self._ranges.items():
            message = self._range_type(radiation_type=ULTRASOUND)
            message.header.stamp, message.header.frame_id = stamp, name
            self._measure(message, self._sensors[name])
            publisher.publish(message)

    def _publish_odometry(self, stamp: Any) -> None:
        pose, now = self._robot.pose(), self._world.time
        message = self._odometry_type()
        message.header.stamp, message.header.frame_id = stamp, self._odom_frame
        message.child_frame_id = self._base_frame
        message.pose.pose.position.x, message.pose.pose.position.y = pose.x, pose.y
        orientation = message.pose.pose.orientation
        orientation.z, orientation.w = (
            math.sin(pose.theta / 2.0),
            math.cos(pose.theta / 2.0),
        )
        if self._pose is not None and now > self._time:
            way, elapsed = pose.relative_to(self._pose), now - self._time
            twist = message.twist.twist
            twist.linear.x, twist.linear.y = way.x / elapsed, way.y / elapsed
            twist.angular.z = wrap_angle(way.theta) / elapsed
        if now > self._time or self._pose is None:
            self._pose, self._time = pose, now
        self._odometry.publish(message)

    def _measure(self, message: Any, sensor: Mapping[str, Any]) -> None:
        """What a sensor detects, as REP 117 says it: a bumper has one distance, and measures none."""
        reach = float(sensor["range"])
        message.field_of_view, message.max_range = float(sensor["cone"]), reach
        if sensor["kind"] == "bumper":
            message.min_range = reach
            is_hit = self._robot.detects(sensor["name"])
            message.range = -math.inf if is_hit else math.inf
        else:
            distance = self._robot.distance(sensor["name"])
            message.range = math.inf if distance is None else distance

    def _take(self, message: Any) -> None:
        twist = getattr(message, "twist", message)
        command = (twist.linear.x, twist.linear.y, twist.angular.z)
        self._watchdog.take(command, self._world.time)
        self.has_command = True


class World:
    """A world, and its clock."""

    def __init__(
        self,
        robots: Sequence[Mapping[str, Any]],
        *,
        speed: float,
        mujoco: Path | None = None,
    ) -> None:
        """Its robots as they are described, and seconds of simulation time per second; raises SetupError."""
        self._world = simulation(mujoco)
        self._link = Link("pydslrep_world")
        self._robots = [RobotNode(each, self._world, self._link) for each in robots]
        clock = Topic(CLOCK, "clock")
        self._clock, self._clock_type = self._link.publisher(clock), clock.type.load()
        self._world.start()
        # Before the first step, sensors have no readings.
        self._world.advance()
        self._speed, self._due = speed, time.monotonic()

    def step(self, *, lockstep: bool) -> None:
        """Takes a step when it is due; in lockstep, when all robots that somebody drives have a command for it."""
        if lockstep:
            self._await_commands()
        else:
            self._due = max(
                self._due + self._world.time_step / self._speed, time.monotonic()
            )
            while (rest := self._due - time.monotonic()) > 0.0:
                self._link.wait(rest)
        self._link.take_all()
        for robot in self._robots:
            robot.drive()
        self._world.advance()
        self._publish()

    def close(self) -> None:
        """Leaves the world."""
        self._world.close()
        self._link.close()

    def _await_commands(self) -> None:
        told = time.monotonic()
        while True:
            driven = [robot for robot in self._robots if robot.is_driven()]
            if driven and all(robot.has_command for robot in driven):
                return
            self._link.wait(REPEAT_PERIOD)
            if time.monotonic() >= told + REPEAT_PERIOD:
                told = time.monotonic()
                # Who has just come does not know it yet.
                self._publish()

    def _publish(self) -> None:
        message = self._clock_type()
        whole = int(self._world.time)
        message.clock.sec = whole
        message.clock.nanosec = round((self._world.time - whole) * 1e9)
        if message.clock.nanosec >= 1_000_000_000:
            message.clock.sec, message.clock.nanosec = whole + 1, 0
        for robot in self._robots:
            robot.publish(message.clock)
        # Last: who waits for it then has the rest.
        self._clock.publish(message)


def interrupt(_signal: int, _frame: FrameType | None) -> None:
    """Ends the node."""
    raise KeyboardInterrupt


def main() -> None:
    """Runs a world until it is interrupted."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("robots", type=Path, help="a JSON file that describes them")
    parser.add_argument("--speed", type=float, default=1.0)
    parser.add_argument("--lockstep", action="store_true")
    parser.add_argument("--mujoco", type=Path, help="a world of MuJoCo's")
    options = parser.parse_args()
    robots = json.loads(options.robots.read_text(encoding="utf-8"))
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, interrupt)
    try:
        world = World(robots, speed=options.speed, mujoco=options.mujoco)
        print("ready", flush=True)
        while True:
            world.step(lockstep=options.lockstep)
    except KeyboardInterrupt:
        sys.exit(EXIT_CODE)
    except (SetupError, SimulatorError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    main()
