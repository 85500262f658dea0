#: if standalone
"""Where a robot is."""

import math
from dataclasses import dataclass

#: endif


def wrap_angle(angle: float) -> float:
    """The same direction as an angle from -pi to pi."""
    return math.remainder(angle, math.tau)


@dataclass(frozen=True)
class Pose:
    """A place and a heading: x forward and y left in metres, theta in radians.

    Angles grow counter-clockwise as seen from above.
    """

    x: float
    y: float
    theta: float

    def ahead(self, distance: float) -> "Pose":
        """The pose after driving straight on, backwards where negative."""
        return Pose(
            self.x + distance * math.cos(self.theta),
            self.y + distance * math.sin(self.theta),
            self.theta,
        )

    def turned(self, angle: float) -> "Pose":
        """The pose after turning in place, to the left where positive."""
        return Pose(self.x, self.y, wrap_angle(self.theta + angle))

    #: if slam
    def placed_on(self, body: "Pose") -> "Pose":
        """The pose of what is mounted here on a body, in the frame of that body's pose."""
        cos, sin = math.cos(body.theta), math.sin(body.theta)
        return Pose(
            body.x + cos * self.x - sin * self.y,
            body.y + sin * self.x + cos * self.y,
            wrap_angle(body.theta + self.theta),
        )

    #: endif
    def seen_from(self, origin: "Pose") -> "Pose":
        """The same pose in the frame of `origin`: x ahead of it, y to its left."""
        dx, dy = self.x - origin.x, self.y - origin.y
        cos, sin = math.cos(origin.theta), math.sin(origin.theta)
        return Pose(
            cos * dx + sin * dy,
            cos * dy - sin * dx,
            wrap_angle(self.theta - origin.theta),
        )
