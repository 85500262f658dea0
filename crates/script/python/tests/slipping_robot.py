"""A robot in closed rooms whose wheels slip and whose sensors are noisy, without simulator or time."""

import math
import random
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

from ideal_rover import MOUNTS, RADIUS, GhostRover, on
from pydslrep_parts.errors import MovementError
from pydslrep_parts.model import Eye
from pydslrep_parts.occupancy_grid import Floor, Reading
from pydslrep_parts.pose import Pose
from pydslrep_parts.scan import Sweep
from pydslrep_parts.settings import RIM_SPEED
from rooms import Rooms

CONE = math.radians(20.0)
RANGE = 1.0
STEP = 0.05  # s


class SlippingRobot:
    """What a surveyor needs of a robot; `here` is where it is, `pose` where it believes to be."""

    def __init__(
        self, rooms: Rooms, slip: float = 0.0, noise: float = 0.0, seed: int = 1
    ) -> None:
        self.ghost = GhostRover(rooms, Floor(RADIUS))
        self.here = self.believed = Pose(*rooms.start, 0.0)
        self.touched: list[Pose] = []
        self._dice, self._slip, self._noise = random.Random(seed), slip, noise
        self._wheels = [0.0, 0.0]
        self._rolled = 0.0
        self.body: Any = SimpleNamespace(
            model=SimpleNamespace(name="r", eyes=[str(n) for n in range(len(MOUNTS))]),
            drive=SimpleNamespace(turning_radius=0.15),
            eye=lambda sensor: Eye(MOUNTS[int(sensor)], RANGE, CONE),
            distance=self.distance,
        )

    def pose(self) -> Pose:
        return self.believed

    def correct(self, pose: Pose) -> None:
        self.believed = pose

    def rolled(self) -> float:
        return self._rolled

    def off(self) -> tuple[float, float]:
        """Metres and degrees by which it is wrong about where it is."""
        off = self.believed.seen_from(self.here)
        return math.hypot(off.x, off.y), abs(math.degrees(off.theta))

    def distance(self, sensor: str) -> float | None:
        away = self.ghost.distance(on(self.here, MOUNTS[int(sensor)]))
        away += self._dice.gauss(0.0, self._noise)
        return away if away <= RANGE else None

    def rotate(
        self,
        angle: float,
        heed: Callable[[Pose], object],
        speed: float = RIM_SPEED,
    ) -> None:
        count = max(1, math.ceil(abs(angle) * 0.15 / (speed * STEP)))
        for _ in range(count):
            self._roll(0.0, angle / count)
            heed(self.believed)

    def drive_to(self, goal: Pose, is_enough: Callable[[Pose], bool]) -> None:
        to_go = goal.seen_from(self.believed).x
        count = max(1, math.ceil(abs(to_go) / (RIM_SPEED * STEP)))
        for _ in range(count):
            self._roll(to_go / count, 0.0)
            if is_enough(self.believed):
                break

    def failure(self, reason: object) -> MovementError:
        return MovementError(str(reason))

    def _roll(self, way: float, turned: float) -> None:
        """A step, in which the slip of each wheel changes a little, as in the embedded simulator."""
        kept = math.exp(-STEP)
        fresh = math.sqrt(1.0 - kept * kept) * self._slip
        self._wheels = [kept * s + self._dice.gauss(0.0, fresh) for s in self._wheels]
        rims = way - 0.15 * turned, way + 0.15 * turned
        self._rolled += (abs(rims[0]) + abs(rims[1])) / 2.0
        left, right = (
            rim * (1.0 + slip) for rim, slip in zip(rims, self._wheels, strict=True)
        )
        self.here = self.here.turned((right - left) / 0.3).ahead((left + right) / 2.0)
        self.believed = self.believed.turned(turned).ahead(way)
        here = self.here
        if not self.ghost.rooms.holds(here.x, here.y, here.theta, 0.149):
            self.touched.append(here)


def sweep_from(robot: SlippingRobot, place: Pose, angle: float = math.pi) -> Sweep:
    """What it sees on a turn in place there."""
    robot.here = robot.believed = place
    sweep = Sweep()

    def look(here: Pose) -> None:
        for number, mount in enumerate(MOUNTS):
            distance = robot.distance(str(number))
            sees = distance is not None
            reading = Reading(
                mount, CONE, RANGE if distance is None else distance, sees
            )
            sweep.add(here, str(number), reading)

    robot.rotate(angle, look)
    return sweep
