"""A robot in closed rooms with slipping wheels and noisy sensors, without simulator or time."""

import math
import random
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

from ideal_robot import HALF, MOUNTS, RADIUS, IdealRobot, at_once, on
from pydslrep_runtime.backend import SensorCone
from pydslrep_runtime.errors import MovementError
from pydslrep_runtime.facts import RIM_SPEED
from pydslrep_runtime.pose import Pose, wrap_angle
from pydslrep_runtime.slam.occupancy_grid import OccupancyGrid, Position, Reading
from pydslrep_runtime.slam.odometry.odometer import Odometer
from pydslrep_runtime.slam.odometry.robot import OdometrySlamRobot
from pydslrep_runtime.slam.odometry.scan import Scan
from rooms import Rooms

CONE = math.radians(20.0)
RANGE = 1.0
STEP = 0.05  # s
TURNING_RADIUS = 0.15  # m
WHEEL = 0.05  # m, the radius


class SlippingRobot:
    """The parts of a robot that an `OdometrySlamRobot` uses; `here` is its actual pose."""

    def __init__(
        self,
        rooms: Rooms,
        slip: float = 0.0,
        noise: float = 0.0,
        seed: int = 1,
        *,
        track_error: float = 0.0,
        radius_error: float = 0.0,
    ) -> None:
        self.ideal = IdealRobot(rooms, OccupancyGrid(RADIUS))
        self.here = Pose(*rooms.start, 0.0)
        self.touched: list[Pose] = []
        # Where something blocks it that no sensor detects.
        self.blocks: list[Position] = []
        self.blocked_steps = math.inf  # after which it slides free
        self._dice, self._slip, self._noise = random.Random(seed), slip, noise
        # What its wheels do not tell.
        self._track = 2.0 * TURNING_RADIUS * (1.0 + track_error)
        self._growth = 1.0 + radius_error
        self._wheels = [0.0, 0.0]
        self._angles = [0.0, 0.0]
        self._odometer: Odometer | None = None
        self.name = "r"
        self.spec: Any = SimpleNamespace(
            wheels={"l": WHEEL, "r": WHEEL},
            sensors=[str(number) for number in range(len(MOUNTS))],
        )
        self.drive: Any = SimpleNamespace(turning_radius=TURNING_RADIUS)
        self.backend: Any = SimpleNamespace(
            pose=lambda: self.here,
            wheel_angles=lambda: tuple(self._angles),
            sensor_cone=lambda sensor: SensorCone(MOUNTS[int(sensor)], RANGE, CONE),
            distance=self.distance,
        )

    def use_odometry(self, odometer: Odometer) -> None:
        self._odometer = odometer

    def pose(self) -> Pose:
        return self.here if self._odometer is None else self._odometer.pose()

    def correct(self, pose: Pose) -> None:
        assert self._odometer
        self._odometer.correct(pose)

    def off(self) -> tuple[float, float]:
        """The error of the estimated pose, in metres and degrees."""
        off = self.pose().relative_to(self.here)
        return math.hypot(off.x, off.y), abs(math.degrees(off.theta))

    def distance(self, sensor: str) -> float | None:
        away = self.ideal.distance(on(self.here, MOUNTS[int(sensor)]))
        away += self._dice.gauss(0.0, self._noise)
        return away if away <= RANGE else None

    async def rotate(
        self,
        angle: float,
        on_pose: Callable[[Pose], object] | None = None,
        speed: float = RIM_SPEED,
    ) -> None:
        count = max(1, math.ceil(abs(angle) * TURNING_RADIUS / (speed * STEP)))
        before, left = self.pose(), angle
        for steps in range(count, 0, -1):
            self._roll(0.0, left / steps)
            here = self.pose()
            # Without odometry, it turns by its wheels.
            rolled = left / steps
            left -= (
                rolled
                if self._odometer is None
                else wrap_angle(here.theta - before.theta)
            )
            before = here
            if on_pose is not None:
                on_pose(here)

    async def drive_to(self, goal: Pose, should_stop: Callable[[Pose], bool]) -> None:
        remaining = goal.relative_to(self.pose()).x
        count = max(1, math.ceil(abs(remaining) / (RIM_SPEED * STEP)))
        for steps in range(count, 0, -1):
            self._roll(goal.relative_to(self.pose()).x / steps, 0.0)
            if should_stop(self.pose()):
                break

    def failure(self, reason: object) -> MovementError:
        return MovementError(str(reason))

    def _roll(self, way: float, turned: float) -> None:
        """One step; the slip of each wheel is correlated, as in the embedded simulator."""
        kept = math.exp(-STEP)
        fresh = math.sqrt(1.0 - kept * kept) * self._slip
        self._wheels = [kept * s + self._dice.gauss(0.0, fresh) for s in self._wheels]
        rims = way - TURNING_RADIUS * turned, way + TURNING_RADIUS * turned
        self._angles = [
            angle + rim / WHEEL for angle, rim in zip(self._angles, rims, strict=True)
        ]
        left, right = (
            rim * self._growth * (1.0 + slip)
            for rim, slip in zip(rims, self._wheels, strict=True)
        )
        turned = (right - left) / self._track
        here = self.here.turned(turned).ahead((left + right) / 2.0)
        if any(
            is_in_body(Pose(*block, 0.0).relative_to(here)) for block in self.blocks
        ):
            self.blocked_steps -= 1
            if self.blocked_steps <= 0:
                self.blocks = []
            return
        self.here = here
        if not self.ideal.rooms.holds(here.x, here.y, here.theta, 0.149):
            self.touched.append(here)


def slam_robot(robot: SlippingRobot) -> OdometrySlamRobot:
    """The robot of an explorer, on this one's wheels and sensors."""
    slam_session: Any = SimpleNamespace(
        uses_odometry=True,
        extent=20.0,
        range=lambda robot, sensor, reported: reported,
        cone=lambda robot, sensor, reported: reported,
        radius=lambda robot, spanned: spanned,
    )
    driving: Any = robot
    return OdometrySlamRobot(driving, slam_session)


def is_in_body(point: Pose) -> bool:
    """Whether a point in the robot's frame is in its body."""
    return max(abs(point.x), abs(point.y)) < HALF


def scan_from(robot: SlippingRobot, pose: Pose, angle: float = math.pi) -> Scan:
    """The scan of a turn in place at a pose."""
    robot.here = pose
    scan = Scan()

    def look(here: Pose) -> None:
        readings = []
        for number, mount in enumerate(MOUNTS):
            distance = robot.distance(str(number))
            depth = RANGE if distance is None else distance
            readings.append(Reading(mount, CONE, depth, distance is not None))
        scan.add(here, readings)

    at_once(robot.rotate(angle, look))
    return scan
