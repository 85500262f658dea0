"""Graph SLAM: localises a robot that relies on wheel odometry."""

import itertools
import math
from collections.abc import Sequence

import numpy as np

from ...pose import Pose, wrap_angle
from .calibration import Calibration
from .dominant_orientation import (
    RIGHT_ANGLE,
    DominantOrientation,
    find_dominant_orientation,
)
from .odometer import Leg
from .pose_graph import Constraint, PoseGraph
from .relocalisation import (
    MIN_POINTS,
    is_same,
    is_sure,
    relocalise,
    seen_through,
)
from .scan import Scan
from .scan_matching import DRIFT_SIGMA, MapPoints, ScanMatch, match_scan
from .surface import Complex, SurfacePoints

MIN_WAY = 0.2  # m between keyframes that tell how far the wheels drive
MAX_WAY_ERROR = 0.005  # m of a match along the way; those that are less sure are short
MAX_DRIFT = 0.1  # radians in a scan; more is a wrong match
MAX_DRIFTS = 3.3  # standard deviations of the drift in a scan
FEW_SEEN_THROUGH = (
    5  # known points behind which others are seen; more are doubtful, ...
)
MAX_SEEN_THROUGH = 20  # ... and yet more a wrong pose
MIN_KNOWN_RATIO = 0.9  # of points that match elsewhere if nothing is seen through
MAX_LOOP_OFFSET = (
    0.3  # m between the estimated and the matched position in a loop, and ...
)
MAX_LOOP_TURN = 0.15  # ... radians between the headings
# Where the search for the match that closes a loop begins, in m from the estimate.
SHIFTS = sorted(
    itertools.product((0.0, -0.2, 0.2), repeat=2), key=lambda s: math.hypot(*s)
)


