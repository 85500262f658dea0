#: if standalone
"""The SLAM back end: localises a robot that relies on wheel odometry."""

import itertools
import math
from collections.abc import Iterable, Sequence

from .dominant_orientation import DominantOrientation, find_dominant_orientation
from .pose import Pose, wrap_angle
from .pose_graph import Constraint, HeadingEstimate, PoseGraph
from .scan import Scan, SurfacePoint
from .scan_matching import MapPoint, MapPoints, ScanMatch, match_scan

#: endif


MAX_LOOP_OFFSET = 0.3  # m between the estimated and the matched position in a loop
MAX_DRIFT = 0.1  # radians in a scan; more is a wrong match


class SlamBackend:
    """Keyframes, each a pose with the scan taken there.

    Odometry connects each keyframe with the one before; scan matching connects it with
    those nearby. The dominant orientation of walls gives an absolute heading.
    """

    NEIGHBOUR_RADIUS = 1.2  # m between keyframes whose scans may overlap
    MAX_NEIGHBOURS = 8  # that a scan is matched with
    TRANSLATION_ERROR = 0.012  # m, and ...
    ROTATION_ERROR = 0.04  # radians, per square root of a metre (standard deviations)
    HEADING_ERROR = math.radians(0.8)  # of a heading from the dominant orientation
    MIN_INLIER_RATIO = 0.5  # of points that agree on a dominant orientation

    def __init__(self) -> None:
        self._graph = PoseGraph()
        self._points: list[list[SurfacePoint]] = []
        self._wall_direction: float | None = None  # in the world
        self._unoriented_travel = 0.0  # m travelled since the last heading estimate

    @property
    def keyframes(self) -> Sequence[Pose]:
        """The current estimates of the keyframes' poses."""
        return self._graph.poses

    def add_keyframe(self, scan: Scan, here: Pose, wheel_travel: float) -> Pose:
        """Adds a keyframe and returns the corrected pose of the robot.

        `here` is the odometry's pose at the end of the scan, `wheel_travel` the distance
        travelled since the previous keyframe, in metres.
        """
        middle_pose, points = scan.middle_pose(), scan.surface_points()
        number = self._graph.add(middle_pose)
        self._unoriented_travel += wheel_travel
        orientation = self._dominant_orientation(points, middle_pose)
        self._add_odometry(number, middle_pose, wheel_travel)
        drift = 0.0
        if orientation:
            drift = orientation.drift
            self._correct_heading(number, orientation, middle_pose)
        points = downsample(undistort(point, drift) for point in points)
        more = self._add_scan_matches(number, points, wheel_travel)
        self._points.append([undistort(point, more) for point in points])
        drift += more
        end = here.relative_to(middle_pose).transformed_by(self._graph.poses[number])
        return end.turned(drift / 2.0)

    def _add_odometry(
        self, number: int, middle_pose: Pose, wheel_travel: float
    ) -> None:
        if number == 0:
            return
        before = self._graph.poses[number - 1]
        weight = 1.0 / (self.TRANSLATION_ERROR**2 * wheel_travel + 1e-6)
        heading = 1.0 / (self.ROTATION_ERROR**2 * wheel_travel + 1e-6)
        information = [[weight, 0.0, 0.0], [0.0, weight, 0.0], [0.0, 0.0, heading]]
        relative = middle_pose.relative_to(before)
        self._graph.add_constraint(
            Constraint(number - 1, number, relative, information, is_odometry=True)
        )

    def _dominant_orientation(
        self, points: Sequence[SurfacePoint], middle_pose: Pose
    ) -> DominantOrientation | None:
        """The dominant orientation of the walls in the scan's frame."""
        within = math.pi / 4.0
        guess = 0.0
        if self._wall_direction is not None:
            within = min(
                within,
                0.03 + 3.0 * self.ROTATION_ERROR * math.sqrt(self._unoriented_travel),
            )
            guess = self._wall_direction - middle_pose.theta
        orientation = find_dominant_orientation(points, guess, within)
        if (
            orientation is None
            or orientation.inlier_ratio < self.MIN_INLIER_RATIO
            or abs(orientation.drift) > MAX_DRIFT
        ):
            return None
        error = math.remainder(orientation.angle - guess, math.pi / 2.0)
        return orientation if abs(error) <= within else None

    def _correct_heading(
        self, number: int, orientation: DominantOrientation, middle_pose: Pose
    ) -> None:
        """Corrects the heading by the dominant orientation."""
        self._unoriented_travel = 0.0
        if self._wall_direction is None:
            # The world's frame is that of the robot before its first scan.
            middle_pose = middle_pose.turned(orientation.drift / 2.0)
            self._graph.poses[number] = middle_pose
            self._wall_direction = middle_pose.theta + orientation.angle
            return
        error = math.remainder(
            self._wall_direction - orientation.angle - middle_pose.theta, math.pi / 2.0
        )
        heading = wrap_angle(middle_pose.theta + error)
        self._graph.add_heading(
            HeadingEstimate(number, heading, 1.0 / self.HEADING_ERROR**2)
        )
        self._graph.poses[number] = Pose(middle_pose.x, middle_pose.y, heading)
        if abs(error) > self.ROTATION_ERROR:
            self._graph.optimise()

    def _add_scan_matches(
        self, number: int, points: list[SurfacePoint], wheel_travel: float
    ) -> float:
        """Matches a scan with keyframes nearby; returns the remaining drift."""
        poses = self._graph.poses
        here = poses[number]
        away = {n: math.hypot(p.x - here.x, p.y - here.y) for n, p in enumerate(poses)}
        near = sorted(
            (n for n in away if away[n] < self.NEIGHBOUR_RADIUS), key=lambda n: away[n]
        )
        groups = self._graph.connected_components(near[: self.MAX_NEIGHBOURS])
        drift = 0.0
        # Those that the robot comes from first, then loop closures.
        groups.sort(key=lambda group: number not in group)
        for group in groups:
            map_points = self._map_points([n for n in group if n != number])
            if number in group:
                found = self._match_neighbours(
                    points, poses[number], map_points, wheel_travel
                )
                if found:
                    drift = found.drift
                    poses[number] = found.pose
                    for constraint in self._constraints(number, found):
                        self._graph.add_constraint(constraint)
            else:
                found = self._match_loop(points, poses[number], map_points)
                if found and self._graph.try_loop_closure(
                    self._constraints(number, found)
                ):
                    drift = found.drift
        if number % 10 == 9:
            self._graph.optimise()
        return drift

    def _match_neighbours(
        self,
        points: Sequence[SurfacePoint],
        here: Pose,
        map_points: MapPoints,
        wheel_travel: float,
    ) -> ScanMatch | None:
        """The match with the keyframes that the robot comes from."""
        sigma = 0.02 + self.TRANSLATION_ERROR * math.sqrt(wheel_travel), 0.03
        found = match_scan(points, here, sigma, map_points)
        if (
            found is None
            or found.inlier_count < 10
            or found.rms_error > 0.03
            or abs(found.drift) > MAX_DRIFT
        ):
            return None
        change = found.pose.relative_to(here)
        is_near = math.hypot(change.x, change.y) < 4.0 * sigma[0]
        return found if is_near and abs(change.theta) < 4.0 * sigma[1] else None

    def _match_loop(
        self, points: Sequence[SurfacePoint], here: Pose, map_points: MapPoints
    ) -> ScanMatch | None:
        """The match with keyframes that the robot returns to: a loop closure."""
        if len(points) < 25:
            return None
        best: ScanMatch | None = None
        shifts = sorted(
            itertools.product((0.0, -0.2, 0.2), repeat=2),
            key=lambda s: math.hypot(*s),
        )
        for right, up in shifts:
            start = Pose(here.x + right, here.y + up, here.theta)
            found = match_scan(points, here, (0.2, 0.05), map_points, start)
            if (
                not found
                or found.inlier_count < 15
                or abs(found.drift) > MAX_DRIFT
                or abs(wrap_angle(found.pose.theta - here.theta)) > 0.15
                or found.inlier_ratio < 0.4
                or found.rms_error > 0.025
            ):
                continue
            if (
                math.hypot(found.pose.x - here.x, found.pose.y - here.y)
                > MAX_LOOP_OFFSET
            ):
                continue
            if best is None or found.inlier_ratio > best.inlier_ratio + 0.05:
                best = found
            if found.inlier_ratio > 0.7:
                break
        return best

    def _constraints(self, number: int, found: ScanMatch) -> list[Constraint]:
        poses = self._graph.poses
        return [
            Constraint(
                keyframe, number, found.pose.relative_to(poses[keyframe]), information
            )
            for keyframe, information in found.information.items()
        ]

    def _map_points(self, keyframes: Sequence[int]) -> MapPoints:
        found = []
        for number in keyframes:
            for point in self._points[number]:
                at = Pose(point.x, point.y, point.normal).transformed_by(
                    self._graph.poses[number]
                )
                cos, sin = math.cos(at.theta), math.sin(at.theta)
                found.append(MapPoint(at.x, at.y, cos, sin, number))
        return MapPoints(found)


