#: if standalone
"""Kinematics of robots with mecanum wheels."""

import math
from collections.abc import Sequence

from .errors import SetupError
from .pose import Pose

#: endif


class FourMecanumDrive:
    """Four mecanum wheels: left-front, left-rear, right-front, right-rear.

    Seen from above their rollers form an X, so the robot can also move sideways.
    """

    # Position errors are corrected at this rate (1/s), up to CORRECTION_SPEED (m/s).
    CORRECTION_RATE = 2.0
    CORRECTION_SPEED = 0.05

    def __init__(
        self, mounts: Sequence[tuple[float, float]], radii: Sequence[float]
    ) -> None:
        """`mounts` are the wheels' x (forward) and y (left) in the body, in metres."""
        left_front, left_rear, right_front, right_rear = mounts
        track = (left_front[1] + left_rear[1] - right_front[1] - right_rear[1]) / 2.0
        wheelbase = (
            left_front[0] + right_front[0] - left_rear[0] - right_rear[0]
        ) / 2.0
        if track <= 0.0:
            raise SetupError("the left wheels are not to the left of the right wheels")
        if wheelbase <= 0.0:
            raise SetupError("the front wheels are not ahead of the rear wheels")
        self.track = track
        self.wheelbase = wheelbase
        self.radii = tuple(radii)
        self.turning_radius = (wheelbase + track) / 2.0

    def wheel_rates(
        self, forward: float, sideways: float, turn_rate: float
    ) -> list[float]:
        """Inverse kinematics: wheel rates in rad/s for m/s (ahead, left) and rad/s."""
        turn = self.turning_radius * turn_rate
        rims = (
            forward - sideways - turn,
            forward + sideways - turn,
            forward + sideways + turn,
            forward - sideways + turn,
        )
        return [rim / radius for rim, radius in zip(rims, self.radii, strict=True)]

    def follow_line(self, speed: float, offset: Pose, _to_go: float) -> list[float]:
        """Wheel rates that drive along a line; `offset` is the pose relative to it."""
        turn_rate = -self.CORRECTION_RATE * offset.theta
        return self._along(offset.theta, speed, self._correction(offset.y), turn_rate)

    def turn_in_place(self, rim_speed: float, offset: Pose) -> list[float]:
        """Wheel rates that turn on a spot; `offset` is the pose relative to it."""
        turn_rate = rim_speed / self.turning_radius
        ahead, sideways = self._correction(offset.x), self._correction(offset.y)
        return self._along(offset.theta, ahead, sideways, turn_rate)

    def _along(
        self, theta: float, ahead: float, sideways: float, turn_rate: float
    ) -> list[float]:
        """Wheel rates for velocities in a frame; `theta` is the robot's heading in it."""
        cos, sin = math.cos(theta), math.sin(theta)
        return self.wheel_rates(
            cos * ahead + sin * sideways, cos * sideways - sin * ahead, turn_rate
        )

    def _correction(self, error: float) -> float:
        wanted = -self.CORRECTION_RATE * error
        return max(-self.CORRECTION_SPEED, min(self.CORRECTION_SPEED, wanted))
