"""A robot with ROS 2's usual topics that does exactly what it is told, one step for each command."""

from __future__ import annotations

import math
import subprocess
from collections.abc import Callable
from typing import Any

import rclpy
from geometry_msgs.msg import Twist, TwistStamped
from nav_msgs.msg import Odometry
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import LaserScan, Range

STEP = 0.05  # s
REPEAT_PERIOD = (
    0.1  # s of real time, after which a script that is not there yet is told again
)


class FakeRobot:
    """A robot in the process of the test, which takes its steps; tests replace what it publishes."""

    def __init__(
        self, name: str = "rover", *, command: Any = Twist, odometry: Any = Odometry
    ) -> None:
        self.context = rclpy.Context()
        self.context.init()
        self.node = Node(
            "fake", context=self.context, namespace=f"/{name}", enable_rosout=False
        )
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)
        self.x = self.y = self.theta = 0.0
        self.time = 0.0
        self.commands: list[tuple[float, float, float]] = []
        self._fresh = 0
        self.frames: set[str] = set()
        self.node.create_subscription(command, "cmd_vel", self._take, 10)
        self.odometry_type = odometry
        self.odometry = self.node.create_publisher(odometry, "odom", 10)
        self.clock = self.node.create_publisher(Clock, "/clock", 10)
        self.publishers: dict[str, Any] = {}
        self.says: dict[str, Callable[[], Any]] = {}
        self.is_lost = False  # whether there is no odometry any more
        self.turning = 1.0  # how much it turns, as a share of what it is told
        self.frame = ""  # of its body

    def close(self) -> None:
        self.node.destroy_node()
        self.context.try_shutdown()

    def add_range(self, name: str, distance: Callable[[], float]) -> None:
        """A sensor; None keeps it silent."""
        self._add(f"range/{name}", Range)
        self.says[f"range/{name}"] = lambda: Range(
            min_range=0.02, max_range=1.0, range=distance()
        )

    def add_scan(self, distances: Callable[[], list[float]]) -> None:
        """A laser scanner that looks around, from behind by way of the right."""
        self._add("scan", LaserScan)

        def scan() -> LaserScan:
            found = distances()
            return LaserScan(
                angle_min=-math.pi,
                angle_increment=math.tau / len(found),
                angle_max=math.pi,
                range_min=0.12,
                range_max=3.5,
                ranges=found,
            )

        self.says["scan"] = scan

    def _add(self, topic: str, kind: Any) -> None:
        self.publishers[topic] = self.node.create_publisher(kind, topic, 10)

    def drive(
        self,
        script: subprocess.Popen[str],
        each_step: Callable[[], object] = lambda: None,
    ) -> None:
        """Takes steps until a script has ended."""
        while script.poll() is None:
            self.publish()
            if self._await_command(script):
                self._integrate()
                each_step()

    def publish(self) -> None:
        stamp = self._stamp(self.time)
        if not self.is_lost:
            self.odometry.publish(self._odometry())
        for topic, say in self.says.items():
            message = say()
            message.header.stamp = stamp
            self.publishers[topic].publish(message)
        self.clock.publish(Clock(clock=stamp))

    def _odometry(self) -> Any:
        message = self.odometry_type()
        if isinstance(message, Odometry):
            message.header.stamp = self._stamp(self.time)
            message.child_frame_id = self.frame
            position = message.pose.pose.position
            position.x, position.y = self.x, self.y
            orientation = message.pose.pose.orientation
            orientation.z = math.sin(self.theta / 2.0)
            orientation.w = math.cos(self.theta / 2.0)
        return message

    @staticmethod
    def _stamp(seconds: float) -> Any:
        stamp = Clock().clock
        total = round(seconds * 1e9)
        stamp.sec, stamp.nanosec = divmod(total, 1_000_000_000)
        return stamp

    def _take(self, message: Any) -> None:
        if isinstance(message, TwistStamped):
            self.frames.add(message.header.frame_id)
            message = message.twist
        self.commands.append((message.linear.x, message.linear.y, message.angular.z))
        self._fresh += 1

    def _await_command(self, script: subprocess.Popen[str]) -> bool:
        """Whether a command has come; otherwise the script may not have heard what it needs yet, and is told again, or has
        ended."""
        if self._fresh == 0:
            self.executor.spin_once(timeout_sec=REPEAT_PERIOD)
        if self._fresh == 0 or script.poll() is not None:
            return False
        self._fresh -= 1
        return True

    def _integrate(self) -> None:
        ahead, left, turn = self.commands[-1]
        turn *= self.turning
        middle = self.theta + turn * STEP / 2.0
        self.x += (ahead * math.cos(middle) - left * math.sin(middle)) * STEP
        self.y += (ahead * math.sin(middle) + left * math.cos(middle)) * STEP
        self.theta += turn * STEP
        self.time += STEP
