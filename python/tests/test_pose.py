"""Tests of `pose`."""

import math
import random

import pytest
from pydslrep_runtime.pose import Pose, heading_degrees, wrap_angle


def random_poses(count: int) -> list[tuple[Pose, Pose]]:
    """Pairs of poses, the same ones every time."""
    chance = random.Random(7)

    def pose() -> Pose:
        return Pose(chance.uniform(-9, 9), chance.uniform(-9, 9), chance.uniform(-4, 4))

    return [(pose(), pose()) for _ in range(count)]


@pytest.mark.parametrize(
    ("angle", "wrapped"),
    [(0.0, 0.0), (math.tau, 0.0), (4.0, 4.0 - math.tau), (-7.0, math.tau - 7.0)],
)
def test_angles_wrap(angle: float, wrapped: float) -> None:
    assert wrap_angle(angle) == pytest.approx(wrapped)


@pytest.mark.parametrize(
    ("theta", "shown"),
    [
        (-math.pi, "180"),
        (-3.14159, "180"),
        (math.pi, "180"),
        (-0.0001, "0"),
        (-0.5, "-28.6"),
    ],
)
def test_a_heading_has_one_sign(theta: float, shown: str) -> None:
    assert f"{heading_degrees(theta):g}" == shown


def test_ahead_is_along_the_heading() -> None:
    pose = Pose(1.0, 2.0, math.radians(150.0)).ahead(-2.0)
    assert pose.x == pytest.approx(1.0 + math.sqrt(3.0))
    assert pose.y == pytest.approx(1.0)
    assert pose.theta == pytest.approx(math.radians(150.0))


def test_left_of_a_pose_is_positive_y() -> None:
    seen = Pose(-1.0, 0.0, math.pi).relative_to(Pose(0.0, 0.0, math.pi / 2.0))
    assert (seen.x, seen.y, seen.theta) == pytest.approx((0.0, 1.0, math.pi / 2.0))


@pytest.mark.parametrize(("origin", "pose"), random_poses(50))
def test_seen_from_inverts_going_there(origin: Pose, pose: Pose) -> None:
    seen = pose.relative_to(origin)
    again = origin.ahead(seen.x).turned(math.pi / 2.0).ahead(seen.y)
    assert (again.x, again.y) == pytest.approx((pose.x, pose.y))
    assert wrap_angle(origin.theta + seen.theta - pose.theta) == pytest.approx(
        0.0, abs=1e-12
    )


@pytest.mark.parametrize("theta", [0.0, 1.0, -2.5, math.pi])
def test_how_far_one_is_ahead_is_a_part_of_where_it_is(theta: float) -> None:
    origin, here = Pose(1.0, -2.0, theta), Pose(3.0, 0.5, 0.3)
    assert here.ahead_of(origin) == pytest.approx(here.relative_to(origin).x)
    assert origin.ahead(0.7).ahead_of(origin) == pytest.approx(0.7)
