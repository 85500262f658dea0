#: if standalone
"""Wheel odometry."""

import math

from .coppeliasim import Body
from .pose import Pose, wrap_angle

#: endif


class Odometer:
    """The pose of a two-wheel robot, integrated from the rotation of its wheels."""

    def __init__(self, body: Body) -> None:
        """Starts at the robot's actual pose, which is read only once."""
        self._body = body
        self._pose = body.pose()
        self._angles = body.wheel_angles()
        self.wheel_travel = 0.0  # m, the mean of both wheels, forward or backward

    def pose(self) -> Pose:
        """The estimated pose."""
        before, self._angles = self._angles, self._body.wheel_angles()
        left, right = (
            wrap_angle(now - was) * radius
            for now, was, radius in zip(
                self._angles, before, self._body.model.wheels.values(), strict=True
            )
        )
        self.wheel_travel += (abs(left) + abs(right)) / 2.0
        # Both wheels move around the same centre: this is exact for any arc.
        turned = (right - left) / (2.0 * self._body.drive.turning_radius)
        chord = (left + right) / 2.0
        if turned:
            chord *= 2.0 * math.sin(turned / 2.0) / turned
        self._pose = self._pose.turned(turned / 2.0).ahead(chord).turned(turned / 2.0)
        return self._pose

    def correct(self, pose: Pose) -> None:
        """Replaces the estimated pose."""
        self._pose = pose
