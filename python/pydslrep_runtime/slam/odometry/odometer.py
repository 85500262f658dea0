"""Wheel odometry."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from ...backend import Backend
from ...pose import Pose, wrap_angle
from .calibration import Calibration


@dataclass(frozen=True)
class Leg:
    """What the wheels report of the way between two keyframes, before calibration."""

    travel: float  # m, forward or backward, with what stands for other uncertainties
    turn: float | None = None  # radians, to the left if positive; None if it is wrong

    @property
    def was_held(self) -> bool:
        """Whether something has held the robot, so that its wheels report too much."""
        return self.turn is None


class Odometer:
    """The pose of a two-wheel robot, integrated from the rotation of its wheels."""

    def __init__(
        self, backend: Backend, radii: Sequence[float], turning_radius: float
    ) -> None:
        """Starts at the robot's actual pose, which is read only once.

        `radii` are those of the left and the right wheel, `turning_radius` is half the
        distance between them, in metres.
        """
        self.calibration = Calibration()
        self._backend, self._radii = backend, radii
        self._turning_radius = turning_radius
        self._pose = backend.pose()
        self._angles = backend.wheel_angles()
        # What the wheels report, before calibration.
        self.wheel_travel = 0.0  # m, the mean of both wheels, forward or backward
        self.wheel_turn = 0.0  # radians, to the left if positive

    def pose(self) -> Pose:
        """The estimated pose."""
        before, self._angles = self._angles, self._backend.wheel_angles()
        left, right = (
            wrap_angle(now - was) * radius
            for now, was, radius in zip(self._angles, before, self._radii, strict=True)
        )
        self.wheel_travel += (abs(left) + abs(right)) / 2.0
        reported = (right - left) / (2.0 * self._turning_radius)
        self.wheel_turn += reported
        # Both wheels move around the same centre: this is exact for any arc.
        turned = reported * self.calibration.turn.value
        chord = (left + right) / 2.0 * self.calibration.way.value
        if turned:
            chord *= 2.0 * math.sin(turned / 2.0) / turned
        self._pose = self._pose.turned(turned / 2.0).ahead(chord).turned(turned / 2.0)
        return self._pose

    def correct(self, pose: Pose) -> None:
        """Replaces the estimated pose."""
        self._pose = pose
