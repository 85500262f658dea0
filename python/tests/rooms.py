"""Closed worlds of rooms, corridors, pillars and loops, generated from a seed."""

import math
import random
from dataclasses import dataclass, field
from functools import cached_property

Position = tuple[float, float]
THICKNESS = 0.1  # m, of walls


@dataclass
class Wall:
    """A line with a thickness, as in scene files."""

    start: Position
    end: Position

    @cached_property
    def corners(self) -> list[Position]:
        (x1, y1), (x2, y2) = self.start, self.end
        length = math.dist(self.start, self.end)
        ux, uy = (x2 - x1) / length, (y2 - y1) / length
        h = THICKNESS / 2.0
        return [
            (x1 + h * uy, y1 - h * ux),
            (x2 + h * uy, y2 - h * ux),
            (x2 - h * uy, y2 + h * ux),
            (x1 - h * uy, y1 + h * ux),
        ]

    def is_about(self, position: Position, margin: float) -> bool:
        margin += THICKNESS
        return all(
            min(a, b) - margin <= value <= max(a, b) + margin
            for a, b, value in zip(self.start, self.end, position, strict=True)
        )


@dataclass(frozen=True)
class Pillar:
    """A cylinder."""

    at: Position
    radius: float


@dataclass
class Rooms:
    """A closed rectangle with its lower left corner at the origin."""

    width: float
    height: float
    start: Position = (0.6, 0.6)
    walls: list[Wall] = field(default_factory=list)
    pillars: list[Pillar] = field(default_factory=list)

    def scene(self, robot: str, noise: str = "") -> str:
        """The world as a scene file."""
        lines = [
            noise,
            "[world]",
            f"size = [{self.width:.3f}, {self.height:.3f}]",
            "corner = [0, 0]",
        ]
        for wall in self.walls:
            (x1, y1), (x2, y2) = wall.start, wall.end
            lines += [
                "[[wall]]",
                f"from = [{x1:.3f}, {y1:.3f}]",
                f"to = [{x2:.3f}, {y2:.3f}]",
            ]
        for pillar in self.pillars:
            x, y = pillar.at
            lines += [
                "[[cylinder]]",
                f"at = [{x:.3f}, {y:.3f}]",
                f"radius = {pillar.radius:.3f}",
            ]
        x, y = self.start
        lines += [f"[robots.{robot}]", f"start = [{x:.3f}, {y:.3f}, 0]"]
        return "\n".join(lines) + "\n"

    def free(self, position: Position, clearance: float = 0.0) -> bool:
        """Whether a disc of that radius touches nothing."""
        x, y = position
        inside = (
            clearance <= x <= self.width - clearance
            and clearance <= y <= self.height - clearance
        )
        return (
            inside
            and all(
                math.dist(position, pillar.at) >= pillar.radius + clearance
                for pillar in self.pillars
            )
            and all(
                distance_to_polygon(position, wall.corners) >= clearance
                and not is_inside(position, wall.corners)
                for wall in self.walls
                if wall.is_about(position, clearance)
            )
        )

    def holds(self, x: float, y: float, theta: float, half: float) -> bool:
        """Whether a square body of that half width touches nothing."""
        cos, sin = math.cos(theta), math.sin(theta)

        def on_body(position: Position) -> Position:
            dx, dy = position[0] - x, position[1] - y
            return cos * dx + sin * dy, cos * dy - sin * dx

        corners = [
            (x + cos * a - sin * b, y + sin * a + cos * b)
            for a, b in ((half, half), (-half, half), (-half, -half), (half, -half))
        ]
        reach = 2.0 * half
        ends = (
            corner
            for wall in self.walls
            if wall.is_about((x, y), reach)
            for corner in wall.corners
        )
        return (
            all(self.free(corner) for corner in corners)
            and all(max(map(abs, on_body(end))) >= half for end in ends)
            and all(
                distance_to_polygon(pillar.at, corners) >= pillar.radius
                for pillar in self.pillars
                if math.dist(pillar.at, (x, y)) < reach + pillar.radius
            )
        )

    def is_at_wall(self, position: Position) -> bool:
        """Whether a wall could end here, and not in a door."""
        x, y = position
        return min(x, y, self.width - x, self.height - y) < 0.01 or any(
            distance_to_segment(position, wall.start, wall.end) < 0.01
            and min(math.dist(position, wall.start), math.dist(position, wall.end))
            > 0.1
            for wall in self.walls
        )

    def segments(self) -> list[tuple[Position, Position]]:
        """The outlines of everything straight."""
        corners = [
            (0.0, 0.0),
            (self.width, 0.0),
            (self.width, self.height),
            (0.0, self.height),
        ]
        outlines = [corners, *(wall.corners for wall in self.walls)]
        return [
            (a, b)
            for outline in outlines
            for a, b in zip(outline, outline[1:] + outline[:1], strict=True)
        ]

    def is_straight(self, a: Position, b: Position) -> bool:
        """Whether the line between two positions is free."""
        return not any(
            crosses(a, b, start, end) for start, end in self.segments()
        ) and all(
            distance_to_segment(pillar.at, a, b) > pillar.radius
            for pillar in self.pillars
        )

    def floor(self, grain: float) -> list[Position]:
        """A grid of points on the floor that is connected to the start."""

        def at(cell: tuple[int, int]) -> Position:
            return (cell[0] + 0.5) * grain, (cell[1] + 0.5) * grain

        first = (int(self.start[0] / grain), int(self.start[1] / grain))
        found, queue = {first}, [first]
        while queue:
            column, row = queue.pop()
            for right, up in ((1, 0), (-1, 0), (0, 1), (0, -1)):
                cell = (column + right, row + up)
                if cell not in found and self.free(at(cell)):
                    found.add(cell)
                    queue.append(cell)
        return [at(cell) for cell in sorted(found)]

    def coverage(
        self, nodes: list[Position], reach: float, grain: float = 0.1
    ) -> float:
        """The fraction of the floor within reach and in line of sight of a node."""
        floor, segments = self.floor(grain), self.segments()

        def sees(node: Position, position: Position) -> bool:
            return not any(
                crosses(node, position, start, end) for start, end in segments
            ) and all(
                distance_to_segment(pillar.at, node, position) > pillar.radius
                for pillar in self.pillars
            )

        seen = sum(
            any(
                math.dist(position, node) <= reach and sees(node, position)
                for node in sorted(nodes, key=lambda node: math.dist(position, node))
            )
            for position in floor
        )
        return seen / len(floor)


