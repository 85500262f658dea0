#: if standalone
"""What sensors have seen of the floor."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from .pose import Pose

#: endif


Place = tuple[float, float]  # x and y in metres
Cell = tuple[int, int]


@dataclass(frozen=True)
class Reading:
    """What a proximity sensor sees: a cone that is free up to a distance."""

    eye: Pose  # of the sensor, looking along its heading
    cone: float  # opening angle in radians
    distance: float  # m; the sensor's range where it sees nothing
    sees: bool  # whether something is at that distance, anywhere across the cone

    def seen_by(self, here: Pose) -> "Reading":
        """The reading of a sensor that is mounted like that on a robot."""
        return Reading(self.eye.placed_on(here), self.cone, self.distance, self.sees)


class Floor:
    """The floor in cells: free where some cone has shown it, unknown where none has.

    A robot has room where all cells about its middle are free. So whatever no sensor has
    seen is in the way, whether it hid between two cones or behind a corner.
    """

    CELL = 0.05  # m
    CAUTION = 0.03  # m by which a sensor's reading may be too long
    SIGHT = 0.6  # m that something is near enough for a robot to know where it is
    LEEWAY = 0.06  # m to keep from obstacles: half a cell, and what driving is off

    def __init__(self, radius: float) -> None:
        """`radius` is that of a circle about the robot's middle that holds its body."""
        self._body = list(self._disc(radius))
        self._room = list(self._disc(radius + self.LEEWAY))
        self._reach = (radius + self.LEEWAY) / self.CELL + 3.0
        self._free: set[Cell] = set()
        self._edges: set[Cell] = set()  # where something is, unless free as well
        self._roomy: set[Cell] = set()

    def clear(self) -> None:
        """Nothing was seen."""
        self._free.clear()
        self._edges.clear()
        self._roomy.clear()

    def stand(self, x: float, y: float) -> None:
        """The robot has turned here, and touched nothing."""
        column, row = self._cell(x, y)
        for right, up in self._body:
            self._free.add((column + right, row + up))

    def see(self, reading: Reading) -> None:
        """Takes in what a sensor sees."""
        eye, half = reading.eye, min(reading.cone / 2.0, 1.5)
        depth = max(0.0, reading.distance - self.CAUTION)
        end = reading.distance + self.CELL if reading.sees else depth
        cos, sin, slope = math.cos(eye.theta), math.sin(eye.theta), math.tan(half)
        columns, rows = self._box(eye, half, end)
        for column in columns:
            right = column * self.CELL - eye.x
            for row in rows:
                up = row * self.CELL - eye.y
                if abs(up * cos - right * sin) > slope * (right * cos + up * sin):
                    continue
                square = right * right + up * up
                if square <= depth * depth:
                    self._free.add((column, row))
                elif reading.sees and square <= end * end:
                    self._edges.add((column, row))

    def block(self, x: float, y: float) -> None:
        """Something is here, whatever was seen before."""
        column, row = self._cell(x, y)
        for right in (-1, 0, 1):
            for up in (-1, 0, 1):
                cell = (column + right, row + up)
                self._free.discard(cell)
                self._edges.add(cell)
        self._roomy = {
            cell for cell in self._roomy if math.dist(cell, (column, row)) > self._reach
        }

    def has_room(self, x: float, y: float) -> bool:
        """Whether the robot can stand here and turn."""
        return self._is_roomy(self._cell(x, y))

    def is_open(self, start: Place, end: Place) -> bool:
        """Whether the robot can drive straight from one place to another."""
        return all(self._is_roomy(cell) for cell in self._cells(start, end))

    def is_bare(self, place: Place) -> bool:
        """Whether nothing is near by which a robot could tell where it is."""
        column, row = self._cell(*place)
        reach = round(self.SIGHT / self.CELL)
        return not any(
            (cell := (column + right, row + up)) in self._edges
            and cell not in self._free
            for right in range(-reach, reach + 1)
            for up in range(-reach, reach + 1)
        )

    def is_undecided(self, start: Place, end: Place) -> bool:
        """Whether a way is not open only because nobody has looked there yet."""
        for cell in self._cells(start, end):
            if not self._is_roomy(cell):
                missing = [
                    near
                    for right, up in self._room
                    if (near := (cell[0] + right, cell[1] + up)) not in self._free
                ]
                return self._edges.isdisjoint(missing)
        return False

    def _is_roomy(self, cell: Cell) -> bool:
        if cell in self._roomy:
            return True
        column, row = cell
        free = self._free
        for right, up in self._room:
            if (column + right, row + up) not in free:
                return False
        self._roomy.add(cell)
        return True

    def _cell(self, x: float, y: float) -> Cell:
        return round(x / self.CELL), round(y / self.CELL)

    def _cells(self, start: Place, end: Place) -> Iterator[Cell]:
        count = max(1, math.ceil(math.dist(start, end) / (0.5 * self.CELL)))
        for index in range(count + 1):
            part = index / count
            yield self._cell(
                start[0] + part * (end[0] - start[0]),
                start[1] + part * (end[1] - start[1]),
            )

    def _disc(self, radius: float) -> Iterator[Cell]:
        """The cells about a cell, those most likely to be unknown first."""
        reach = math.ceil(radius / self.CELL)
        cells = [
            (right, up)
            for right in range(-reach, reach + 1)
            for up in range(-reach, reach + 1)
            if math.hypot(right, up) * self.CELL <= radius
        ]
        yield from sorted(cells, key=lambda cell: -math.hypot(*cell))

    def _box(self, eye: Pose, half: float, end: float) -> tuple[range, range]:
        """Columns and rows about a cone."""
        points = [eye, *(eye.turned(turn).ahead(end) for turn in (-half, 0.0, half))]
        left, low = self._cell(min(p.x for p in points), min(p.y for p in points))
        right, high = self._cell(max(p.x for p in points), max(p.y for p in points))
        return range(left - 1, right + 2), range(low - 1, high + 2)
