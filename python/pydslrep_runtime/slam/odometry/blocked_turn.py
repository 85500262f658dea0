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
MIN_LOSS = math.radians(20.0)  # of a turn that counts as blocked


class Sightings:
    """What the sensors have detected during a turn, in the robot's frame."""

    def __init__(self, ends: Complex) -> None:
        """`ends` has a row for each moment and a column for each sensor, in metres."""
        self._depth, self._bearing = np.abs(ends), np.angle(ends)

    def spreads(self, angles: Array) -> tuple[Array, Array]:
        """The standard deviation of the depths in each direction, in metres, and its weight.

        `angles` are those that the robot has turned at each moment, in radians.
        """
        turned = (angles[:, None] + self._bearing) / BIN
        direction = np.round(turned).astype(int).ravel() % BINS
        depth = self._depth.ravel()
        count, total, squares = (
            np.bincount(direction, weights, BINS)
            for weights in (np.ones_like(depth), depth, depth**2)
        )
        mean = total / np.maximum(count, 1.0)
        variance = np.maximum(squares / np.maximum(count, 1.0) - mean**2, 0.0)
        return np.sqrt(variance), count / count.sum()

    def mean_spread(self, angles: Array) -> float:
        """The mean over all directions, in metres."""
        spread, weight = self.spreads(angles)
        return float(spread @ weight)


def actual_angles(turned: Array, ends: Complex) -> Array:
    """The angles that a robot has turned, which are less than reported if it was blocked.

    `turned` are those by odometry, in radians since the start of a turn in place; `ends` are
    where the sensors have detected something at those moments, in the robot's frame.
    """
    seen = Sightings(ends)
    spread, weight = seen.spreads(turned)
    contradicted = weight @ (spread > MAX_SPREAD)
    if contradicted <= MAX_CONTRADICTED or abs(float(turned[-1])) < MIN_LOSS:
        return turned
    angles = likeliest_blocked_turn(turned, seen)
    is_better = seen.mean_spread(angles) < MAX_SPREAD_RATIO * (spread @ weight)
    return angles if is_better else turned


def likeliest_blocked_turn(turned: Array, seen: Sightings) -> Array:
    """The angles of the turn with which the sightings agree best, if it was blocked once."""
    way = abs(float(turned[-1]))
    starts, losses = np.arange(0.0, way, STEPS[0]), np.arange(MIN_LOSS, way, STEPS[0])
    for _ in STEPS:
        found = [
            (seen.mean_spread(blocked(turned, start, lost)), lost, start)
            for start in starts
            for lost in losses
            if start + lost < way + ROUNDING
        ]
        # What sees each direction once contradicts nothing: it may have turned even less.
        limit = min(found)[0] + TOLERANCE
        lost, start = max(
            (lost, start) for spread, lost, start in found if spread <= limit
        )
        around = np.arange(-STEPS[0], STEPS[0], STEPS[1])
        starts, losses = np.maximum(start + around, 0.0), lost + around
    return blocked(turned, start, lost)


def blocked(turned: Array, start: float, lost: float) -> Array:
    """The angles of a turn that was blocked at an angle while the wheels lost another one."""
    reported = np.abs(turned)
    angles: Array = np.where(
        reported < start, reported, np.maximum(start, reported - lost)
    )
    return np.copysign(angles, turned)
