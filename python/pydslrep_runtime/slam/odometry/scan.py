"""Scans: the surfaces that a robot detects while it turns in place."""

import math
from collections.abc import Iterable, Sequence

import numpy as np

from ...pose import Pose
from ..occupancy_grid import Reading
from .blocked_turn import actual_angles
from .surface import Array, Complex, Flags, Indices, SurfacePoints, joined

BIN = math.radians(2.5)  # angular resolution
BINS = round(math.tau / BIN)
WINDOW = 4  # bins to each side that a line is fitted to
MAX_DEPTH_STEP = 0.1  # m between readings: beyond it, one surface occludes another
MAX_GAP = 0.15  # m between neighbouring points on the same surface
MAX_RMS_ERROR = 0.012  # m from points on a flat surface to the fitted line
CORNER_DEPTH = 0.01  # m: cones round off corners; a deeper bend is a corner
BEYOND = 0.3  # m from a sensor's range to where it could have detected something
SMOOTHING_ANGLE = 1.05 * BIN  # to each side of a reading
SMOOTHING_DEPTH = 0.06  # m between readings that are smoothed


class Scan:
    """The readings of one turn in place, and the surfaces extracted from them.

    A cone measures the distance to the nearest point in it, but not the direction of that
    point. On a flat, inclined surface the point is on one edge of the cone. While the cone
    turns, each of its two edges therefore gives a distance for every direction; the larger
    of the two belongs to the surface.
    """

    def __init__(self) -> None:
        self._poses: list[Pose] = []
        self._readings: list[Sequence[Reading]] = []

    def add(self, here: Pose, readings: Sequence[Reading]) -> None:
        """Adds a reading of each sensor in the robot's frame, taken at a pose."""
        self._poses.append(here)
        self._readings.append(readings)

    def middle_pose(self) -> Pose:
        """The robot's pose halfway through: the origin of the scan's frame."""
        return self._poses[len(self._poses) // 2]

    def turned(self) -> float:
        """The angle that the robot has turned, in radians, as reported."""
        headings = np.unwrap([pose.theta for pose in self._poses])
        return float(headings[-1] - headings[0])

    def correct(self) -> float:
        """Corrects the poses if something has blocked the turn.

        Returns the angle by which the robot has turned less than its wheels report, in radians.
        """
        headings = np.unwrap([pose.theta for pose in self._poses])
        ends = [
            [
                reading.sensor.ahead(reading.distance + (not reading.is_hit) * BEYOND)
                for reading in readings
            ]
            for readings in self._readings
        ]
        turned = headings - headings[0]
        angles = actual_angles(
            turned, np.array([[complex(end.x, end.y) for end in row] for row in ends])
        )
        excess = (turned - angles).tolist()
        self._poses = [
            pose.turned(-angle) for pose, angle in zip(self._poses, excess, strict=True)
        ]
        return float(excess[-1])

    def observations(self) -> Iterable[tuple[Pose, Sequence[Reading]]]:
        """The poses with their readings."""
        return zip(self._poses, self._readings, strict=True)

    def surface_points(self) -> SurfacePoints:
        """The points on surfaces, in the frame of the middle pose."""
        origin = self.middle_pose()
        poses = [pose.relative_to(origin) for pose in self._poses]
        of_sensors = zip(*self._readings, strict=True)
        return joined(surfaces_of(poses, readings) for readings in of_sensors)


def surfaces_of(poses: Sequence[Pose], readings: Sequence[Reading]) -> SurfacePoints:
    """The points on flat surfaces that one sensor detects."""
    sensors = [
        reading.sensor.transformed_by(pose)
        for pose, reading in zip(poses, readings, strict=True)
    ]
    position = np.array([complex(sensor.x, sensor.y) for sensor in sensors])
    heading = np.unwrap([sensor.theta for sensor in sensors])
    is_hit = np.array([reading.is_hit for reading in readings])
    distance = np.array([reading.distance for reading in readings])
    distance = smoothed(heading, distance, is_hit)
    edges = []
    for side in (-0.5, 0.5):
        bearing = heading + side * readings[0].cone
        edges.append(passed_bins(position + distance * np.exp(1j * bearing), is_hit))
    bins, depth, phase, hits = map(np.concatenate, zip(*edges, strict=True))
    # The deepest point in each bin: the last one assigned.
    deepest = np.full(BINS, -1)
    order = np.argsort(depth)
    deepest[bins[order]] = order
    deepest[bins[~hits]] = -1
    return flat_parts(np.where(deepest < 0, np.nan, depth[deepest]), phase[deepest])


def smoothed(heading: Array, distance: Array, is_hit: Flags) -> Array:
    """Each distance becomes the mean of those within an angle around it, if they are similar."""
    index = np.arange(len(heading))
    turned = np.maximum.accumulate(np.abs(heading - heading[0]))
    before = index - np.searchsorted(turned, turned - SMOOTHING_ANGLE, "right")
    after = np.searchsorted(turned, turned + SMOOTHING_ANGLE, "left") - 1 - index
    reach = np.minimum(before, after)
    ranges = np.column_stack([index - reach, index + reach + 1]).ravel()
    padded = np.append(np.where(is_hit, distance, np.inf), 0.0)
    with np.errstate(invalid="ignore"):
        highest = np.maximum.reduceat(padded, ranges)[::2]
        lowest = np.minimum.reduceat(padded, ranges)[::2]
        mean = np.add.reduceat(padded, ranges)[::2] / (2 * reach + 1)
        return np.where(highest - lowest < SMOOTHING_DEPTH, mean, distance)


def passed_bins(ends: Complex, is_hit: Flags) -> tuple[Indices, Array, Array, Flags]:
    """The bins that the far end of an edge passes, with depth, phase and whether it hits."""
    depth, direction = np.abs(ends), np.unwrap(np.angle(ends))
    step, turned = np.diff(depth), np.diff(direction)
    first = np.ceil(np.minimum(direction[:-1], direction[1:]) / BIN).astype(np.int64)
    last = np.ceil(np.maximum(direction[:-1], direction[1:]) / BIN).astype(np.int64)
    count = np.where(np.abs(step) > MAX_DEPTH_STEP, 0, last - first)
    pair = np.repeat(np.arange(len(count)), count)
    number = np.arange(len(pair)) + np.repeat(first - np.cumsum(count) + count, count)
    part = (number * BIN - direction[pair]) / turned[pair]
    hits = is_hit[:-1] & is_hit[1:]
    phase = (pair + part) / len(step) - 0.5
    return number % BINS, depth[pair] + part * step[pair], phase, hits[pair]


def flat_parts(depth: Array, phase: Array) -> SurfacePoints:
    """The points of all bins that are on flat surfaces; `depth` is NaN without a point."""
    point = depth * np.exp(1j * BIN * np.arange(BINS))
    window = (np.arange(BINS)[:, None] + np.arange(-WINDOW, WINDOW + 1)) % BINS
    offset = point[window] - point[:, None]
    is_near = np.abs(offset) < MAX_GAP
    ends = [0, -1]
    is_corner = depth[window[:, ends]].max(axis=1) < depth - CORNER_DEPTH
    is_corner &= is_near[:, ends].all(axis=1)
    chosen = (is_near.sum(axis=1) >= WINDOW + 2) & ~is_corner
    point, phase = point[chosen], phase[chosen]
    away, along, rms_error = fitted_lines(offset[chosen], is_near[chosen])
    # Onto the line, whose normal faces the sensor.
    normal = 1j * along
    normal *= np.where((normal.conj() * point).real > 0.0, -1.0, 1.0)
    point = point + (normal.conj() * away).real * normal
    is_flat = rms_error <= MAX_RMS_ERROR
    return SurfacePoints(point[is_flat], normal[is_flat], phase[is_flat])


def fitted_lines(points: Complex, is_used: Flags) -> tuple[Complex, Complex, Array]:
    """Fits a line to each row of points: a point on it, its direction, and the RMS error."""
    count = is_used.sum(axis=1)
    points = np.where(is_used, points, 0.0)
    mean = points.sum(axis=1) / count
    offset = np.where(is_used, points - mean[:, None], 0.0)
    # Twice the angle of the line, as long as the difference of the covariance's eigenvalues.
    spread = (offset**2).sum(axis=1) / count
    across = ((np.abs(offset) ** 2).sum(axis=1) / count - np.abs(spread)) / 2.0
    return mean, np.exp(0.5j * np.angle(spread)), np.sqrt(np.maximum(0.0, across))
