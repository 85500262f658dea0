#: if standalone
"""Where a robot is by how its wheels turn."""

import math

from .coppeliasim import Body
from .pose import Pose, wrap_angle

#: endif


class Odometer:
    """Adds up what the wheels of a two-wheel robot roll."""

    def __init__(self, body: Body) -> None:
        """Starts where the simulator says that the robot is, and never asks it again."""
        self._body = body
        self._pose = body.pose()
        self._angles = body.wheel_angles()
        self.rolled = 0.0  # m that the wheels have rolled, on average

    def pose(self) -> Pose:
        """Where the robot should be."""
        before, self._angles = self._angles, self._body.wheel_angles()
        left, right = (
            wrap_angle(now - was) * radius
            for now, was, radius in zip(
                self._angles, before, self._body.model.wheels.values(), strict=True
            )
        )
        self.rolled += (abs(left) + abs(right)) / 2.0
        # Both wheels go round the same centre: this is exact for any arc.
        turned = (right - left) / (2.0 * self._body.drive.turning_radius)
        chord = (left + right) / 2.0
        if turned:
            chord *= 2.0 * math.sin(turned / 2.0) / turned
        there = self._pose.turned(turned / 2.0).ahead(chord)
        self._pose = there.turned(turned / 2.0)
        return self._pose

    def correct(self, pose: Pose) -> None:
        """The robot is somewhere else."""
        self._pose = pose
