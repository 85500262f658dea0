#: if standalone
"""Kinematics of two-wheel robots."""

from collections.abc import Sequence

from .errors import SetupError
from .pose import Pose
from .steering import speed_back, steer

#: endif


class TwoWheelDrive:
    """Two-wheel differential drive; the wheels are left, right."""

    def __init__(
        self, mounts: Sequence[tuple[float, float]], radii: Sequence[float]
    ) -> None:
        """`mounts` are the wheels' x (forward) and y (left) in the body, in metres."""
        (_, left), (_, right) = mounts
        self.track = left - right
        if self.track <= 0.0:
            raise SetupError(
                "the left wheel does not stand to the left of the right one"
            )
        self.radii = tuple(radii)
        self.turning_radius = self.track / 2.0

    def wheel_rates(self, speed: float, turn_rate: float) -> list[float]:
        """Inverse kinematics: from m/s and rad/s of the body to rad/s of the wheels."""
        left = speed - turn_rate * self.track / 2.0
        right = speed + turn_rate * self.track / 2.0
        return [left / self.radii[0], right / self.radii[1]]

    def follow_line(self, speed: float, offset: Pose, to_go: float) -> list[float]:
        """Wheel rates that drive along a line; `offset` is the pose seen from it."""
        return self.wheel_rates(speed, steer(speed, offset, to_go))

    def turn_in_place(self, rim_speed: float, offset: Pose) -> list[float]:
        """Wheel rates that turn the robot on the spot that `offset` is seen from."""
        return self.wheel_rates(speed_back(offset), rim_speed / self.turning_radius)
