"""The objects of a floor and of the obstacles on it."""

import math
from collections.abc import Sequence
from typing import Any

from .description import ObstacleDescription, Point, SceneDescription
from .frames import Vector, frame, planar, product
from .maker import Maker, Matter, Place

HEIGHT = 0.3  # m
FLOOR = "floor"
FLOOR_THICKNESS = 0.1  # m
MARGIN = (
    10.0  # m of floor around everything, and around all places that robots may get to
)

# Robots slide along what they touch.
OBSTACLE = Matter(friction=0.3, detectable=True)


def build_floor(maker: Maker, scene: SceneDescription) -> None:
    """Makes a floor below everything; raises SimulatorError. Sensors do not see it: their cones would touch it."""
    points = [*scene.reach, *((robot.x, robot.y) for robot in scene.robots)]
    for obstacle in scene.obstacles:
        reach = _reach(obstacle)
        points += [(obstacle.x - reach, obstacle.y - reach)]
        points += [(obstacle.x + reach, obstacle.y + reach)]
    xs, ys = zip(*points, strict=True)
    size = (max(xs) - min(xs) + 2.0 * MARGIN, max(ys) - min(ys) + 2.0 * MARGIN)
    made = maker.cuboid((*size, FLOOR_THICKNESS), Matter(friction=1.0))
    middle = ((min(xs) + max(xs)) / 2.0, (min(ys) + max(ys)) / 2.0)
    place = Place(frame((*middle, -FLOOR_THICKNESS / 2.0)))
    maker.put(made, FLOOR, place, "floor")


def build_obstacle(maker: Maker, obstacle: ObstacleDescription, alias: str) -> None:
    """Makes an obstacle; raises SimulatorError."""
    place = Place(planar(obstacle.x, obstacle.y, HEIGHT / 2.0, obstacle.heading))
    more: dict[str, Any] = {"name": obstacle.name}
    if obstacle.size is not None:
        made = maker.cuboid((*obstacle.size, HEIGHT), OBSTACLE)
    elif obstacle.radius is not None:
        made = maker.cylinder(obstacle.radius, HEIGHT, OBSTACLE)
    else:
        made = _prism(maker, obstacle.triangles)
        # The simulator chooses the frame of a mesh.
        origin = maker.frame(made)
        place = Place(product(place.frame, origin))
        more |= {"corners": obstacle.corners, "origin": origin}
    maker.put(made, alias, place, "obstacle", more)


def _prism(maker: Maker, outline: Sequence[Sequence[Point]]) -> int:
    """A mesh with an outline: triangles, counter-clockwise from above."""
    vertices: list[Vector] = []
    triangles: list[int] = []
    for corners in outline:
        a, b, c = range(len(vertices), len(vertices) + 3)
        vertices += [(x, y, -HEIGHT / 2.0) for x, y in corners]
        vertices += [(x, y, HEIGHT / 2.0) for x, y in corners]
        triangles += [a, c, b, a + 3, b + 3, c + 3]
        for start, end in ((a, b), (b, c), (c, a)):
            triangles += [start, end, end + 3, start, end + 3, start + 3]
    return maker.mesh(vertices, triangles, OBSTACLE)


def _reach(obstacle: ObstacleDescription) -> float:
    """No point of an obstacle is further from its middle."""
    if obstacle.size is not None:
        return math.hypot(*obstacle.size) / 2.0
    if obstacle.radius is not None:
        return obstacle.radius
    return max(math.hypot(x, y) for x, y in obstacle.corners)
