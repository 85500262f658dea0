"""Blocked turns: the wheels turn, but the robot does not."""

import math
from collections.abc import Sequence

import numpy as np

from ...pose import wrap_angle
from ..occupancy_grid import Reading

# In such an angle, something changes for a robot that turns. If several sensors detect
# something, it changes earlier for one of them.
UNCHANGED_ANGLE = math.radians(120.0)
MAX_CHANGE = 0.02  # m between mean distances, because of noise


class TurnWatch:
    """Notices that something blocks a turn: what the sensors read stays the same."""

    def __init__(self, heading: float) -> None:
        """`heading` is that at the start of the turn, in radians."""
        self._heading = heading
        self._turned: list[float] = []  # radians since the start, by odometry
        self._distances: list[list[float]] = []  # m; infinite without a hit
        self._kept: list[bool] = []
        self._first: int | None = None  # of the readings that are the same

    def add(
        self, heading: float, readings: Sequence[Reading], *, is_kept: bool
    ) -> None:
        """Adds a reading of each sensor, at a heading by odometry."""
        turned = self._turned[-1] if self._turned else 0.0
        self._turned.append(turned + wrap_angle(heading - self._heading - turned))
        self._distances.append([r.distance if r.is_hit else math.inf for r in readings])
        self._kept.append(is_kept)
        if is_kept and self._first is None:
            self._first = self._find_unchanged()

    def is_blocked(self) -> bool:
        """Whether nothing has changed in the last part of the turn."""
        return self._first is not None

    @property
    def turned(self) -> float:
        """The angle before the robot was blocked, in radians, to the left if positive."""
        return self._turned[self._first or 0]

    @property
    def unchanged(self) -> int:
        """How many of the readings that were kept were taken after that."""
        return sum(self._kept[(self._first or 0) + 1 :])

    def _find_unchanged(self) -> int | None:
        """The first of the readings that are the same up to now, if they are enough."""
        hits = sum(map(math.isfinite, self._distances[-1]))
        least = UNCHANGED_ANGLE / max(1, hits)
        for first in reversed(range(len(self._turned))):
            if abs(self._turned[-1] - self._turned[first]) >= least:
                return first if hits and is_unchanged(self._distances[first:]) else None
        return None


def is_unchanged(distances: Sequence[Sequence[float]]) -> bool:
    """Whether each sensor has read the same all the time."""
    rows = np.array(distances)
    is_hit = np.isfinite(rows)
    always, never = is_hit.all(axis=0), ~is_hit.any(axis=0)
    if not (always | never).all():
        return False
    means = [part[:, always].mean(axis=0) for part in np.array_split(rows, 3)]
    return bool(np.ptp(means, axis=0).max() < MAX_CHANGE)