def distance_to_segment(p: Position, a: Position, b: Position) -> float:
    return math.dist(p, nearest_on_segment(p, a, b))


def nearest_on_segment(p: Position, a: Position, b: Position) -> Position:
    dx, dy = b[0] - a[0], b[1] - a[1]
    square = dx * dx + dy * dy
    t = ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / square if square else 0.0
    t = max(0.0, min(1.0, t))
    return a[0] + t * dx, a[1] + t * dy


def distance_to_polygon(p: Position, corners: list[Position]) -> float:
    return min(
        distance_to_segment(p, a, b)
        for a, b in zip(corners, corners[1:] + corners[:1], strict=True)
    )


def is_inside(p: Position, corners: list[Position]) -> bool:
    """For convex, counter-clockwise outlines."""
    return all(
        (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0.0
        for a, b in zip(corners, corners[1:] + corners[:1], strict=True)
    )


def crosses(a: Position, b: Position, c: Position, d: Position) -> bool:
    def side(p: Position, q: Position, r: Position) -> float:
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    return side(a, b, c) * side(a, b, d) < 0.0 and side(c, d, a) * side(c, d, b) < 0.0


def generate(seed: int) -> Rooms:
    """A world of 30 to 80 m² divided into rooms, with doors, dead ends and pillars."""
    dice = random.Random(seed)
    area = dice.uniform(30.0, 80.0)
    ratio = dice.uniform(0.7, 1.4)
    rooms = Rooms(math.sqrt(area * ratio), math.sqrt(area / ratio))
    leaves: list[tuple[float, float, float, float]] = []
    divide(rooms, dice, (0.0, 0.0, rooms.width, rooms.height), leaves, 0)
    for left, low, right, high in leaves:
        if min(right - left, high - low) < 2.2:
            continue
        for _ in range(dice.choice([0, 1, 1, 2])):
            radius = dice.uniform(0.08, 0.3)
            at = (
                dice.uniform(left + 0.2, right - 0.2),
                dice.uniform(low + 0.2, high - 0.2),
            )
            # Neither in a door nor in a passage.
            if rooms.free(at, radius + 0.75):
                rooms.pillars.append(Pillar(at, radius))
        if dice.random() < 0.5 and right - left > 2.6 and high - low > 2.6:
            # A dead end: a bay behind a wall that ends in the room.
            depth = low + dice.uniform(0.9, 1.2)
            wall = Wall((left, depth), (left + 0.6 * (right - left), depth))
            middle = ((wall.start[0] + wall.end[0]) / 2.0, depth)
            if all(
                distance_to_segment(pillar.at, wall.start, wall.end)
                > pillar.radius + 0.75
                for pillar in rooms.pillars
            ) and rooms.free(middle, 0.4):
                rooms.walls.append(wall)
    while not rooms.free(rooms.start, 0.35):
        rooms.start = (
            dice.uniform(0.5, rooms.width - 0.5),
            dice.uniform(0.5, rooms.height - 0.5),
        )
    return rooms


def divide(
    rooms: Rooms,
    dice: random.Random,
    box: tuple[float, float, float, float],
    leaves: list[tuple[float, float, float, float]],
    depth: int,
) -> None:
    left, low, right, high = box
    width, height = right - left, high - low
    if max(width, height) < 3.4 or (depth > 2 and dice.random() < 0.3):
        leaves.append(box)
        return
    is_upright = width > height
    length = width if is_upright else height
    for _ in range(20):
        # Sometimes cut off a corridor.
        is_corridor = depth < 2 and dice.random() < 0.4
        at = dice.uniform(1.1, 1.3) if is_corridor else length * dice.uniform(0.4, 0.6)
        ends = (
            [(left + at, low), (left + at, high)]
            if is_upright
            else [(left, low + at), (right, low + at)]
        )
        if all(rooms.is_at_wall(end) for end in ends):
            break
    else:
        leaves.append(box)
        return
    across = height if is_upright else width
    doors = [dice.uniform(0.15, 0.85)]
    if across > 4.0 and dice.random() < 0.7:
        doors = [dice.uniform(0.12, 0.35), dice.uniform(0.65, 0.88)]
    pieces, begin = [], 0.0
    for door in doors:
        half = dice.uniform(0.4, 0.6)
        middle = max(half + 0.1, min(across - half - 0.1, door * across))
        pieces.append((begin, middle - half))
        begin = middle + half
    pieces.append((begin, across))
    for start, end in pieces:
        if end - start < 0.02:
            continue
        if is_upright:
            rooms.walls.append(Wall((left + at, low + start), (left + at, low + end)))
        else:
            rooms.walls.append(Wall((left + start, low + at), (left + end, low + at)))
    if is_upright:
        divide(rooms, dice, (left, low, left + at, high), leaves, depth + 1)
        divide(rooms, dice, (left + at, low, right, high), leaves, depth + 1)
    else:
        divide(rooms, dice, (left, low, right, low + at), leaves, depth + 1)
        divide(rooms, dice, (left, low + at, right, high), leaves, depth + 1)
