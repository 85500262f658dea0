#: if standalone
"""Which way walls run: rooms are built at right angles, mostly."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from .scan import Mark
from .scan_matching import DRIFT

#: endif


RIGHT_ANGLE = math.pi / 2.0
SPREAD = math.radians(3.5)  # of the normals of marks on the same wall
ASIDE = math.radians(
    8.0
)  # so far from the direction of the others, a wall is a slanting one


@dataclass(frozen=True)
class Grain:
    """The direction of walls that are parallel or at right angles."""

    angle: float  # radians, up to full right angles
    drift: float  # radians that the sweep turned further than the wheels did
    share: float  # of the marks that have this direction


def grain_of(marks: Sequence[Mark], guess: float, within: float) -> Grain | None:
    """The direction of most walls, that near the one it was thought to be; None without walls."""
    if len(marks) < 20:
        return None
    angle, drift = mode_of(marks, guess, within), 0.0
    for _ in range(8):
        # Least squares for both, with a weight that makes light of what is far off.
        aa, ad, dd, ra, rd = 0.0, 0.0, SPREAD**2 / DRIFT**2, 0.0, 0.0
        for mark in marks:
            off = math.remainder(mark.normal + drift * mark.when - angle, RIGHT_ANGLE)
            weight = 0.2 / (1.0 + (off / SPREAD / 1.5) ** 2) ** 2
            aa += weight
            ad -= weight * mark.when
            dd += weight * mark.when**2
            ra += weight * off
            rd -= weight * mark.when * off
        rd -= SPREAD**2 / DRIFT**2 * drift
        determinant = aa * dd - ad * ad
        if determinant <= 0.0:
            return None
        angle += (ra * dd - rd * ad) / determinant
        drift += (aa * rd - ad * ra) / determinant
    fitting = sum(
        abs(math.remainder(m.normal + drift * m.when - angle, RIGHT_ANGLE)) < ASIDE
        for m in marks
    )
    return Grain(angle, drift, fitting / len(marks))


def mode_of(marks: Sequence[Mark], guess: float, within: float) -> float:
    """The direction that most marks have."""
    count = int(within / SPREAD)
    tried = [guess + index * SPREAD for index in range(-count, count + 1)]
    tried.sort(key=lambda angle: abs(angle - guess))
    return max(
        tried,
        key=lambda angle: sum(
            abs(math.remainder(mark.normal - angle, RIGHT_ANGLE)) < SPREAD
            for mark in marks
        ),
    )
