#: if standalone
"""Kinematics of skid-steered robots."""

from collections.abc import Sequence

from .errors import SetupError
from .pose import Pose
from .steering import speed_back, steer

#: endif


class FourWheelDrive:
    """Four standard wheels: left-front, left-rear, right-front, right-rear.

    Both wheels of a side turn at the same rim speed, like those of a two-wheel robot.
    """

    # Wheels that scrub sideways turn the robot less than they roll. Where that is known,
    # set what to multiply the track with; the loop on the pose corrects the rest.
    TRACK_FACTOR = 1.0

    def __init__(
        self, mounts: Sequence[tuple[float, float]], radii: Sequence[float]
    ) -> None:
        """`mounts` are the wheels' x (forward) and y (left) in the body, in metres."""
        left_front, left_rear, right_front, right_rear = (y for _, y in mounts)
        track = (left_front + left_rear - right_front - right_rear) / 2.0
        if track <= 0.0:
            raise SetupError(
                "the left wheels do not stand to the left of the right ones"
            )
        self.track = track * self.TRACK_FACTOR
        self.radii = tuple(radii)
        self.turning_radius = self.track / 2.0

    def wheel_rates(self, speed: float, turn_rate: float) -> list[float]:
        """Inverse kinematics: from m/s and rad/s of the body to rad/s of the wheels."""
        left = speed - turn_rate * self.track / 2.0
        right = speed + turn_rate * self.track / 2.0
        rims = (left, left, right, right)
        return [rim / radius for rim, radius in zip(rims, self.radii, strict=True)]

    def follow_line(self, speed: float, offset: Pose, to_go: float) -> list[float]:
        """Wheel rates that drive along a line; `offset` is the pose seen from it."""
        return self.wheel_rates(speed, steer(speed, offset, to_go))

    def turn_in_place(self, rim_speed: float, offset: Pose) -> list[float]:
        """Wheel rates that turn the robot on the spot that `offset` is seen from."""
        return self.wheel_rates(speed_back(offset), rim_speed / self.turning_radius)
