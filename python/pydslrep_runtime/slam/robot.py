"""A robot that reads its sensors while it explores."""

import math
from collections.abc import Callable, Collection
from typing import TYPE_CHECKING

from ..facts import RIM_SPEED
from ..pose import Pose, wrap_angle
from .explorer import Explorer
from .occupancy_grid import OccupancyGrid, Position, Reading
from .session import SlamSession

if TYPE_CHECKING:
    from ..motion import Motion

STEP_LENGTH = 0.5  # m between nodes of the map
OBSERVE_DISTANCE = 0.03  # m to drive between observations, or ...
OBSERVE_ANGLE = math.radians(5.0)  # ... to turn
SAFETY_MARGIN = 0.02  # m around the robot to keep free


class SlamRobot:
    """The robot of an explorer, by sensors and a known pose."""

    turning_speed = RIM_SPEED  # m/s at the rims
    pose_margin = 0.0  # m of error in the pose
    prefers_walls = False

    def __init__(self, robot: "Motion", session: SlamSession) -> None:
        self._robot = robot
        cones = {s: robot.backend.sensor_cone(s) for s in robot.spec.sensors}
        self._mounts = {sensor: cone.mount for sensor, cone in cones.items()}
        self._ranges = {
            sensor: session.range(robot.name, sensor, cone.range)
            for sensor, cone in cones.items()
        }
        self._angles = {
            sensor: session.cone(robot.name, sensor, cone.angle)
            for sensor, cone in cones.items()
        }
        # The corners of a square body are further out than its wheels by this factor.
        corner = robot.drive.turning_radius * math.sqrt(2.0)
        offsets = (math.hypot(mount.x, mount.y) for mount in self._mounts.values())
        self.radius = session.radius(robot.name, max(corner, *offsets))
        self.grid = OccupancyGrid(self.radius + self.pose_margin)
        self._extent = session.extent
        self._positions: list[Position] = []
        self._last_pose: Pose | None = None  # of the last observation
        self._obstacle: Position | None = None

    def explorer(self) -> Explorer:
        """An explorer for this robot; raises MovementError."""
        reach = min(
            self._ranges[sensor] + math.hypot(mount.x, mount.y)
            for sensor, mount in self._mounts.items()
        )
        step = min(STEP_LENGTH, reach - self.radius - OccupancyGrid.CLEARANCE - 0.1)
        if step < 0.1:
            least = min(self._ranges.values())
            raise self._robot.failure(
                f"its sensors' range of {least:g} m is too short to explore with"
            )
        return Explorer(
            self,
            self.grid,
            step,
            self._blind_angle(),
            self._extent,
            prefers_walls=self.prefers_walls,
        )

    def pose(self) -> Pose:
        """The robot's estimated pose."""
        return self._robot.pose()

    async def turn_by(self, angle: float) -> None:
        """Turns in place, to the left if positive."""
        await self._robot.rotate(angle, self._observe, self.turning_speed)

    async def localise(self) -> int:
        """Adds a keyframe and returns its number."""
        here = self.pose()
        self._positions.append((here.x, here.y))
        return len(self._positions) - 1

    def position(self, number: int) -> Position:
        """The current estimate of a keyframe's position."""
        return self._positions[number]

    def uncertain(self) -> Collection[int]:
        """The keyframes that may be somewhere else; none, as the pose is known."""
        return ()

    async def drive_to(self, goal: Position, should_stop: Callable[[], bool]) -> bool:
        """Turns to a goal and drives there, or until an obstacle is near."""
        here = self.pose()
        bearing = math.atan2(goal[1] - here.y, goal[0] - here.x)
        await self.turn_by(wrap_angle(bearing - here.theta))
        self._obstacle = None
        self._look_along(bearing)

        def must_stop(here: Pose) -> bool:
            return self._observe(here) and (self._obstacle is not None or should_stop())

        if self._obstacle is None:
            await self._robot.drive_to(Pose(*goal, bearing), must_stop)
        if self._obstacle is None:
            return True
        self._mark_obstacle(*self._obstacle)
        return False

    def _look_along(self, bearing: float) -> None:
        """Called before the robot drives along a bearing; may find an obstacle."""

    async def back_up_to(self, goal: Position) -> None:
        """Reverses to a position behind the robot."""

        def observe(here: Pose) -> bool:
            self._observe(here)
            return False

        await self._robot.drive_to(Pose(*goal, self.pose().theta), observe)

    def _observe(self, here: Pose) -> bool:
        """Reads all sensors if the robot has moved; returns whether it has."""
        if not self._has_moved(here):
            return False
        for reading in self._read_sensors():
            self._check_obstacle(reading, here)
            self.grid.add_reading(reading.transformed_by(here))
        return True

    def _has_moved(self, here: Pose) -> bool:
        """Whether the robot has moved far enough for another observation."""
        if self._last_pose is not None:
            step = here.relative_to(self._last_pose)
            distance = math.hypot(step.x, step.y)
            if distance < OBSERVE_DISTANCE and abs(step.theta) < OBSERVE_ANGLE:
                return False
        self._last_pose = here
        return True

    def _read_sensors(self) -> list[Reading]:
        """The readings of all sensors, in the robot's frame."""
        found = []
        for sensor, mount in self._mounts.items():
            distance = self._robot.backend.distance(sensor)
            is_hit = distance is not None
            if distance is None:
                distance = self._ranges[sensor]
            found.append(Reading(mount, self._angles[sensor], distance, is_hit))
        return found

    def _check_obstacle(self, reading: Reading, here: Pose) -> None:
        """Records an obstacle ahead that is too near for the robot to turn there."""
        if not reading.is_hit:
            return
        seen = reading.sensor.ahead(reading.distance)
        reach = self.radius + SAFETY_MARGIN
        if 0.0 < seen.x < reach and abs(seen.y) < 0.8 * self.radius:
            point = seen.transformed_by(here)
            self._obstacle = point.x, point.y

    def _mark_obstacle(self, x: float, y: float) -> None:
        """Keeps an obstacle that has stopped the robot."""
        self.grid.mark_obstacle(x, y)

    def _blind_angle(self) -> float:
        """The widest angle between two neighbouring sensors."""
        bearings = sorted(wrap_angle(mount.theta) for mount in self._mounts.values())
        following = [*bearings[1:], bearings[0] + math.tau]
        return max(b - a for a, b in zip(bearings, following, strict=True))