class GraphSlam:
    """Keyframes, each a pose with the scan taken there.

    Odometry connects each keyframe with the one before; scan matching connects it with
    those nearby. The dominant orientation of walls gives an absolute heading.
    """

    NEIGHBOUR_RADIUS = 1.2  # m between keyframes whose scans may overlap
    MAX_NEIGHBOURS = 8  # that a scan is matched with
    TRANSLATION_ERROR = 0.012  # m, and ...
    ROTATION_ERROR = 0.04  # radians, per square root of a metre (standard deviations)
    HEADING_ERROR = math.radians(0.8)  # of a heading from the dominant orientation
    # Of points that agree on a dominant orientation. If it is off by a large angle, a few
    # oblique walls are likelier than an error of the estimate.
    MIN_INLIER_RATIO = 0.5
    MIN_TURNED_RATIO = 0.75
    LARGE_TURN = 0.1  # radians, or standard deviations, which grow until walls tell it:
    LARGE_ERROR = 1.5

    def __init__(self, calibration: Calibration) -> None:
        """`calibration` is learnt from scans; the odometer applies it."""
        self.calibration = calibration
        self._graph = PoseGraph()
        self._has_heading: list[bool] = []  # of each keyframe, from walls
        self._points: list[SurfacePoints] = []
        self._wall_direction: float | None = None  # in the world
        # Since the last heading estimate:
        self._unoriented_travel = 0.0  # m travelled
        self._unoriented_turn = 0.0  # radians turned
        self._first = 0  # the keyframe since which all are connected with the last one
        self.uncertain: set[int] = set()  # keyframes since the robot lost its way
        self.has_slipped = False  # on the way to the last keyframe

    @property
    def keyframes(self) -> Sequence[Pose]:
        """The current estimates of the keyframes' poses."""
        return self._graph.poses

    def surfaces_near(self, here: Pose) -> Complex:
        """The known surface points around a pose, in its frame."""
        there = self._map_points(self._neighbours(here)).points.position
        found: Complex = (there - complex(here.x, here.y)) * np.exp(-1j * here.theta)
        return found

    def add_keyframe(self, scan: Scan, here: Pose, leg: Leg) -> Pose:
        """Adds a keyframe and returns the corrected pose of the robot.

        `here` is the odometry's pose at the end of the scan, `leg` the way since the previous
        keyframe.
        """
        middle_pose, points = scan.middle_pose(), scan.surface_points()
        number = self._graph.add(middle_pose)
        self._unoriented_travel += leg.travel
        self._unoriented_turn += leg.turn or 0.0
        drift_sigma = math.hypot(
            DRIFT_SIGMA, self.calibration.turn.sigma * scan.turned()
        )
        orientation = self._dominant_orientation(points, middle_pose, drift_sigma)
        self._add_odometry(number, middle_pose, leg)
        drift = 0.0
        if orientation and not self.is_lost:
            drift = orientation.drift
            self._correct_heading(number, orientation, middle_pose)
        points = points.undistorted(drift).downsampled()
        more = self._match(number, points, leg)
        self._points.append(points.undistorted(more))
        drift += more
        self._has_heading.append(bool(orientation) and not self.is_lost)
        self._calibrate_turn(number, leg)
        end = here.relative_to(middle_pose).transformed_by(self._graph.poses[number])
        return end.turned(drift / 2.0)

    def _calibrate_turn(self, number: int, leg: Leg) -> None:
        """Compares the turn between two keyframes with what the walls say of it."""
        if number == 0 or leg.turn is None or self.has_slipped:
            return
        if not all(self._has_heading[number - 1 :]):
            return
        before, here = self._graph.poses[number - 1 :]
        expected = self.calibration.turn.value * leg.turn
        error = wrap_angle(here.theta - before.theta - expected)
        slip = self.ROTATION_ERROR * math.sqrt(leg.travel)
        sigma = math.hypot(slip, self.HEADING_ERROR, self.HEADING_ERROR)
        self.calibration.turn.observe(leg.turn, expected + error, sigma)

    def _calibrate_way(self, number: int, found: ScanMatch, leg: Leg) -> None:
        """Compares the way between two keyframes with what walls across it say of it."""
        before, here = self._graph.poses[number - 1], self._graph.poses[number]
        way = np.array([here.x - before.x, here.y - before.y])
        length = float(np.linalg.norm(way))
        if leg.turn is None or length < MIN_WAY:
            return
        ahead = way / length
        information = sum(found.information.values(), np.eye(3))
        variance = float(ahead @ np.linalg.inv(information)[:2, :2] @ ahead)
        if variance > MAX_WAY_ERROR**2:
            return
        error = float(ahead @ [found.pose.x - here.x, found.pose.y - here.y])
        slip = self.TRANSLATION_ERROR * math.sqrt(leg.travel)
        reported = length / self.calibration.way.value
        self.calibration.way.observe(
            reported, length + error, math.hypot(slip, MAX_WAY_ERROR)
        )

    @property
    def is_lost(self) -> bool:
        """Whether the last keyframe may be somewhere else."""
        return self._first > 0

    def _match(self, number: int, points: SurfacePoints, leg: Leg) -> float:
        """Matches a scan, wherever it fits if it does not fit here; returns the drift."""
        match = self._add_scan_matches(number, points, leg)
        here = self._graph.poses[number]
        near = self._trusted(number, self._neighbours(here))
        # Few points may be of something that is not flat.
        is_enough = len(points) >= MIN_POINTS
        seen = seen_through(points, here, self._map_points(near)) if is_enough else 0
        is_wrong = seen >= MAX_SEEN_THROUGH
        # A match nearby may be wrong if the robot may be elsewhere.
        is_held = number > 0 and leg.was_held
        is_wrong = is_wrong or (is_held and not (match and is_sure(match)))
        is_doubtful = seen >= FEW_SEEN_THROUGH or self.is_lost or is_wrong
        self.has_slipped = False
        if is_doubtful or (is_enough and match is None):
            found = self._search(number, points)
            # Something new may look like something else.
            if found and not is_doubtful and found.inlier_ratio < MIN_KNOWN_RATIO:
                found = None
            is_elsewhere = found is not None and not is_same(found.pose, here)
            if is_wrong or (is_elsewhere and not self.is_lost):
                self._graph.loosen(number)
                self.has_slipped = True
                self._first = number
            if found:
                self._return_to(number, found)
                return found.drift
            if self.is_lost:
                self.uncertain.add(number)
        return match.drift if match else 0.0

    def _search(self, number: int, points: SurfacePoints) -> ScanMatch | None:
        """The only place nearby where a scan fits, or None."""
        here = self._graph.poses[number]
        near = self._neighbours(here, 2.0, 2 * self.MAX_NEIGHBOURS)
        near = [n for n in near if n != number and n not in self.uncertain]
        known = self._map_points(near)
        since = number - self._first if self.is_lost else 0
        found = relocalise(points, here, min(0.3 + 0.1 * since, 0.8), known)
        if found and seen_through(points, found.pose, known) < FEW_SEEN_THROUGH:
            return found
        return None

    def _return_to(self, number: int, found: ScanMatch) -> None:
        """Connects the last keyframes with the map: the robot has found its way."""
        for constraint in self._constraints(number, found):
            self._graph.add_constraint(constraint)
        self._graph.poses[number] = found.pose
        self._graph.optimise()
        self.uncertain.difference_update(range(self._first, number + 1))
        self._first = 0

    def _trusted(self, number: int, near: Sequence[int]) -> list[int]:
        """Those keyframes nearby whose poses relative to the last one are known."""
        return [
            n
            for n in near
            if n != number
            and (n >= self._first if self.is_lost else n not in self.uncertain)
        ]

    def _add_odometry(self, number: int, middle_pose: Pose, leg: Leg) -> None:
        if number == 0:
            return
        errors = self.TRANSLATION_ERROR, self.TRANSLATION_ERROR, self.ROTATION_ERROR
        relative = middle_pose.relative_to(self._graph.poses[number - 1])
        way = self.calibration.way.sigma * math.hypot(relative.x, relative.y)
        turn = self.calibration.turn.sigma * (leg.turn or 0.0)
        variances = np.square(errors) * leg.travel + np.square([way, way, turn])
        information = np.diag(1.0 / (variances + 1e-6))
        self._graph.add_constraint(
            Constraint(number - 1, number, relative, information, is_odometry=True)
        )

    def _dominant_orientation(
        self, points: SurfacePoints, middle_pose: Pose, drift_sigma: float
    ) -> DominantOrientation | None:
        """The dominant orientation of the walls in the scan's frame."""
        within, guess, large = RIGHT_ANGLE / 2.0, 0.0, math.inf
        if self._wall_direction is not None:
            turned = math.hypot(
                self.ROTATION_ERROR * math.sqrt(self._unoriented_travel),
                self.calibration.turn.sigma * self._unoriented_turn,
            )
            within = min(within, 0.03 + 3.0 * turned)
            large = max(self.LARGE_TURN, self.LARGE_ERROR * turned)
            guess = self._wall_direction - middle_pose.theta
        found = find_dominant_orientation(points, guess, within, drift_sigma)
        if found is None or abs(found.drift) > MAX_DRIFTS * drift_sigma:
            return None
        turn = abs(math.remainder(found.angle - guess, RIGHT_ANGLE))
        least = self.MIN_TURNED_RATIO if turn > large else self.MIN_INLIER_RATIO
        return found if turn <= within and found.inlier_ratio >= least else None

    def _correct_heading(
        self, number: int, orientation: DominantOrientation, middle_pose: Pose
    ) -> None:
        """Corrects the heading by the dominant orientation."""
        self._unoriented_travel = self._unoriented_turn = 0.0
        if self._wall_direction is None:
            # In the middle of its first scan the robot looks where it did before: what it turned
            # too far on one side it has turned too far on the other.
            self._wall_direction = middle_pose.theta + orientation.angle
            return
        walls = self._wall_direction - orientation.angle
        error = math.remainder(walls - middle_pose.theta, RIGHT_ANGLE)
        corrected = middle_pose.turned(error)
        self._graph.add_heading(number, corrected.theta, self.HEADING_ERROR)
        self._graph.poses[number] = corrected
        if abs(error) > self.ROTATION_ERROR:
            self._graph.optimise()

    def _add_scan_matches(
        self,
        number: int,
        points: SurfacePoints,
        leg: Leg,
    ) -> ScanMatch | None:
        """Matches a scan with keyframes nearby; returns the last match."""
        poses = self._graph.poses
        match: ScanMatch | None = None
        near = self._trusted(number, self._neighbours(poses[number]))
        groups = self._graph.connected_components([number, *near])
        # Those that the robot comes from first, then loop closures.
        groups.sort(key=lambda group: number not in group)
        for group in groups:
            map_points = self._map_points([n for n in group if n != number])
            if number in group:
                found = match_neighbours(
                    points, poses[number], map_points, self._sigma(leg.travel)
                )
                if found:
                    self._calibrate_way(number, found, leg)
                    match, poses[number] = found, found.pose
                    for constraint in self._constraints(number, found):
                        self._graph.add_constraint(constraint)
            else:
                found = match_loop(points, poses[number], map_points)
                if found and self._graph.try_loop_closure(
                    self._constraints(number, found)
                ):
                    match = found
        if number % 10 == 9:
            self._graph.optimise()
        return match

    def _sigma(self, wheel_travel: float) -> tuple[float, float]:
        """The uncertainty of a pose by odometry, in metres and radians."""
        return 0.02 + self.TRANSLATION_ERROR * math.sqrt(wheel_travel), 0.03

    def _neighbours(
        self, here: Pose, within: float = NEIGHBOUR_RADIUS, limit: int = MAX_NEIGHBOURS
    ) -> list[int]:
        """The keyframes with scans that may overlap, nearest first."""
        away = [math.hypot(p.x - here.x, p.y - here.y) for p in self._graph.poses]
        near = [n for n, distance in enumerate(away) if distance < within]
        return sorted(near, key=away.__getitem__)[:limit]

    def _constraints(self, number: int, found: ScanMatch) -> list[Constraint]:
        poses = self._graph.poses
        return [
            Constraint(
                keyframe, number, found.pose.relative_to(poses[keyframe]), information
            )
            for keyframe, information in found.information.items()
        ]

    def _map_points(self, keyframes: Sequence[int]) -> MapPoints:
        poses = self._graph.poses
        return MapPoints(
            {n: self._points[n].transformed_by(poses[n]) for n in keyframes}
        )


