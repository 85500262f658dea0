"""The topics of a robot in ROS 2: what they are called, and the types of their messages.

Imports nothing of ROS 2: robots have settings for it whether or not it is there.
"""

import importlib
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, TypedDict

from .errors import SimulatorError
from .facts import ROS2_CMD_VEL, ROS2_ODOM, ROS2_RANGES, ROS2_STAMPED

CLOCK = "/clock"


class Ros2Settings(TypedDict, total=False):
    """What is not as usual; the keys are those of `[robots.NAME.ros2]` in a scene, and `docs/scenes.md` describes them."""

    namespace: str
    cmd_vel: str
    stamped: bool
    odom: str
    pose: str
    ranges: str  # with `{sensor}`
    scan: str
    base_frame: str
    odom_frame: str
    qos: Literal["best-effort", "reliable"]
    track: float  # m
    wheelbase: float  # m
    speed_limit: float  # m/s


NO_SETTINGS: Ros2Settings = {}

Mounts = Mapping[str, tuple[float, float, float, float, float]]
"""Where sensors are: m ahead and to the left, degrees to the left, range in m, and degrees of the cone."""


@dataclass(frozen=True)
class MessageType:
    """A type of messages."""

    package: str
    name: str

    def __str__(self) -> str:
        """As ROS 2 writes it."""
        return f"{self.package}/msg/{self.name}"

    def load(self) -> Any:
        """The class of its messages."""
        return getattr(importlib.import_module(f"{self.package}.msg"), self.name)


# Which message each topic has. Another sensor or robot is another row.
TYPES: Mapping[str, MessageType] = {
    "command": MessageType("geometry_msgs", "Twist"),
    "stamped command": MessageType("geometry_msgs", "TwistStamped"),
    "odometry": MessageType("nav_msgs", "Odometry"),
    "pose": MessageType("geometry_msgs", "PoseWithCovarianceStamped"),
    "range": MessageType("sensor_msgs", "Range"),
    "scan": MessageType("sensor_msgs", "LaserScan"),
    "clock": MessageType("rosgraph_msgs", "Clock"),
}


@dataclass(frozen=True)
class Topic:
    """A topic of one robot."""

    name: str
    what: str  # a key of TYPES

    @property
    def type(self) -> MessageType:
        """The type of its messages."""
        return TYPES[self.what]


class Topics:
    """The topics of one robot."""

    def __init__(self, robot: str, settings: Ros2Settings) -> None:
        self._namespace = settings.get("namespace", f"/{robot}").rstrip("/")
        stamped = settings.get("stamped", ROS2_STAMPED)
        self.command = self._topic(
            settings.get("cmd_vel", ROS2_CMD_VEL),
            "stamped command" if stamped else "command",
        )
        self.odometry = self._topic(settings.get("odom", ROS2_ODOM), "odometry")
        # Where poses come from.
        self.pose = (
            self._topic(settings["pose"], "pose")
            if "pose" in settings
            else self.odometry
        )
        self._ranges = settings.get("ranges", ROS2_RANGES)
        self._scan = settings.get("scan")

    def sensor(self, name: str) -> Topic:
        """Where the readings of a sensor come from."""
        if self._scan is not None:
            return self._topic(self._scan, "scan")
        return self.range(name)

    def range(self, name: str) -> Topic:
        """Where the readings of a sensor are that has a topic of its own."""
        return self._topic(self._ranges.replace("{sensor}", name), "range")

    def _topic(self, name: str, what: str) -> Topic:
        return Topic(
            name if name.startswith("/") else f"{self._namespace}/{name}", what
        )


def seconds(stamp: Any) -> float:
    """A time of ROS 2 in seconds."""
    return float(stamp.sec) + float(stamp.nanosec) * 1e-9


def heading(orientation: Any) -> float:
    """The rotation about the vertical of a quaternion, in radians; raises SimulatorError if it is none."""
    x, y, z, w = (float(getattr(orientation, axis)) for axis in "xyzw")
    norm = math.sqrt(x * x + y * y + z * z + w * w)
    if not abs(norm - 1.0) < 0.01:
        raise SimulatorError(
            f"the orientation is no unit quaternion: its norm is {norm:.2f}"
        )
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def measured(message: Any) -> float | None:
    """The distance in metres that a Range has; None if it detects nothing. Raises SimulatorError if it is no number.

    As REP 117 says: infinity is free, minus infinity too near to be measured.
    """
    distance = float(message.range)
    if math.isnan(distance):
        raise SimulatorError("its reading is no number")
    if distance > message.max_range or distance == math.inf:
        return None
    # A sensor that only tells whether something is there has no other reading than minus infinity.
    return max(distance, 0.0)


def nearest(scan: Any, bearing: float, cone: float, reach: float) -> float | None:
    """The nearest distance in a sector of a LaserScan, in metres and radians; None if nothing is nearer than `reach`.

    Raises SimulatorError if the scan has no reading there. Distances that the scanner cannot measure are left out, as the
    message's documentation wants it.
    """
    rays = [
        float(distance)
        for index, distance in enumerate(scan.ranges)
        if abs(
            math.remainder(
                scan.angle_min + index * scan.angle_increment - bearing, math.tau
            )
        )
        <= cone / 2.0 + 1e-6
    ]
    if all(map(math.isnan, rays)):
        raise SimulatorError(
            f"the scan has no reading around {math.degrees(bearing):.0f} deg"
        )
    if -math.inf in rays:
        return 0.0
    near = [
        distance
        for distance in rays
        if scan.range_min <= distance <= min(scan.range_max, reach)
    ]
    return min(near, default=None)
