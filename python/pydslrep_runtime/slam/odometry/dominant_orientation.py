"""The dominant orientation of walls: most rooms have right angles."""

import math
from dataclasses import dataclass

import numpy as np

from .scan_matching import DRIFT_SIGMA
from .surface import Array, SurfacePoints

RIGHT_ANGLE = math.pi / 2.0
NORMAL_SPREAD = math.radians(3.5)  # of the normals of points on the same wall
MAX_DEVIATION = math.radians(8.0)  # of an inlier; walls beyond it are oblique


@dataclass(frozen=True)
class DominantOrientation:
    """The direction of walls that are parallel or at right angles to each other."""

    angle: float  # radians, modulo a right angle
    drift: float  # radians that the robot turned further than the wheels report
    inlier_ratio: float  # of the points that have this direction


def find_dominant_orientation(
    points: SurfacePoints,
    guess: float,
    within: float,
    drift_sigma: float = DRIFT_SIGMA,
) -> DominantOrientation | None:
    """The direction of most walls near a guess; None if there are too few points.

    `drift_sigma` is the standard deviation of the drift.
    """
    if len(points) < 20:
        return None
    normal = np.angle(points.normal)
    angle, drift = most_common_orientation(normal, guess, within), 0.0
    jacobian = np.column_stack([np.ones(len(points)), -points.phase])
    prior = np.diag([0.0, NORMAL_SPREAD**2 / drift_sigma**2])
    for _ in range(8):
        # Weighted least squares for both; outliers get little weight.
        error = deviation(normal + drift * points.phase - angle)
        weight = 0.2 / (1.0 + (error / NORMAL_SPREAD / 1.5) ** 2) ** 2
        weighted = jacobian.T * weight
        change = np.linalg.solve(
            weighted @ jacobian + prior, weighted @ error - prior @ [0.0, drift]
        )
        angle, drift = angle + float(change[0]), drift + float(change[1])
    error = deviation(normal + drift * points.phase - angle)
    is_inlier = np.abs(error) < MAX_DEVIATION
    return DominantOrientation(angle, drift, float(is_inlier.mean()))


def most_common_orientation(normal: Array, guess: float, within: float) -> float:
    """The direction that most points have; of several, the nearest to the guess."""
    count = int(within / NORMAL_SPREAD)
    candidates = guess + NORMAL_SPREAD * np.array(
        sorted(range(-count, count + 1), key=abs)
    )
    error = deviation(normal - candidates[:, None])
    return float(candidates[np.argmax((np.abs(error) < NORMAL_SPREAD).sum(axis=1))])


def deviation(angle: Array) -> Array:
    """The angles to the nearest multiples of a right angle."""
    return angle - RIGHT_ANGLE * np.round(angle / RIGHT_ANGLE)
