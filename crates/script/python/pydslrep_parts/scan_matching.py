#: if standalone
"""Scan matching: the pose that aligns a scan with known surface points."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from .pose import Pose, wrap_angle
from .scan import SurfacePoint

#: endif


Matrix = list[list[float]]


def solve(matrix: Sequence[Sequence[float]], right: Sequence[float]) -> list[float]:
    """Solves linear equations by elimination; the matrix is positive definite."""
    rows = [[*row, value] for row, value in zip(matrix, right, strict=True)]
    size = len(rows)
    for pivot in range(size):
        for row in rows[pivot + 1 :]:
            factor = row[pivot] / rows[pivot][pivot]
            for column in range(pivot, size + 1):
                row[column] -= factor * rows[pivot][column]
    solution = [0.0] * size
    for index in reversed(range(size)):
        known = sum(rows[index][c] * solution[c] for c in range(index + 1, size))
        solution[index] = (rows[index][size] - known) / rows[index][index]
    return solution


@dataclass(frozen=True)
class MapPoint:
    """A surface point in the world, and the number of its keyframe."""

    x: float
    y: float
    cos: float  # of its normal
    sin: float
    keyframe: int


class MapPoints:
    """Surface points, indexed by position."""

    CELL = 0.1  # m

    def __init__(self, points: Iterable[MapPoint]) -> None:
        self._cells: dict[tuple[int, int], list[MapPoint]] = {}
        for point in points:
            self._cells.setdefault(self._cell(point.x, point.y), []).append(point)

    def _cell(self, x: float, y: float) -> tuple[int, int]:
        return math.floor(x / self.CELL), math.floor(y / self.CELL)

    def nearest(
        self, x: float, y: float, normal: float, within: float
    ) -> MapPoint | None:
        """The nearest point with a similar normal."""
        cos, sin = math.cos(normal), math.sin(normal)
        left, low = self._cell(x - within, y - within)
        right, high = self._cell(x + within, y + within)
        best, least = None, within * within
        for column in range(left, right + 1):
            for row in range(low, high + 1):
                for point in self._cells.get((column, row), ()):
                    square = (point.x - x) ** 2 + (point.y - y) ** 2
                    if square < least and point.cos * cos + point.sin * sin > 0.8:
                        best, least = point, square
        return best


@dataclass(frozen=True)
class ScanMatch:
    """The best alignment of a scan with known surface points."""

    pose: Pose  # of the scan
    drift: float  # radians that the robot turned further than the wheels report
    inlier_ratio: float  # of the points that have a counterpart
    inlier_count: int
    rms_error: float  # m from points to the surfaces of their counterparts
    information: dict[int, Matrix]  # on the pose, by keyframe


POINT_ERROR = 0.015  # m (standard deviation)
CORRELATED_POINTS = 4.0  # neighbours that carry the information of one point
DRIFT_SIGMA = 0.03  # radians of drift in a scan (standard deviation)
# The largest distance from a point to its counterpart in m, by iteration.
GATES = (0.25, 0.2, 0.15, 0.1, 0.08, 0.06, 0.06, 0.06)


def match_scan(
    points: Sequence[SurfacePoint],
    guess: Pose,
    uncertainty: tuple[float, float],
    known: MapPoints,
    start: Pose | None = None,
) -> ScanMatch | None:
    """Aligns a scan by point-to-line ICP; None if too few points have a counterpart.

    `uncertainty` of the guess is in metres and radians (standard deviations): the guess is
    kept in directions that the points do not constrain. The search begins at `start`.
    """
    pose, drift = start or guess, 0.0
    position, heading = (1.0 / sigma**2 for sigma in uncertainty)
    for gate in GATES:
        rows = [
            [position, 0.0, 0.0, 0.0],
            [0.0, position, 0.0, 0.0],
            [0.0, 0.0, heading, 0.0],
            [0.0, 0.0, 0.0, 1.0 / DRIFT_SIGMA**2],
        ]
        off = (guess.x - pose.x, guess.y - pose.y, wrap_angle(guess.theta - pose.theta))
        right = [
            position * off[0],
            position * off[1],
            heading * off[2],
            -drift / DRIFT_SIGMA**2,
        ]
        pairs = list(matched_pairs(points, pose, drift, known, gate))
        if len(pairs) < 8:
            return None
        for _, jacobian, error in pairs:
            weight = pair_weight(error)
            for i in range(4):
                right[i] -= weight * jacobian[i] * error
                for j in range(4):
                    rows[i][j] += weight * jacobian[i] * jacobian[j]
        dx, dy, turned, more = solve(rows, right)
        pose = Pose(pose.x + dx, pose.y + dy, wrap_angle(pose.theta + turned))
        drift += more
    return summarise(points, pose, drift, known)


def pair_weight(error: float) -> float:
    """The weight of a pair, smaller with its distance (Geman-McClure)."""
    return (
        1.0
        / (CORRELATED_POINTS * POINT_ERROR**2)
        / (1.0 + (error / (2.0 * POINT_ERROR)) ** 2) ** 2
    )


def matched_pairs(
    points: Sequence[SurfacePoint],
    pose: Pose,
    drift: float,
    known: MapPoints,
    gate: float,
) -> Iterable[tuple[MapPoint, list[float], float]]:
    """Pairs of counterparts, with the error and its derivatives by pose and drift."""
    for point in points:
        turned = Pose(pose.x, pose.y, pose.theta + drift * point.phase)
        at = Pose(point.x, point.y, point.normal).transformed_by(turned)
        other = known.nearest(at.x, at.y, at.theta, gate)
        if other is not None:
            error = other.cos * (at.x - other.x) + other.sin * (at.y - other.y)
            lever = other.sin * (at.x - pose.x) - other.cos * (at.y - pose.y)
            yield other, [other.cos, other.sin, lever, lever * point.phase], error


def summarise(
    points: Sequence[SurfacePoint], pose: Pose, drift: float, known: MapPoints
) -> ScanMatch:
    information: dict[int, Matrix] = {}
    squared_error, inlier_count = 0.0, 0
    for other, jacobian, error in matched_pairs(points, pose, drift, known, GATES[-1]):
        rows = information.setdefault(other.keyframe, [[0.0] * 4 for _ in range(4)])
        weight = pair_weight(error)
        for i in range(4):
            for j in range(4):
                rows[i][j] += weight * jacobian[i] * jacobian[j]
        squared_error += error * error
        inlier_count += 1
    # Marginalise the drift (Schur complement).
    reduced = {}
    for number, rows in information.items():
        rest = rows[3][3] + 1.0 / DRIFT_SIGMA**2
        reduced[number] = [
            [rows[i][j] - rows[i][3] * rows[3][j] / rest for j in range(3)]
            for i in range(3)
        ]
    inlier_ratio = inlier_count / max(1, len(points))
    return ScanMatch(
        pose,
        drift,
        inlier_ratio,
        inlier_count,
        math.sqrt(squared_error / max(1, inlier_count)),
        reduced,
    )
