#: if standalone
"""Kinematics of two-wheel robots."""

from collections.abc import Sequence

from .errors import SetupError
from .pose import Pose
from .steering import return_speed, steer

#: endif


class TwoWheelDrive:
    """Differential drive with two wheels: left, right."""

    def __init__(
        self, mounts: Sequence[tuple[float, float]], radii: Sequence[float]
    ) -> None:
        """`mounts` are the wheels' x (forward) and y (left) in the body, in metres."""
        (_, left), (_, right) = mounts
        self.track = left - right
        if self.track <= 0.0:
            raise SetupError("the left wheel is not to the left of the right wheel")
        self.radii = tuple(radii)
        self.turning_radius = self.track / 2.0

    def wheel_rates(self, speed: float, turn_rate: float) -> list[float]:
        """Inverse kinematics: wheel rates in rad/s for the body's m/s and rad/s."""
        left = speed - turn_rate * self.track / 2.0
        right = speed + turn_rate * self.track / 2.0
        return [left / self.radii[0], right / self.radii[1]]

    def follow_line(self, speed: float, offset: Pose, remaining: float) -> list[float]:
        """Wheel rates that drive along a line; `offset` is the pose relative to it."""
        return self.wheel_rates(speed, steer(speed, offset, remaining))

    def turn_in_place(self, rim_speed: float, offset: Pose) -> list[float]:
        """Wheel rates that turn on a spot; `offset` is the pose relative to it."""
        return self.wheel_rates(return_speed(offset), rim_speed / self.turning_radius)
