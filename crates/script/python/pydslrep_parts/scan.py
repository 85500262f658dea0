#: if standalone
"""What a robot sees of surfaces while it turns in place."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from .occupancy_grid import Place, Reading
from .pose import Pose, wrap_angle

#: endif


@dataclass(frozen=True)
class Mark:
    """A point of a surface, as it is from the place it was seen from."""

    x: float
    y: float
    normal: float  # radians: where the surface faces
    when: float = 0.0  # of the sweep: -0.5 is its begin, 0.5 its end


@dataclass(frozen=True)
class Point:
    """What is seen in a direction."""

    depth: float  # m from the origin
    direction: float  # radians
    when: float  # of the sweep

    @property
    def place(self) -> Place:
        """Where it is."""
        x, y = math.cos(self.direction), math.sin(self.direction)
        return self.depth * x, self.depth * y


class Sweep:
    """Readings on a turn in place, and the surfaces that they show.

    A cone tells how far off the nearest point in it is, but not where across the cone. On
    a flat surface that is slanting to it, the point is at one of its edges. So each edge
    tells, while the cone turns, a depth for every direction, of which the larger one is
    that of the surface.
    """

    BIN = math.radians(2.5)  # between the directions that are told apart
    ABOUT = 4  # directions to each side that make the surface at one of them
    EDGE = 0.1  # m: where depths differ so much at once, one surface hides another
    NEAR = 0.15  # m: next to each other, they are further apart at edges
    ROUGH = 0.012  # m that points of a flat surface are off it
    DENT = 0.01  # m: corners are rounded by cones; where it bends so, it is one

    def __init__(self) -> None:
        self._readings: dict[str, list[tuple[Pose, Reading]]] = {}

    def add(self, here: Pose, sensor: str, reading: Reading) -> None:
        """What a sensor, as it is mounted, sees from a pose."""
        self._readings.setdefault(sensor, []).append((here, reading))

    def middle(self) -> Pose:
        """Where the robot was half-way: the place that marks are seen from."""
        some = next(iter(self._readings.values()))
        return some[len(some) // 2][0]

    def marks(self) -> list[Mark]:
        """The surfaces, as they are from the middle."""
        origin = self.middle()
        found: list[Mark] = []
        for readings in self._readings.values():
            found += self._marks_of(
                [reading.seen_by(here.seen_from(origin)) for here, reading in readings]
            )
        return found

    def _marks_of(self, readings: Sequence[Reading]) -> list[Mark]:
        count = round(math.tau / self.BIN)
        points: list[Point | None] = [None] * count
        blank: set[int] = set()  # as far as the sensor sees, there is nothing
        mean = smoothed(readings, 1.05 * self.BIN)
        for index, (now, after) in enumerate(itertools.pairwise(mean)):
            for side in (-0.5, 0.5):
                first, last = edge_of(now, side), edge_of(after, side)
                if abs(last.depth - first.depth) > self.EDGE:
                    continue
                turned = wrap_angle(last.direction - first.direction)
                for number in self._directions(first.direction, turned):
                    part = (number * self.BIN - first.direction) / (turned or 1.0)
                    if not (now.sees and after.sees):
                        blank.add(number % count)
                    depth = first.depth + part * (last.depth - first.depth)
                    known = points[number % count]
                    if known is None or depth > known.depth:
                        when = (index + part) / (len(mean) - 1) - 0.5
                        points[number % count] = Point(depth, number * self.BIN, when)
        for number in blank:
            points[number] = None
        marks = (self._mark(points, number) for number in range(count))
        return [mark for mark in marks if mark]

    def _directions(self, first: float, turned: float) -> range:
        """The directions that an edge of a cone sweeps over."""
        low, high = sorted((first / self.BIN, (first + turned) / self.BIN))
        return range(math.ceil(low), math.ceil(high))

    def _mark(self, points: "Sequence[Point | None]", number: int) -> Mark | None:
        """A direction's point, if there is a flat surface about it."""
        point = points[number]
        if point is None:
            return None
        place, about, ends = point.place, [], []
        for step in range(-self.ABOUT, self.ABOUT + 1):
            other = points[(number + step) % len(points)]
            if other is not None and math.dist(other.place, place) < self.NEAR:
                about.append(other.place)
                if abs(step) == self.ABOUT:
                    ends.append(other.depth)
        if len(about) < self.ABOUT + 2:
            return None
        if len(ends) == 2 and max(ends) < point.depth - self.DENT:
            return None
        x, y, along, rough = line_through(about)
        if rough > self.ROUGH:
            return None
        normal = along + math.pi / 2.0
        away = (place[0] - x) * math.cos(normal) + (place[1] - y) * math.sin(normal)
        x = place[0] - away * math.cos(normal)
        y = place[1] - away * math.sin(normal)
        if x * math.cos(normal) + y * math.sin(normal) > 0.0:
            normal += math.pi  # it faces who sees it
        return Mark(x, y, wrap_angle(normal), point.when)


def smoothed(readings: Sequence[Reading], within: float) -> list[Reading]:
    """Readings with less noise: each one the mean with those about it, up to an angle."""
    found = []
    for index, now in enumerate(readings):
        count = 0
        while (
            index - count - 1 >= 0
            and index + count + 1 < len(readings)
            and all(
                abs(wrap_angle(readings[n].eye.theta - now.eye.theta)) < within
                for n in (index - count - 1, index + count + 1)
            )
        ):
            count += 1
        about = [
            r.distance for r in readings[index - count : index + count + 1] if r.sees
        ]
        if len(about) == 2 * count + 1 and max(about) - min(about) < 0.06:
            now = replace(now, distance=sum(about) / len(about))
        found.append(now)
    return found


def edge_of(reading: Reading, side: float) -> Point:
    """The end of an edge of a cone."""
    end = reading.eye.turned(side * reading.cone).ahead(reading.distance)
    return Point(math.hypot(end.x, end.y), math.atan2(end.y, end.x), 0.0)


def line_through(places: Sequence[Place]) -> tuple[float, float, float, float]:
    """The line through places: a point, its direction, and how far off it they are (rms)."""
    count = len(places)
    x = sum(place[0] for place in places) / count
    y = sum(place[1] for place in places) / count
    xx = sum((place[0] - x) ** 2 for place in places) / count
    yy = sum((place[1] - y) ** 2 for place in places) / count
    xy = sum((place[0] - x) * (place[1] - y) for place in places) / count
    along = 0.5 * math.atan2(2.0 * xy, xx - yy)
    # The smaller eigenvalue of the covariance: the variance across the line.
    across = (xx + yy) / 2.0 - math.hypot((xx - yy) / 2.0, xy)
    return x, y, along, math.sqrt(max(0.0, across))
