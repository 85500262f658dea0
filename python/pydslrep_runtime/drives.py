"""Kinematics: how the wheels of each type of robot move it.

Wheel mounts are positions on the robot's body: x ahead and y to the left, in metres. Rates are in rad/s, forward if
positive.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Protocol

from . import facts
from .errors import SetupError
from .pose import Pose
from .steering import arc_speed, circling, return_speed, steer


class Drive(Protocol):
    """What motion control needs to know about the wheels of a robot."""

    turning_radius: float  # m from the centre to the wheels, as they count in a turn
    rims_per_radian: float  # m that rims roll in a turn in place
    radii: tuple[float, ...]  # of the wheels, in metres
    scrubs: bool  # whether wheels slide sideways in turns, which then take longer

    def follow(
        self,
        speed: float,
        offset: Pose,
        remaining: float,
        curvature: float,
        scrub: float = 1.0,
    ) -> list[float]:
        """Wheel rates that drive along a line or circle, with m/s and `remaining` metres to go.

        `offset` is the pose relative to the nearest point of the path, whose curvature in 1/m is positive to the left.
        `scrub` is how much wider the track seems than it is taken to be, 1 unless wheels slide sideways.
        """

    def turn_rate(self, rates: Sequence[float]) -> float:
        """Forward kinematics: how fast wheels with these rates turn the robot if none slides, in rad/s."""

    def turn_in_place(
        self, rim_speed: float, offset: Pose, turn: float | None, drift: float
    ) -> list[float]:
        """Wheel rates that turn on a spot; `offset` is the pose relative to it.

        `turn` is the angle to go, None if unknown; `drift` how far the robot slides to its left per radian, in metres.
        """


class DriveType(Protocol):
    """A class of drives."""

    def __call__(
        self, mounts: Sequence[tuple[float, float]], radii: Sequence[float]
    ) -> Drive:
        """Raises SetupError if the wheels are not where the drive has them."""


def track_and_wheelbase(mounts: Sequence[tuple[float, float]]) -> tuple[float, float]:
    """How far the sides of four wheels are apart, and the axles; raises SetupError if the sides are exchanged."""
    (lf_x, lf_y), (lr_x, lr_y), (rf_x, rf_y), (rr_x, rr_y) = mounts
    track = (lf_y + lr_y - rf_y - rr_y) / 2.0
    if track <= 0.0:
        raise SetupError("the left wheels are not to the left of the right wheels")
    return track, (lf_x + rf_x - lr_x - rr_x) / 2.0


class SteeredDrive(ABC):
    """A drive that cannot move sideways: it steers back to its line, and drives an arc back to its spot."""

    turning_radius: float  # m
    rims_per_radian: float  # m
    scrubs = False

    @abstractmethod
    def wheel_rates(self, speed: float, turn_rate: float) -> list[float]:
        """Inverse kinematics: wheel rates in rad/s for the body's m/s and rad/s."""

    @abstractmethod
    def turn_rate(self, rates: Sequence[float]) -> float:
        """Forward kinematics: how fast wheels with these rates turn the robot if none slides, in rad/s."""

    def follow(
        self,
        speed: float,
        offset: Pose,
        remaining: float,
        curvature: float,
        scrub: float = 1.0,
    ) -> list[float]:
        """Wheel rates that drive along a line or circle."""
        turn_rate = steer(speed, offset, remaining, curvature)
        return self.wheel_rates(speed, scrub * turn_rate)

    def turn_in_place(
        self, rim_speed: float, offset: Pose, turn: float | None, drift: float
    ) -> list[float]:
        """Wheel rates that turn on a spot; `offset` is the pose relative to it."""
        turn_rate = rim_speed / self.rims_per_radian
        ahead = (
            return_speed(offset)
            if turn is None
            else arc_speed(offset, turn, drift, turn_rate)
        )
        return self.wheel_rates(ahead, turn_rate)


class TwoWheelDrive(SteeredDrive):
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
        self.turning_radius = self.rims_per_radian = self.track / 2.0

    def wheel_rates(self, speed: float, turn_rate: float) -> list[float]:
        """Inverse kinematics: wheel rates in rad/s for the body's m/s and rad/s."""
        left = speed - turn_rate * self.track / 2.0
        right = speed + turn_rate * self.track / 2.0
        return [left / self.radii[0], right / self.radii[1]]

    def turn_rate(self, rates: Sequence[float]) -> float:
        """Forward kinematics: how fast wheels with these rates turn the robot if none slides, in rad/s."""
        left, right = (
            rate * radius for rate, radius in zip(rates, self.radii, strict=True)
        )
        return (right - left) / self.track


