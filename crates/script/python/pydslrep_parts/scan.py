#: if standalone
"""Scans: the surfaces that a robot detects while it turns in place."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from .occupancy_grid import Position, Reading
from .pose import Pose, wrap_angle

#: endif


@dataclass(frozen=True)
class SurfacePoint:
    """A point on a surface, in the frame of the scan."""

    x: float
    y: float
    normal: float  # radians: the direction that the surface faces
    phase: float = 0.0  # when in the scan: -0.5 at its start, 0.5 at its end


@dataclass(frozen=True)
class RangePoint:
    """The distance measured in one direction."""

    depth: float  # m from the origin
    direction: float  # radians
    phase: float  # when in the scan

    @property
    def position(self) -> Position:
        """Its position in the frame of the scan."""
        x, y = math.cos(self.direction), math.sin(self.direction)
        return self.depth * x, self.depth * y


class Scan:
    """The readings of one turn in place, and the surfaces extracted from them.

    A cone measures the distance to the nearest point in it, but not the direction of that
    point. On a flat, inclined surface the point is on one edge of the cone. While the cone
    turns, each of its two edges therefore gives a distance for every direction; the larger
    of the two belongs to the surface.
    """

    BIN = math.radians(2.5)  # angular resolution
    WINDOW = 4  # bins to each side that a line is fitted to
    MAX_DEPTH_STEP = 0.1  # m between readings: beyond it, one surface occludes another
    MAX_GAP = 0.15  # m between neighbouring points on the same surface
    MAX_RMS_ERROR = 0.012  # m from points on a flat surface to the fitted line
    CORNER_DEPTH = 0.01  # m: cones round off corners; a deeper bend is a corner

    def __init__(self) -> None:
        self._readings: dict[str, list[tuple[Pose, Reading]]] = {}

    def add(self, here: Pose, sensor: str, reading: Reading) -> None:
        """Adds a reading in the robot's frame, taken at a pose."""
        self._readings.setdefault(sensor, []).append((here, reading))

    def middle_pose(self) -> Pose:
        """The robot's pose halfway through: the origin of the scan's frame."""
        readings = next(iter(self._readings.values()))
        return readings[len(readings) // 2][0]

    def surface_points(self) -> list[SurfacePoint]:
        """The points on surfaces, in the frame of the middle pose."""
        origin = self.middle_pose()
        found: list[SurfacePoint] = []
        for readings in self._readings.values():
            found += self._surface_points_of(
                [
                    reading.transformed_by(here.relative_to(origin))
                    for here, reading in readings
                ]
            )
        return found

    def _surface_points_of(self, readings: Sequence[Reading]) -> list[SurfacePoint]:
        count = round(math.tau / self.BIN)
        points: list[RangePoint | None] = [None] * count
        out_of_range: set[int] = set()  # bins without anything in the sensor's range
        mean = smoothed(readings, 1.05 * self.BIN)
        for index, (now, after) in enumerate(itertools.pairwise(mean)):
            for side in (-0.5, 0.5):
                first, last = cone_edge(now, side), cone_edge(after, side)
                if abs(last.depth - first.depth) > self.MAX_DEPTH_STEP:
                    continue
                turned = wrap_angle(last.direction - first.direction)
                for number in self._bins_between(first.direction, turned):
                    part = (number * self.BIN - first.direction) / (turned or 1.0)
                    if not (now.is_hit and after.is_hit):
                        out_of_range.add(number % count)
                    depth = first.depth + part * (last.depth - first.depth)
                    known = points[number % count]
                    if known is None or depth > known.depth:
                        phase = (index + part) / (len(mean) - 1) - 0.5
                        points[number % count] = RangePoint(
                            depth, number * self.BIN, phase
                        )
        for number in out_of_range:
            points[number] = None
        surface_points = (
            self._surface_point(points, number) for number in range(count)
        )
        return [point for point in surface_points if point]

    def _bins_between(self, first: float, turned: float) -> range:
        """The bins that the edge of a cone passes over."""
        low, high = sorted((first / self.BIN, (first + turned) / self.BIN))
        return range(math.ceil(low), math.ceil(high))

    def _surface_point(
        self, points: "Sequence[RangePoint | None]", number: int
    ) -> SurfacePoint | None:
        """The point of a bin, if it is on a flat surface."""
        point = points[number]
        if point is None:
            return None
        position, nearby, ends = point.position, [], []
        for step in range(-self.WINDOW, self.WINDOW + 1):
            other = points[(number + step) % len(points)]
            if other is not None and math.dist(other.position, position) < self.MAX_GAP:
                nearby.append(other.position)
                if abs(step) == self.WINDOW:
                    ends.append(other.depth)
        if len(nearby) < self.WINDOW + 2:
            return None
        if len(ends) == 2 and max(ends) < point.depth - self.CORNER_DEPTH:
            return None
        x, y, along, rms_error = fit_line(nearby)
        if rms_error > self.MAX_RMS_ERROR:
            return None
        normal = along + math.pi / 2.0
        away = (position[0] - x) * math.cos(normal) + (position[1] - y) * math.sin(
            normal
        )
        x = position[0] - away * math.cos(normal)
        y = position[1] - away * math.sin(normal)
        if x * math.cos(normal) + y * math.sin(normal) > 0.0:
            normal += math.pi  # surfaces face the sensor
        return SurfacePoint(x, y, wrap_angle(normal), point.phase)


def smoothed(readings: Sequence[Reading], within: float) -> list[Reading]:
    """Smooths readings: each becomes the mean of those within an angle around it."""
    found = []
    for index, now in enumerate(readings):
        count = 0
        while (
            index - count - 1 >= 0
            and index + count + 1 < len(readings)
            and all(
                abs(wrap_angle(readings[n].sensor.theta - now.sensor.theta)) < within
                for n in (index - count - 1, index + count + 1)
            )
        ):
            count += 1
        nearby = [
            r.distance for r in readings[index - count : index + count + 1] if r.is_hit
        ]
        if len(nearby) == 2 * count + 1 and max(nearby) - min(nearby) < 0.06:
            now = replace(now, distance=sum(nearby) / len(nearby))
        found.append(now)
    return found


def cone_edge(reading: Reading, side: float) -> RangePoint:
    """The far end of one edge of a cone."""
    end = reading.sensor.turned(side * reading.cone).ahead(reading.distance)
    return RangePoint(math.hypot(end.x, end.y), math.atan2(end.y, end.x), 0.0)


def fit_line(positions: Sequence[Position]) -> tuple[float, float, float, float]:
    """Fits a line: a point on it, its direction, and the RMS error."""
    count = len(positions)
    x = sum(position[0] for position in positions) / count
    y = sum(position[1] for position in positions) / count
    xx = sum((position[0] - x) ** 2 for position in positions) / count
    yy = sum((position[1] - y) ** 2 for position in positions) / count
    xy = sum((position[0] - x) * (position[1] - y) for position in positions) / count
    along = 0.5 * math.atan2(2.0 * xy, xx - yy)
    # The smaller eigenvalue of the covariance: the variance across the line.
    across = (xx + yy) / 2.0 - math.hypot((xx - yy) / 2.0, xy)
    return x, y, along, math.sqrt(max(0.0, across))
