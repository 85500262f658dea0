"""A robot in closed rooms with slipping wheels and noisy sensors, without simulator or time."""

import math
import random
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

from ideal_rover import MOUNTS, RADIUS, IdealRover, on
from pydslrep_parts.errors import MovementError
from pydslrep_parts.model import SensorCone
from pydslrep_parts.occupancy_grid import OccupancyGrid, Reading
from pydslrep_parts.pose import Pose
from pydslrep_parts.scan import Scan
from pydslrep_parts.settings import RIM_SPEED
from rooms import Rooms

CONE = math.radians(20.0)
RANGE = 1.0
STEP = 0.05  # s


class SlippingRobot:
    """The parts of a robot that the rover uses; `here` is its actual pose, `pose` the estimate."""

    def __init__(
        self, rooms: Rooms, slip: float = 0.0, noise: float = 0.0, seed: int = 1
    ) -> None:
        self.ideal = IdealRover(rooms, OccupancyGrid(RADIUS))
        self.here = self.believed = Pose(*rooms.start, 0.0)
        self.touched: list[Pose] = []
        self._dice, self._slip, self._noise = random.Random(seed), slip, noise
        self._wheels = [0.0, 0.0]
        self._wheel_travel = 0.0
        self.body: Any = SimpleNamespace(
            model=SimpleNamespace(
                name="r", slam_sensors=[str(n) for n in range(len(MOUNTS))]
            ),
            drive=SimpleNamespace(turning_radius=0.15),
            sensor_cone=lambda sensor: SensorCone(MOUNTS[int(sensor)], RANGE, CONE),
            distance=self.distance,
        )

    def pose(self) -> Pose:
        return self.believed

    def correct(self, pose: Pose) -> None:
        self.believed = pose

    def wheel_travel(self) -> float:
        return self._wheel_travel

    def off(self) -> tuple[float, float]:
        """The error of the estimated pose, in metres and degrees."""
        off = self.believed.relative_to(self.here)
        return math.hypot(off.x, off.y), abs(math.degrees(off.theta))

    def distance(self, sensor: str) -> float | None:
        away = self.ideal.distance(on(self.here, MOUNTS[int(sensor)]))
        away += self._dice.gauss(0.0, self._noise)
        return away if away <= RANGE else None

    def rotate(
        self,
        angle: float,
        on_pose: Callable[[Pose], object],
        speed: float = RIM_SPEED,
    ) -> None:
        count = max(1, math.ceil(abs(angle) * 0.15 / (speed * STEP)))
        for _ in range(count):
            self._roll(0.0, angle / count)
            on_pose(self.believed)

    def drive_to(self, goal: Pose, should_stop: Callable[[Pose], bool]) -> None:
        remaining = goal.relative_to(self.believed).x
        count = max(1, math.ceil(abs(remaining) / (RIM_SPEED * STEP)))
        for _ in range(count):
            self._roll(remaining / count, 0.0)
            if should_stop(self.believed):
                break

    def failure(self, reason: object) -> MovementError:
        return MovementError(str(reason))

    def _roll(self, way: float, turned: float) -> None:
        """One step; the slip of each wheel is correlated, as in the embedded simulator."""
        kept = math.exp(-STEP)
        fresh = math.sqrt(1.0 - kept * kept) * self._slip
        self._wheels = [kept * s + self._dice.gauss(0.0, fresh) for s in self._wheels]
        rims = way - 0.15 * turned, way + 0.15 * turned
        self._wheel_travel += (abs(rims[0]) + abs(rims[1])) / 2.0
        left, right = (
            rim * (1.0 + slip) for rim, slip in zip(rims, self._wheels, strict=True)
        )
        self.here = self.here.turned((right - left) / 0.3).ahead((left + right) / 2.0)
        self.believed = self.believed.turned(turned).ahead(way)
        here = self.here
        if not self.ideal.rooms.holds(here.x, here.y, here.theta, 0.149):
            self.touched.append(here)


def scan_from(robot: SlippingRobot, pose: Pose, angle: float = math.pi) -> Scan:
    """The scan of a turn in place at a pose."""
    robot.here = robot.believed = pose
    scan = Scan()

    def look(here: Pose) -> None:
        for number, mount in enumerate(MOUNTS):
            distance = robot.distance(str(number))
            is_hit = distance is not None
            reading = Reading(
                mount, CONE, RANGE if distance is None else distance, is_hit
            )
            scan.add(here, str(number), reading)

    robot.rotate(angle, look)
    return scan
