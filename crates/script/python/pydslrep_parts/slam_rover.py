#: if standalone
"""A robot that scans its surroundings while it explores."""

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from .explorer import Explorer, UnboundedAreaError
from .occupancy_grid import OccupancyGrid, Position, Reading
from .pose import Pose, wrap_angle
from .scan import Scan
from .scan_log import Observation, ScanLog
from .settings import RIM_SPEED
from .slam_backend import SlamBackend
from .slam_session import SlamSession

if TYPE_CHECKING:
    from .robot import Robot

#: endif


STEP_LENGTH = 0.5  # m between nodes of the map
OBSERVE_DISTANCE = 0.03  # m to drive between observations, or ...
OBSERVE_ANGLE = math.radians(5.0)  # ... to turn
SAFETY_MARGIN = 0.02  # m around the robot to keep free
REBUILD_DISTANCE = (
    0.04  # m by which a keyframe moves before the grid is rebuilt, or ...
)
REBUILD_ANGLE = math.radians(2.0)  # ... turns
ODOMETRY_MARGIN = 0.05  # m of error in the odometry


class SlamRover:
    """The rover of an explorer."""

    def __init__(self, robot: "Robot", session: SlamSession) -> None:
        self._robot, body = robot, robot.body
        name = body.model.name
        cones = {sensor: body.sensor_cone(sensor) for sensor in body.model.slam_sensors}
        self._mounts = {sensor: cone.mount for sensor, cone in cones.items()}
        self._ranges = {s: session.range(name, s, c.range) for s, c in cones.items()}
        self._angles = {s: session.cone(name, s, c.angle) for s, c in cones.items()}
        # The corners of a square body are further out than its wheels by this factor.
        corner = body.drive.turning_radius * math.sqrt(2.0)
        offsets = (math.hypot(mount.x, mount.y) for mount in self._mounts.values())
        self._extent = session.extent
        self.radius = session.radius(name, max(corner, *offsets))
        self._uses_odometry = session.uses_odometry
        # Wheels slip less when they turn slowly.
        self._turning_speed = RIM_SPEED * (0.5 if self._uses_odometry else 1.0)
        self.grid = OccupancyGrid(
            self.radius + (ODOMETRY_MARGIN if self._uses_odometry else 0.0)
        )
        self._scan: Scan | None = None
        self._wheel_travel = 0.0
        self._backend = SlamBackend()
        self._log = ScanLog()
        self._grid_keyframes: list[Pose] = []  # the poses that the grid is built from
        self._positions: list[Position] = []
        self._last_pose: Pose | None = None
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
            prefers_walls=self._uses_odometry,
        )

    def pose(self) -> Pose:
        """The robot's estimated pose."""
        return self._robot.pose()

    def turn_by(self, angle: float) -> None:
        """Turns in place."""
        self._robot.rotate(angle, self._observe, self._turning_speed)

    def localise(self) -> int:
        """Adds a keyframe; with odometry, corrects the pose by a scan."""
        if not self._uses_odometry:
            here = self.pose()
            self._positions.append((here.x, here.y))
            return len(self._positions) - 1
        self._scan, self._last_pose = Scan(), None
        # The first keyframe is the reference for all others, so scan it slowly.
        speed = self._turning_speed if self._positions else 0.5 * self._turning_speed
        self._robot.rotate(self._blind_angle(), self._observe, speed)
        scan, self._scan = self._scan, None
        wheel_travel = self._robot.wheel_travel()
        corrected = self._backend.add_keyframe(
            scan, self.pose(), wheel_travel - self._wheel_travel
        )
        self._wheel_travel = wheel_travel
        self._robot.correct(corrected)
        self._update_grid(scan.middle_pose())
        return len(self._positions) - 1

    def position(self, number: int) -> Position:
        """The current estimate of a keyframe's position."""
        return self._positions[number]

    def _update_grid(self, middle_pose: Pose) -> None:
        """Adds the last leg to the grid, or rebuilds the grid if keyframes have moved."""
        keyframes = self._backend.keyframes
        self._log.add_keyframe(middle_pose, keyframes[-1])
        self._positions = [(pose.x, pose.y) for pose in keyframes]
        if any(map(has_shifted, self._grid_keyframes, keyframes)):
            self.grid.reset()
            self._grid_keyframes = []
        self._log.replay(self.grid, keyframes, since=len(self._grid_keyframes))
        self._grid_keyframes += keyframes[len(self._grid_keyframes) :]

    def drive_to(self, goal: Position, should_stop: Callable[[], bool]) -> bool:
        """Turns to a goal and drives there, or until an obstacle is near."""
        here = self.pose()
        bearing = math.atan2(goal[1] - here.y, goal[0] - here.x)
        self.turn_by(wrap_angle(bearing - here.theta))
        self._obstacle = None

        def must_stop(here: Pose) -> bool:
            return self._observe(here) and (self._obstacle is not None or should_stop())

        self._robot.drive_to(Pose(*goal, bearing), must_stop)
        if self._obstacle is None:
            return True
        self.grid.mark_obstacle(*self._obstacle)
        if self._uses_odometry:
            here = self.pose()
            obstacle = Pose(*self._obstacle, 0.0).relative_to(here)
            self._log.add(here, Observation((), (obstacle.x, obstacle.y)))
        return False

    def back_up_to(self, goal: Position) -> None:
        """Reverses to a position behind the robot."""
        heading = self.pose().theta
        self._robot.drive_to(Pose(*goal, heading), self._observe_only)

    def _observe_only(self, here: Pose) -> bool:
        self._observe(here)
        return False

    def _observe(self, here: Pose) -> bool:
        """Reads all sensors if the robot has moved; returns whether it has."""
        is_new = self._last_pose is None or has_moved(here, self._last_pose)
        if is_new:
            self._last_pose = here
        elif self._scan is None:
            return False
        seen = []
        for sensor, mount in self._mounts.items():
            distance = self._robot.body.distance(sensor)
            is_hit = distance is not None
            if distance is None:
                distance = self._ranges[sensor]
            elif is_new:
                self._check_obstacle(mount.transformed_by(here).ahead(distance), here)
            reading = Reading(mount, self._angles[sensor], distance, is_hit)
            seen.append(reading)
            if self._scan is not None:
                self._scan.add(here, sensor, reading)
            else:
                self.grid.add_reading(reading.transformed_by(here))
        if self._uses_odometry and is_new:
            self._log.add(here, Observation(seen))
        return is_new

    def _check_obstacle(self, point: Pose, here: Pose) -> None:
        """Records a point ahead that is too near for the robot to turn there."""
        seen = point.relative_to(here)
        reach = self.radius + SAFETY_MARGIN
        if 0.0 < seen.x < reach and abs(seen.y) < 0.8 * self.radius:
            self._obstacle = point.x, point.y

    def _blind_angle(self) -> float:
        """The widest angle between two neighbouring sensors."""
        bearings = sorted(wrap_angle(mount.theta) for mount in self._mounts.values())
        following = [*bearings[1:], bearings[0] + math.tau]
        return max(b - a for a, b in zip(bearings, following, strict=True))


def has_moved(here: Pose, before: Pose) -> bool:
    """Whether the robot has moved far enough for another observation."""
    step = here.relative_to(before)
    distance = math.hypot(step.x, step.y)
    return distance >= OBSERVE_DISTANCE or abs(step.theta) >= OBSERVE_ANGLE


def has_shifted(a: Pose, b: Pose) -> bool:
    """Whether a keyframe has moved far enough to rebuild the grid."""
    turned = abs(wrap_angle(a.theta - b.theta))
    return math.hypot(a.x - b.x, a.y - b.y) > REBUILD_DISTANCE or turned > REBUILD_ANGLE


def explore_with(robot: "Robot", session: SlamSession) -> None:
    """Explores with a robot and adds its map to the session; raises MovementError."""
    explorer = SlamRover(robot, session).explorer()
    try:
        explorer.explore()
    except UnboundedAreaError as error:
        raise robot.failure(error) from error
    finally:
        session.add_map(robot.body.model.name, explorer.map)
