#: if standalone
"""Kinematics of skid-steered robots."""

from collections.abc import Sequence

from .errors import SetupError
from .pose import Pose
from .steering import return_speed, steer

#: endif


class FourWheelDrive:
    """Four standard wheels: left-front, left-rear, right-front, right-rear.

    Both wheels on a side have the same rim speed, as in a differential drive.
    """

    # Wheels scrub sideways in a turn, so the robot turns less than they roll. Set this
    # factor if you have measured it; closed-loop control corrects the rest.
    TRACK_FACTOR = 1.0

    def __init__(
        self, mounts: Sequence[tuple[float, float]], radii: Sequence[float]
    ) -> None:
        """`mounts` are the wheels' x (forward) and y (left) in the body, in metres."""
        left_front, left_rear, right_front, right_rear = (y for _, y in mounts)
        track = (left_front + left_rear - right_front - right_rear) / 2.0
        if track <= 0.0:
            raise SetupError("the left wheels are not to the left of the right wheels")
        self.track = track * self.TRACK_FACTOR
        self.radii = tuple(radii)
        self.turning_radius = self.track / 2.0

    def wheel_rates(self, speed: float, turn_rate: float) -> list[float]:
        """Inverse kinematics: wheel rates in rad/s for the body's m/s and rad/s."""
        left = speed - turn_rate * self.track / 2.0
        right = speed + turn_rate * self.track / 2.0
        rims = (left, left, right, right)
        return [rim / radius for rim, radius in zip(rims, self.radii, strict=True)]

    def follow_line(self, speed: float, offset: Pose, remaining: float) -> list[float]:
        """Wheel rates that drive along a line; `offset` is the pose relative to it."""
        return self.wheel_rates(speed, steer(speed, offset, remaining))

    def turn_in_place(self, rim_speed: float, offset: Pose) -> list[float]:
        """Wheel rates that turn on a spot; `offset` is the pose relative to it."""
        return self.wheel_rates(return_speed(offset), rim_speed / self.turning_radius)
