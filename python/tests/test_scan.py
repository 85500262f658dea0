import math

import numpy as np
import pytest
from pydslrep_runtime.pose import Pose, wrap_angle
from pydslrep_runtime.slam.odometry.dominant_orientation import (
    find_dominant_orientation,
)
from pydslrep_runtime.slam.odometry.odometer import Odometer
from pydslrep_runtime.slam.odometry.relocalisation import relocalise
from pydslrep_runtime.slam.odometry.scan import Scan
from pydslrep_runtime.slam.odometry.scan_matching import MapPoints, match_scan
from pydslrep_runtime.slam.odometry.surface import NOTHING, SurfacePoints
from rooms import Pillar, Rooms
from slipping_robot import TURNING_RADIUS, WHEEL, SlippingRobot, scan_from

ROOM = Rooms(1.4, 1.7)
HERE = Pose(0.6, 0.8, 0.4)


def map_points(points: SurfacePoints, pose: Pose) -> MapPoints:
    return MapPoints({7: points.transformed_by(pose)})


def wall_errors(scan: Scan, room: Rooms) -> list[tuple[float, float]]:
    """The errors of surface points against the nearest wall, in metres and degrees."""
    found = []
    points = scan.surface_points().transformed_by(scan.middle_pose())
    for position, normal in zip(points.position, points.normal, strict=True):
        at = Pose(position.real, position.imag, float(np.angle(normal)))
        sides = [
            (at.x, 0.0),
            (at.y, 90.0),
            (room.width - at.x, 180.0),
            (room.height - at.y, -90.0),
        ]
        away, normal = min(sides, key=lambda side: abs(side[0]))
        turned = wrap_angle(at.theta - math.radians(normal))
        found.append((abs(away), abs(math.degrees(turned))))
    return found


