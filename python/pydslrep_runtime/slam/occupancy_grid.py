"""An occupancy grid of the floor, built from proximity sensors."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from ..pose import Pose

Position = tuple[float, float]  # x and y in metres
Cell = tuple[int, int]


@dataclass(frozen=True)
class Reading:
    """One reading of a proximity sensor: a cone that is free up to a distance."""

    sensor: Pose  # of the sensor, which points along its heading
    cone: float  # opening angle in radians
    distance: float  # m; the sensor's range if it detects nothing
    is_hit: bool  # whether an object is at that distance, anywhere across the cone

    def transformed_by(self, here: Pose) -> "Reading":
        """Transforms the reading from the robot's frame to the frame of its pose."""
        return Reading(
            self.sensor.transformed_by(here), self.cone, self.distance, self.is_hit
        )


class OccupancyGrid:
    """The floor as a grid of cells, each free, occupied or unknown.

    The robot can stand where all cells around its centre are free. Unknown cells count as
    obstacles, whether they are between two cones or around a corner.
    """

    CELL = 0.05  # m
    MAX_HALF_ANGLE = 1.5  # radians from the middle of a cone to its edges
    RANGE_MARGIN = 0.03  # m by which a sensor may overestimate a distance
    LANDMARK_RANGE = 0.6  # m within which an object helps to localise the robot
    CLEARANCE = 0.06  # m to keep from obstacles: half a cell plus the control error

    def __init__(self, radius: float) -> None:
        """`radius` is that of the circle around the robot that encloses its body."""
        self.radius = radius
        self._footprint = list(self._disc(radius))
        self._clearance = list(self._disc(radius + self.CLEARANCE))
        self._reach = (radius + self.CLEARANCE) / self.CELL + 3.0
        self._free: set[Cell] = set()
        self._occupied: set[Cell] = set()  # a cell that is also free counts as free
        self._clear_cells: set[Cell] = set()

    def reset(self) -> None:
        """Forgets all readings."""
        self._free.clear()
        self._occupied.clear()
        self._clear_cells.clear()

    def mark_footprint(self, x: float, y: float) -> None:
        """Marks the robot's footprint as free: it has turned here without contact."""
        column, row = self._cell(x, y)
        for right, up in self._footprint:
            self._free.add((column + right, row + up))

    def add_reading(self, reading: Reading) -> None:
        """Adds a sensor reading."""
        sensor, half = reading.sensor, min(reading.cone / 2.0, self.MAX_HALF_ANGLE)
        depth = max(0.0, reading.distance - self.RANGE_MARGIN)
        end = reading.distance + self.CELL if reading.is_hit else depth
        cos, sin, slope = math.cos(sensor.theta), math.sin(sensor.theta), math.tan(half)
        columns, rows = self._bounding_box(sensor, half, end)
        ups = [(row, row * self.CELL - sensor.y) for row in rows]
        parts = [(row, up * cos, up * sin, up * up) for row, up in ups]
        near, far = depth * depth, end * end if reading.is_hit else -1.0
        for column in columns:
            right = column * self.CELL - sensor.x
            along, across, square = right * cos, right * sin, right * right
            for row, up_across, up_along, up_square in parts:
                if abs(up_across - across) > slope * (along + up_along):
                    continue
                if square + up_square <= near:
                    self._free.add((column, row))
                elif square + up_square <= far:
                    self._occupied.add((column, row))

    def add_cells(self, free: Iterable[Cell], occupied: Iterable[Cell]) -> None:
        """Adds cells that sensor readings cover."""
        self._free.update(free)
        self._occupied.update(occupied)

    def mark_obstacle(self, x: float, y: float) -> None:
        """Marks an obstacle, overriding earlier readings."""
        column, row = self._cell(x, y)
        for right in (-1, 0, 1):
            for up in (-1, 0, 1):
                cell = (column + right, row + up)
                self._free.discard(cell)
                self._occupied.add(cell)
        self._clear_cells = {
            cell
            for cell in self._clear_cells
            if math.dist(cell, (column, row)) > self._reach
        }

    def has_clearance(self, x: float, y: float) -> bool:
        """Whether the robot can turn in place here."""
        return self._has_clearance(self._cell(x, y))

    def is_path_clear(self, start: Position, end: Position) -> bool:
        """Whether the robot can drive straight from one position to another."""
        clear = self._clear_cells  # most cells of a way are known: these cost no call
        return all(
            cell in clear or self._has_clearance(cell)
            for cell in self._cells_between(start, end)
        )

    def is_featureless(self, position: Position) -> bool:
        """Whether there is nothing nearby to localise the robot by."""
        column, row = self._cell(*position)
        reach = round(self.LANDMARK_RANGE / self.CELL)
        return not any(
            (cell := (column + right, row + up)) in self._occupied
            and cell not in self._free
            for right in range(-reach, reach + 1)
            for up in range(-reach, reach + 1)
        )

    def is_unexplored(self, start: Position, end: Position) -> bool:
        """Whether a path is blocked by unknown cells only."""
        for cell in self._cells_between(start, end):
            if not self._has_clearance(cell):
                missing = [
                    near
                    for right, up in self._clearance
                    if (near := (cell[0] + right, cell[1] + up)) not in self._free
                ]
                return self._occupied.isdisjoint(missing)
        return False

    def _has_clearance(self, cell: Cell) -> bool:
        if cell in self._clear_cells:
            return True
        column, row = cell
        free = self._free
        for right, up in self._clearance:
            if (column + right, row + up) not in free:
                return False
        self._clear_cells.add(cell)
        return True

    def _cell(self, x: float, y: float) -> Cell:
        return round(x / self.CELL), round(y / self.CELL)

    def _cells_between(self, start: Position, end: Position) -> Iterator[Cell]:
        count = max(1, math.ceil(math.dist(start, end) / (0.5 * self.CELL)))
        size, (x, y) = self.CELL, start
        to_right, upwards = end[0] - x, end[1] - y
        for index in range(count + 1):
            part = index / count
            yield (
                round((x + part * to_right) / size),
                round((y + part * upwards) / size),
            )

    def _disc(self, radius: float) -> Iterator[Cell]:
        """The offsets of the cells in a disc, those most likely to be unknown first."""
        reach = math.ceil(radius / self.CELL)
        cells = [
            (right, up)
            for right in range(-reach, reach + 1)
            for up in range(-reach, reach + 1)
            if math.hypot(right, up) * self.CELL <= radius
        ]
        yield from sorted(cells, key=lambda cell: -math.hypot(*cell))

    def _bounding_box(
        self, sensor: Pose, half: float, end: float
    ) -> tuple[range, range]:
        """The columns and rows that enclose a cone."""
        points = [
            sensor,
            *(sensor.turned(turn).ahead(end) for turn in (-half, 0.0, half)),
        ]
        left, low = self._cell(min(p.x for p in points), min(p.y for p in points))
        right, high = self._cell(max(p.x for p in points), max(p.y for p in points))
        return range(left - 1, right + 2), range(low - 1, high + 2)
