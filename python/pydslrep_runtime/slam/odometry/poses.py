"""Many poses at once: arrays with rows of x, y and heading."""

from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

from ...pose import Pose

Array = npt.NDArray[np.float64]


def rows_of(poses: Iterable[Pose]) -> Array:
    """The rows of poses."""
    return np.array([(pose.x, pose.y, pose.theta) for pose in poses]).reshape(-1, 3)


def transformed(rows: Array, origins: Array) -> Array:
    """Transforms poses, each relative to its origin, into the frame of the origins."""
    x, y, _ = rows.T
    cos, sin = np.cos(origins[..., 2]), np.sin(origins[..., 2])
    turned = np.column_stack([cos * x - sin * y, sin * x + cos * y, rows[:, 2]])
    found: Array = origins + turned
    return found


def difference(rows: Array, others: Array) -> Array:
    """What must be added to the other poses; headings change by half a turn at most."""
    found = rows - others
    found[:, 2] -= 2.0 * np.pi * np.round(found[:, 2] / (2.0 * np.pi))
    return found
