"""Positions and headings."""

import math
from typing import NamedTuple


def wrap_angle(angle: float) -> float:
    """Wraps an angle to the range from -pi to pi."""
    return math.remainder(angle, math.tau)


def heading_degrees(theta: float) -> float:
    """A heading as people read it: tenths of a degree above -180 and up to 180, and never -0."""
    degrees = round(math.degrees(wrap_angle(theta)), 1) + 0.0
    return 180.0 if degrees <= -180.0 else degrees


class Pose(NamedTuple):
    """A position and a heading: x forward and y left in metres, theta in radians.

    Angles are counter-clockwise, seen from above.
    """

    x: float
    y: float
    theta: float

    def ahead(self, distance: float) -> "Pose":
        """The pose after driving straight, backwards if negative."""
        return Pose(
            self.x + distance * math.cos(self.theta),
            self.y + distance * math.sin(self.theta),
            self.theta,
        )

    def turned(self, angle: float) -> "Pose":
        """The pose after turning in place, to the left if positive."""
        return Pose(self.x, self.y, wrap_angle(self.theta + angle))

    def transformed_by(self, origin: "Pose") -> "Pose":
        """Transforms a pose relative to `origin` into the frame that `origin` is in."""
        cos, sin = math.cos(origin.theta), math.sin(origin.theta)
        return Pose(
            origin.x + cos * self.x - sin * self.y,
            origin.y + sin * self.x + cos * self.y,
            wrap_angle(origin.theta + self.theta),
        )

    def relative_to(self, origin: "Pose") -> "Pose":
        """The pose in the frame of `origin`: x ahead of it, y to its left."""
        x, y, theta = origin
        dx, dy = self.x - x, self.y - y
        cos, sin = math.cos(theta), math.sin(theta)
        turned = math.remainder(self.theta - theta, math.tau)
        return Pose(cos * dx + sin * dy, cos * dy - sin * dx, turned)

    def ahead_of(self, origin: "Pose") -> float:
        """How far it is ahead of `origin`, in metres."""
        x, y, theta = origin
        return math.cos(theta) * (self.x - x) + math.sin(theta) * (self.y - y)