@pytest.mark.parametrize("angle", [math.pi, -math.pi])
def test_surface_points_are_on_the_walls(angle: float) -> None:
    found = wall_errors(scan_from(SlippingRobot(ROOM), HERE, angle), ROOM)
    assert len(found) > 200
    aways, turns = (sorted(values) for values in zip(*found, strict=True))
    # Cones round off corners, not flat walls.
    assert aways[len(aways) * 3 // 4] < 0.005
    assert turns[len(turns) // 2] < 1.5


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("free", [20.0, 40.0, 70.0])
def test_a_scan_knows_how_far_the_turn_was_blocked(free: float, side: float) -> None:
    robot = SlippingRobot(Rooms(1.9, 1.5), noise=0.01)
    robot.here = HERE
    robot.use_odometry(Odometer(robot.backend, (WHEEL, WHEEL), TURNING_RADIUS))
    # A corner of the body gets there.
    post = HERE.turned(side * math.radians(52.5 + free)).ahead(0.19)
    robot.blocks = [(post.x, post.y)]
    scan = scan_from(robot, HERE, side * math.pi)
    lost = math.degrees(scan.correct())
    assert lost == pytest.approx(side * (180.0 - free), abs=12.0)


@pytest.mark.parametrize("slip", [0.0, 0.05])
def test_a_scan_of_a_whole_turn_has_lost_nothing(slip: float) -> None:
    robot = SlippingRobot(ROOM, slip=slip, noise=0.01)
    robot.use_odometry(Odometer(robot.backend, (WHEEL, WHEEL), TURNING_RADIUS))
    for place in (HERE, Pose(0.3, 0.3, -2.0), Pose(1.1, 1.4, 3.0)):
        assert scan_from(robot, place).correct() == 0.0


def test_noise_moves_surface_points_little() -> None:
    robot = SlippingRobot(ROOM, noise=0.01)
    aways = sorted(away for away, _ in wall_errors(scan_from(robot, HERE), ROOM))
    assert len(aways) > 100
    assert aways[len(aways) // 2] < 0.008


@pytest.mark.parametrize(("width", "is_found"), [(1.0, False), (1.6, True)])
def test_a_pose_is_found_again_only_where_no_other_fits(
    width: float, is_found: bool
) -> None:
    # In a square room, 45 degrees to the left look like 45 degrees to the right.
    room, here = Rooms(width, 1.0), Pose(width / 2.0, 0.5, 0.0)
    points = scan_from(SlippingRobot(room), here).surface_points().downsampled()
    middle = here.turned(math.pi / 2.0)
    known = map_points(points, middle)
    found = relocalise(points, middle.turned(math.radians(45.0)), 0.3, known)
    assert (found is not None) == is_found
    if found:
        assert abs(wrap_angle(found.pose.theta - middle.theta)) < 0.02
        assert math.hypot(found.pose.x - middle.x, found.pose.y - middle.y) < 0.02


def test_nothing_in_range_gives_no_surface_points() -> None:
    wide = Rooms(9.0, 9.0, pillars=[Pillar((1.0, 1.0), 0.1)])
    assert not len(scan_from(SlippingRobot(wide), Pose(4.0, 4.0, 0.0)).surface_points())


@pytest.mark.parametrize(
    "off", [Pose(0.0, 0.0, 0.0), Pose(0.06, -0.05, 0.0), Pose(-0.04, 0.05, -0.08)]
)
def test_matching_finds_the_pose_of_a_scan(off: Pose) -> None:
    robot = SlippingRobot(ROOM, noise=0.01)
    first = scan_from(robot, HERE)
    second = scan_from(robot, Pose(0.8, 1.0, -1.0))
    there = second.middle_pose()
    guess = Pose(there.x + off.x, there.y + off.y, there.theta + off.theta)
    found = match_scan(
        second.surface_points(),
        guess,
        (0.1, 0.1),
        map_points(first.surface_points(), first.middle_pose()),
    )
    assert found is not None
    assert list(found.information) == [7]
    assert math.hypot(found.pose.x - there.x, found.pose.y - there.y) < 0.01
    assert abs(wrap_angle(found.pose.theta - there.theta)) < math.radians(1.0)


def test_a_counterpart_is_the_nearest_with_a_similar_normal() -> None:
    away = np.array([0.01, 0.03, 0.05], complex)
    normals = np.exp(1j * np.array([math.pi, 0.5, 0.0]))
    known = MapPoints({7: SurfacePoints(away, normals, np.zeros(3))})
    point = SurfacePoints(np.zeros(1, complex), np.ones(1, complex), np.zeros(1))
    for within, expected in ((0.1, [1]), (0.02, [])):
        assert known.counterparts(point, within)[1].tolist() == expected


def test_along_a_bare_wall_the_guess_is_kept() -> None:
    corridor = Rooms(9.0, 1.2)
    robot = SlippingRobot(corridor)
    first = scan_from(robot, Pose(4.0, 0.6, 0.0))
    second = scan_from(robot, Pose(4.4, 0.6, 0.0))
    there = second.middle_pose()
    guess = Pose(there.x + 0.05, there.y + 0.05, there.theta)
    found = match_scan(
        second.surface_points(),
        guess,
        (0.1, 0.1),
        map_points(first.surface_points(), first.middle_pose()),
    )
    assert found is not None
    assert found.pose.y == pytest.approx(there.y, abs=0.01)
    assert found.pose.x == pytest.approx(guess.x, abs=0.03)
    information = found.information[7]
    assert information[1][1] > 20.0 * information[0][0]


def test_an_unknown_area_has_no_match() -> None:
    surface_points = scan_from(SlippingRobot(ROOM), HERE).surface_points()
    assert (
        match_scan(
            surface_points,
            Pose(5.0, 5.0, 0.0),
            (0.1, 0.1),
            map_points(surface_points, HERE),
        )
        is None
    )


def test_walls_give_the_heading_and_the_drift() -> None:
    scan = scan_from(SlippingRobot(ROOM), HERE)
    walls = -scan.middle_pose().theta
    found = find_dominant_orientation(scan.surface_points(), walls + 0.1, 0.3)
    assert found is not None
    assert math.remainder(found.angle - walls, math.pi / 2.0) == pytest.approx(
        0.0, abs=0.01
    )
    assert found.inlier_ratio > 0.8
    # The robot turned further than its wheels report: late points are further left.
    late = scan.surface_points().undistorted(-0.06)
    slipped = find_dominant_orientation(late, walls, 0.3)
    assert slipped is not None
    assert 0.02 < slipped.drift - found.drift < 0.08


def test_few_points_give_no_heading() -> None:
    few = SurfacePoints(np.ones(10, complex), -np.ones(10, complex), np.zeros(10))
    assert find_dominant_orientation(few, 0.0, 0.3) is None
    nothing = MapPoints({})
    assert match_scan(few, HERE, (0.1, 0.1), nothing) is None
    assert match_scan(NOTHING, HERE, (0.1, 0.1), map_points(few, HERE)) is None
