"""A robot without wheels or time in closed rooms: it moves exactly as told, and scans on the way."""

import math
from collections.abc import Callable, Coroutine
from typing import Any, TypeVar

from pydslrep_runtime.pose import Pose, wrap_angle
from pydslrep_runtime.slam.occupancy_grid import OccupancyGrid, Position, Reading
from rooms import Pillar, Rooms, nearest_on_segment

T = TypeVar("T")

HALF = 0.15  # m, of the square body
RADIUS = math.hypot(HALF, HALF)

# The simulator's mounts for five sensors: x, y and bearing on the body.
MOUNTS = [
    Pose(0.0, HALF, math.pi / 2.0),
    Pose(HALF, HALF, math.pi / 4.0),
    Pose(HALF, 0.0, 0.0),
    Pose(HALF, -HALF, -math.pi / 4.0),
    Pose(0.0, -HALF, -math.pi / 2.0),
]


def at_once(driving: Coroutine[Any, Any, T]) -> T:
    """The result of a coroutine that never waits, because its time is no one else's."""
    try:
        driving.send(None)
    except StopIteration as done:
        result: T = done.value
        return result
    raise AssertionError("it waits")


def on(pose: Pose, mount: Pose) -> Pose:
    """A mount's pose in the world."""
    cos, sin = math.cos(pose.theta), math.sin(pose.theta)
    return Pose(
        pose.x + cos * mount.x - sin * mount.y,
        pose.y + sin * mount.x + cos * mount.y,
        wrap_angle(pose.theta + mount.theta),
    )


class IdealRobot:
    """Records its path and its collisions."""

    STEP = 0.03  # m
    TURN = math.radians(5.0)

    def __init__(
        self,
        rooms: Rooms,
        grid: OccupancyGrid,
        reach: float = 1.0,
        cone: float = math.radians(20.0),
    ) -> None:
        self.rooms, self.grid, self.reach, self.cone = rooms, grid, reach, cone
        self.here = Pose(*rooms.start, 0.0)
        self.touched: list[Pose] = []
        self.positions: list[Position] = []
        self.driven = self.turned = 0.0
        self.segments = rooms.segments()
        self.surprises: list[Pillar] = []  # that no sensor detects from a distance
        self.look()

    def pose(self) -> Pose:
        return self.here

    async def turn_by(self, angle: float) -> None:
        count = max(1, math.ceil(abs(angle) / self.TURN))
        for _ in range(count):
            self.here = self.here.turned(angle / count)
            self.look()
        self.turned += abs(angle)

    async def localise(self) -> int:
        """Its pose is exact."""
        self.positions.append((self.here.x, self.here.y))
        return len(self.positions) - 1

    def position(self, number: int) -> Position:
        return self.positions[number]

    def uncertain(self) -> tuple[int, ...]:
        return ()

    async def drive_to(self, goal: Position, should_stop: Callable[[], bool]) -> bool:
        dx, dy = goal[0] - self.here.x, goal[1] - self.here.y
        await self.turn_by(wrap_angle(math.atan2(dy, dx) - self.here.theta))
        length = math.hypot(dx, dy)
        count = max(1, math.ceil(length / self.STEP))
        for index in range(count):
            near = [s.at for s in self.surprises if self.is_near_ahead(s)]
            if near:
                self.grid.mark_obstacle(*near[0])
                return False
            self.here = self.here.ahead(length / count)
            self.driven += length / count
            self.look()
            if index % 5 == 0 and should_stop():
                break
        return True

    def is_near_ahead(self, surprise: Pillar) -> bool:
        seen = Pose(*surprise.at, 0.0).relative_to(self.here)
        reach = RADIUS + surprise.radius
        return 0.0 < seen.x < reach + 0.05 and abs(seen.y) < reach

    async def back_up_to(self, goal: Position) -> None:
        self.here = Pose(*goal, self.here.theta)

    def look(self) -> None:
        if not self.rooms.holds(self.here.x, self.here.y, self.here.theta, HALF):
            self.touched.append(self.here)
        for mount in MOUNTS:
            sensor = on(self.here, mount)
            away = self.distance(sensor)
            self.grid.add_reading(
                Reading(sensor, self.cone, min(away, self.reach), away < self.reach)
            )

    def distance(self, sensor: Pose) -> float:
        """The distance to the nearest point in the cone."""
        best = math.inf
        position, half = (sensor.x, sensor.y), self.cone / 2.0

        def consider(point: Position) -> None:
            nonlocal best
            away = math.dist(position, point)
            if away < best:
                bearing = math.atan2(point[1] - sensor.y, point[0] - sensor.x)
                if abs(wrap_angle(bearing - sensor.theta)) <= half + 1e-9:
                    best = away

        rays = [
            (
                math.cos(sensor.theta + side * half),
                math.sin(sensor.theta + side * half),
            )
            for side in (-1.0, 1.0)
        ]
        for start, end in self.segments:
            if (
                max(start[0], end[0]) < sensor.x - self.reach
                or min(start[0], end[0]) > sensor.x + self.reach
                or max(start[1], end[1]) < sensor.y - self.reach
                or min(start[1], end[1]) > sensor.y + self.reach
            ):
                continue
            nearest = nearest_on_segment(position, start, end)
            if math.dist(position, nearest) > self.reach:
                continue
            consider(nearest)
            for ray in rays:
                dx, dy = end[0] - start[0], end[1] - start[1]
                cross = ray[0] * dy - ray[1] * dx
                if abs(cross) < 1e-12:
                    continue
                wx, wy = start[0] - sensor.x, start[1] - sensor.y
                along, part = (
                    (wx * dy - wy * dx) / cross,
                    (wx * ray[1] - wy * ray[0]) / cross,
                )
                if along > 0.0 and 0.0 <= part <= 1.0:
                    best = min(best, along)
        for pillar in self.rooms.pillars:
            away = math.dist(position, pillar.at)
            if away - pillar.radius > self.reach:
                continue
            consider(
                (
                    pillar.at[0] + (sensor.x - pillar.at[0]) * pillar.radius / away,
                    pillar.at[1] + (sensor.y - pillar.at[1]) * pillar.radius / away,
                )
            )
            for ray in rays:
                wx, wy = pillar.at[0] - sensor.x, pillar.at[1] - sensor.y
                along = wx * ray[0] + wy * ray[1]
                square = pillar.radius**2 - (wx * wx + wy * wy - along * along)
                if square >= 0.0 and along > 0.0:
                    best = min(best, along - math.sqrt(square))
        return best
