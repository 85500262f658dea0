"""A log of all readings, to rebuild the occupancy grid when keyframes move."""

import itertools
import math
from collections.abc import Iterable, Sequence

import numpy as np

from ...pose import Pose
from ..occupancy_grid import OccupancyGrid, Reading
from .cones import cells_within
from .poses import Array, difference, rows_of, transformed

NEAR = 0.25  # m within which the width of a cone does not matter


class ScanLog:
    """The readings between keyframes, by leg.

    Poses between two keyframes are interpolated from both, which spreads the odometry's
    error over the leg.
    """

    def __init__(self) -> None:
        self._legs: list[Array] = []
        # Since the last keyframe, relative to it.
        self._open_leg: list[tuple[Pose, Sequence[Reading]]] = []
        self._keyframe = Pose(0.0, 0.0, 0.0)  # the last one

    def add(self, here: Pose, readings: Sequence[Reading]) -> None:
        """Adds readings in the robot's frame, taken at its estimated pose."""
        self._open_leg.append((here.relative_to(self._keyframe), readings))

    def add_obstacle(self, here: Pose, x: float, y: float) -> None:
        """Adds an obstacle that has stopped the robot, at its estimated position."""
        seen = Pose(x, y, 0.0).relative_to(here)
        self.add(here, [Reading(seen, 0.0, 0.0, is_hit=True)])

    def recent(self) -> Iterable[tuple[Pose, Sequence[Reading]]]:
        """The poses since the last keyframe, in the world, with readings."""
        return (
            (pose.transformed_by(self._keyframe), readings)
            for pose, readings in self._open_leg
        )

    def obstacles_near(self, here: Pose) -> list[complex]:
        """Where readings since the last keyframe have hit something near, from a pose."""
        origin = self._keyframe.relative_to(here)
        ends = (
            reading.sensor.ahead(reading.distance).transformed_by(pose)
            for pose, readings in self._open_leg
            for reading in readings
            if reading.is_hit and reading.distance < NEAR
        )
        return [complex(p.x, p.y) for p in (e.transformed_by(origin) for e in ends)]

    def add_keyframe(
        self, estimate: Pose, keyframe: Pose, *, is_valid: bool = True
    ) -> None:
        """Ends a leg at a keyframe; `estimate` is its pose by odometry alone.

        Drops the readings of a leg on which odometry has failed.
        """
        end = estimate.relative_to(self._keyframe)
        # With the pose relative to the new keyframe.
        seen = [(pose.relative_to(end), pose, part) for pose, part in self._open_leg]
        away = [math.hypot(pose.x, pose.y) + abs(pose.theta) for pose, _, _ in seen]
        # The scan at the keyframe ends this leg, and begins the next one.
        count = len(away) - 1 - int(np.argmin(away[::-1])) if away else 0
        # The first leg has no keyframe at its start.
        self._legs.append(
            leg_of(
                (before if self._legs else after, after, number / count, readings)
                for number, (after, before, readings) in enumerate(
                    seen[:count] if is_valid else ()
                )
            )
        )
        self._open_leg = [(after, readings) for after, _, readings in seen[count:]]
        self._keyframe = keyframe

    def replay(
        self, grid: OccupancyGrid, keyframes: Sequence[Pose], since: int = 0
    ) -> None:
        """Adds the readings of all legs after the first `since` to a grid."""
        newest = leg_of(
            (pose, pose, 0.0, readings) for pose, readings in self._open_leg
        )
        ends = itertools.pairwise(rows_of([keyframes[0], *keyframes, keyframes[-1]]))
        legs = list(zip([*self._legs, newest], ends, strict=True))
        for leg, (start, end) in legs[since:]:
            add_leg(grid, leg, start, end)
        for keyframe in keyframes[since:]:
            grid.mark_footprint(keyframe.x, keyframe.y)


def leg_of(seen: Iterable[tuple[Pose, Pose, float, Sequence[Reading]]]) -> Array:
    """A row per reading.

    Its columns are the robot's pose relative to both keyframes, the fraction of the leg that
    was complete, the sensor's pose relative to the robot, and what it has measured.
    """
    rows = [
        (
            *(before.x, before.y, before.theta, after.x, after.y, after.theta, part),
            *(reading.sensor.x, reading.sensor.y, reading.sensor.theta),
            *(reading.cone, reading.distance, reading.is_hit),
        )
        for before, after, part, readings in seen
        for reading in readings
    ]
    return np.array(rows, float).reshape(-1, 13)


def add_leg(grid: OccupancyGrid, leg: Array, start: Array, end: Array) -> None:
    """Adds the readings between two keyframes to a grid."""
    before, after, part, sensor, measured = np.split(leg, [3, 6, 7, 10], axis=1)
    here = transformed(before, start)
    here += part * difference(transformed(after, end), here)
    sensor = transformed(sensor, here)
    is_obstacle = measured[:, 0] == 0.0
    # Later readings may find an obstacle gone.
    for rows in np.split(np.arange(len(leg)), np.flatnonzero(is_obstacle) + 1):
        cones = rows[~is_obstacle[rows]]
        add_cones(grid, sensor[cones], *measured[cones].T)
        for x, y, _ in sensor[rows[is_obstacle[rows]]].tolist():
            grid.mark_obstacle(x, y)


def add_cones(
    grid: OccupancyGrid, sensors: Array, angles: Array, distances: Array, hits: Array
) -> None:
    """Adds readings to a grid; see `OccupancyGrid.add_reading`."""
    slopes = np.tan(np.minimum(angles / 2.0, grid.MAX_HALF_ANGLE))
    depths = np.maximum(0.0, distances - grid.RANGE_MARGIN)
    ends = np.where(hits > 0.0, distances + grid.CELL, -1.0)
    grid.add_cells(
        cells_within(sensors, slopes, depths), cells_within(sensors, slopes, ends)
    )