class FourWheelDrive(SteeredDrive):
    """Four standard wheels: left-front, left-rear, right-front, right-rear.

    Both wheels on a side have the same rim speed, as in a differential drive.
    """

    # Wheels scrub sideways in a turn, so the robot turns less than they roll, as if its track were wider. This is their
    # friction sideways as a share of that along, as in plans and scenes; closed-loop control corrects the rest.
    GRIP = facts.ROBOT_TYPES["fw"].grip
    scrubs = True

    def __init__(
        self, mounts: Sequence[tuple[float, float]], radii: Sequence[float]
    ) -> None:
        """`mounts` are the wheels' x (forward) and y (left) in the body, in metres."""
        track, wheelbase = track_and_wheelbase(mounts)
        self.track = track * (1.0 + self.GRIP * (wheelbase / track) ** 2)
        self.radii = tuple(radii)
        self.turning_radius, self.rims_per_radian = track / 2.0, self.track / 2.0

    def wheel_rates(self, speed: float, turn_rate: float) -> list[float]:
        """Inverse kinematics: wheel rates in rad/s for the body's m/s and rad/s."""
        left = speed - turn_rate * self.track / 2.0
        right = speed + turn_rate * self.track / 2.0
        rims = (left, left, right, right)
        return [rim / radius for rim, radius in zip(rims, self.radii, strict=True)]

    def turn_rate(self, rates: Sequence[float]) -> float:
        """Forward kinematics: how fast wheels with these rates turn the robot if none slides, in rad/s."""
        left_front, left_rear, right_front, right_rear = (
            rate * radius for rate, radius in zip(rates, self.radii, strict=True)
        )
        left, right = left_front + left_rear, right_front + right_rear
        return (right - left) / 2.0 / self.track


class MecanumDrive:
    """Four mecanum wheels: left-front, left-rear, right-front, right-rear.

    Seen from above their rollers form an X, so the robot can also move sideways.
    """

    # Position errors are corrected at this rate (1/s), up to CORRECTION_SPEED (m/s).
    CORRECTION_RATE = 2.0
    CORRECTION_SPEED = 0.05
    scrubs = False

    def __init__(
        self, mounts: Sequence[tuple[float, float]], radii: Sequence[float]
    ) -> None:
        """`mounts` are the wheels' x (forward) and y (left) in the body, in metres."""
        self.track, self.wheelbase = track_and_wheelbase(mounts)
        if self.wheelbase <= 0.0:
            raise SetupError("the front wheels are not ahead of the rear wheels")
        self.radii = tuple(radii)
        self.turning_radius = (self.wheelbase + self.track) / 2.0
        self.rims_per_radian = self.turning_radius

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

    def turn_rate(self, rates: Sequence[float]) -> float:
        """Forward kinematics: how fast wheels with these rates turn the robot if none slides, in rad/s."""
        left_front, left_rear, right_front, right_rear = (
            rate * radius for rate, radius in zip(rates, self.radii, strict=True)
        )
        rims = right_front + right_rear - left_front - left_rear
        return rims / 4.0 / self.turning_radius

    def follow(
        self,
        speed: float,
        offset: Pose,
        remaining: float,  # noqa: ARG002
        curvature: float,
        scrub: float = 1.0,  # noqa: ARG002
    ) -> list[float]:
        """Wheel rates that drive along a line or circle."""
        turn_rate = -self.CORRECTION_RATE * offset.theta
        turn_rate += circling(speed, offset, curvature)
        return self._along(offset.theta, speed, self._correction(offset.y), turn_rate)

    def turn_in_place(
        self,
        rim_speed: float,
        offset: Pose,
        turn: float | None,  # noqa: ARG002
        drift: float,  # noqa: ARG002
    ) -> list[float]:
        """Wheel rates that turn on a spot; `offset` is the pose relative to it."""
        turn_rate = rim_speed / self.rims_per_radian
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
