"""The way ahead: what a robot has seen on it, also if it does not see it any more.

The cone of a sensor that looks ahead is narrower than the robot in front of it. The end of a wall leaves it before the
robot is there, and touches a corner of the body that no sensor looks ahead from.
"""

import math
from collections.abc import Iterable

from ...pose import Pose
from ..occupancy_grid import Reading


class WayAhead:
    """A straight way that a robot drives along, with what is on it for certain."""

    def __init__(self, start: Pose, radius: float) -> None:
        """`start` looks along the way; `radius` is that of the circle around the robot."""
        self._start, self._radius = start, radius
        self.length = math.inf  # m from the start to the first obstacle

    def add(self, here: Pose, readings: Iterable[Reading]) -> None:
        """Adds readings in the robot's frame, taken at its estimated pose."""
        from_start = here.relative_to(self._start)
        for reading in readings:
            distance = self._distance(from_start, reading)
            # What is nearer was beside the robot, or it would have touched it.
            if distance is not None and distance > 0.5 * self._radius:
                self.length = min(self.length, distance)

    def end(self) -> Pose:
        """Where the first obstacle is, if there is one."""
        return self._start.ahead(self.length)

    def is_near_end(self, here: Pose, reach: float) -> bool:
        """Whether an obstacle is within reach of the robot's centre."""
        return here.relative_to(self._start).x + reach > self.length

    def _distance(self, from_start: Pose, reading: Reading) -> float | None:
        """How far along the way something is; None if it may be beside the way."""
        if not reading.is_hit:
            return None
        sensor = reading.sensor.transformed_by(from_start)
        half = reading.cone / 2.0
        points = [
            sensor.turned(turn).ahead(reading.distance) for turn in (-half, 0.0, half)
        ]
        # The body is narrower than the circle around it.
        if any(abs(point.y) > 0.6 * self._radius for point in points):
            return None
        return points[1].x
