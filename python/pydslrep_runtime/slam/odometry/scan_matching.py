"""Scan matching: the pose that aligns a scan with known surface points."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...pose import Pose, wrap_angle
from .surface import Array, Complex, Indices, SurfacePoints, joined

POINT_ERROR = 0.015  # m (standard deviation)
CORRELATED_POINTS = 4.0  # neighbours that carry the information of one point
DRIFT_SIGMA = 0.03  # radians of drift in a scan (standard deviation)
NEAR = 0.08  # m between a point and its surface when the pose is about right
MIN_PAIRS = 8
MIN_COSINE = 0.8  # between the normals of counterparts
# The largest distance from a point to its counterpart in m, by iteration.
GATES = (0.25, 0.2, 0.15, 0.1, 0.08, 0.06, 0.06, 0.06)


class MapPoints:
    """Surface points in the world, indexed by position."""

    def __init__(self, points: Mapping[int, SurfacePoints]) -> None:
        """`points` are those of each keyframe."""
        self.points = joined(points.values())
        counts = [len(part) for part in points.values()]
        self.keyframe = np.repeat(np.array(list(points), np.int64), counts)
        self._tree = tree_of(self.points.position)

    def counterparts(
        self, points: SurfacePoints, within: float
    ) -> tuple[Indices, Indices]:
        """The numbers of points that have counterparts, and of these.

        The counterpart of a point is the nearest of those with similar normals.
        """
        near = tree_of(points.position).sparse_distance_matrix(
            self._tree, within, output_type="ndarray"
        )
        near = near[np.argsort(near["v"])]
        facing = points.normal[near["i"]].conj() * self.points.normal[near["j"]]
        near = near[facing.real > MIN_COSINE]
        own, first = np.unique(near["i"], return_index=True)
        return own, near["j"][first]

    def score(self, points: Complex) -> Array:
        """The fraction of the points in each row that are near a surface."""
        rows = points.view(np.float64).reshape(*points.shape, 2)
        away, _ = self._tree.query(rows, distance_upper_bound=NEAR)
        found: Array = np.isfinite(away).mean(axis=-1)
        return found


def tree_of(positions: Complex) -> cKDTree:
    """An index of positions."""
    return cKDTree(positions.view(np.float64).reshape(-1, 2))


@dataclass(frozen=True, eq=False)
class ScanMatch:
    """The best alignment of a scan with known surface points."""

    pose: Pose  # of the scan
    drift: float  # radians that the robot turned further than the wheels report
    inlier_ratio: float  # of the points that have a counterpart
    inlier_count: int
    rms_error: float  # m from points to the surfaces of their counterparts
    information: dict[int, Array]  # on the pose, by keyframe


@dataclass(frozen=True, eq=False)
class Pairs:
    """Points with their counterparts."""

    keyframe: Indices  # of each counterpart
    error: Array  # m from the point to the surface of its counterpart
    jacobian: Array  # of the errors, by pose and drift
    weighted: Array  # its transpose, with weights that fall with the error

    @staticmethod
    def find(
        points: SurfacePoints, pose: Pose, drift: float, known: MapPoints, gate: float
    ) -> "Pairs":
        """The points of a scan that have counterparts nearby."""
        there = points.undistorted(drift).transformed_by(pose)
        own, other = known.counterparts(there, gate)
        position, normal = there.position[own], known.points.normal[other]
        error = (normal.conj() * (position - known.points.position[other])).real
        lever = (normal.conj() * 1j * (position - complex(pose.x, pose.y))).real
        jacobian = np.column_stack(
            [normal.real, normal.imag, lever, lever * points.phase[own]]
        )
        weight = (1.0 + (error / (2.0 * POINT_ERROR)) ** 2) ** -2  # Geman-McClure
        weight /= CORRELATED_POINTS * POINT_ERROR**2
        return Pairs(known.keyframe[other], error, jacobian, jacobian.T * weight)

    def information(self) -> dict[int, Array]:
        """The information on the pose that each keyframe contributes."""
        found = {}
        for keyframe in np.unique(self.keyframe).tolist():
            own = self.keyframe == keyframe
            rows = self.weighted[:, own] @ self.jacobian[own]
            # Marginalise the drift (Schur complement).
            rest = rows[3, 3] + DRIFT_SIGMA**-2
            found[keyframe] = rows[:3, :3] - np.outer(rows[:3, 3], rows[3, :3]) / rest
        return found


def match_scan(
    points: SurfacePoints,
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
    position, heading = uncertainty
    prior = np.array([position, position, heading, DRIFT_SIGMA]) ** -2
    for gate in GATES:
        pairs = Pairs.find(points, pose, drift, known, gate)
        if len(pairs.error) < MIN_PAIRS:
            return None
        turned = wrap_angle(guess.theta - pose.theta)
        off = np.array([guess.x - pose.x, guess.y - pose.y, turned, -drift])
        dx, dy, turned, more = np.linalg.solve(
            pairs.weighted @ pairs.jacobian + np.diag(prior),
            prior * off - pairs.weighted @ pairs.error,
        ).tolist()
        pose = Pose(pose.x + dx, pose.y + dy, wrap_angle(pose.theta + turned))
        drift += more
    pairs = Pairs.find(points, pose, drift, known, GATES[-1])
    count = len(pairs.error)
    rms_error = float(np.linalg.norm(pairs.error)) / max(1, count) ** 0.5
    ratio = count / max(1, len(points))
    return ScanMatch(pose, drift, ratio, count, rms_error, pairs.information())