def match_neighbours(
    points: SurfacePoints, here: Pose, known: MapPoints, sigma: tuple[float, float]
) -> ScanMatch | None:
    """The match with the keyframes that the robot comes from."""
    found = match_scan(points, here, sigma, known)
    if found is None or found.inlier_count < 10 or found.rms_error > 0.03:
        return None
    change = found.pose.relative_to(here)
    is_plausible = (
        abs(found.drift) <= MAX_DRIFT
        and math.hypot(change.x, change.y) < 4.0 * sigma[0]
        and abs(change.theta) < 4.0 * sigma[1]
    )
    return found if is_plausible else None


def match_loop(points: SurfacePoints, here: Pose, known: MapPoints) -> ScanMatch | None:
    """The match with keyframes that the robot returns to: a loop closure."""
    best: ScanMatch | None = None
    for right, up in SHIFTS if len(points) >= 25 else ():
        start = Pose(here.x + right, here.y + up, here.theta)
        found = match_scan(points, here, (0.2, 0.05), known, start)
        if found is None or not closes_loop(found, here):
            continue
        if best is None or found.inlier_ratio > best.inlier_ratio + 0.05:
            best = found
        if found.inlier_ratio > 0.7:
            break
    return best


def closes_loop(found: ScanMatch, here: Pose) -> bool:
    """Whether a match is sure, and near enough to the estimated pose."""
    return (
        found.inlier_count >= 15
        and found.inlier_ratio >= 0.4
        and found.rms_error <= 0.025
        and abs(found.drift) <= MAX_DRIFT
        and math.hypot(found.pose.x - here.x, found.pose.y - here.y) <= MAX_LOOP_OFFSET
        and abs(wrap_angle(found.pose.theta - here.theta)) <= MAX_LOOP_TURN
    )
