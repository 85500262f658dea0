"""The outlines of meshes."""

import math

import pytest
from pydslrep_runtime.scene.frames import Vector
from pydslrep_runtime.scene.outlines import Polygon, area, hull, outlines, simplified

L_SHAPE = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)]
L_TRIANGLES = [(0, 1, 3), (1, 2, 3), (0, 3, 5), (3, 4, 5)]
Mesh = tuple[list[Vector], list[tuple[int, int, int]]]


def prism(corners: Polygon, top: list[tuple[int, int, int]]) -> Mesh:
    """The mesh of an outline with a height of 0.3 m."""
    count = len(corners)
    vertices = [(x, y, z) for z in (0.0, 0.3) for x, y in corners]
    triangles = [(a + count, b + count, c + count) for a, b, c in top]
    triangles += [(a, c, b) for a, b, c in top]
    for start in range(count):
        end = (start + 1) % count
        triangles += [(start, end, end + count), (start, end + count, start + count)]
    return vertices, triangles


def separate(mesh: Mesh) -> Mesh:
    """The same mesh, whose triangles share no vertices."""
    vertices, triangles = mesh
    corners = [vertices[index] for each in triangles for index in each]
    return corners, [(i, i + 1, i + 2) for i in range(0, len(corners), 3)]


def test_the_hull_of_points() -> None:
    square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    assert set(hull([*square, (0.5, 0.5), (0.5, 0.0)])) == set(square)
    assert area(hull(square)) == pytest.approx(1.0)


@pytest.mark.parametrize("change", [lambda mesh: mesh, separate])
def test_a_prism_keeps_its_corners(change: object) -> None:
    assert callable(change)
    vertices, triangles = change(prism(L_SHAPE, L_TRIANGLES))
    (found,) = outlines(vertices, triangles, is_convex=False) or []
    assert area(found) == pytest.approx(3.0)
    assert {(round(x, 3), round(y, 3)) for x, y in found} == set(L_SHAPE)


def test_parts_have_outlines_of_their_own() -> None:
    first = prism(L_SHAPE, L_TRIANGLES)
    second = prism([(x + 5.0, y) for x, y in L_SHAPE], L_TRIANGLES)
    moved = [(a + 12, b + 12, c + 12) for a, b, c in second[1]]
    mesh = first[0] + second[0], first[1] + moved
    found = outlines(*mesh, is_convex=False)
    assert found is not None
    assert sorted(round(area(each), 6) for each in found) == [3.0, 3.0]


def ring() -> Mesh:
    """Four walls around a room."""
    outer = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)]
    inner = [(0.9 * x, 0.9 * y) for x, y in outer]
    top = []
    for start in range(4):
        end = (start + 1) % 4
        top += [(start, end, end + 4), (start, end + 4, start + 4)]
    return prism([*outer, *inner], top)[0], [(a + 8, b + 8, c + 8) for a, b, c in top]


def test_a_room_stays_open() -> None:
    found = outlines(*ring(), is_convex=False)
    assert found is not None
    assert sum(map(area, found)) == pytest.approx(16.0 - 3.6**2)
    middle = [p for each in found for p in each if math.hypot(*p) < 1.0]
    assert middle == []


def test_parts_above_each_other_are_not_clear() -> None:
    vertices, triangles = prism(L_SHAPE, L_TRIANGLES)
    twice = [(x, y, z + 1.0) for x, y, z in vertices]
    above = [(a + 12, b + 12, c + 12) for a, b, c in triangles]
    assert outlines(vertices + twice, triangles + above, is_convex=False) is None


def test_round_things_have_few_corners() -> None:
    circle = [
        (math.cos(angle), math.sin(angle))
        for angle in (math.tau * step / 1000 for step in range(1000))
    ]
    found = simplified(circle)
    assert len(found) < 200
    assert area(found) == pytest.approx(math.pi, rel=5e-3)