def undistort(point: SurfacePoint, drift: float) -> SurfacePoint:
    """Corrects a point for the drift during its scan."""
    at = Pose(point.x, point.y, point.normal)
    at = at.transformed_by(Pose(0.0, 0.0, drift * point.phase))
    return SurfacePoint(at.x, at.y, at.theta, point.phase)


GRID_SIZE = 0.04  # m within which points with similar normals are merged


def downsample(points: Iterable[SurfacePoint]) -> list[SurfacePoint]:
    """Merges points that are close in position, normal and time."""
    cells: dict[tuple[int, ...], list[SurfacePoint]] = {}
    for point in points:
        facing = round(4.0 * point.normal / math.pi) % 8
        cell = (
            round(point.x / GRID_SIZE),
            round(point.y / GRID_SIZE),
            facing,
            round(4.0 * point.phase),
        )
        cells.setdefault(cell, []).append(point)
    return [mean_point(cell) for cell in cells.values()]


def mean_point(points: Sequence[SurfacePoint]) -> SurfacePoint:
    """The mean of points with similar normals."""
    count, first = len(points), points[0].normal
    return SurfacePoint(
        sum(point.x for point in points) / count,
        sum(point.y for point in points) / count,
        first + sum(wrap_angle(point.normal - first) for point in points) / count,
        sum(point.phase for point in points) / count,
    )
