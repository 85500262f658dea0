"""A robot that explores by wheel odometry, and corrects its pose by scans."""

import math
from collections.abc import Callable, Collection
from typing import TYPE_CHECKING

import numpy as np

from ...facts import RIM_SPEED
from ...pose import Pose, wrap_angle
from ..occupancy_grid import Position
from ..robot import SAFETY_MARGIN, SlamRobot
from ..session import SlamSession
from .calibration import Calibration
from .graph_slam import GraphSlam
from .odometer import Leg, Odometer
from .scan import Scan
from .scan_log import ScanLog
from .way_ahead import WayAhead

if TYPE_CHECKING:
    from ...motion import Motion

REBUILD_DISTANCE = 0.04  # m that a keyframe moves before the grid is rebuilt, or ...
REBUILD_ANGLE = math.radians(2.0)  # ... turns
BLOCKED_TRAVEL = 14.0  # m that are as uncertain as the heading after a blocked turn
WAYS = [0.02 * count for count in range(-15, 16)]  # m to drive to have room


class OdometrySlamRobot(SlamRobot):
    """The robot of an explorer, by sensors and wheel odometry."""

    turning_speed = 0.5 * RIM_SPEED  # wheels slip less when they turn slowly
    pose_margin = 0.05
    prefers_walls = True

    def __init__(self, robot: "Motion", session: SlamSession) -> None:
        super().__init__(robot, session)
        self._odometer = Odometer(
            robot.backend, tuple(robot.spec.wheels.values()), robot.drive.turning_radius
        )
        robot.use_odometry(self._odometer)
        self._scan: Scan | None = None
        self._wheel_travel = 0.0  # m, up to the last keyframe
        self._wheel_turns: list[float] = []  # radians, since the scan has begun
        self._wheel_turn = 0.0  # radians, up to the last keyframe
        self._blocked_travel = 0.0  # m for a blocked turn at the last keyframe
        self._way: WayAhead | None = None  # that the robot drives along
        self._slam = GraphSlam(self.calibration)
        self._log = ScanLog()
        self._grid_keyframes: list[Pose] = []  # the poses that the grid is built from

    @property
    def calibration(self) -> Calibration:
        """How much further it turns and drives than its wheels report."""
        return self._odometer.calibration

    async def drive_to(self, goal: Position, should_stop: Callable[[], bool]) -> bool:
        """Turns to a goal and drives there, or until an obstacle is near."""
        await self._make_room()
        try:
            return await super().drive_to(goal, should_stop)
        finally:
            self._way = None

    def _look_along(self, bearing: float) -> None:
        """Remembers what the robot has seen ahead since the last keyframe."""
        here = self.pose()
        self._way = WayAhead(Pose(here.x, here.y, bearing), self.radius)
        for there, readings in self._log.recent():
            self._way.add(there, readings)
        self._check_way(self._way, here)

    def _check_way(self, way: WayAhead, here: Pose) -> None:
        """Records an obstacle that the robot is near to, whether it sees it now or not."""
        if way.is_near_end(here, self.radius + SAFETY_MARGIN):
            end = way.end()
            self._obstacle = end.x, end.y

    async def _make_room(self) -> None:
        """Drives back or ahead to where the robot can turn without touching a wall.

        A wall would turn the robot, which its wheels do not notice.
        """
        here = self.pose()
        walls = np.append(
            self._slam.surfaces_near(here), self._log.obstacles_near(here)
        )
        is_beside = np.abs(walls.imag) < 0.6 * self.radius

        def room_at(way: float) -> float:
            """The distance to the nearest wall; 0 if one is in the way."""
            if (
                is_beside
                & (np.abs(walls.real - way / 2.0) < (abs(way) + self.radius) / 2.0)
            ).any():
                return 0.0
            return float(np.abs(walls - way).min(initial=1.0))

        room = room_at(0.0) or float(np.abs(walls).min())
        needed = self.radius + SAFETY_MARGIN
        if room >= needed:
            return
        ways = sorted(WAYS, key=lambda way: (-min(room_at(way), needed), abs(way)))
        if room_at(ways[0]) < room + 0.01:
            return
        self._obstacle = None

        def must_stop(here: Pose) -> bool:
            return self._observe(here) and ways[0] > 0.0 and self._obstacle is not None

        await self._robot.drive_to(here.ahead(ways[0]), must_stop)

    async def localise(self) -> int:
        """Adds a keyframe and corrects the pose by a scan, or by several if it is lost."""
        await self._make_room()
        was_blocked = await self._take_keyframe()
        if was_blocked:
            await self._make_room()
        if was_blocked or (self._slam.has_slipped and self._slam.is_lost):
            await self._take_keyframe()
        return len(self._positions) - 1

    def uncertain(self) -> Collection[int]:
        """The keyframes at which the robot was lost."""
        return self._slam.uncertain

    async def _take_keyframe(self) -> bool:
        """Scans in a turn; returns whether something has blocked it."""
        angle, speed = self._blind_angle(), self.turning_speed
        if not self._positions:
            # The first keyframe is the reference for all others, so scan it slowly. Its middle
            # is where the robot looks now, whatever the track is.
            speed *= 0.25
            await self._robot.rotate(-angle / 2.0, None, speed)
        self._scan, self._wheel_turns = Scan(), []
        scan = self._scan
        await self._robot.rotate(angle, self._observe, speed)
        self._scan = None
        lost = scan.correct()
        if lost:
            self._robot.correct(self.pose().turned(-lost))
        self._log_scan(scan)
        leg = self._leg(is_blocked=lost != 0.0)
        self._robot.correct(self._slam.add_keyframe(scan, self.pose(), leg))
        self._update_grid(scan.middle_pose())
        return lost != 0.0

    def _leg(self, *, is_blocked: bool) -> Leg:
        """What the wheels report of the way from the last keyframe to this one."""
        # The keyframe is halfway through the turn, so the next leg is uncertain, too.
        before, self._blocked_travel = self._blocked_travel, BLOCKED_TRAVEL * is_blocked
        travelled = self._odometer.wheel_travel - self._wheel_travel
        travelled += max(before, self._blocked_travel)
        turned = -self._wheel_turn
        self._wheel_travel = self._odometer.wheel_travel
        self._wheel_turn = self._wheel_turns[len(self._wheel_turns) // 2]
        was_blocked = before > 0.0 or is_blocked
        return Leg(travelled, None if was_blocked else turned + self._wheel_turn)

    def _log_scan(self, scan: Scan) -> None:
        """Keeps as many of a scan's readings as the grid needs."""
        self._last_pose = None
        for here, readings in scan.observations():
            if self._has_moved(here):
                self._log.add(here, readings)

    def _update_grid(self, middle_pose: Pose) -> None:
        """Adds the last leg to the grid, or all if keyframes have moved."""
        keyframes = self._slam.keyframes
        has_slipped = self._slam.has_slipped
        self._log.add_keyframe(middle_pose, keyframes[-1], is_valid=not has_slipped)
        self._positions = [(pose.x, pose.y) for pose in keyframes]
        if has_slipped or any(map(has_shifted, self._grid_keyframes, keyframes)):
            self.grid.reset()
            self._grid_keyframes = []
        self._log.replay(self.grid, keyframes, since=len(self._grid_keyframes))
        self._grid_keyframes += keyframes[len(self._grid_keyframes) :]

    def _observe(self, here: Pose) -> bool:
        """Reads all sensors if the robot has moved or scans; returns if it has moved."""
        if self._scan is not None:
            self._scan.add(here, self._read_sensors())
            self._wheel_turns.append(self._odometer.wheel_turn)
            return False
        if not self._has_moved(here):
            return False
        readings = self._read_sensors()
        self._log.add(here, readings)
        for reading in readings:
            self._check_obstacle(reading, here)
            self.grid.add_reading(reading.transformed_by(here))
        if self._way:
            self._way.add(here, readings)
            self._check_way(self._way, here)
        return True

    def _mark_obstacle(self, x: float, y: float) -> None:
        """Keeps an obstacle that has stopped the robot, also when the grid is rebuilt."""
        super()._mark_obstacle(x, y)
        self._log.add_obstacle(self.pose(), x, y)


def has_shifted(a: Pose, b: Pose) -> bool:
    """Whether a keyframe has moved far enough to rebuild the grid."""
    turned = abs(wrap_angle(a.theta - b.theta))
    return math.hypot(a.x - b.x, a.y - b.y) > REBUILD_DISTANCE or turned > REBUILD_ANGLE
