"""The cells of an occupancy grid that many sensor readings cover."""

import math
from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

from ..occupancy_grid import Cell, OccupancyGrid
from .poses import Array

SIZE = OccupancyGrid.CELL
Integers = npt.NDArray[np.int64]


def cells_within(sensors: Array, slopes: Array, radii: Array) -> Iterable[Cell]:
    """The cells in cones: in each row of the grid, those in an interval of columns.

    `sensors` are poses, `slopes` those of the cones' edges; `radii` are in metres.
    """
    x, y, heading, slope, radius = np.column_stack([sensors, slopes, radii]).T[
        ..., None
    ]
    reach = math.ceil(radii.max(initial=0.0) / SIZE) + 1
    row = np.round(y / SIZE) + np.arange(-reach, reach + 1)
    up = row * SIZE - y
    right = np.sqrt(np.maximum(0.0, radius**2 - up**2))
    left = -right
    cos, sin = np.cos(heading), np.sin(heading)
    for side in (-1.0, 1.0):
        # Of the points between the edges, `right * factor >= least`.
        factor = slope * cos - side * sin
        least = -side * up * (cos + side * slope * sin)
        bound = least / factor
        left = np.where(factor > 0.0, np.maximum(left, bound), left)
        right = np.where(factor < 0.0, np.minimum(right, bound), right)
    first = np.ceil((x + left) / SIZE)
    end = np.floor((x + right) / SIZE) + 1.0
    is_any = (np.abs(up) <= radius) & (first < end)
    return filled(*np.array([row[is_any], first[is_any], end[is_any]], np.int64))


def filled(rows: Integers, first: Integers, end: Integers) -> Iterable[Cell]:
    """The cells of intervals of columns, each from `first` up to `end`."""
    if not len(rows):
        return ()
    low, left = rows.min(), first.min()
    depth = np.zeros((rows.max() - low + 1, end.max() - left + 1), int)
    np.add.at(depth, (rows - low, first - left), 1)
    np.add.at(depth, (rows - low, end - left), -1)
    up, right = np.nonzero(depth.cumsum(axis=1))
    return zip((right + left).tolist(), (up + low).tolist(), strict=True)
