#: if standalone
"""The dominant orientation of walls: most rooms have right angles."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from .scan import SurfacePoint
from .scan_matching import DRIFT_SIGMA

#: endif


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
    points: Sequence[SurfacePoint], guess: float, within: float
) -> DominantOrientation | None:
    """The direction of most walls near a guess; None if there are too few points."""
    if len(points) < 20:
        return None
    angle, drift = most_common_orientation(points, guess, within), 0.0
    for _ in range(8):
        # Weighted least squares for both; outliers get little weight.
        aa, ad, dd, ra, rd = 0.0, 0.0, NORMAL_SPREAD**2 / DRIFT_SIGMA**2, 0.0, 0.0
        for point in points:
            error = math.remainder(
                point.normal + drift * point.phase - angle, RIGHT_ANGLE
            )
            weight = 0.2 / (1.0 + (error / NORMAL_SPREAD / 1.5) ** 2) ** 2
            aa += weight
            ad -= weight * point.phase
            dd += weight * point.phase**2
            ra += weight * error
            rd -= weight * point.phase * error
        rd -= NORMAL_SPREAD**2 / DRIFT_SIGMA**2 * drift
        determinant = aa * dd - ad * ad
        if determinant <= 0.0:
            return None
        angle += (ra * dd - rd * ad) / determinant
        drift += (aa * rd - ad * ra) / determinant
    inliers = sum(
        abs(math.remainder(p.normal + drift * p.phase - angle, RIGHT_ANGLE))
        < MAX_DEVIATION
        for p in points
    )
    return DominantOrientation(angle, drift, inliers / len(points))


def most_common_orientation(
    points: Sequence[SurfacePoint], guess: float, within: float
) -> float:
    """The direction that most points have."""
    count = int(within / NORMAL_SPREAD)
    candidates = [guess + index * NORMAL_SPREAD for index in range(-count, count + 1)]
    candidates.sort(key=lambda angle: abs(angle - guess))
    return max(
        candidates,
        key=lambda angle: sum(
            abs(math.remainder(point.normal - angle, RIGHT_ANGLE)) < NORMAL_SPREAD
            for point in points
        ),
    )
