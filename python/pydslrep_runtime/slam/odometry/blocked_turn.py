"""Blocked turns: something holds the robot while its wheels turn.

In a turn, several sensors look in the same directions one after the other. If they measure
different distances there, the robot has not turned as its wheels report.
"""

import math

import numpy as np

from .surface import Array, Complex

BIN = math.radians(5.0)
BINS = round(math.tau / BIN)
MAX_SPREAD = 0.06  # m between what sensors measure in one direction
MAX_CONTRADICTED = 0.32  # of the readings of a turn that may be as reported
MAX_SPREAD_RATIO = 0.5  # that is left if a turn was blocked
ROUNDING = 1e-6  # radians
TOLERANCE = 0.0005  # m between spreads that are equally good
STEPS = math.radians(10.0), math.radians(2.0)  # of the search, and around what it found
LEAST = math.radians(20.0)  # that a blocked turn loses


def actual_angles(turned: Array, ends: Complex) -> Array:
    """The angles that a robot has turned, which are less than reported if it was blocked.

    `turned` are those by odometry, in radians since the start of a turn in place; `ends` has
    a row for each, with what every sensor has detected in the robot's frame, in metres.
    """
    depth, bearing = np.abs(ends), np.angle(ends)

    def spreads(angles: Array) -> tuple[Array, Array]:
        """The standard deviations of what sensors measure in each direction, with weights."""
        direction = np.round((angles[:, None] + bearing) / BIN).astype(int) % BINS
        count, total, squares = (
            np.bincount(direction.ravel(), weights.ravel(), BINS)
            for weights in (np.ones_like(depth), depth, depth**2)
        )
        mean = total / np.maximum(count, 1.0)
        variance = np.maximum(squares / np.maximum(count, 1.0) - mean**2, 0.0)
        return np.sqrt(variance), count / count.sum()

    def mean_spread(angles: Array) -> float:
        spread, weight = spreads(angles)
        return float(spread @ weight)

    spread, weight = spreads(turned)
    way = abs(float(turned[-1]))
    if weight @ (spread > MAX_SPREAD) <= MAX_CONTRADICTED or way < LEAST:
        return turned
    starts, losses = np.arange(0.0, way, STEPS[0]), np.arange(LEAST, way, STEPS[0])
    for _ in STEPS:
        found = [
            (mean_spread(blocked(turned, start, lost)), start, lost)
            for start in starts
            for lost in losses
            if start + lost < way + ROUNDING
        ]
        least = min(found)[0]
        # What sees each direction once contradicts nothing: it may have turned even less.
        lost, start = max(
            (lost, start) for left, start, lost in found if left <= least + TOLERANCE
        )
        around = np.arange(-STEPS[0], STEPS[0], STEPS[1])
        starts, losses = np.maximum(start + around, 0.0), lost + around
    is_blocked = least < MAX_SPREAD_RATIO * (spread @ weight)
    return blocked(turned, start, lost) if is_blocked else turned


def blocked(turned: Array, start: float, lost: float) -> Array:
    """The angles of a turn that was blocked at an angle while the wheels lost another one."""
    reported = np.abs(turned)
    angles: Array = np.where(
        reported < start, reported, np.maximum(start, reported - lost)
    )
    return np.copysign(angles, turned)
