"""The outlines of meshes, as seen from above: polygons on the floor, counter-clockwise."""

import math
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence

from .description import Point
from .frames import Vector

Polygon = Sequence[Point]
Triangle = tuple[int, int, int]
Edge = tuple[Point, Point]

FINENESS = 0.002  # m by which an outline may be off
MERGED = 1e-5  # m within which corners are one
MAX_TRIANGLES = 200  # of an outline with holes


def outlines(
    vertices: Sequence[Vector], triangles: Iterable[Triangle], *, is_convex: bool
) -> Sequence[Polygon] | None:
    """What covers the same area as a mesh; None if that is not found out, as where its parts lie above each other."""
    if is_convex:
        return [hull(vertices)]
    seen = [corners for each in triangles if (corners := _seen(vertices, each))]
    loops = _loops(seen)
    if not loops:
        return None
    if all(area(loop) > 0.0 for loop in loops):
        return [simplified(loop) for loop in loops]
    # Polygons have no holes.
    return seen if len(seen) <= MAX_TRIANGLES else None


def hull(vertices: Iterable[Sequence[float]]) -> Polygon:
    """The smallest convex polygon around points."""
    points = sorted({(each[0], each[1]) for each in vertices})
    half: list[Point] = []
    sides: list[list[Point]] = []
    for side in (points, reversed(points)):
        half = []
        for point in side:
            while len(half) > 1 and area((half[-2], half[-1], point)) <= 0.0:
                half.pop()
            half.append(point)
        sides.append(half[:-1])
    return simplified([*sides[0], *sides[1]])


def area(corners: Polygon) -> float:
    """The area of a polygon in square metres; negative if it is clockwise."""
    following = [*corners[1:], *corners[:1]]
    pairs = zip(corners, following, strict=True)
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in pairs) / 2.0


def simplified(corners: Polygon) -> Polygon:
    """A polygon without the corners that hardly change it."""
    first = max(range(len(corners)), key=lambda i: math.dist(corners[i], corners[0]))
    loop = [*corners[first:], *corners[: first + 1]]
    middle = max(range(len(loop)), key=lambda i: math.dist(loop[i], loop[0]))
    kept = [*_line(loop[: middle + 1])[:-1], *_line(loop[middle:])[:-1]]
    return kept if len(kept) > 2 else corners


def _line(points: Sequence[Point]) -> Sequence[Point]:
    """A line through all points, without those that are near a shorter one."""
    if len(points) < 3:
        return points
    a, b = points[0], points[-1]
    base = math.dist(a, b)
    off = [2.0 * abs(area((a, point, b))) for point in points]
    far = max(range(len(points)), key=off.__getitem__)
    if off[far] <= FINENESS * base:
        return [a, b]
    return [*_line(points[: far + 1])[:-1], *_line(points[far:])]


def _seen(vertices: Sequence[Vector], triangle: Triangle) -> Polygon | None:
    """The corners of a triangle that is seen from above."""
    corners = [
        (round(x / MERGED) * MERGED, round(y / MERGED) * MERGED)
        for x, y, _ in (vertices[index] for index in triangle)
    ]
    return corners if area(corners) > MERGED**2 else None


def _loops(triangles: Sequence[Polygon]) -> Sequence[Polygon] | None:
    """The edges around triangles that cover an area once; holes are clockwise. None if they do not."""
    edges: Counter[Edge] = Counter()
    for a, b, c in triangles:
        edges.update(((a, b), (b, c), (c, a)))
    if any(count > 1 for count in edges.values()):
        return None
    following: defaultdict[Point, list[Point]] = defaultdict(list)
    for start, end in edges:
        if (end, start) not in edges:
            following[start].append(end)
    if any(len(ends) > 1 for ends in following.values()):
        return None
    return _chains({start: ends[0] for start, ends in following.items()})


def _chains(following: Mapping[Point, Point]) -> Sequence[Polygon] | None:
    """Closed chains of points, each of which is followed by one."""
    left, loops = dict(following), []
    while left:
        first, here = left.popitem()
        loop = [first]
        while here != first:
            loop.append(here)
            if here not in left:
                return None
            here = left.pop(here)
        loops.append(loop)
    return loops
