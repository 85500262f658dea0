"""Circles that robots drive along."""

import math
from dataclasses import dataclass

from .pose import Pose, wrap_angle


@dataclass(frozen=True)
class Circle:
    """A circle through a pose that a robot starts in.

    Points on it are told by how much the heading has changed since the start, in radians.
    """

    start: Pose
    curvature: float  # 1/m; positive if the centre is to the left of the robot

    def pose_at(self, angle: float) -> Pose:
        """The pose on the circle where the heading has changed by an angle."""
        # 1 - cos is 2 sin², which stays exact on large circles.
        ahead = math.sin(angle) / self.curvature
        left = 2.0 * math.sin(angle / 2.0) ** 2 / self.curvature
        return Pose(ahead, left, angle).transformed_by(self.start)

    def angle_at(self, here: Pose, near: float) -> float:
        """The angle of the point that is nearest to a pose; of all full turns the one that is nearest to an angle."""
        offset = here.relative_to(self.start)
        angle = math.atan2(self.curvature * offset.x, 1.0 - self.curvature * offset.y)
        return near + wrap_angle(angle - near)
